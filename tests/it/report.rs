//! Every number on a report's page against the views it is from.

use std::collections::BTreeMap;

use super::program::Place;

/// A table of a page.
struct Table {
    caption: String,
    /// Names over groups of columns.
    groups: Vec<String>,
    /// Cells of each row of the body.
    rows: Vec<Vec<String>>,
}

/// What lies between two marks, again and again.
fn between<'a>(text: &'a str, open: &'a str, close: &'a str) -> impl Iterator<Item = &'a str> {
    text.split(open).skip(1).filter_map(move |rest| rest.split_once(close).map(|(inside, _)| inside))
}

/// Text without tags; small print and marks are left out.
fn plain(html: &str) -> String {
    let mut kept = html.to_owned();
    for (open, close) in [("<small", "</small>"), ("<span", "</span>")] {
        while let Some((before, rest)) = kept.split_once(open) {
            kept = format!("{before}{}", rest.split_once(close).expect("closed").1);
        }
    }
    let text: String = kept.split('<').map(|part| part.split_once('>').map_or(part, |(_, text)| text)).collect();
    text.replace("\u{2212}", "-").replace("&#39;", "'").trim().to_owned()
}

fn tables(page: &str) -> Vec<Table> {
    let table = |html: &str| {
        let caption = plain(between(html, "<caption>", "</caption>").next().unwrap_or_default());
        let groups = between(html, "<th scope=\"colgroup\" colspan=\"2\">", "</th>").map(plain).collect();
        let body = html.split_once("<tbody>").map_or("", |(_, body)| body);
        let cells = |row: &str| -> Vec<String> {
            let cells = row.split("<t").skip(1).filter(|cell| cell.starts_with('h') || cell.starts_with('d'));
            cells.map(|cell| plain(cell.split_once('>').map_or("", |(_, rest)| rest))).collect()
        };
        Table { caption, groups, rows: between(body, "<tr>", "</tr>").map(cells).collect() }
    };
    between(page, "<table", "</table>").map(table).collect()
}

/// The row of a table whose head begins with a text.
fn row<'a>(tables: &'a [Table], caption: &str, head: &str) -> (&'a Table, &'a Vec<String>) {
    let table = tables.iter().find(|table| table.caption.starts_with(caption));
    let table = table.unwrap_or_else(|| panic!("no table {caption}"));
    let row = table.rows.iter().find(|row| row.first().is_some_and(|cell| cell.starts_with(head)));
    (table, row.unwrap_or_else(|| panic!("{caption}: no row {head} in {:?}", table.rows)))
}

fn name(simulator: &str) -> &'static str {
    if simulator == "fem" { "FEM-GS" } else { "Hybrid-GS" }
}

/// Whether a page shows a number: rounded to so many decimals, halves either way.
fn is_shown(shown: &str, value: &str, decimals: usize) -> bool {
    let is_rounded = shown.split_once('.').map_or(0, |(_, rest)| rest.len()) == decimals;
    let (Ok(number), Ok(value)) = (shown.parse::<f64>(), value.parse::<f64>()) else { return false };
    is_rounded && (number - value).abs() <= 0.5 * 0.1f64.powi(decimals as i32) * (1.0 + 1e-6)
}

/// Checks a row of numbers: what the page shows, the value, its decimals.
#[track_caller]
fn are_shown(numbers: &[(&String, &str, usize)], place: &str) {
    for (shown, value, decimals) in numbers {
        assert!(is_shown(shown, value, *decimals), "{place}: the page shows {shown}, the view has {value}");
    }
}

/// Every L3D and chi; the query gives garment, size, subject, simulator, number, L2D, L3D, chi.
fn chis(place: &Place, tables: &[Table], query: &str) -> usize {
    let answers = place.sql(query);
    for answer in &answers {
        let cell: Vec<&str> = answer.split(',').collect();
        let caption = format!("{}, size {}, {}", cell[0], cell[1], name(cell[3]));
        let (table, row) = row(tables, &caption, &format!("#{} ", cell[4]));
        let at = table.groups.iter().position(|subject| subject == cell[2]).expect("a column of the subject");
        are_shown(
            &[(&row[1], cell[5], 1), (&row[2 + 2 * at], cell[6], 1), (&row[3 + 2 * at], cell[7], 3)],
            &format!("{caption}: {answer}"),
        );
    }
    answers.len()
}

