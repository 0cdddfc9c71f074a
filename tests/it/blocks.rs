//! Blocks of code in the documents: TOML is what the reader of such a file takes, SQL fits the program's own schema.

use std::collections::BTreeSet;
use std::path::PathBuf;

use toml::{Table, Value};

use super::documents::{commands, lines, named, words};
use super::program::Place;
use super::readers::{Readers, seam_file};
use super::tree::{documents, files, root, text, within};

/// A block of code.
struct Block {
    /// Line on which it begins, from 1.
    at: usize,
    /// What stands behind the fence.
    language: String,
    /// All that stands before it.
    before: String,
    text: String,
}

/// Blocks of a document.
fn blocks(text: &str) -> Vec<Block> {
    let mut found = Vec::new();
    let mut open: Option<Block> = None;
    let mut before = String::new();
    for (at, line) in text.lines().enumerate() {
        let fence = line.trim_start().strip_prefix("```");
        match (fence, &mut open) {
            (Some(_), Some(_)) => found.extend(open.take()),
            (Some(language), None) => {
                let language = language.trim().to_owned();
                open = Some(Block { at: at + 1, language, before: before.clone(), text: String::new() });
            }
            (None, Some(block)) => block.text += &format!("{line}\n"),
            (None, None) => before += &format!("{line}\n"),
        }
    }
    found
}

impl Block {
    /// Whether it is TOML: it says so, or begins with the header of a table.
    fn is_toml(&self) -> bool {
        let first = self.text.lines().next().unwrap_or_default();
        self.language == "toml" || self.language.is_empty() && first.starts_with('[') && first.ends_with(']')
    }
}

/// Documents, and those of studies.
fn all_documents() -> Vec<PathBuf> {
    documents().into_iter().chain(files(&root().join("studies"), &["md"])).collect()
}

/// A small study that is right.
const STUDY: &str = r#"
[[subject]]
id = "ii"
like = "male-ii"
[[garment]]
name = "tshirt"
seams = "patterns/tshirt.seams.toml"
fabric = "cotton_shirting_light"
sizes = [{ name = "S", pattern = "patterns/tshirt-s.dxf" }, { name = "M", pattern = "patterns/tshirt-m.dxf" }]
"#;

/// The tables of a list.
fn tables<'t>(file: &'t mut Table, key: &str) -> Vec<&'t mut Table> {
    let list = file.get_mut(key).and_then(Value::as_array_mut);
    list.into_iter().flatten().filter_map(Value::as_table_mut).collect()
}

/// Names of garments that a study file has in its outfits, its sweeps and its `after`.
fn mentioned(file: &mut Table) -> BTreeSet<String> {
    let places = [("outfit", "layers"), ("garment", "after"), ("sweep", "garments")];
    let lists = places.map(|(kind, key)| {
        tables(file, kind).into_iter().filter_map(|t| t.get(key)?.as_array()).cloned().collect::<Vec<_>>()
    });
    lists.concat().concat().iter().filter_map(|name| name.as_str().map(str::to_owned)).collect()
}

/// A part of a study file with what a whole one needs besides.
fn whole_study(mut part: Table) -> String {
    let whole: Table = STUDY.parse().expect("it is right");
    for kind in ["subject", "garment"] {
        let one = whole[kind][0].as_table().expect("a table").clone();
        part.entry(kind).or_insert_with(|| whole[kind].clone());
        for entry in tables(&mut part, kind) {
            let is_somebody = entry.contains_key("scan") || entry.contains_key("sex");
            for (key, value) in one.iter().filter(|(key, _)| *key != "like" || !is_somebody) {
                entry.entry(key.clone()).or_insert_with(|| value.clone());
            }
        }
    }
    let there: BTreeSet<String> =
        tables(&mut part, "garment").iter().filter_map(|one| Some(one["name"].as_str()?.to_owned())).collect();
    for name in mentioned(&mut part).difference(&there) {
        let mut garment = whole["garment"][0].clone();
        garment["name"] = Value::String(name.clone());
        part["garment"].as_array_mut().expect("a list").insert(0, garment);
    }
    part.to_string()
}

/// What is wrong with a block as a file of the workbench, which reads these before it looks for a terminal.
fn workbench_faults(block: &Block) -> Vec<String> {
    let name = ["keys.toml", "theme.toml"].into_iter().max_by_key(|name| block.before.rfind(name)).expect("two");
    let place = Place::new();
    place.write(&format!("toile/{name}"), &block.text);
    let output = place.command("").env("XDG_CONFIG_HOME", place.path("")).output().expect("it starts");
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    if told.contains("needs a terminal") { Vec::new() } else { vec![told] }
}

/// What the reader of such a file says of a block of TOML. Files that it names need not be there.
fn toml_faults(readers: &Readers, path: &str, block: &Block) -> Vec<String> {
    let table: Table = match block.text.parse() {
        Ok(table) => table,
        Err(error) => return vec![error.to_string()],
    };
    if path.ends_with("workbench.md") {
        return workbench_faults(block);
    }
    if ["piece", "seam", "measurement", "reinforce"].iter().any(|key| table.contains_key(*key)) {
        let name = if table.contains_key("name") { "" } else { "name = \"a style\"\n" };
        return seam_file(&format!("{name}{}", block.text)).into_iter().collect();
    }
    let told = readers.study(&whole_study(table));
    told.into_iter().filter(|problem| !problem.contains("No such file")).collect()
}

