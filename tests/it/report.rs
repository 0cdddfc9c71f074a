//! Every number on a report's page against the views it is from.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};

use super::program::Place;

/// A table of a page.
pub struct Table {
    pub caption: String,
    /// Names over groups of columns.
    groups: Vec<String>,
    /// Names over the columns of the last row of the head.
    pub columns: Vec<String>,
    /// Cells of each row of the body.
    pub rows: Vec<Vec<String>>,
    /// Which of them have been compared, by row and column.
    compared: RefCell<BTreeSet<(usize, usize)>>,
}

impl Table {
    /// A cell, which counts as compared from now on.
    pub fn cell(&self, row: usize, column: usize) -> &str {
        self.compared.borrow_mut().insert((row, column));
        &self.rows[row][column]
    }

    /// The row that begins with a text.
    #[track_caller]
    pub fn row(&self, head: &str) -> usize {
        let found = self.rows.iter().position(|row| row.first().is_some_and(|cell| cell.starts_with(head)));
        found.unwrap_or_else(|| panic!("{}: no row {head} in {:?}", self.caption, self.rows))
    }
}

/// Tables whose numbers are in no view: what the tape reads on the bodies, and what went into the simulators. Sizes are names.
const OF_NO_VIEW: [&str; 4] = ["Program and parameters", "Inputs", "Subjects and their measurements", "Size to wear"];

/// No table but those of [`OF_NO_VIEW`] and of fabrics has a number that was not compared.
pub fn all_are_compared(tables: &[Table], fabrics: &[String]) {
    let is_of_view =
        |table: &&Table| !OF_NO_VIEW.contains(&table.caption.as_str()) && !fabrics.contains(&table.caption);
    for table in tables.iter().filter(is_of_view) {
        for (row, cells) in table.rows.iter().enumerate() {
            for (column, cell) in cells.iter().enumerate().skip(1) {
                let is_number = cell.trim_start_matches('+').parse::<f64>().is_ok() || seconds(cell).is_some();
                let is_compared = table.compared.borrow().contains(&(row, column));
                assert!(!is_number || is_compared, "{}, {}: {cell} is compared with nothing", table.caption, cells[0]);
            }
        }
    }
}

/// What lies between two marks, again and again.
pub fn between<'a>(text: &'a str, open: &'a str, close: &'a str) -> impl Iterator<Item = &'a str> {
    text.split(open).skip(1).filter_map(move |rest| rest.split_once(close).map(|(inside, _)| inside))
}

/// Text without tags; small print and marks are left out.
pub fn plain(html: &str) -> String {
    let mut kept = html.to_owned();
    for (open, close) in [("<small", "</small>"), ("<span", "</span>")] {
        while let Some((before, rest)) = kept.split_once(open) {
            kept = format!("{before}{}", rest.split_once(close).expect("closed").1);
        }
    }
    let text: String = kept.split('<').map(|part| part.split_once('>').map_or(part, |(_, text)| text)).collect();
    text.replace("\u{2212}", "-").replace("&#39;", "'").trim().to_owned()
}

pub fn tables(page: &str) -> Vec<Table> {
    let table = |html: &str| {
        let caption = plain(between(html, "<caption>", "</caption>").next().unwrap_or_default());
        let groups = between(html, "<th scope=\"colgroup\" colspan=\"2\">", "</th>").map(plain).collect();
        let (head, body) = html.split_once("<tbody>").unwrap_or_default();
        let last = head.rsplit_once("<tr>").map_or("", |(_, last)| last);
        let columns = between(last, "<th scope=\"col\"", "</th>").map(|cell| plain(&format!("<{cell}"))).collect();
        let cells = |row: &str| -> Vec<String> {
            let cells = row.split("<t").skip(1).filter(|cell| cell.starts_with('h') || cell.starts_with('d'));
            cells.map(|cell| plain(cell.split_once('>').map_or("", |(_, rest)| rest))).collect()
        };
        let rows = between(body, "<tr>", "</tr>").map(cells).collect();
        Table { caption, groups, columns, rows, compared: RefCell::default() }
    };
    between(page, "<table", "</table>").map(table).collect()
}

