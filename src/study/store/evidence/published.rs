//! The thesis's printed tables as pairs: chi recomputed from the printed lengths, fit by the girth that is printed.

use rusqlite::{Connection, Row};

use crate::error::Result;
use crate::store::read::simulator;
use fit::{Cuts, Errors, Pair, Simulator};
use geom::units::from_mm;

/// A row for each measurement of each case and simulator. No pattern girth at chest or hip is printed, so the fit is by
/// a proxy. It is the hem's girth less the chest for tops and the dress, the waist's less the hip for trousers (FEM's
/// L2D: Table 6-21 prints something else as the waist). Subjects of both sexes have the same names and are told apart.
const ROWS: &str = "
    WITH girth AS (
        SELECT garment, size, l2d_mm FROM published
        WHERE simulator = 'fem' AND measurement_no = iif(garment = 'male_trousers', 5, 1)
    ),
    body AS (SELECT name, chest_girth_mm, hip_girth_mm FROM subject WHERE revision = 1)
    SELECT garment, size, name, girth.l2d_mm - iif(garment = 'male_trousers', hip_girth_mm, chest_girth_mm) AS ease_mm,
        simulator, measurement_no, measurement, abs(chi - 1)
    FROM v_published JOIN girth USING (garment, size)
        JOIN body ON name = substr(garment, 1, instr(garment, '_') - 1) || '-' || subject
    ORDER BY garment, size, name, measurement_no, simulator";

/// Names of measurements along an edge that no seam holds, as printed.
const FREE_EDGES: [&str; 3] = ["Hem", "Sleeve Opening", "Neck Opening"];
/// Name of the measurement that pop-up sets to its pattern length by construction [T 5.4].
const CONTROLLED: &str = "Hem";

/// All 54 cases.
pub(super) fn pairs(connection: &Connection) -> Result<Vec<Pair>> {
    let mut statement = connection.prepare_cached(ROWS)?;
    let mut rows = statement.query([])?;
    let mut pairs: Vec<Pair> = Vec::new();
    while let Some(row) = rows.next()? {
        let (garment, size, subject): (String, String, String) = (row.get(0)?, row.get(1)?, row.get(2)?);
        let known = pairs.last().is_some_and(|p| (&p.garment, &p.size, &p.subject) == (&garment, &size, &subject));
        if !known {
            let ease_m = from_mm(row.get(3)?);
            let class = Cuts::default().classify(ease_m);
            pairs.push(Pair { garment, size, subject, class, ease_m, errors: vec![] });
        }
        if let Some(pair) = pairs.last_mut() {
            add(pair, row)?;
        }
    }
    Ok(pairs)
}

/// Adds a measurement of one simulator to its case.
fn add(pair: &mut Pair, row: &Row<'_>) -> Result<()> {
    let (no, name, error): (u32, String, f64) = (row.get(5)?, row.get(6)?, row.get(7)?);
    if pair.errors.last().is_none_or(|last| last.no != no) {
        let free_edge = FREE_EDGES.iter().any(|edge| name.starts_with(edge));
        let controlled = name.starts_with(CONTROLLED);
        pair.errors.push(Errors { no, name, fem: f64::NAN, hybrid: f64::NAN, free_edge, controlled });
    }
    if let Some(errors) = pair.errors.last_mut() {
        match simulator(row, 4)? {
            Simulator::Fem => errors.fem = error,
            Simulator::Hybrid => errors.hybrid = error,
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use crate::store::evidence::PUBLISHED;
    use crate::workspace::Workspace;
    use fit::{Errors, Finding, FitClass, Pair, rule_score, wins};

    fn open() -> (tempfile::TempDir, Workspace) {
        let folder = tempfile::tempdir().expect("a folder");
        let workspace = Workspace::open(&folder.path().join("toile.sqlite"), false).expect("a new database");
        (folder, workspace)
    }

    fn of<'a>(pairs: &'a [Pair], garment: &str) -> Vec<&'a Pair> {
        pairs.iter().filter(|pair| pair.garment.ends_with(garment)).collect()
    }

    /// Cases in which FEM-GS and Hybrid-GS have the lower EI, as the audit of the tables counts them.
    #[test]
    fn the_published_tables_know_no_winner() {
        let (_folder, workspace) = open();
        let pairs = workspace.pairs(PUBLISHED).expect("readable");
        let all = |_: &Errors| true;
        let check =
            |garment: &str, expected: [usize; 2]| assert_eq!(wins(&of(&pairs, garment), all), expected, "{garment}");
        check("", [27, 27]);
        check("tshirt", [5, 13]);
        check("trousers", [8, 10]);
        check("teetop", [8, 4]);
        check("dress", [6, 0]);
        assert_eq!(pairs.len(), 54);
        let class = |class: FitClass| pairs.iter().filter(|pair| pair.class == class).collect::<Vec<_>>();
        assert_eq!(wins(&class(FitClass::Loose), all), [12, 9]);
        assert_eq!(wins(&class(FitClass::Just), all), [6, 5]);
        assert_eq!(wins(&class(FitClass::Tight), all), [9, 13]);
        let score = rule_score(&pairs);
        assert_eq!((score.right, score.of), (25, 43));
    }

    #[test]
    fn t_shirts_turn_to_fem_without_the_neck_opening() {
        let (_folder, workspace) = open();
        let evidence = workspace.evidence(PUBLISHED).expect("readable");
        let garment = |name: &str| evidence.garments.iter().find(|all| all.garment == name).expect("published");
        let shirts = &garment("male_tshirt").analysis;
        let all = shirts.estimate.expect("six subjects");
        assert!(all.mean > 0.0 && shirts.wins == [5, 13], "{all:?}");
        let rest = shirts.turned_by().expect("one measurement");
        assert_eq!((rest.what.as_str(), rest.wins), ("#6 Neck Opening", [15, 3]));
        assert!(rest.mean < 0.0, "{rest:?}");
        // The dress: six of six subjects for FEM-GS, the least p that six can give.
        let (dress, p_holm) = (&garment("female_dress").analysis, garment("female_dress").p_holm);
        assert_eq!((dress.wins, dress.estimate.expect("six").p), ([6, 0], 0.03125));
        assert_eq!(p_holm, Some(0.125), "of four garments");
        // No universal rule: nothing is proven in any garment and fit class.
        for answer in &evidence.answers {
            assert_eq!(answer.finding, Finding::InsufficientEvidence, "{} {:?}", answer.garment, answer.class);
            assert_eq!(answer.recommended(), answer.class.rule_says());
        }
        assert_eq!(evidence.answers.len(), 11);
    }
}
