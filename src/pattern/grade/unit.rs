//! Unit of a grade rule table. Tables know only METRIC and ENGLISH, and programs that draw in centimetres write
//! centimetres under METRIC as well.

use super::super::dxf::Unit;
use super::table::{GradeError, GradeTable, check_steps};
use geom::units::{from_mm, mm};

/// Least step between neighbouring sizes that some point makes. Sizes differ by an inch of girth or more, a quarter of
/// which, 6 mm, moves each side seam.
const LEAST_STEP_M: f64 = 0.004;

/// Greatest step between neighbouring sizes. Letter sizes differ by up to 0.1 m of girth, and by less in length.
const MOST_STEP_M: f64 = 0.1;

/// Takes the unit `given`, else that of the table, or that of the pattern (`drawn`) if the table's would make no
/// plausible grade. Also returns a note for the user. Fails where displacements become too long.
pub fn in_unit_of(
    table: GradeTable,
    drawn: Unit,
    given: Option<Unit>,
) -> Result<(GradeTable, Option<String>), GradeError> {
    let said = table.unit;
    let longest_m = longest_step_m(&table);
    let is_grade = longest_m >= LEAST_STEP_M || longest_m == 0.0;
    let in_mm = |unit: Unit| mm(longest_m) * unit.mm_per_unit() / said.mm_per_unit();
    let reach = |unit: Unit| format!("{:.1} mm from one size to the next", in_mm(unit));
    let name = &table.file;
    let (unit, note) = match given {
        Some(given) => (given, None),
        None if !is_grade
            && said == Unit::Mm
            && drawn != Unit::In
            && (LEAST_STEP_M..=MOST_STEP_M).contains(&from_mm(in_mm(drawn))) =>
        {
            let (drawn_in, so_far) = (drawn.as_str(), reach(drawn));
            let note = format!(
                "{name}: in mm, as METRIC means, its longest step is {}, which is no grade: its numbers are taken as {drawn_in}, as those of \
                 the pattern are, and go up to {so_far}; --rul-unit mm takes them as mm",
                reach(said)
            );
            (drawn, Some(note))
        }
        None if !is_grade => {
            let note = format!(
                "{name}: its longest step is {} in {}, which is hardly a grade; --rul-unit says the unit of its numbers",
                reach(said),
                said.as_str()
            );
            (said, Some(note))
        }
        None if said != drawn => {
            let [read, drawn] = [said, drawn].map(Unit::as_str);
            let note = format!(
                "{name}: its numbers are read as {read}, those of the pattern are {drawn}: its longest step is {}; --rul-unit says another \
                 unit",
                reach(said)
            );
            (said, Some(note))
        }
        None => (said, None),
    };
    Ok((scaled(table, unit)?, note))
}

/// Longest step between neighbouring sizes.
fn longest_step_m(table: &GradeTable) -> f64 {
    let steps = table.rules.values().flat_map(|steps| steps.windows(2).map(|pair| (pair[1] - pair[0]).norm()));
    steps.fold(0.0, f64::max)
}

fn scaled(mut table: GradeTable, unit: Unit) -> Result<GradeTable, GradeError> {
    if unit == table.unit {
        return Ok(table);
    }
    let scale = unit.mm_per_unit() / table.unit.mm_per_unit();
    for (number, steps) in &mut table.rules {
        steps.iter_mut().for_each(|step| *step *= scale);
        check_steps(&table.file, None, *number, steps)?;
    }
    Ok(GradeTable { unit, ..table })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grade::read;

    #[test]
    fn the_unit_is_that_of_the_head_unless_it_makes_no_grade_or_another_is_given() {
        let table = |unit: &str, step: f64| {
            let text = format!(
                "UNITS: {unit}\nNUMBER OF SIZES: 3\nSIZE LIST: S M L\nSAMPLE SIZE: M\nRULE: DELTA 1\n-{step}, 0 0, 0 {step}, 0\nEND\n"
            );
            read(text.as_bytes(), "a.rul").expect("a table")
        };
        let check = |unit: &str, step: f64, drawn: Unit, given: Option<Unit>, expect_mm: f64, said: &str| {
            let (read, note) = in_unit_of(table(unit, step), drawn, given).expect("short steps");
            let note = note.unwrap_or_default();
            assert!((mm(read.rules[&1][2].x) - expect_mm).abs() < 1e-9, "{unit} {step} {drawn:?} {given:?}: {read:?}");
            assert!(
                if said.is_empty() { note.is_empty() } else { note.contains(said) },
                "{unit} {step} {drawn:?}: {note}"
            );
        };
        check("METRIC", 15.0, Unit::Mm, None, 15.0, "");
        check(
            "METRIC",
            15.0,
            Unit::Cm,
            None,
            15.0,
            "read as mm, those of the pattern are cm: its longest step is 15.0 mm",
        );
        check(
            "METRIC",
            1.5,
            Unit::Cm,
            None,
            15.0,
            "its longest step is 1.5 mm from one size to the next, which is no grade",
        );
        check("METRIC", 1.5, Unit::Cm, None, 15.0, "go up to 15.0 mm");
        check("METRIC", 0.012, Unit::M, None, 12.0, "taken as m");
        check("METRIC", 1.5, Unit::Cm, Some(Unit::Mm), 1.5, "");
        check("METRIC", 1.5, Unit::Mm, Some(Unit::Cm), 15.0, "");
        check("METRIC", 1.5, Unit::Mm, None, 1.5, "hardly a grade; --rul-unit");
        check("METRIC", 1.5, Unit::M, None, 1.5, "hardly a grade");
        check("METRIC", 0.0, Unit::Mm, None, 0.0, "");
        check("METRIC", 12.0, Unit::In, None, 12.0, "those of the pattern are in");
        check("ENGLISH", 0.5, Unit::In, None, 12.7, "");
        check("ENGLISH", 0.5, Unit::Cm, None, 12.7, "read as in");
        let long = in_unit_of(table("METRIC", 15.0), Unit::Mm, Some(Unit::M)).expect_err("15 m").to_string();
        assert!(long.contains("15.0 m in rule 1"), "{long}");
    }
}
