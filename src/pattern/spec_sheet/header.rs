//! Columns of a specification sheet, found by the words at their heads.

use std::collections::BTreeSet;

use super::grid::Grid;
use super::number;

const CODES: [&str; 21] = [
    "code", "pom", "pom #", "pom#", "pom no", "pom code", "no", "no.", "#", "ref", "ref.", "id", "item", "pos", "pos.",
    "point", "key", "nr", "nr.", "dim", "pt",
];
const DESCRIPTIONS: [&str; 24] = [
    "description",
    "descriptions",
    "point of measure",
    "points of measure",
    "point of measurement",
    "points of measurement",
    "measurement",
    "measurements",
    "measurement point",
    "measurement points",
    "measurement description",
    "measure",
    "pom description",
    "pom name",
    "name",
    "beschreibung",
    "bezeichnung",
    "messpunkt",
    "maß",
    "libellé",
    "désignation",
    "mesure",
    "descripción",
    "descrizione",
];
/// Beginnings of the heads of columns of tolerances.
const TOLERANCES: [&str; 4] = ["tol", "+/-", "±", "+-"];
/// Beginnings of the heads of columns that hold no specification.
const OTHERS: [&str; 24] = [
    "actual",
    "act",
    "diff",
    "dev",
    "var",
    "comment",
    "remark",
    "note",
    "critical",
    "crit",
    "qc",
    "rev",
    "status",
    "uom",
    "unit",
    "image",
    "sketch",
    "type",
    "category",
    "group",
    "section",
    "method",
    "how to",
    "instruction",
];
/// Letters of sizes, between which there are only digits and signs.
const LETTERS: [&str; 12] = ["xxxs", "xxs", "xs", "s", "m", "l", "xl", "xxl", "xxxl", "xxxxl", "os", "one size"];
/// Greatest number of letters after the number of a size, as in `10Y` or `34L`.
const MOST_LETTERS: usize = 2;
/// Greatest number that is a size, such as the stature of a child in cm.
const GREATEST_SIZE: u32 = 188;

#[derive(Clone, Debug, PartialEq)]
pub struct Columns {
    /// First and last row of the heads.
    pub heads: [usize; 2],
    pub code: Option<usize>,
    pub description: usize,
    /// Upwards and downwards; the same for a column that holds both ways.
    pub tolerance: Option<[usize; 2]>,
    pub sizes: Vec<(usize, String)>,
}

/// Takes the first table. `known` are the pattern's sizes. `None` if no row has heads for descriptions and sizes.
pub fn columns(grid: &Grid, known: &[String]) -> Option<Columns> {
    grid.rows.iter().find_map(|row| columns_at(grid, row.line, known))
}

struct Heads {
    rows: [usize; 2],
    /// Both rows of heads, in lower case.
    words: Vec<String>,
    /// Lower row, or the upper one if that is empty.
    own: Vec<String>,
}

fn columns_at(grid: &Grid, line: usize, known: &[String]) -> Option<Columns> {
    let words: Vec<String> = (0..grid.width()).map(|column| plain(grid.at(line, column))).collect();
    let find = |names: &[&str]| words.iter().position(|word| names.contains(&word.as_str()));
    let (code, described) = (find(&CODES), find(&DESCRIPTIONS));
    // A sheet with a single such column has the descriptions in it.
    let (code, description) = match (code, described) {
        (code, Some(description)) => (code, description),
        (Some(code), None) => (None, code),
        (None, None) => return None,
    };
    let heads = heads(grid, line, description, code);
    let is_taken = |column: usize| Some(column) == code || column == description;
    let free = |column: &usize| !is_taken(*column) && !heads.words[*column].is_empty();
    let tolerances: Vec<usize> = (0..words.len()).filter(free).filter(|k| is_tolerance(&heads.words[*k])).collect();
    let numbers = |column: &usize| {
        let rows = grid.rows.iter().filter(|row| row.line > heads.rows[1]);
        rows.filter(|row| number::length(grid.at(row.line, *column)).is_some()).count()
    };
    let others = |column: &usize| {
        let word = &heads.words[*column];
        let is_grade = word.starts_with("grad") && !is_size(&heads.own[*column], known);
        is_grade || tolerances.contains(column) || OTHERS.iter().any(|other| word.starts_with(other))
    };
    let filled: Vec<usize> = (0..words.len()).filter(free).filter(|k| !others(k) && numbers(k) > 0).collect();
    let named: Vec<usize> = filled.iter().copied().filter(|k| is_size(&heads.own[*k], known)).collect();
    let sizes = if named.is_empty() { filled } else { named };
    let mut sizes: Vec<(usize, String)> = sizes.into_iter().map(|k| (k, size_name(&heads.own[k]))).collect();
    // A further block of the same sizes holds what was measured on samples.
    let mut names = BTreeSet::new();
    sizes.retain(|(_, name)| names.insert(name.to_lowercase()));
    let lines = || grid.rows.iter().map(|row| row.line).filter(|line| *line > heads.rows[1]);
    let specified: Vec<usize> =
        lines().filter(|line| sizes.iter().any(|(k, _)| number::length(grid.at(*line, *k)).is_some())).collect();
    let is_described = |line: &&usize| {
        let text = grid.spread(**line, description);
        !text.is_empty() && number::length(text).is_none()
    };
    // A word such as `Ref` above other cells heads no table.
    let is_table = 2 * specified.iter().filter(is_described).count() > specified.len();
    is_table.then(|| Columns {
        heads: heads.rows,
        code,
        description,
        tolerance: tolerance(&tolerances, &heads.words),
        sizes,
    })
}

