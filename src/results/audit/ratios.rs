//! Ratios L3D / L2D, with the mean and SD of each row.

use crate::audit::rounding::{blur, mean, prints_as, variance};
use crate::audit::tables::{Row, SUBJECTS, Sized, Tables};
use crate::audit::{Audit, Finding, three, threes};
use fit::Simulator;

/// Checks every ratio, row mean and row SD.
pub(super) fn check(tables: &Tables) -> Audit {
    let mut findings: Vec<Finding> =
        tables.rows.iter().flat_map(|row| ratios(row).into_iter().chain(summary(row))).collect();
    findings.extend(winners(tables));
    findings.extend(shifts(tables));
    Audit { recomputed: tables.rows.len() * 8, findings }
}

/// Ratio as the thesis computed it: to the pattern length or, in a chained row, to L3D of the subject before.
pub(super) fn as_computed(row: &Row, subject: usize) -> f64 {
    let chained = if is_chained(row) { chained(row, subject) } else { None };
    chained.unwrap_or_else(|| row.ratio(subject))
}

/// L3D of a subject divided by L3D of the subject before.
fn chained(row: &Row, subject: usize) -> Option<f64> {
    let before = row.l3d_mm[subject.checked_sub(1)?];
    Some(row.l3d_mm[subject] / before)
}

fn holds(row: &Row, subject: usize) -> bool {
    let ratio = row.ratio(subject);
    prints_as(ratio, row.chi[subject], blur(ratio, row.l2d_mm))
}

/// True if a row is chained: some ratios are not to the pattern, and all but the first are to the subject before.
fn is_chained(row: &Row) -> bool {
    let fits = |subject: usize| {
        let blur = blur(row.chi[subject], row.l3d_mm[subject - 1]);
        chained(row, subject).is_some_and(|chained| prints_as(chained, row.chi[subject], blur))
    };
    (1..6).all(fits) && (1..6).any(|subject| !holds(row, subject))
}

fn ratios(row: &Row) -> Option<Finding> {
    let wrong: Vec<usize> = (0..6).filter(|&s| !holds(row, s)).collect();
    if wrong.is_empty() {
        return None;
    }
    let why = if is_chained(row) {
        "each subject's length is divided by that of the subject before, not by the pattern's"
    } else {
        "L3D / L2D is another number"
    };
    let subjects: Vec<&str> = wrong.iter().map(|&s| SUBJECTS[s]).collect();
    Some(Finding {
        kind: "ratio",
        place: format!("{}, {}", row.place(), subjects.join(" ")),
        stated: threes(wrong.iter().map(|&s| row.chi[s])),
        recomputed: threes(wrong.iter().map(|&s| row.ratio(s))),
        says: format!("{} of 6 ratios are wrong: {why}", wrong.len()),
    })
}

fn summary(row: &Row) -> Option<Finding> {
    let computed: Vec<f64> = (0..6).map(|s| as_computed(row, s)).collect();
    let (mean, sd) = (mean(&computed), variance(&computed, 1.0).sqrt());
    let blur = blur(mean, row.l2d_mm);
    let holds = prints_as(mean, row.mean, blur) && prints_as(sd, row.sd, blur);
    (!holds).then(|| Finding {
        kind: "row",
        place: row.place(),
        stated: threes([row.mean, row.sd]),
        recomputed: threes([mean, sd]),
        says: "mean or sample SD of the row's own ratios is another number".into(),
    })
}

/// Greatest changes of E and of EI caused by wrong ratios.
fn shifts(tables: &Tables) -> Vec<Finding> {
    let of_garment = |of: Sized| {
        let cells =
            [Simulator::Fem, Simulator::Hybrid].into_iter().flat_map(|simulator| (0..6).map(move |s| (simulator, s)));
        cells.map(move |(simulator, subject)| (of.clone(), simulator, subject))
    };
    let cells: Vec<(Sized, Simulator, usize)> = tables.garments().into_iter().flat_map(of_garment).collect();
    let greatest = |name: &str, error: fn(f64) -> f64| {
        let both = |(of, simulator, subject): &(Sized, Simulator, usize)| {
            let rows = tables.table(of, *simulator);
            let over =
                |ratio: &dyn Fn(&Row) -> f64| mean(&rows.iter().map(|row| error(ratio(row))).collect::<Vec<_>>());
            let place = format!("{name} of {of} ({}), {}", simulator.as_str(), SUBJECTS[*subject]);
            (place, over(&|row| as_computed(row, *subject)), over(&|row| row.ratio(*subject)))
        };
        let shift = |(_, stated, mended): &(String, f64, f64)| (stated - mended).abs();
        let found = cells.iter().map(both).max_by(|a, b| shift(a).total_cmp(&shift(b)));
        found.filter(|found| shift(found) > 0.0)
    };
    let worst = [greatest("E", |ratio| ratio), greatest("EI", |ratio| (ratio - 1.0).abs())];
    let finding = |(place, stated, mended): (String, f64, f64)| Finding {
        kind: "shift",
        place,
        stated: three(stated),
        recomputed: three(mended),
        says: format!("nowhere do the wrong ratios change it more: by {}", three((stated - mended).abs())),
    };
    worst.into_iter().flatten().map(finding).collect()
}

/// Cases in which wrong ratios change which simulator has the lower EI.
fn winners(tables: &Tables) -> Vec<Finding> {
    let mut findings = Vec::new();
    for of in tables.garments() {
        for subject in 0..6 {
            let ei = |simulator: Simulator, ratio: &dyn Fn(&Row) -> f64| {
                let rows = tables.table(&of, simulator);
                mean(&rows.iter().map(|row| (ratio(row) - 1.0).abs()).collect::<Vec<_>>())
            };
            let lead = |ratio: &dyn Fn(&Row) -> f64| ei(Simulator::Fem, ratio) - ei(Simulator::Hybrid, ratio);
            let (stated, mended) = (lead(&|row| as_computed(row, subject)), lead(&|row| row.ratio(subject)));
            if stated * mended < 0.0 {
                findings.push(Finding {
                    kind: "winner",
                    place: format!("{of}, {}", SUBJECTS[subject]),
                    stated: three(stated),
                    recomputed: three(mended),
                    says: "EI of FEM less EI of Hybrid changes its sign once the ratios are mended".into(),
                });
            }
        }
    }
    findings
}