/// The table whose caption begins with a text.
#[track_caller]
fn table<'a>(tables: &'a [Table], caption: &str) -> &'a Table {
    let table = tables.iter().find(|table| table.caption.starts_with(caption));
    table.unwrap_or_else(|| panic!("no table {caption}"))
}

/// The value of a tile at the head of a page.
#[track_caller]
fn tile(page: &str, name: &str) -> String {
    let tiles = between(page, "<ul class=\"tiles\">", "</ul>").next().expect("tiles");
    let value =
        between(tiles, "<li><b>", "</li>").find_map(|tile| tile.strip_suffix(&format!("</b><span>{name}</span>")));
    value.unwrap_or_else(|| panic!("no tile {name} in {tiles}")).to_owned()
}

/// What each chart of a page says it shows, and the texts in the colour of what is to be read; axes are muted.
fn charts(page: &str) -> Vec<(String, Vec<String>)> {
    let chart = |svg: &str| {
        let label = between(svg, "aria-label=\"", "\"").next().expect("a label").to_owned();
        let texts = svg.split("<text ").skip(1).filter_map(|text| text.split_once('>'));
        let read = texts.filter(|(style, _)| style.contains("var(--ink)")).map(|(_, text)| plain(text));
        (label, read.collect())
    };
    between(page, "<svg class=\"chart\"", "</svg>").map(chart).collect()
}

fn name(simulator: &str) -> &'static str {
    if simulator == "fem" { "FEM-GS" } else { "Hybrid-GS" }
}

/// Whether a page shows a number: rounded to so many decimals, halves either way.
pub fn is_shown(shown: &str, value: &str, decimals: usize) -> bool {
    let is_rounded = shown.split_once('.').map_or(0, |(_, rest)| rest.len()) == decimals;
    let (Ok(number), Ok(value)) = (shown.parse::<f64>(), value.parse::<f64>()) else { return false };
    is_rounded && (number - value).abs() <= 0.5 * 0.1f64.powi(decimals as i32) * (1.0 + 1e-6)
}

/// Checks cells of a row: column, the view's value, its decimals. No value is a dash.
#[track_caller]
pub fn are_shown(table: &Table, row: usize, numbers: &[(usize, &str, usize)]) {
    for (column, value, decimals) in numbers {
        let shown = table.cell(row, *column).trim_start_matches('+');
        let place = format!("{}, {}", table.caption, table.rows[row][0]);
        let agrees = if value.is_empty() { ["–", ""].contains(&shown) } else { is_shown(shown, value, *decimals) };
        assert!(agrees, "{place}, column {column}: the page shows {shown:?}, the view has {value:?}");
    }
}

/// A time as the page writes it, s, and half of its last digit.
fn seconds(shown: &str) -> Option<(f64, f64)> {
    let (number, unit) = shown.split_once(' ')?;
    let (second, digit) = match unit {
        "ms" => (1e-3, 1.0),
        "s" => (1.0, 0.1),
        "min" => (60.0, 0.1),
        _ => return None,
    };
    Some((number.parse::<f64>().ok()? * second, 0.5 * digit * second))
}

/// Checks a time against the view's, ms.
#[track_caller]
fn is_time(shown: &str, ms: &str) {
    let ms: f64 = ms.parse().expect("a time");
    let agrees = seconds(shown).is_some_and(|(shown, half)| (shown - ms / 1e3).abs() <= half * (1.0 + 1e-6));
    assert!(agrees, "the page shows {shown}, the view has {ms} ms");
}

/// Whether a name is that of a run: its subject, the fabric where there are several, the simulator where there are two.
fn is_run(name: &str, subject: &str, simulator: &str, both: bool) -> bool {
    let rest = name.strip_prefix(subject).unwrap_or("another");
    let rest = if both { rest.strip_suffix(&format!(" {simulator}")).unwrap_or("another") } else { rest };
    rest.is_empty() || rest.starts_with(", ")
}

/// Where lengths come from: a table or query with garment, size, subject, simulator, number, L2D, L3D, chi, and whether each
/// measurement is a free edge or controlled.
struct Lengths<'a>(&'a str);

