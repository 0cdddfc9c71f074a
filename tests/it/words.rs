//! Comments on items begin with a noun or a verb, as those of the standard library do.

use super::tree::{files, root, text, within};

/// Words that begin a question, and so a comment that answers it in a roundabout way.
const QUESTIONS: [&str; 5] = ["What", "Whether", "How", "Where", "Who"];

/// Where comments are the help that users read.
const HELP: &str = "src/cli/args";

/// Lines that begin a comment on an item with such a word, by number.
fn roundabout(text: &str) -> Vec<usize> {
    let comment = |line: &str| {
        let line = line.trim_start();
        line.strip_prefix("///").or_else(|| line.strip_prefix("//!")).map(|comment| comment.trim().to_owned())
    };
    let mut found = Vec::new();
    let mut is_within = false;
    for (number, line) in text.lines().enumerate() {
        let Some(comment) = comment(line) else {
            is_within = false;
            continue;
        };
        let first = comment.split_whitespace().next().unwrap_or_default();
        if !is_within && QUESTIONS.contains(&first) {
            found.push(number + 1);
        }
        is_within = true;
    }
    found
}

#[test]
fn comments_of_items_begin_with_a_noun_or_a_verb() {
    let sources = files(&root().join("src"), &["rs"]);
    let told: Vec<String> = sources
        .iter()
        .filter(|path| !path.starts_with(root().join(HELP)))
        .flat_map(|path| roundabout(&text(path)).into_iter().map(|line| format!("{}:{line}", within(path))))
        .collect();
    assert!(sources.len() > 500, "only {} files", sources.len());
    assert!(told.is_empty(), "begin with a noun or a verb:\n{}", told.join("\n"));
}

#[test]
fn roundabout_comments_are_found() {
    let check = |text: &str, expect: &[usize]| assert_eq!(roundabout(text), expect, "{text}");
    check("/// Length of a seam, m.\nfn f() {}\n", &[]);
    check("/// Length of a seam, m.\n/// Where it is open, nothing.\nfn f() {}\n", &[]);
    check("    /// Whether it is open.\n    is_open: bool,\n", &[1]);
    check("//! What a file holds.\n\n/// How long it is.\nfn f() {}\n", &[1, 3]);
    check("// What is plain may begin so.\n", &[]);
}