#[test]
fn toml_in_the_documents_is_read() {
    let readers = Readers::new();
    let mut count = 0;
    let mut faults = Vec::new();
    for path in all_documents() {
        for block in blocks(&text(&path)).iter().filter(|block| block.is_toml()) {
            count += 1;
            let told = toml_faults(&readers, &within(&path), block);
            faults.extend(told.iter().map(|fault| format!("{}, line {}: {fault}", within(&path), block.at)));
        }
    }
    assert!(count > 10, "only {count} blocks are found");
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn a_wrong_block_is_found() {
    let readers = Readers::new();
    let check = |path: &str, text: &str, says: &str| {
        let document = format!("`toile/keys.toml`\n```toml\n{text}\n```\n");
        let told = toml_faults(&readers, path, &blocks(&document)[0]).join("\n");
        assert!(if says.is_empty() { told.is_empty() } else { told.contains(says) }, "{text}: {told}");
    };
    check("docs/a.md", "[[outfit]]\nname = \"office\"\nlayers = [\"shirt\", \"trousers\"]", "");
    check("docs/a.md", "[[outfit]]\nname = \"office\"\nlayer = [\"shirt\", \"trousers\"]", "did you mean `layers`?");
    check("docs/a.md", "[[subject]]\nid = \"anna\"\nscan = \"anna.ply\"", "");
    check("docs/a.md", "[[garment]]\nfabric = \"felt\"", "no fabric `felt`");
    check("docs/a.md", "[parameters]\nfem.ofset_mu = 1", "did you mean `fem.offset_mu`?");
    check("docs/a.md", "[[reinforce]]\nedge = [\"front.hem\"]", "unknown field `edge`");
    check("docs/a.md", "name = ", "TOML parse error");
    check("docs/workbench.md", "cancel = \"D\"", "");
    check("docs/workbench.md", "cancle = \"D\"", "cancle");
}

/// Questions of a document: blocks of SQL, and what `toile sql` is asked.
fn questions(text: &str) -> Vec<(usize, Vec<String>)> {
    let of_blocks = blocks(text).into_iter().filter(|block| block.language == "sql");
    let of_blocks = of_blocks.map(|block| (block.at, vec!["sql".to_owned(), block.text]));
    let [code, prose] = lines(text);
    let typed = code.iter().flat_map(|(at, line)| commands(line).into_iter().map(|command| (*at, command)));
    let told = prose.iter().flat_map(|(at, line)| named(line).into_iter().map(|command| (*at, command)));
    let asked = typed.chain(told).map(|(at, command)| (at, words(&command).split_off(1)));
    of_blocks.chain(asked.filter(|(_, words)| words.len() > 1 && words[0] == "sql")).collect()
}

#[test]
fn sql_in_the_documents_fits_the_schema() {
    let place = Place::new();
    let mut count = 0;
    let mut faults = Vec::new();
    // The questions of docs/sql.md have a test of their own, and its other commands stand for what is asked.
    for path in all_documents().iter().filter(|path| !path.ends_with("docs/sql.md")) {
        for (at, words) in questions(&text(path)) {
            count += 1;
            let output = place.command("").args(&words).output().expect("it starts");
            if !output.status.success() {
                let told = String::from_utf8_lossy(&output.stderr);
                faults.push(format!("{}, line {at}: {}: {told}", within(path), words.join(" ")));
            }
        }
    }
    assert!(count > 5, "only {count} questions are found");
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn questions_are_found() {
    let text = "`toile sql thesis_table`\n```sql\nSELECT 1\n```\n```\n$ toile sql \"select a\"\n```\n";
    let found: Vec<(usize, String)> = questions(text).into_iter().map(|(at, words)| (at, words[1].clone())).collect();
    assert_eq!(found, [(2, "SELECT 1\n".to_owned()), (6, "select a".to_owned()), (1, "thesis_table".to_owned())]);
}

#[test]
fn the_recipe_for_a_pattern_of_ones_own_works() {
    let heading = "### Your own pattern and body\n";
    let recipe = blocks(&text(&root().join("README.md"))).into_iter().find(|block| block.before.ends_with(heading));
    let place = Place::new();
    place.draft();
    std::fs::rename(place.path("patterns/tshirt-m.dxf"), place.path("shirt.dxf")).expect("writable");
    let recipe: Vec<String> = recipe.expect("in the readme").text.lines().flat_map(commands).collect();
    assert_eq!(recipe.len(), 5);
    for command in recipe {
        let output = place.command("").args(words(&command).split_off(1)).output().expect("it starts");
        assert!(output.status.success(), "{command}: {}", String::from_utf8_lossy(&output.stderr));
        if command.contains("study new") {
            // Coarse cloth comes to rest sooner.
            let study = text(&place.path("mine/study.toml"));
            place.write("mine/study.toml", study.replace("edge_length_mm = 15 ", "edge_length_mm = 60 "));
        }
    }
    assert!(place.path("reports/mine/index.html").is_file());
}
