//! Contradictions within the tables: rows that are sums of others, copied columns, and patterns that differ between the
//! simulators.

use crate::audit::tables::{Row, SUBJECTS, Sized, Tables};
use crate::audit::{Audit, Finding};
use fit::Simulator;

/// Greatest difference between a printed length and the sum of two that counts as none; lengths have 0.01 mm.
const PRINTED_MM: f64 = 0.0101;
/// Least difference between the simulators in a pattern length that is more than rounding.
const SAME_PATTERN_MM: f64 = 0.011;
/// Ratio of a size step to the next below which the step is no grading.
const UNEVEN_GRADE: f64 = 0.02;

pub(super) fn check(tables: &Tables) -> Audit {
    let mut findings = Vec::new();
    for of in tables.garments() {
        for simulator in [Simulator::Fem, Simulator::Hybrid] {
            let rows = tables.table(&of, simulator);
            findings.extend(sums(&rows));
            findings.extend(copies(&rows, &of, simulator));
        }
        findings.extend(patterns(tables, &of));
    }
    findings.extend(grading(tables));
    findings.extend(waists(tables));
    Audit { recomputed: tables.rows.len(), findings }
}

/// Rows in which all six lengths are sums of those of two other rows.
fn sums(rows: &[&Row]) -> Vec<Finding> {
    let is_sum =
        |row: &Row, a: &Row, b: &Row| (0..6).all(|s| (row.l3d_mm[s] - a.l3d_mm[s] - b.l3d_mm[s]).abs() <= PRINTED_MM);
    let mut findings = Vec::new();
    for row in rows {
        for (k, a) in rows.iter().enumerate() {
            for b in rows[k + 1..].iter().filter(|b| is_sum(row, a, b)) {
                findings.push(Finding {
                    kind: "row",
                    place: row.place(),
                    stated: format!("L2D {:.2} mm", row.l2d_mm),
                    recomputed: format!("#{} + #{}: L2D {:.2} mm", a.no, b.no, a.l2d_mm + b.l2d_mm),
                    says: format!(
                        "all six lengths are #{} + #{} of the same table: this is no {}",
                        a.no, b.no, row.name
                    ),
                });
            }
        }
    }
    findings
}

/// Pairs of subjects with the same lengths in all rows.
fn copies(rows: &[&Row], of: &Sized, simulator: Simulator) -> Vec<Finding> {
    let mut findings = Vec::new();
    for a in 0..6 {
        for b in a + 1..6 {
            if rows.iter().all(|row| row.l3d_mm[a] == row.l3d_mm[b]) {
                let table = rows.first().map_or("?", |row| &row.table);
                findings.push(Finding {
                    kind: "copy",
                    place: format!("table {table}, {of} ({}), {} and {}", simulator.as_str(), SUBJECTS[a], SUBJECTS[b]),
                    stated: "two subjects".into(),
                    recomputed: format!("{} equal lengths of {}", rows.len(), rows.len()),
                    says: "one column is a copy of the other; which one cannot be told".into(),
                });
            }
        }
    }
    findings
}

fn patterns(tables: &Tables, of: &Sized) -> Vec<Finding> {
    let hybrid = tables.table(of, Simulator::Hybrid);
    let differs = |fem: &Row| {
        let other = hybrid.iter().find(|row| row.no == fem.no)?;
        ((fem.l2d_mm - other.l2d_mm).abs() > SAME_PATTERN_MM).then(|| Finding {
            kind: "pattern",
            place: format!("tables {} and {}, {of}, #{} {}", fem.table, other.table, fem.no, fem.name),
            stated: format!("L2D {:.2} mm (fem)", fem.l2d_mm),
            recomputed: format!("L2D {:.2} mm (hybrid)", other.l2d_mm),
            says: "one pattern has one length, whatever the simulator".into(),
        })
    };
    tables.table(of, Simulator::Fem).into_iter().filter_map(differs).collect()
}

/// Pattern lengths that shrink from one size to the next, or hardly change in the first of two steps.
fn grading(tables: &Tables) -> Vec<Finding> {
    let order = ["s", "m", "l"];
    let mut findings = Vec::new();
    let mut garments: Vec<String> = tables.garments().into_iter().map(|of| of.garment).collect();
    garments.dedup();
    for garment in garments {
        let size = |size: &str| tables.table(&Sized { garment: garment.clone(), size: size.into() }, Simulator::Fem);
        let sizes: Vec<(&str, Vec<&Row>)> =
            order.iter().map(|s| (*s, size(s))).filter(|(_, rows)| !rows.is_empty()).collect();
        let count = sizes.iter().map(|(_, rows)| rows.len()).min().unwrap_or(0);
        for k in 0..count {
            let lengths: Vec<f64> = sizes.iter().map(|(_, rows)| rows[k].l2d_mm).collect();
            let steps: Vec<f64> = lengths.windows(2).map(|pair| pair[1] - pair[0]).collect();
            let row = sizes[0].1[k];
            let says = if steps.iter().any(|step| *step < -PRINTED_MM) {
                "gets shorter as the size grows"
            } else if steps.len() == 2 && steps[0].abs() < UNEVEN_GRADE * steps[1].abs() {
                "hardly moves from S to M and jumps from M to L"
            } else {
                continue;
            };
            let names: Vec<&str> = sizes.iter().map(|(name, _)| *name).collect();
            findings.push(Finding {
                kind: "pattern",
                place: format!("{garment}, #{} {}, sizes {}", row.no, row.name, names.join(" ")),
                stated: lengths.iter().map(|l| format!("{l:.2}")).collect::<Vec<_>>().join(" "),
                recomputed: steps.iter().map(|s| format!("{s:+.2}")).collect::<Vec<_>>().join(" "),
                says: says.into(),
            });
        }
    }
    findings
}

/// A waist wider than the hem of the skirt below it.
fn waists(tables: &Tables) -> Vec<Finding> {
    let mut findings = Vec::new();
    for of in tables.garments() {
        let rows = tables.table(&of, Simulator::Fem);
        let named = |name: &str| rows.iter().find(|row| row.name.to_lowercase().starts_with(name)).copied();
        if let (Some(waist), Some(hem), Some(_)) = (named("waist"), named("hem"), named("skirt"))
            && waist.l2d_mm > hem.l2d_mm
        {
            findings.push(Finding {
                kind: "pattern",
                place: format!("{of}, #{} {}", waist.no, waist.name),
                stated: format!("L2D {:.2} mm", waist.l2d_mm),
                recomputed: format!("hem {:.2} mm", hem.l2d_mm),
                says: "wider than the hem: this seam cannot lie at the natural waist".into(),
            });
        }
    }
    findings
}
