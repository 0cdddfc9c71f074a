//! Rules that the words keep: how long a sentence of the documents, and of the comments on items, may be.

use std::path::{Path, PathBuf};

use super::tree::{documents, files, root, text};

/// Words that the middle sentence has at most.
const MEDIAN: usize = 14;

/// Words that nine sentences in ten stay below.
const NINE_IN_TEN: usize = 26;

/// Words that a sentence has at most.
const MOST: usize = 40;

/// Words that end with a point and end no sentence.
const SHORT: [&str; 14] =
    ["e.g.", "i.e.", "cf.", "vs.", "al.", "St.", "Fig.", "fig.", "approx.", "No.", "pp.", "p.", "ca.", "resp."];

/// Lines with their numbers.
type Lines<'a> = Vec<(usize, &'a str)>;

/// Where a sentence begins, and how many words it has.
#[derive(Debug, PartialEq, Eq)]
struct Sentence {
    line: usize,
    words: usize,
}

/// The text of a line without the mark of a list's item, if it has one.
fn item(line: &str) -> Option<&str> {
    let number = line.trim_start_matches(|c: char| c.is_ascii_digit());
    if number.len() < line.len() {
        return number.strip_prefix(". ");
    }
    ["- ", "* ", "+ "].iter().find_map(|mark| line.strip_prefix(*mark))
}

