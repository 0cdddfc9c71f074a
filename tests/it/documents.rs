//! What the documents say is there: every command parses, every link leads somewhere.

use std::collections::BTreeSet;

use toile::cli;

use super::tree::{documents, text, within};

/// A line with its number.
pub type Line = (usize, String);

/// Lines within blocks of code, and those outside.
pub fn lines(text: &str) -> [Vec<Line>; 2] {
    let mut sorted = [Vec::new(), Vec::new()];
    let mut is_code = false;
    for (at, line) in text.lines().enumerate() {
        if line.trim_start().starts_with("```") {
            is_code = !is_code;
        } else {
            sorted[usize::from(!is_code)].push((at + 1, line.to_owned()));
        }
    }
    sorted
}

/// Pieces of a line that stand two spaces or more apart: a command, its remark, another command.
fn apart(line: &str) -> impl Iterator<Item = &str> {
    line.split("  ").map(str::trim).filter(|part| !part.is_empty())
}

/// Words of a command as a shell reads them, without what is piped on. Brackets mark what may be left out.
pub fn words(command: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    let mut quote = None;
    for c in command.chars() {
        match (quote, c) {
            (Some(open), c) if c == open => quote = None,
            (None, '\'' | '"') => quote = Some(c),
            (None, '|' | '#' | '>' | ';') => break,
            (None, '[' | ']') => {}
            (None, ' ') => words.push(String::new()),
            (_, c) => words.last_mut().expect("one").push(c),
        }
    }
    // `N` stands for a number, as `JOB` does.
    let number = |word: String| if ["N", "JOB", "JOB..."].contains(&word.as_str()) { "1".to_owned() } else { word };
    words.into_iter().filter(|word| !word.is_empty() && !word.starts_with("...")).map(number).collect()
}

/// Commands of a line of a block, from the name of the program on.
pub fn commands(line: &str) -> Vec<String> {
    let typed = line.trim().strip_prefix("$ ").unwrap_or(line.trim());
    let typed = typed.replace("cargo run --release -- ", "toile ");
    let begins = |part: &&str| part.starts_with("toile ");
    apart(&typed).filter(begins).map(str::to_owned).collect()
}

/// Commands between backquotes in prose.
pub fn named(line: &str) -> Vec<String> {
    let code = line.split('`').skip(1).step_by(2);
    code.filter(|code| code.starts_with("toile ")).map(str::to_owned).collect()
}

/// What is wrong with a command. One that prose names need not have all its arguments.
fn fault(command: &str, is_named: bool) -> Option<String> {
    let error = cli::command().try_get_matches_from(words(command)).err()?;
    let kind = format!("{:?}", error.kind());
    let is_short = ["MissingRequiredArgument", "DisplayHelpOnMissingArgumentOrSubcommand", "MissingSubcommand"];
    let is_help = ["DisplayHelp", "DisplayVersion"].contains(&kind.as_str());
    let is_fine = is_help || is_named && is_short.contains(&kind.as_str());
    (!is_fine).then(|| error.to_string())
}

#[test]
fn every_command_in_the_documents_parses() {
    let mut count = 0;
    let mut faults = Vec::new();
    for path in documents().iter().filter(|path| !path.ends_with("CHANGELOG.md")) {
        let [code, prose] = lines(&text(path));
        let of_code = code.iter().flat_map(|(at, line)| commands(line).into_iter().map(|c| (*at, c, false)));
        let of_prose = prose.iter().flat_map(|(at, line)| named(line).into_iter().map(|c| (*at, c, true)));
        for (at, command, is_named) in of_code.chain(of_prose) {
            count += 1;
            if let Some(fault) = fault(&command, is_named) {
                faults.push(format!("{}, line {at}: {command}\n{fault}", within(path)));
            }
        }
    }
    assert!(count > 150, "only {count} commands are found");
    assert!(faults.is_empty(), "{} of {count}:\n{}", faults.len(), faults.join("\n"));
}