impl Lengths<'_> {
    fn rows(&self, place: &Place, query: &str) -> Vec<Vec<String>> {
        let with = format!(
            "WITH l(garment, size, subject, simulator, no, l2d, l3d, chi, free, controlled) AS ({}) {query}",
            self.0
        );
        place.sql(&with).iter().map(|line| line.split(',').map(str::to_owned).collect()).collect()
    }

    /// Every L2D, L3D and chi, in its table and in the heat map; how many there are.
    fn cases(&self, place: &Place, tables: &[Table], both: bool) -> usize {
        let answers = self.rows(place, "SELECT garment, size, subject, simulator, no, l2d, l3d, chi FROM l");
        for cell in &answers {
            let title = format!("{}, size {}", cell[0], cell[1]);
            let series = table(tables, &format!("{title}, {}", name(&cell[3])));
            let row = series.row(&format!("#{} ", cell[4]));
            let at = series.groups.iter().position(|subject| *subject == cell[2]).expect("a column of the subject");
            are_shown(series, row, &[(1, &cell[5], 1), (2 + 2 * at, &cell[6], 1), (3 + 2 * at, &cell[7], 3)]);
            let heat = table(tables, &format!("{title}: chi, every run"));
            let at = heat
                .columns
                .iter()
                .position(|name| is_run(name, &cell[2], &cell[3], both))
                .expect("a column of the run");
            are_shown(heat, heat.row(&format!("#{} ", cell[4])), &[(at, &cell[7], 3)]);
        }
        answers.len()
    }

    /// Mean and SD of every measurement over the subjects, wherever they stand.
    fn over_subjects(&self, place: &Place, tables: &[Table]) {
        let query =
            "SELECT garment, size, simulator, no, avg(chi), coalesce(stddev(chi), 0) FROM l GROUP BY 1, 2, 3, 4";
        for cell in self.rows(place, query) {
            let title = format!("{}, size {}", cell[0], cell[1]);
            let head = format!("#{} ", cell[3]);
            let of = |table: &&Table| table.caption.starts_with(&format!("{title}, {}", name(&cell[2])));
            let same: Vec<&Table> = tables.iter().filter(of).collect();
            assert_eq!(same.len(), 2, "{title}: the lengths, and what is free and controlled");
            for table in same {
                let (row, last) = (table.row(&head), table.rows[table.row(&head)].len() - 1);
                are_shown(table, row, &[(last - 1, &cell[4], 3), (last, &cell[5], 3)]);
            }
            if let Some(means) = tables.iter().find(|t| t.caption.starts_with(&format!("{title}: chi, mean"))) {
                let at = means.columns.iter().position(|series| series.starts_with(name(&cell[2]))).expect("a series");
                are_shown(means, means.row(&head), &[(at, &cell[4], 3)]);
            }
        }
    }

    /// E, SD and EI of every case, below its lengths and in the table of its group.
    fn truth(&self, place: &Place, tables: &[Table], both: bool) {
        let query = "SELECT garment, size, subject, simulator, count(*), avg(chi), coalesce(stddev(chi), 0), avg(abs(chi - 1)),
            avg(abs(chi - 1)) FILTER (WHERE NOT free), avg(abs(chi - 1)) FILTER (WHERE NOT controlled), max(abs(chi - 1))
            FROM l GROUP BY 1, 2, 3, 4";
        for cell in self.rows(place, query) {
            let title = format!("{}, size {}", cell[0], cell[1]);
            let series = table(tables, &format!("{title}, {}", name(&cell[3])));
            let at = 3 + 2 * series.groups.iter().position(|subject| *subject == cell[2]).expect("a column");
            for (head, value) in [("E (", 5), ("SD (", 6), ("EI (", 7)] {
                are_shown(series, series.row(head), &[(at, &cell[value], 3)]);
            }
            for (head, value) in [("EI without free", 8), ("EI without controlled", 9)] {
                if let Some(row) = series.rows.iter().position(|row| row[0].starts_with(head)) {
                    are_shown(series, row, &[(at, &cell[value], 3)]);
                }
            }
            let group = table(tables, &format!("{title}: truth"));
            let row =
                group.rows.iter().position(|row| is_run(&row[0], &cell[2], &cell[3], both)).expect("a row of the run");
            let columns = [(2, 4, 0), (3, 5, 3), (4, 6, 3), (5, 7, 3), (6, 8, 3), (7, 9, 3), (8, 10, 3)];
            are_shown(
                group,
                row,
                &columns.map(|(at, of, decimals): (usize, usize, usize)| (at, cell[of].as_str(), decimals)),
            );
        }
    }

    /// The tiles at the head of the page that come from lengths, and the sentence above them.
    fn head(&self, place: &Place, page: &str) {
        let mean = "SELECT simulator, avg(ei) FROM (SELECT simulator, avg(abs(chi - 1)) AS ei FROM l
            GROUP BY garment, size, subject, simulator) GROUP BY 1";
        for cell in self.rows(place, mean) {
            let shown = tile(page, &format!("mean EI, {}", name(&cell[0])));
            assert!(is_shown(&shown, &cell[1], 3), "{shown}, {cell:?}");
            assert!(page.contains(&format!("(mean EI {shown})")), "{shown}");
        }
        let range = tile(page, "range of chi");
        let ends: Vec<&str> = range.split('–').collect();
        let [least, most] = ends.as_slice() else { panic!("{range}") };
        let cell = &self.rows(place, "SELECT min(chi), max(chi) FROM l")[0];
        assert!(is_shown(least, &cell[0], 3) && is_shown(most, &cell[1], 3), "{range}, {cell:?}");
        let cell = &self.rows(place, "SELECT no, chi FROM l ORDER BY abs(chi - 1) DESC LIMIT 1")[0];
        let said = between(page, "The greatest departure is #", ", on subject").next().expect("a sentence");
        let (no, chi) = (said.split(' ').next(), said.rsplit(' ').next());
        assert!(no == Some(&cell[0]) && is_shown(chi.unwrap_or_default(), &cell[1], 3), "{said}, {cell:?}");
    }

    /// The number at each bar of E, SD and EI.
    fn bars(&self, place: &Place, page: &str) {
        let query =
            "SELECT garment, size, subject, simulator, avg(chi), coalesce(stddev(chi), 0), avg(abs(chi - 1)) FROM l
            GROUP BY 1, 2, 3, 4 ORDER BY 1, 2, 3, 4";
        let charts = charts(page);
        let mut bars = 0;
        let answers = self.rows(place, query);
        for cell in &answers {
            for (metric, value) in [("E", 4), ("SD", 5), ("EI", 6)] {
                let label = format!("{}, size {}: {metric} of ", cell[0], cell[1]);
                let (_, texts) = charts.iter().find(|(of, _)| of.starts_with(&label)).expect("a chart");
                let at = texts.iter().position(|text| is_run(text, &cell[2], "", false)).expect("a subject");
                let numbers = texts[at + 1..].iter().take_while(|text| text.parse::<f64>().is_ok());
                let found = numbers.clone().filter(|shown| is_shown(shown, &cell[value], 3)).count();
                assert!(found > 0, "{label}{cell:?}: {:?}", numbers.collect::<Vec<_>>());
                bars += 1;
            }
        }
        let is_metric = |(label, _): &&(String, Vec<String>)| label.contains(" runs as bars");
        let numbers = charts.iter().filter(is_metric).flat_map(|(_, texts)| texts);
        let all = numbers.filter(|text| text.parse::<f64>().is_ok()).count();
        assert_eq!(all, bars, "every bar of a chart is compared");
    }

    fn all(&self, place: &Place, page: &str, tables: &[Table], both: bool) -> usize {
        self.head(place, page);
        self.bars(place, page);
        self.over_subjects(place, tables);
        self.truth(place, tables, both);
        self.cases(place, tables, both)
    }
}