/// Paragraphs and items of lists. Code, tables, headings, pictures and tags are left out.
fn paragraphs(lines: Lines<'_>) -> Vec<Lines<'_>> {
    let mut found = Vec::new();
    let mut open = Lines::new();
    let mut is_code = false;
    for (number, line) in lines {
        let line = line.trim();
        let is_fence = line.starts_with("```");
        is_code ^= is_fence;
        let is_other = ["|", "#", "![", "<"].iter().any(|mark| line.starts_with(*mark));
        let begins = item(line);
        if is_fence || is_code || is_other || line.is_empty() || begins.is_some() {
            found.push(std::mem::take(&mut open));
        }
        if !is_fence && !is_code && !is_other && !line.is_empty() {
            open.push((number, begins.unwrap_or(line)));
        }
    }
    found.push(open);
    found.retain(|lines| !lines.is_empty());
    found
}

/// Whether a word is the last of a sentence.
fn is_last(word: &str) -> bool {
    let closing = |c: char| ")]\"'*_".contains(c);
    let opening = |c: char| "([\"'*_".contains(c);
    let word = word.trim_end_matches(closing);
    word.ends_with(['.', '!', '?']) && !SHORT.contains(&word.trim_start_matches(opening))
}

/// Words of a paragraph with their lines. Code between backquotes is a word; the target of a link is none.
fn words(paragraph: &[(usize, &str)]) -> Vec<(usize, String)> {
    let mut found = Vec::new();
    let mut word = String::new();
    let mut is_code = false;
    let mut depth = 0;
    for (number, line) in paragraph {
        let mut before = ' ';
        for c in line.chars() {
            if depth > 0 {
                match c {
                    '(' => depth += 1,
                    ')' => depth -= 1,
                    _ => {}
                }
            } else if c == '`' {
                is_code = !is_code;
                word.push('c');
            } else if is_code {
                word.push('c');
            } else if c == '(' && before == ']' {
                depth = 1;
            } else if c.is_whitespace() {
                found.push((*number, std::mem::take(&mut word)));
            } else {
                word.push(c);
            }
            before = c;
        }
        if !is_code {
            found.push((*number, std::mem::take(&mut word)));
        }
    }
    found.extend(paragraph.last().map(|(number, _)| (*number, word)));
    found.retain(|(_, word)| !word.is_empty());
    found
}

/// Sentences of a paragraph. A word has a letter or a digit.
fn sentences(paragraph: &[(usize, &str)]) -> Vec<Sentence> {
    let mut found = Vec::new();
    let mut open = Sentence { line: 0, words: 0 };
    for (number, word) in words(paragraph) {
        if word.contains(char::is_alphanumeric) {
            if open.words == 0 {
                open.line = number;
            }
            open.words += 1;
        }
        if open.words > 0 && is_last(&word) {
            found.push(std::mem::replace(&mut open, Sentence { line: 0, words: 0 }));
        }
    }
    if open.words > 0 {
        found.push(open);
    }
    found
}

/// Sentences of a document; of the changelog those of its newest version.
fn of_document(path: &Path, text: &str) -> Vec<Sentence> {
    let mut lines: Lines = text.lines().enumerate().map(|(at, line)| (at + 1, line)).collect();
    if path.ends_with("CHANGELOG.md") {
        let versions = lines.iter().enumerate().filter(|(_, (_, line))| line.starts_with("## "));
        let end = versions.map(|(at, _)| at).nth(1).unwrap_or(lines.len());
        lines.truncate(end);
    }
    paragraphs(lines).iter().flat_map(|paragraph| sentences(paragraph)).collect()
}

/// Sentences of the comments on the items of a source file.
fn of_comments(text: &str) -> Vec<Sentence> {
    let mut found = Vec::new();
    let mut open = Lines::new();
    for (at, line) in text.lines().chain([""]).enumerate() {
        let comment = line.trim().strip_prefix("///").filter(|rest| !rest.starts_with('/'));
        match comment {
            Some(comment) => open.push((at + 1, comment)),
            None => {
                let comment = paragraphs(std::mem::take(&mut open));
                found.extend(comment.iter().flat_map(|paragraph| sentences(paragraph)));
            }
        }
    }
    found
}

/// Holds the sentences of some files to the limits.
fn hold(what: &str, sentences: &[(PathBuf, Sentence)]) {
    let mut counts: Vec<usize> = sentences.iter().map(|(_, sentence)| sentence.words).collect();
    counts.sort_unstable();
    let long: Vec<String> = sentences
        .iter()
        .filter(|(_, sentence)| sentence.words > MOST)
        .map(|(path, sentence)| {
            let path = path.strip_prefix(root()).unwrap_or(path);
            format!("{}, line {}: {} words", path.display(), sentence.line, sentence.words)
        })
        .collect();
    assert!(long.is_empty(), "{what}: {} sentences of more than {MOST} words\n{}", long.len(), long.join("\n"));
    assert!(!counts.is_empty(), "{what}: no sentence");
    let median = counts[counts.len() / 2];
    assert!(median <= MEDIAN, "{what}: the middle sentence has {median} words, more than {MEDIAN}");
    let ninth = counts[counts.len() * 9 / 10];
    assert!(ninth < NINE_IN_TEN, "{what}: one sentence in ten has {ninth} words or more");
}

#[test]
fn sentences_of_documents_are_short() {
    let mut all = Vec::new();
    for path in documents() {
        let found = of_document(&path, &text(&path));
        all.extend(found.into_iter().map(|sentence| (path.clone(), sentence)));
    }
    hold("documents", &all);
}

#[test]
fn sentences_of_comments_are_short() {
    let mut all = Vec::new();
    for path in files(&root().join("src"), &["rs"]) {
        let found = of_comments(&text(&path));
        all.extend(found.into_iter().map(|sentence| (path.clone(), sentence)));
    }
    hold("comments", &all);
}

#[test]
fn sentences_are_told_apart() {
    let check = |text: &str, expect: &[[usize; 2]]| {
        let found: Vec<[usize; 2]> =
            of_document(Path::new("a.md"), text).iter().map(|sentence| [sentence.line, sentence.words]).collect();
        assert_eq!(found, expect, "{text}");
    };
    check("", &[]);
    check("One two. Three!", &[[1, 2], [1, 1]]);
    check("One two\nthree. Four\nfive", &[[1, 3], [2, 2]]);
    check("It is 0.5 mm, e.g. here: there; so.", &[[1, 8]]);
    check("(One two.) Three", &[[1, 2], [1, 1]]);
    check("`a b. c` is [one](two/three four.md) word - no more?", &[[1, 6]]);
    check("`a b\nc` d", &[[2, 2]]);
    check("# No heading\nOne\n\n| no | table |\n![no picture](a.png)\nTwo", &[[2, 1], [6, 1]]);
    check("One:\n- two\n  three\n- four\n2. five", &[[1, 1], [2, 2], [4, 1], [5, 1]]);
    check("One\n```\nno code. At all\n```\ntwo", &[[1, 1], [5, 1]]);
    let found = of_comments("/// One two.\n/// Three\nfn a() {}\n    /// Four.\n//// No.\n// No.\n");
    let counts: Vec<[usize; 2]> = found.iter().map(|sentence| [sentence.line, sentence.words]).collect();
    assert_eq!(counts, [[1, 2], [2, 1], [4, 1]]);
    let log = of_document(Path::new("CHANGELOG.md"), "# Log\n## 2\nOne two.\n## 1\nThree.\n");
    assert_eq!(log, [Sentence { line: 3, words: 2 }]);
}
