//! Figures of the documents that a run made: each stands in one table, with what it was made with, and is no older than that.

use std::collections::{BTreeMap, BTreeSet};

use super::documents::lines;
use super::golden::versions;
use super::tree::{files, root, text, within};

/// The table: document, words of the figure, versions of the stages that made it, date, command.
const TABLE: &str = "docs/claims.tsv";

/// A figure of a document.
struct Claim {
    document: String,
    words: String,
    /// Stages with their versions; none of what no stage makes.
    made_with: Vec<(String, String)>,
}

/// Words of a text with one space between them.
fn plain(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

fn claims() -> Vec<Claim> {
    let claim = |line: &str| {
        let cells: Vec<&str> = line.split('\t').collect();
        assert_eq!(cells.len(), 5, "{TABLE}: {line}");
        let is_date = cells[3].len() == 10 && cells[3].split('-').all(|part| part.parse::<u32>().is_ok());
        assert!(is_date && !cells[4].is_empty(), "{TABLE}: a date and a command: {line}");
        let stage = |made: &str| {
            let (stage, version) = made.split_once('=').unwrap_or_else(|| panic!("{TABLE}: stage=version: {line}"));
            (stage.to_owned(), version.to_owned())
        };
        let made_with = cells[2].split_whitespace().filter(|made| *made != "-").map(stage).collect();
        Claim { document: cells[0].to_owned(), words: plain(cells[1]), made_with }
    };
    text(&root().join(TABLE)).lines().skip(1).map(claim).collect()
}

/// Versions of today's stages; of a simulator that of its method, for a constant that changes changes no claim by itself.
fn todays() -> BTreeMap<String, String> {
    let of = |(stage, version): (&str, String)| {
        let version = version.split(' ').next().unwrap_or_default().to_owned();
        (if stage == "fem" { "sim" } else { stage }.to_owned(), version)
    };
    versions().into_iter().filter(|(stage, _)| *stage != "hybrid").map(of).collect()
}

#[test]
fn no_figure_is_older_than_what_made_it() {
    let today = todays();
    let mut told = Vec::new();
    for Claim { document, words, made_with } in claims() {
        if !plain(&text(&root().join(&document))).contains(&words) {
            told.push(format!("{document} does not say: {words}"));
        }
        for (stage, version) in made_with {
            let now = today.get(&stage).unwrap_or_else(|| panic!("{TABLE}: no stage {stage}"));
            if *now != version {
                told.push(format!("{document}: {words}: made with {stage} {version}, which is at {now} now"));
            }
        }
    }
    assert!(told.is_empty(), "measure these again, or take them out:\n{}", told.join("\n"));
}

/// Shares in a text: `54 of 54`, as words.
fn shares(text: &str) -> Vec<String> {
    let words: Vec<&str> = text.split_whitespace().collect();
    let number = |word: &str| {
        let digits = word.trim_matches(|c: char| !c.is_ascii_digit()).replace(',', "");
        digits.parse::<f64>().is_ok()
    };
    let share = |three: &[&str]| three[1] == "of" && number(three[0]) && number(three[2]);
    words.windows(3).filter(|three| share(three)).map(|three| three.join(" ")).collect()
}

#[test]
fn every_share_of_a_document_is_in_the_table() {
    let claims = claims();
    let mut documents = vec![root().join("README.md")];
    documents.extend(files(&root().join("docs"), &["md"]));
    let is_record = |name: &str| name.starts_with("docs/experiments/") || name.starts_with("docs/decisions/");
    let mut untold = BTreeSet::new();
    for path in documents.iter().filter(|path| !is_record(&within(path))) {
        let [_, prose] = lines(&text(path));
        let prose = prose.into_iter().map(|(_, line)| line).collect::<Vec<_>>().join(" ");
        for share in shares(&prose) {
            let is_told = |claim: &Claim| claim.document == within(path) && claim.words.contains(&share);
            if !claims.iter().any(is_told) {
                untold.insert(format!("{}: {share}", within(path)));
            }
        }
    }
    assert!(untold.is_empty(), "in no row of {TABLE}: {untold:#?}");
}