fn heads(grid: &Grid, line: usize, description: usize, code: Option<usize>) -> Heads {
    let width = grid.width();
    let is_other = |column: usize| column != description && Some(column) != code;
    let near = |line: usize| {
        let row = grid.rows.iter().find(|row| row.line == line)?;
        let is_beside =
            grid.at(line, description).is_empty() && (0..width).any(|k| is_other(k) && !grid.at(line, k).is_empty());
        is_beside.then_some(row.line)
    };
    let is_bare = (0..width).filter(|k| is_other(*k)).all(|k| {
        let word = plain(grid.at(line, k));
        word.is_empty() || is_tolerance(&word)
    });
    let [upper, lower] = match (near(line + 1), line.checked_sub(1).and_then(near)) {
        (Some(below), _) => [line, below],
        (None, Some(above)) if is_bare => [above, line],
        _ => [line, line],
    };
    let texts = |line: usize| (0..width).map(move |k| grid.spread(line, k).to_owned());
    let both = texts(upper).zip(texts(lower));
    let words = both.clone().map(|(above, below)| match upper == lower || above == below {
        true => plain(&below),
        false => plain(&format!("{above} {below}")),
    });
    let own = both.map(|(above, below)| if below.is_empty() { above } else { below });
    Heads { rows: [upper, lower], words: words.collect(), own: own.collect() }
}

/// Lower case with single spaces, without a unit in brackets and a colon at the end.
fn plain(text: &str) -> String {
    let mut text = text.to_lowercase().replace('\u{2212}', "-");
    for unit in ["(in)", "(inch)", "(inches)", "(cm)", "(mm)"] {
        text = text.replace(unit, "");
    }
    text.split_whitespace().collect::<Vec<_>>().join(" ").trim_end_matches([':', '.']).to_owned()
}

fn is_tolerance(word: &str) -> bool {
    let word = word.trim_start_matches('(');
    TOLERANCES.iter().any(|begin| word.starts_with(begin)) || ["+", "-", "+)", "-)", "plus", "minus"].contains(&word)
}

fn tolerance(columns: &[usize], words: &[String]) -> Option<[usize; 2]> {
    let signs = |column: &usize| {
        let word = &words[*column];
        [word.contains(['+', '±']) || word.contains("plus"), word.contains(['-', '±']) || word.contains("minus")]
    };
    let of = |signed: [bool; 2]| columns.iter().copied().find(|column| signs(column) == signed);
    match (of([true, false]), of([false, true])) {
        (Some(plus), Some(minus)) => Some([plus, minus]),
        _ => columns.first().map(|both| [*both; 2]),
    }
}

fn is_size(head: &str, known: &[String]) -> bool {
    let name = size_name(head).to_lowercase();
    let part = |part: &str| {
        let digits = part.trim_end_matches(|c: char| c.is_ascii_alphabetic());
        let number = digits.parse::<u32>().ok().filter(|number| *number <= GREATEST_SIZE);
        let letters = part.trim_start_matches(|c: char| c.is_ascii_digit());
        LETTERS.contains(&letters) || number.is_some() && part.len() - digits.len() <= MOST_LETTERS
    };
    let is_known = known.iter().any(|size| !size.is_empty() && size.eq_ignore_ascii_case(&name));
    is_known || !name.is_empty() && name.split(['/', '-']).all(|one| part(one.trim()))
}

/// Cuts words such as `size` before the name, and remarks in brackets after it.
fn size_name(head: &str) -> String {
    let name = head.split('(').next().unwrap_or_default().trim();
    let name = if name.is_empty() { head.trim() } else { name };
    let words: Vec<&str> = name.split_whitespace().collect();
    let is_before = |word: &&str| {
        ["size", "sz", "sz.", "gr.", "größe", "taille", "talla", "taglia"].contains(&word.to_lowercase().as_str())
    };
    let skip = words.first().filter(|first| words.len() > 1 && is_before(first)).map_or(0, |_| 1);
    words[skip..].join(" ").trim_matches(['*', ':', '"']).to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_told_from_other_columns() {
        let check = |head: &str, expect: bool| assert_eq!(is_size(head, &["base".to_owned()]), expect, "{head}");
        for size in ["S", "XXL", "2XL", "Size 38", "36/38", "S/M", "10Y", "34L", "M (sample)", "BASE", "176"] {
            check(size, true);
        }
        for other in ["Spec", "Target", "1st sample", "2026", "Remarks", "", "S1 actual"] {
            check(other, false);
        }
    }
}