#[test]
fn commands_are_told_from_their_remarks() {
    let check = |line: &str, expect: &[&[&str]]| {
        let found: Vec<Vec<String>> = commands(line).iter().map(|command| words(command)).collect();
        assert_eq!(found, expect, "{line}");
    };
    check("toile run a   what it does", &[&["toile", "run", "a"]]);
    check("$ toile sql \"a  b\"", &[&["toile", "sql", "a"]]);
    check("$ toile sql 'a b' | head", &[&["toile", "sql", "a b"]]);
    check("toile report A       toile ease B", &[&["toile", "report", "A"], &["toile", "ease", "B"]]);
    check("cargo run --release -- run a [--workers N]", &[&["toile", "run", "a", "--workers", "1"]]);
    check("tshirt S, fem: toile", &[]);
    assert!(fault("toile run", true).is_none() && fault("toile run", false).is_some());
    assert!(fault("toile rum", true).is_some() && fault("toile run a --no-such", true).is_some());
}

/// Targets of the links and pictures of a line.
fn targets(line: &str) -> Vec<&str> {
    line.split("](").skip(1).filter_map(|rest| Some(rest.split_once(')')?.0)).collect()
}

/// The anchor of a heading, as GitHub makes it.
fn anchor(heading: &str) -> String {
    let kept = |c: &char| c.is_alphanumeric() || "-_ ".contains(*c);
    heading.trim_start_matches('#').trim().to_lowercase().chars().filter(kept).collect::<String>().replace(' ', "-")
}

fn anchors(text: &str) -> BTreeSet<String> {
    let [_, prose] = lines(text);
    prose.iter().filter(|(_, line)| line.starts_with('#')).map(|(_, line)| anchor(line)).collect()
}

#[test]
fn every_link_leads_somewhere() {
    let mut count = 0;
    let mut faults = Vec::new();
    for path in documents() {
        let text_here = text(&path);
        let [_, prose] = lines(&text_here);
        // A link may be broken at the end of a line.
        let whole: Vec<&str> = prose.iter().map(|(_, line)| line.as_str()).collect();
        for target in targets(&whole.join("\n")) {
            let target = target.replace('\n', " ");
            if target.contains("://") {
                continue;
            }
            count += 1;
            let (file, place) = target.split_once('#').unwrap_or((&target, ""));
            let to = if file.is_empty() { path.clone() } else { path.parent().expect("a folder").join(file) };
            let is_there = to.exists() && (place.is_empty() || anchors(&text(&to)).contains(place));
            if !is_there {
                faults.push(format!("{}: {target}", within(&path)));
            }
        }
    }
    assert!(count > 100, "only {count} links are found");
    assert!(faults.is_empty(), "{} of {count}:\n{}", faults.len(), faults.join("\n"));
}

#[test]
fn headings_have_anchors() {
    let check = |heading: &str, expect: &str| assert_eq!(anchor(heading), expect);
    check("## Other machines", "other-machines");
    check("# `toile run`: a study, and more", "toile-run-a-study-and-more");
    assert_eq!(targets("[a](b.md#c) and ![d](e.png)"), ["b.md#c", "e.png"]);
}

/// Rows and columns of a terminal on which the help of a command is seen whole.
const SCREEN: [usize; 2] = [50, 100];

/// Every command by the words that call it.
pub fn calls(command: &clap::Command, before: &[String]) -> Vec<Vec<String>> {
    let words = [before, &[command.get_name().to_owned()]].concat();
    let below = command.get_subcommands().flat_map(|of| calls(of, &words)).collect::<Vec<_>>();
    [vec![words], below].concat()
}

#[test]
fn the_help_of_every_command_fits_a_screen() {
    let all = calls(&cli::command(), &[]);
    assert!(all.len() > 80, "only {} commands", all.len());
    let mut faults = Vec::new();
    for call in all {
        let words = call.iter().map(String::as_str).chain(["--help"]);
        let help = cli::command().term_width(SCREEN[1]).try_get_matches_from(words).expect_err("help").to_string();
        let widest = help.lines().map(|line| line.chars().count()).max().unwrap_or(0);
        let rows = help.lines().count();
        if rows > SCREEN[0] || widest > SCREEN[1] {
            faults.push(format!("{}: {rows} rows of up to {widest}", call.join(" ")));
        }
    }
    assert!(faults.is_empty(), "{faults:#?}");
}