/// Every number of the page of a study of one simulator that is in a view.
pub fn numbers_are_those_of_the_views(place: &Place, page: &str) {
    let tables = tables(page);
    let lengths = Lengths(
        "SELECT garment, size, subject, simulator, measurement_no, l2d_mm, l3d_mm, chi, is_free_edge, is_controlled
        FROM v_chi WHERE stage = 'drape'",
    );
    assert_ne!(lengths.all(place, page, &tables, false), 0);
    tiles_are(place, page);

    let metrics = "SELECT garment, size, subject, n, e_chi, sd_chi, ei, max_abs_error, residual * 100,
        penetration_max_mm, seam_gap_max_mm, iterations, vertices, faces, wall_ms FROM v_metrics";
    for answer in place.sql(metrics) {
        let cell: Vec<&str> = answer.split(',').collect();
        let title = format!("{}, size {}", cell[0], cell[1]);
        let truth = table(&tables, &format!("{title}: truth"));
        let columns = [(2, 3, 0), (3, 4, 3), (4, 5, 3), (5, 6, 3), (8, 7, 3)];
        are_shown(
            truth,
            truth.row(cell[2]),
            &columns.map(|(at, of, decimals): (usize, usize, usize)| (at, cell[of], decimals)),
        );
        let course = table(&tables, &format!("{title}: how"));
        let columns = [(2, 8, 2), (3, 9, 1), (4, 10, 1), (5, 11, 0), (6, 12, 0), (7, 13, 0)];
        are_shown(
            course,
            course.row(cell[2]),
            &columns.map(|(at, of, decimals): (usize, usize, usize)| (at, cell[of], decimals)),
        );
        is_time(course.cell(course.row(cell[2]), 8), cell[14]);
    }

    for answer in place.sql("SELECT garment, size, subject, ease_mm FROM v_ease WHERE decides") {
        let cell: Vec<&str> = answer.split(',').collect();
        let matrix = table(&tables, &format!("{}: ease in mm", cell[0]));
        let at = matrix.columns.iter().position(|subject| subject == cell[2]).expect("a column of the subject");
        are_shown(matrix, matrix.row(cell[1]), &[(at, cell[3], 1)]);
    }
    let columns = "garment, fit_class, verdict, recommended, coalesce(effect, ''), coalesce(ci_low, ''), coalesce(ci_high, ''), n_subjects";
    cards_are(page, &place.sql(&format!("SELECT {columns} FROM v_recommendation")));
    all_are_compared(&tables, &place.sql("SELECT DISTINCT name FROM fabric"));
}

