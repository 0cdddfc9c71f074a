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

/// A number as the page writes it; a nought has no sign.
fn number(value: &str, decimals: usize) -> String {
    let value: f64 = value.parse().unwrap_or_else(|_| panic!("{value} is no number"));
    let text = format!("{value:.decimals$}");
    if text.trim_start_matches(['-', '0', '.']).is_empty() { text.trim_start_matches('-').to_owned() } else { text }
}

/// A number with its sign.
fn signed(value: &str, decimals: usize) -> String {
    let text = number(value, decimals);
    let is_more = !text.starts_with('-') && text.bytes().any(|b| (b'1'..=b'9').contains(&b));
    if is_more { format!("+{text}") } else { text }
}

/// Every L3D and chi; the query gives garment, size, subject, simulator, number, L2D, L3D, chi.
fn chis(place: &Place, tables: &[Table], query: &str) -> usize {
    let answers = place.sql(query);
    for answer in &answers {
        let cell: Vec<&str> = answer.split(',').collect();
        let caption = format!("{}, size {}, {}", cell[0], cell[1], name(cell[3]));
        let (table, row) = row(tables, &caption, &format!("#{} ", cell[4]));
        let at = table.groups.iter().position(|subject| subject == cell[2]).expect("a column of the subject");
        let shown = [&row[1], &row[2 + 2 * at], &row[3 + 2 * at]];
        assert_eq!(
            shown,
            [number(cell[5], 1), number(cell[6], 1), number(cell[7], 3)].each_ref(),
            "{caption}: {answer}"
        );
    }
    answers.len()
}

/// Every number of the page of a study that the views `v_chi`, `v_metrics`, `v_ease` and `v_recommendation` have.
pub fn numbers_are_those_of_the_views(place: &Place, page: &str) {
    let tables = tables(page);
    let lengths = "SELECT garment, size, subject, simulator, measurement_no, l2d_mm, l3d_mm, chi FROM v_chi";
    assert_ne!(chis(place, &tables, lengths), 0);

    let metrics = "SELECT garment, size, subject, simulator, n, e_chi, sd_chi, ei, max_abs_error, residual * 100,
        penetration_max_mm, seam_gap_max_mm, iterations, vertices, faces FROM v_metrics";
    for answer in place.sql(metrics) {
        let cell: Vec<&str> = answer.split(',').collect();
        let title = format!("{}, size {}", cell[0], cell[1]);
        let (_, truth) = row(&tables, &format!("{title}: truth"), cell[2]);
        let [e, sd, ei, most] = [5, 6, 7, 8].map(|k: usize| number(cell[k], 3));
        assert_eq!([&truth[2], &truth[3], &truth[4], &truth[5], &truth[8]], [cell[4], &e, &sd, &ei, &most], "{title}");
        let (_, course) = row(&tables, &format!("{title}: how"), cell[2]);
        let shown: Vec<&str> = course[2..8].iter().map(String::as_str).collect();
        let decimals = [2, 1, 1, 0, 0, 0];
        let expected: Vec<String> = (0..6).map(|k| number(cell[9 + k], decimals[k])).collect();
        assert_eq!(shown, expected, "{title}");
    }

    for answer in place.sql("SELECT garment, size, subject, ease_mm FROM v_ease WHERE decides") {
        let cell: Vec<&str> = answer.split(',').collect();
        let (_, sizes) = row(&tables, &format!("{}: ease in mm", cell[0]), cell[1]);
        assert!(sizes[1..].contains(&signed(cell[3], 1)), "{answer}: {sizes:?}");
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
        let effect = match (cell[4], cell[5]) {
            ("", _) => "not measured".to_owned(),
            (mean, "") => signed(mean, 4),
            _ => {
                let [mean, low, high] = [4, 5, 6].map(|k: usize| signed(cell[k], 4));
                format!("{mean} ({low} to {high})")
            }
        };
        assert!(plain(card).contains(&effect), "{answer}: {effect} is not on {}", plain(card));
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
