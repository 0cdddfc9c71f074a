//! Every number on a fit report's page against the views it is from.

use super::program::Place;
use super::report::{Table, all_are_compared, are_shown, between, is_shown, plain, tables};

/// Every number of a fit report that is in a view; the page allows its own script and no other.
pub fn numbers_are_those_of_the_views(place: &Place, page: &str) {
    let sheets: Vec<&str> = between(page, "<section class=\"sheet\"", "</section>").collect();
    let cards = place.sql("SELECT DISTINCT garment, subject FROM v_fit ORDER BY 1, 2");
    assert_eq!(sheets.len(), cards.len(), "{cards:?}");
    for sheet in sheets {
        let title = between(sheet, "<h2>", "</h2>").next().map(plain).expect("a title");
        let (garment, subject) = title.split_once(" on ").expect("a garment and a subject");
        let own = format!("garment = '{garment}' AND subject = '{subject}'");
        let tables = tables(sheet);
        let [ease, hang, points] = tables.as_slice() else { panic!("{title}: {} tables", tables.len()) };
        let sizes = &ease.columns[3..];
        assert!(!sizes.is_empty(), "{title}");
        for (number, size) in sizes.iter().enumerate() {
            let of_size = format!("{own} AND size = '{size}'");
            eases_are(place, ease, &of_size, 3 + number);
            drape_is(place, hang, &of_size, 1 + number);
            points_are(place, points, &of_size, 1 + number);
        }
        let wear = &place.sql(&format!("SELECT size FROM v_size WHERE place = 1 AND {own}"))[0];
        let verdict = between(sheet, "<p class=\"verdict\">", "</p>").next().map(plain).expect("a verdict");
        let is_told = |begins: &&str| verdict.starts_with(&format!("{begins} {wear}: "));
        let is_told = ["wear", "no size fits; nearest is"].iter().any(is_told);
        assert!(is_told, "{title}: {verdict}, the view says {wear}");
        let charts = place.sql(&format!("SELECT DISTINCT level FROM v_section_level WHERE {own}"));
        assert_eq!(sheet.matches("<svg class=\"chart\"").count(), charts.len(), "{title}: {charts:?}");
        all_are_compared(&tables, &[]);
    }
    policy_allows_one_script(page);
}

fn rows(place: &Place, sql: &str) -> Vec<Vec<String>> {
    place.sql(sql).iter().map(|line| line.split(',').map(str::to_owned).collect()).collect()
}

/// Body, and ease beside it.
fn eases_are(place: &Place, table: &Table, of_size: &str, column: usize) {
    let found = rows(place, &format!("SELECT level, body_girth_mm, ease_mm FROM v_fit WHERE {of_size}"));
    assert!(!found.is_empty(), "{of_size}");
    for cell in found {
        let row = table.row(&cell[0].replace('_', " "));
        are_shown(table, row, &[(1, &cell[1], 0), (column, &cell[2], 0)]);
    }
}

/// Balance, pressure, folds and gaps.
fn drape_is(place: &Place, table: &Table, of_size: &str, column: usize) {
    let names = [
        ("hem_front", "hem above the floor, in front"),
        ("hem_back", "hem above the floor, behind"),
        ("hem_front_over_back", "hem, front over back"),
        ("hem_right_over_left", "hem, right over left"),
    ];
    for (quantity, name) in names {
        let found = rows(place, &format!("SELECT value FROM v_balance WHERE {of_size} AND quantity = '{quantity}'"));
        are_shown(table, table.row(name), &[(column, &found[0][0], 0)]);
    }
    let lean = "SELECT value FROM v_balance WHERE {} AND quantity GLOB 'side_seam_lean_*' ORDER BY quantity DESC";
    let lean = rows(place, &lean.replace("{}", of_size));
    let shown = table.cell(table.row("side seam lean"), column);
    for (shown, value) in shown.split(", ").zip(&lean) {
        assert!(is_shown(shown, value[0].trim_start_matches('-'), 1), "{of_size}: {shown}, {value:?}");
    }
    let most = rows(place, &format!("SELECT max(most_kpa) FROM v_pressure WHERE {of_size}"));
    are_shown(table, table.row("greatest pressure"), &[(column, &most[0][0], 2)]);
    let folds = rows(place, &format!("SELECT count(*) FROM v_fold WHERE {of_size}"));
    are_shown(table, table.row("folds and drag lines"), &[(column, &folds[0][0], 0)]);
    let gaps = format!("SELECT level, coalesce(mean_gap_mm, '') FROM v_section_level WHERE {of_size}");
    for cell in rows(place, &gaps) {
        let row = table.row(&format!("mean gap at the {}", cell[0].replace('_', " ")));
        are_shown(table, row, &[(column, &cell[1], 0)]);
    }
}

/// Points of measure, flat.
fn points_are(place: &Place, table: &Table, of_size: &str, column: usize) {
    let found = rows(place, &format!("SELECT point, flat_mm FROM v_pom WHERE {of_size}"));
    assert!(found.len() > 10, "{of_size}: {found:?}");
    for cell in found {
        let name = cell[0].replace('_', " ");
        let row = table.rows.iter().position(|row| row[0] == name).expect("a row of the point");
        are_shown(table, row, &[(column, &cell[1], 1)]);
    }
}

/// The one script that the page runs is named by its hash, and nothing may be loaded.
fn policy_allows_one_script(page: &str) {
    let policy = between(page, "Content-Security-Policy\" content=\"", "\"").next().expect("a policy");
    assert!(
        policy.starts_with("default-src 'none'; img-src data:;") && policy.contains("script-src 'sha256-"),
        "{policy}"
    );
    assert_eq!(page.matches("<script>").count(), 1, "one script");
    assert!(page.contains("<script type=\"application/json\" id=\"drapes\">{\"front\":[0.0,1.0,0.0]"), "the drapes");
    for forbidden in ["fetch(", "XMLHttpRequest", "eval(", "import(", "src=\"http", "href=\"http"] {
        assert!(!page.contains(forbidden), "the fit report holds {forbidden}");
    }
}
