//! Tests of growth on the drafted garments.

use super::*;
use crate::draft::Model;
use crate::grade::grade;

fn growth(model: Model, handles: &[Handle]) -> Growth {
    let drafts = model.drafts();
    let draft = &drafts[drafts.len() / 2];
    Growth::of(&draft.pieces, model.seams(), "drafted.seams.toml", handles).expect("our own")
}

#[test]
fn an_even_grade_has_even_rules_few_of_them_and_seams_that_agree() {
    let check = |model: Model, told: &[(Handle, f64)], most_rules: usize| {
        let handles: Vec<Handle> = told.iter().map(|(handle, _)| *handle).collect();
        let growth = growth(model, &handles);
        assert!(growth.refused().is_empty(), "{:?}", growth.refused());
        let step = growth.aimed(told).expect("handles");
        let size = |k: i32| {
            let amounts = step.iter().map(|(handle, m)| (*handle, f64::from(k) * m)).collect();
            (format!("S{}", k + 3), amounts)
        };
        let sizes: Vec<_> = (-2..=2).map(size).collect();
        let graded = growth.graded(&sizes, 2).expect("sizes");
        assert!(graded.table.rules.len() <= most_rules, "{model:?}: {} rules", graded.table.rules.len());
        for rule in graded.table.rules.values() {
            for pair in rule.windows(2).map(|pair| pair[1] - pair[0]).collect::<Vec<_>>().windows(2) {
                // Half of what a cutter sees.
                assert!((pair[1] - pair[0]).norm() < 0.25e-3, "{model:?}: {rule:?}");
            }
        }
        let file = crate::dxf::PatternFile {
            pieces: graded.pieces.clone(),
            ..crate::dxf::read(
                &crate::dxf::write_pieces(&graded.pieces, &[], crate::dxf::Standard::Aama),
                "a.dxf",
                None,
            )
            .expect("our own file")
        };
        let nest = grade(&file, &graded.table).expect("rules of its points");
        for (k, (name, _)) in sizes.iter().enumerate() {
            let pieces: Vec<Piece> =
                nest.pieces.iter().filter(|piece| piece.size.as_ref() == Some(name)).cloned().collect();
            let style = Style::read(&pieces, &graded.seams, "graded").expect("seams that agree");
            assert!(growth.off_m(&style).iter().all(|off| off.abs() < SEAM_M), "{model:?} {name}");
            for (handle, by_m) in told {
                let Some(point) = handle.changes() else { continue };
                let length = |style: &Style| {
                    style.points_of_measure().iter().find(|found| found.point == point).map(|found| found.length_m)
                };
                // A dress has no hip that is measured flat.
                let Some(before) = length(growth.style()) else { continue };
                let grown = length(&style).map(|after| after - before);
                let meant = (k as f64 - 2.0) * by_m;
                let off = grown.map_or(1.0, |grown| (grown - meant).abs());
                assert!(off < 0.6e-3, "{model:?} {name}: {} {grown:?}, meant {meant}", handle.as_str());
            }
        }
    };
    use Handle::*;
    let tee = [
        (Chest, 0.02),
        (Waist, 0.02),
        (Hem, 0.02),
        (ShoulderLength, 0.0025),
        (NeckWidth, 0.004),
        (SleeveLength, 0.005),
    ];
    check(Model::Tshirt, &tee, 60);
    check(Model::Trousers, &[(Waist, 0.02), (Hip, 0.02), (Knee, 0.006), (LegLength, 0.005)], 60);
    check(Model::Dress, &[(Chest, 0.02), (Waist, 0.02), (Hip, 0.02), (SkirtLength, 0.005)], 80);
}
