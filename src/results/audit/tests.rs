use crate::audit::tables::{Row, Sized, Tables};
use crate::audit::*;
use fit::Simulator;
use wardrobe::catalogue;

fn thesis() -> Audit {
    let folder = tempfile::tempdir().expect("a folder");
    let store = catalogue::open(&folder.path().join("toile.sqlite"), false).expect("a new database");
    audit_thesis(&store).expect("the tables are there")
}

#[test]
fn the_thesis_is_audited() {
    let audit = thesis();
    let lines: Vec<String> = audit
        .findings
        .iter()
        .map(|f| format!("{} | {} | {} | {} | {}", f.kind, f.place, f.stated, f.recomputed, f.says))
        .collect();
    insta::assert_snapshot!(format!("{} numbers\n{}", audit.recomputed, lines.join("\n")));
}

#[test]
fn every_kind_of_error_is_found_as_often_as_it_is_there() {
    let audit = thesis();
    let check = |kind: &str, says: &str, places: usize| {
        let found = audit.findings.iter().filter(|f| f.kind == kind && f.says.contains(says)).count();
        assert_eq!(found, places, "{kind}: {says}");
    };
    check("ratio", "that of the subject before", 10);
    check("winner", "changes its sign", 5);
    check("metric", "of measurement #2 alone", 11);
    check("metric", "the sum over the 11", 6);
    check("metric", "another number", 1);
    check("metric", "wrong ones included", 8);
    check("shift", "", 2);
    check("reference", "", 2);
    check("word", "", 2);
    check("statement", "other numbers of iterations", 1);
    check("row", "this is no Waist Girth", 1);
    check("row", "mean or sample SD", 0);
    check("copy", "copy of the other", 1);
    let missing = audit.findings.iter().filter(|f| f.kind == "missing");
    assert_eq!(missing.map(|f| f.says.matches(['E', 'S']).count()).sum::<usize>(), 21, "E, SD or EI");
    check("equation", "", 4);
    check("caption", "", 3);
    let wrong: usize = audit
        .findings
        .iter()
        .filter(|f| f.says.contains("of 6 ratios"))
        .map(|f| f.says[..1].parse::<usize>().expect("a count"))
        .sum();
    assert_eq!(wrong, 48, "ratios that are visibly wrong");
}

#[test]
fn tables_without_errors_have_no_findings() {
    let row = |no: u32, simulator, l2d_mm: f64, grow: f64| {
        let l3d_mm = std::array::from_fn(|s| l2d_mm * (grow + 0.01 * s as f64 + 0.001 * f64::from(no)));
        let chi: [f64; 6] = std::array::from_fn(|s| l3d_mm[s] / l2d_mm);
        let mean = rounding::mean(&chi);
        let sd = rounding::variance(&chi, 1.0).sqrt();
        let of = Sized { garment: "male_tshirt".into(), size: "s".into() };
        Row { table: "1".into(), of, simulator, no, name: "Neck".into(), l2d_mm, l3d_mm, chi, mean, sd }
    };
    let rows =
        [Simulator::Fem, Simulator::Hybrid].into_iter().flat_map(|s| [row(1, s, 500.0, 1.0), row(2, s, 900.0, 0.97)]);
    let tables =
        Tables { rows: rows.collect(), metrics: vec![], summaries: vec![], subjects: vec![], prepositions: vec![] };
    for check in [ratios::check, structure::check] {
        assert_eq!(check(&tables).findings, vec![]);
    }
}