/// The tiles that come from how the runs went.
fn tiles_are(place: &Place, page: &str) {
    let [runs] = &place.sql("SELECT count(*) FILTER (WHERE status = 'done') || ' / ' || count(*) FROM v_jobs")[..]
    else {
        panic!("one row")
    };
    assert_eq!(tile(page, "runs converged"), *runs);
    is_time(&tile(page, "mean time of a run"), &place.sql("SELECT avg(wall_ms) FROM v_metrics")[0]);
    for answer in place.sql("SELECT simulator, max(penetration_max_mm) FROM v_metrics GROUP BY 1") {
        let (simulator, deepest) = answer.split_once(',').expect("two columns");
        let shown = tile(page, &format!("deepest in the body, {}", name(simulator)));
        assert!(is_shown(shown.trim_end_matches(" mm"), deepest, 1), "{shown}, {answer}");
    }
}

/// The rows of the charts of differences: each answer and garment as in the table of the pairs, and each garment without one
/// measurement after another, from the lengths by themselves. How many numbers there were.
fn differences_are(place: &Place, page: &str, tables: &[Table], lengths: &Lengths<'_>) -> usize {
    let pairs = table(tables, "Paired analysis");
    let charts = charts(page);
    let texts = |label: &str| -> &[String] {
        &charts.iter().find(|(of, _)| of.starts_with(label)).unwrap_or_else(|| panic!("no chart {label}")).1
    };
    let (all, mut compared) = (texts("thesis-published: EI difference of"), 0);
    for (row, cells) in pairs.rows.iter().enumerate() {
        let (effect, subjects) = (pairs.cell(row, 4), pairs.cell(row, 2));
        if effect != "–" {
            let head = format!("{}, ", cells[0]);
            let tail = format!("({subjects})");
            let shown =
                all.chunks(2).find(|pair| pair[0].starts_with(&head) && pair[0].ends_with(&tail) && pair[1] == effect);
            assert!(shown.is_some(), "{cells:?} is not in {all:?}");
            compared += 1;
        }
    }
    assert_eq!(all.len(), 2 * compared, "{all:?}");
    let query = "SELECT garment, left_out, name, avg(d) FROM (
            SELECT garment, subject, left_out, avg(d) AS d FROM (
                SELECT l.garment, size, subject, left_out, avg(abs(chi - 1)) FILTER (WHERE simulator = 'fem')
                    - avg(abs(chi - 1)) FILTER (WHERE simulator = 'hybrid') AS d
                FROM l JOIN (SELECT DISTINCT garment AS of, no AS left_out FROM l) ON of = l.garment AND no <> left_out
                GROUP BY 1, 2, 3, 4) GROUP BY 1, 2, 3)
        JOIN (SELECT DISTINCT garment AS g, measurement_no AS n, measurement AS name FROM v_published) ON g = garment AND n = left_out
        GROUP BY 1, 2";
    for cell in lengths.rows(place, query) {
        let rows = texts(&format!("{}: EI difference of without", cell[0]));
        let row = rows.chunks(2).find(|pair| pair[0].starts_with(&format!("without #{} ", cell[1]))).expect("a row");
        assert!(is_shown(row[1].trim_start_matches('+'), &cell[3], 4), "{cell:?}: {row:?}");
        compared += 1;
    }
    compared
}