/// Every number of the page of a study that the views `v_chi`, `v_metrics`, `v_ease` and `v_recommendation` have.
pub fn numbers_are_those_of_the_views(place: &Place, page: &str) {
    let tables = tables(page);
    let lengths = "SELECT garment, size, subject, simulator, measurement_no, l2d_mm, l3d_mm, chi FROM v_chi
        WHERE stage = 'drape'";
    assert_ne!(chis(place, &tables, lengths), 0);

    let metrics = "SELECT garment, size, subject, simulator, n, e_chi, sd_chi, ei, max_abs_error, residual * 100,
        penetration_max_mm, seam_gap_max_mm, iterations, vertices, faces FROM v_metrics";
    for answer in place.sql(metrics) {
        let cell: Vec<&str> = answer.split(',').collect();
        let title = format!("{}, size {}", cell[0], cell[1]);
        let (_, truth) = row(&tables, &format!("{title}: truth"), cell[2]);
        let columns = [(2, 4, 0), (3, 5, 3), (4, 6, 3), (5, 7, 3), (8, 8, 3)];
        are_shown(&columns.map(|(at, of, decimals): (usize, usize, usize)| (&truth[at], cell[of], decimals)), &title);
        let (_, course) = row(&tables, &format!("{title}: how"), cell[2]);
        let columns = [(2, 9, 2), (3, 10, 1), (4, 11, 1), (5, 12, 0), (6, 13, 0), (7, 14, 0)];
        are_shown(&columns.map(|(at, of, decimals): (usize, usize, usize)| (&course[at], cell[of], decimals)), &title);
    }

    for answer in place.sql("SELECT garment, size, subject, ease_mm FROM v_ease WHERE decides") {
        let cell: Vec<&str> = answer.split(',').collect();
        let (_, sizes) = row(&tables, &format!("{}: ease in mm", cell[0]), cell[1]);
        assert!(
            sizes[1..].iter().any(|shown| is_shown(shown.trim_start_matches('+'), cell[3], 1)),
            "{answer}: {sizes:?}"
        );
    }
    let columns = "garment, fit_class, verdict, recommended, coalesce(effect, ''), coalesce(ci_low, ''), coalesce(ci_high, ''), n_subjects";
    cards_are(page, &place.sql(&format!("SELECT {columns} FROM v_recommendation")));
}

/// The verdict cards, for answers of garment, fit class, verdict, recommended, effect, its ends and subjects.
fn cards_are(page: &str, answers: &[String]) {
    let mut shown: BTreeMap<(String, String), &str> = BTreeMap::new();
    let section = between(page, "<section id=\"verdicts\">", "</section>").next().expect("verdicts");
    for garment in section.split("<h3>").skip(1) {
        let (head, cards) = garment.split_once("</h3>").expect("a heading");
        for card in between(cards, "<article class=\"card ", "</article>") {
            shown.insert((head.to_owned(), card.split_once('"').expect("a class").0.to_owned()), card);
        }
    }
    for answer in answers {
        let cell: Vec<&str> = answer.split(',').collect();
        let card =
            shown.get(&(cell[0].to_owned(), cell[1].to_owned())).unwrap_or_else(|| panic!("no card of {answer}"));
        assert!(card.contains(&format!("data-verdict=\"{}\"", cell[2])), "{answer}");
        assert!(card.contains(&format!("<p class=\"use\">{}</p>", name(cell[3]))), "{answer}");
        let effect = between(card, "<dt>Effect (interval)</dt><dd>", "</dd>").next().map(plain).expect("an effect");
        let numbers: Vec<&str> = effect.split([' ', '(', ')']).filter(|word| !["", "to"].contains(word)).collect();
        let values: Vec<&str> = cell[4..7].iter().copied().filter(|value| !value.is_empty()).collect();
        if values.is_empty() {
            assert_eq!(effect, "not measured", "{answer}");
        } else {
            let agree = |(shown, value): (&&str, &&str)| is_shown(shown.trim_start_matches('+'), value, 4);
            assert!(numbers.len() == values.len() && numbers.iter().zip(&values).all(agree), "{answer}: {effect}");
        }
        assert!(plain(card).contains(&format!("{} subject", cell[7])), "{answer}");
    }
}

#[test]
fn the_report_on_the_printed_tables_has_all_their_numbers_and_marks_the_wrong_ones() {
    let place = Place::new();
    place.toile("report thesis-published -o published").ends_with(0);
    let page = std::fs::read_to_string(place.path("published/index.html")).expect("the page is there");
    let tables = tables(&page);
    let lengths = "SELECT garment, size, substr(garment, 1, instr(garment, '_') - 1) || '-' || subject, simulator,
        measurement_no, l2d_mm, l3d_mm, chi FROM v_published";
    assert_eq!(chis(&place, &tables, lengths), 888);
    assert_eq!(page.matches("✗ printed").count(), 48, "every misprinted ratio is marked");
    for told in ["25 of 43 loose or tight cases", "without #6 Neck Opening", "hem less chest"] {
        assert!(page.contains(told), "{told}");
    }
    let answers = place.toile("recommend thesis-published --json").ends_with(0).json();
    let answers = answers.as_array().expect("rows");
    let line = |row: &serde_json::Value| {
        let text = |key: &str| match &row[key] {
            serde_json::Value::String(text) => text.clone(),
            serde_json::Value::Null => String::new(),
            other => other.to_string(),
        };
        ["garment", "fit_class", "verdict", "recommended", "effect", "ci_low", "ci_high", "n_subjects"]
            .map(text)
            .join(",")
    };
    assert_eq!(answers.len(), 11);
    cards_are(&page, &answers.iter().map(line).collect::<Vec<_>>());
    assert!(answers.iter().all(|row| row["basis"] == "rule"), "the tables prove no rule");
    let explained = place.toile("recommend thesis-published --explain").ends_with(0).out;
    assert!(explained.contains("turns      without #6 Neck Opening -0.0150 (FEM-GS 15, Hybrid-GS 3)"), "{explained}");
}
