//! Specification of a garment for the fit report, from `v_spec`.

use crate::reporting::facts::number;
use geom::units::signed_tenths;
use report::data::{FitCell, FitRow, FitTable, FitVerdict};
use store::{JobId, Result, Store, Value, sql};

/// Table of the specification of a style in some sizes: a row for each row of the buyer's sheet, with the deviation of
/// the flat pattern in each size, and what was worn in the drapes of `jobs`. Without rows for a style without a sheet.
pub(super) fn specification(store: &Store, jobs: &[JobId], sizes: &[String]) -> Result<FitTable> {
    let jobs = jobs.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ");
    let lines = sql::query(
        store,
        &format!(
            "SELECT position, code || ' ' || description || coalesce(' (' || replace(point, '_', ' ') || ')', ''), size,
                minus_mm, plus_mm, spec_mm, flat_mm, deviation_mm, verdict, step_mm, flat_step_mm,
                max(iif(job_id IN ({jobs}), worn_mm, NULL))
            FROM v_spec WHERE style IN (SELECT style FROM v_spec WHERE job_id IN ({jobs}))
            GROUP BY position, size_position ORDER BY position, size_position"
        ),
    )?;
    let row = |lines: &[Vec<Value>]| {
        let cell = |size: &String| {
            let own = lines.iter().find(|line| line[2].to_string() == *size);
            own.map_or_else(FitCell::default, |line| cell(line))
        };
        let first = &lines[0];
        let tolerance = FitCell { text: tolerance(number(&first[3]), number(&first[4])), ..FitCell::default() };
        let cells = std::iter::once(tolerance).chain(sizes.iter().map(cell));
        FitRow { name: first[1].to_string(), cells: cells.collect() }
    };
    let rows = lines.rows.chunk_by(|one, other| one[0] == other[0]).map(row).collect();
    let columns = std::iter::once("tolerance".to_owned()).chain(sizes.iter().cloned()).collect();
    Ok(FitTable { caption: "Specification: flat pattern less the buyer's sheet, mm".to_owned(), columns, rows })
}

/// Number with U+2212 as its minus sign.
fn signed(mm: f64) -> String {
    signed_tenths(mm).replace('-', "\u{2212}")
}

fn tolerance(minus_mm: Option<f64>, plus_mm: Option<f64>) -> String {
    match (minus_mm, plus_mm) {
        (Some(minus), Some(plus)) if minus == plus => format!("±{plus:.1}"),
        (Some(minus), Some(plus)) => format!("+{plus:.1} \u{2212}{minus:.1}"),
        _ => String::new(),
    }
}

fn cell(line: &[Value]) -> FitCell {
    let [spec, flat, off] = [5, 6, 7].map(|column| number(&line[column]));
    let [step, flat_step, worn] = [9, 10, 11].map(|column| number(&line[column]));
    let Some((spec, (flat, off))) = spec.zip(flat.zip(off)) else {
        let note = spec.map_or_else(String::new, |spec| format!("{spec:.1} is specified, and not measured"));
        return FitCell { note, ..FitCell::default() };
    };
    let verdict = match line[8].to_string().as_str() {
        "in" => Some(FitVerdict::AsMeant),
        "out" if off < 0.0 => Some(FitVerdict::Tight),
        "out" => Some(FitVerdict::Loose),
        _ => None,
    };
    let verdict_word = verdict.map(|_| line[8].to_string());
    let lengths = format!("{flat:.1} of {spec:.1}");
    let worn = worn.map(|worn| format!("worn {worn:.1}"));
    let steps = step.zip(flat_step).map(|(step, flat)| format!("step {} of {}", signed(flat), signed(step)));
    let notes = verdict_word.into_iter().chain([lengths]).chain(worn).chain(steps);
    FitCell { text: signed(off), note: notes.collect::<Vec<_>>().join(", "), verdict }
}

#[cfg(test)]
mod tests {
    use super::*;
    use spec::patterns::{self, Model};
    use wardrobe::catalogue::{self, SpecGiven};
    use wardrobe::{Mode, StyleGiven};

    #[test]
    fn the_page_has_the_numbers_of_the_view() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = |name: &str| folder.path().join(name);
        store::files::write_files(folder.path(), &patterns::drafted(Model::Tshirt)).expect("writable");
        let text =
            "In cm,,,,\ncode,description,tol,M,L\nA,1/2 chest,1,51.5,54.5\nB,CB length,0.5,73,73.5\nC,Logo,,3,3\n";
        std::fs::write(path("sheet.csv"), text).expect("writable");
        let mut store = catalogue::open(&path("toile.sqlite"), false).expect("a new database");
        let given = StyleGiven {
            seams: Some(path("tshirt.seams.toml")),
            patterns: ["M", "L"]
                .map(|size| (Some(size.to_owned()), path(&format!("tshirt-{}.dxf", size.to_lowercase()))))
                .to_vec(),
            ..StyleGiven::default()
        };
        catalogue::save_style(&mut store, Mode::Add, "tee", &given).expect("it is sewn");
        let sizes = ["M", "L"].map(str::to_owned);
        let none = specification(&store, &[JobId(1)], &sizes).expect("a table");
        assert!(none.rows.is_empty(), "no sheet is kept");
        let given = SpecGiven { file: Some(path("sheet.csv")), ..SpecGiven::default() };
        catalogue::keep_spec(&mut store, "tee", &given).expect("it is kept");
        let fill = "INSERT INTO study (study_id, name, path, tight_below_mm, loose_above_mm, updated_at)
                VALUES (1, 'tops', 'p', 50, 100, 0);
            INSERT INTO job (job_id, study_id, garment, size, subject, simulator, input_hash, status, queued_at, subject_id,
                style_id, size_id, fabric_id)
            SELECT 1, 1, 'tee', 'M', 'ii', 'fem', 'h', 'done', 0, 1, style_id, size_id, 1 FROM style, size
                WHERE style.name = 'tee' AND size.name = 'M';
            INSERT INTO pom VALUES (1, 1, 'half_chest', 517.05, 520.5);";
        store.writer().expect("writable").execute_batch(fill).expect("valid");
        let table = specification(&store, &[JobId(1)], &sizes).expect("a table");
        let names: Vec<&str> = table.rows.iter().map(|row| row.name.as_str()).collect();
        assert_eq!(names, ["A 1/2 chest (half chest)", "B CB length (centre back length)", "C Logo"]);
        let view = sql::query(
            &store,
            "SELECT deviation_mm, flat_mm, spec_mm, verdict FROM v_spec WHERE verdict IS NOT NULL ORDER BY position,
                size_position",
        );
        let view = view.expect("valid").rows;
        let cells: Vec<&FitCell> = table.rows[..2].iter().flat_map(|row| &row.cells[1..]).collect();
        assert_eq!(cells.len(), view.len());
        for (cell, line) in cells.iter().zip(&view) {
            let [off, flat, spec] = [0, 1, 2].map(|column| number(&line[column]).expect("a number"));
            assert_eq!(cell.text, signed(off));
            assert!(cell.note.contains(&format!("{flat:.1} of {spec:.1}")), "{cell:?}");
            assert!(cell.note.starts_with(&line[3].to_string()), "{cell:?}");
        }
        assert!(cells[0].note.contains("worn 520.5") && cells[1].note.contains("step +30.0 of +30.0"), "{cells:?}");
        assert_eq!(cells[2].verdict, Some(FitVerdict::Tight));
        assert_eq!(
            (&*table.rows[2].cells[1].text, &*table.rows[2].cells[1].note),
            ("", "30.0 is specified, and not measured")
        );
    }
}
