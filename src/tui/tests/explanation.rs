//! Explanations of the numbers of a screen.

use super::Bench;
use crate::glossary::TERMS;
use crate::keys::screen::Screen;
use crate::screens::fit::actions::{card_levels, quantities_shown};

/// Names in the glossary, the longest first.
fn names() -> Vec<&'static str> {
    let mut names: Vec<&str> = TERMS.iter().flat_map(|term| &term.names).map(String::as_str).collect();
    names.sort_by_key(|name| std::cmp::Reverse(name.chars().count()));
    names
}

/// Part of a heading that the glossary lacks, without names of this study and signs of order.
fn unknown(heading: &str, own: &[&str]) -> String {
    let heading = heading.replace(['▲', '▼', '│', '"', '↓', '↕', '◂', '▸'], " ");
    let heading = heading.split_whitespace().collect::<Vec<_>>().join(" ");
    let mut rest = heading.as_str();
    while !rest.is_empty() {
        let known = names()
            .into_iter()
            .chain(own.iter().copied())
            .find(|name| rest.strip_prefix(name).is_some_and(|after| after.is_empty() || after.starts_with(' ')));
        let Some(known) = known else { return rest.to_owned() };
        rest = rest[known.len()..].trim_start();
    }
    String::new()
}

#[test]
fn every_heading_has_a_term() {
    let check = |keys: &str, begins: &str, own: &[&str]| {
        let screen = Bench::example(160, 50).press(keys).screen();
        let heading = screen.lines().find_map(|line| line.find(begins).map(|at| &line[at..]));
        let heading = heading.unwrap_or_else(|| panic!("{begins} in\n{screen}"));
        let end = heading.find('│').unwrap_or(heading.len());
        assert_eq!(unknown(&heading[..end], own), "", "of `{}`", &heading[..end]);
    };
    check("", "EI  ", &["i", "ii", "iii"]);
    check("2", "subject▲", &[]);
    check("2", "mm, kg", &["mm, kg"]);
    check("3", "style   ", &[]);
    check("3", "edges  ", &[]);
    check("4", "ID▲", &[]);
    check("5", "#▲", &[]);
    check("c", "# meas", &[]);
    check("9", "fabric▲", &[]);
    check("9", "value  ", &["3"]);
    check("0", "body   ", &["S", "M wear", "M", "wear", "S wear", "L"]);
    check("0<Tab>", "gap, mm", &[]);
}

#[test]
fn every_number_of_a_result_has_a_term() {
    let numbers = "EI E(chi) SD(chi) max err n seam gap in body residual steps vertices faces ease mm why cached made";
    assert_eq!(unknown(numbers, &[]), "");
}

#[test]
fn every_quantity_of_the_sizes_has_a_term() {
    let mut bench = Bench::example(160, 50);
    bench.press("0");
    let quantities = quantities_shown(&bench.app.state);
    assert!(quantities.len() > 5);
    for quantity in quantities {
        assert!(crate::glossary::term(&quantity.name).is_some(), "{}", quantity.name);
    }
    for level in card_levels(&bench.app.state) {
        assert!(crate::glossary::term(&level.replace('_', " ")).is_some(), "{level}");
    }
}

#[test]
fn what_is_selected_is_told_first() {
    let check = |keys: &str, expect: &[&str]| {
        let screen = Bench::example(80, 24).press(keys).screen();
        for words in expect {
            assert!(screen.contains(words), "{keys}: {words} in\n{screen}");
        }
    };
    check("K", &["S on i by FEM, done, EI 0.0117, ease +43 mm, tight", "The mean distance of chi"]);
    check("4KE(chi)", &["job 1, tshirt S on i: done", "The mean of chi"]);
    check("9jK", &["jersey: 104 g/m²"]);
    check("2ssK", &["measurements known", "The height of the body"]);
    check("8Kresidual", &["The force that is left over"]);
    check("8Kno such thing", &["nothing of that name"]);
    check(":explain<Enter>", &["what is this"]);
    let mut bench = Bench::example(80, 24);
    assert!(bench.press("K<Esc>").app.state.overlay.is_none() && bench.app.state.nav.screen == Screen::Study);
}