/// The paired analysis, for answers as `toile recommend --json` has them, which begin the table in their order.
fn pairs_are(tables: &[Table], answers: &[serde_json::Value]) {
    let table = table(tables, "Paired analysis");
    let mut cases = 0;
    for (row, answer) in answers.iter().enumerate() {
        assert_eq!(Some(table.cell(row, 0)), answer["garment"].as_str());
        for (column, key, decimals) in [(2, "n_subjects", 0), (4, "effect", 4), (6, "effect_size", 2)] {
            let value = answer[key].as_f64().map_or_else(String::new, |value| value.to_string());
            are_shown(table, row, &[(column, &value, decimals)]);
        }
        for (column, key) in [(7, "p"), (8, "p_holm"), (9, "p_equivalence")] {
            match answer[key].as_f64() {
                Some(p) if p < 0.001 => assert_eq!(table.cell(row, column), "&lt; 0.001"),
                p => are_shown(table, row, &[(column, &p.map_or_else(String::new, |p| p.to_string()), 3)]),
            }
        }
        let ends = table.cell(row, 5).to_owned();
        for (end, key) in ends.split(" to ").zip(["ci_low", "ci_high"]) {
            let agrees = |value: f64| is_shown(end.trim_start_matches('+'), &value.to_string(), 4);
            assert!(answer[key].as_f64().map_or(end == "–", agrees), "{answer}: {ends}");
        }
        cases += table.cell(row, 3).parse::<u32>().expect("a count");
    }
    assert_eq!(cases, 54, "every case belongs to one answer");
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
    let lengths = Lengths(
        "SELECT garment, size, substr(garment, 1, instr(garment, '_') - 1) || '-' || subject, simulator, measurement_no, l2d_mm,
            l3d_mm, chi, measurement GLOB 'Hem*' OR measurement GLOB 'Neck Opening*' OR measurement GLOB 'Sleeve Opening*',
            measurement GLOB 'Hem*' FROM v_published",
    );
    assert_eq!(lengths.all(&place, &page, &tables, true), 888);
    let drapes =
        &place.sql("SELECT count(*) FROM (SELECT DISTINCT garment, size, subject, simulator FROM v_published)")[0];
    assert_eq!(tile(&page, "drapes, as printed"), *drapes);
    assert!(differences_are(&place, &page, &tables, &lengths) > 30);
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
    pairs_are(&tables, answers);
    cards_are(&page, &answers.iter().map(line).collect::<Vec<_>>());
    assert!(answers.iter().all(|row| row["basis"] == "rule"), "the tables prove no rule");
    let explained = place.toile("recommend thesis-published --explain").ends_with(0).out;
    assert!(explained.contains("turns      without #6 Neck Opening -0.0150 (FEM-GS 15, Hybrid-GS 3)"), "{explained}");
}
