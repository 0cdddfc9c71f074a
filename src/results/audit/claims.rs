//! Statements of the thesis's text, checked against its tables.

use crate::audit::rounding::{mean, variance};
use crate::audit::tables::{SUBJECTS, Sized, Tables};
use crate::audit::{Audit, Finding, three};
use fit::Simulator::{self, Fem, Hybrid};

/// Greatest difference between a printed limit of a range and the number that it rounds: half a unit of its last digit.
const ROUNDING: f64 = 0.0005;
/// Greatest difference between two EI that count as equivalent: a fifth of the thesis's mean EI.
const EQUIVALENT: f64 = 0.01;

/// Result from the tables that contradicts a statement; `None` where the statement holds.
type Refuted = Option<String>;

struct Claim {
    section: &'static str,
    says: &'static str,
    refute: fn(&Tables) -> Refuted,
}

/// A statistic of chi for one garment, simulator and subject; less is better.
type Figure = fn(&Tables, &Sized, Simulator, usize) -> f64;

const EI: Figure = |tables, of, simulator, subject| tables.ei(of, simulator, subject);
const BIAS: Figure = |tables, of, simulator, subject| (mean(&tables.chis(of, simulator, subject)) - 1.0).abs();
const SD: Figure = |tables, of, simulator, subject| variance(&tables.chis(of, simulator, subject), 1.0).sqrt();

/// Statements about numbers, in order of the text.
const CLAIMS: [Claim; 15] = [
    Claim { section: "4.4.2.2", says: "bending by 120 or 180 degrees is more accurate than flat", refute: bending },
    Claim {
        section: "6.3.1.1",
        says: "hybrid t-shirt S stretches or shrinks by 6 % at most",
        refute: |t| range(t, ("male_tshirt", "s"), Hybrid, 0.94, 1.06),
    },
    Claim {
        section: "6.3.1.2",
        says: "hybrid t-shirt M lies between 0.925 and 1.163",
        refute: |t| range(t, ("male_tshirt", "m"), Hybrid, 0.925, 1.163),
    },
    Claim {
        section: "6.3.1.2",
        says: "t-shirt M: EI of iii to vi favours Hybrid",
        refute: |t| favours(t, ("male_tshirt", "m"), Hybrid, &[2, 3, 4, 5], EI),
    },
    Claim {
        section: "6.3.1.3",
        says: "t-shirt L: EI favours Hybrid throughout",
        refute: |t| favours(t, ("male_tshirt", "l"), Hybrid, &[0, 1, 2, 3, 4, 5], EI),
    },
    Claim {
        section: "6.3.1.3",
        says: "t-shirt L: SD favours Hybrid throughout",
        refute: |t| favours(t, ("male_tshirt", "l"), Hybrid, &[0, 1, 2, 3, 4, 5], SD),
    },
    Claim {
        section: "6.3.2.1",
        says: "trousers S: E of i, ii, iii and v is better with Hybrid",
        refute: |t| favours(t, ("male_trousers", "s"), Hybrid, &[0, 1, 2, 4], BIAS),
    },
    Claim { section: "6.3.2.1", says: "trousers S: measurements but the crotch are better with Hybrid", refute: legs },
    Claim { section: "6.3.2.2", says: "trousers M: equivalent on ii, iii and iv", refute: equivalence },
    Claim {
        section: "6.3.2.3",
        says: "trousers L: FEM is better on i, ii, iii, iv and vi",
        refute: |t| favours(t, ("male_trousers", "l"), Fem, &[0, 1, 2, 3, 5], EI),
    },
    Claim {
        section: "6.3.3.1",
        says: "tee-top M: Hybrid is better on all, by EI",
        refute: |t| favours(t, ("female_teetop", "m"), Hybrid, &[0, 1, 2, 3, 4, 5], EI),
    },
    Claim {
        section: "6.3.3.1",
        says: "tee-top M: Hybrid is better on all, by E",
        refute: |t| favours(t, ("female_teetop", "m"), Hybrid, &[0, 1, 2, 3, 4, 5], BIAS),
    },
    Claim {
        section: "6.3.3.2",
        says: "tee-top L: EI of ii, iv and v favours Hybrid",
        refute: |t| favours(t, ("female_teetop", "l"), Hybrid, &[1, 3, 4], EI),
    },
    Claim {
        section: "6.3.3.2",
        says: "FEM tee-top L lies between 0.857 and 1.184",
        refute: |t| range(t, ("female_teetop", "l"), Fem, 0.857, 1.184),
    },
    Claim {
        section: "6.3.4",
        says: "dress: Hybrid is more accurate on i to iv",
        refute: |t| favours(t, ("female_dress", "one"), Hybrid, &[0, 1, 2, 3], EI),
    },
];

pub(super) fn check(tables: &Tables) -> Audit {
    let refuted = |claim: &Claim| {
        Some(Finding {
            kind: "statement",
            place: format!("section {}", claim.section),
            stated: claim.says.into(),
            recomputed: (claim.refute)(tables)?,
            says: "the tables do not bear it out".into(),
        })
    };
    Audit { recomputed: CLAIMS.len(), findings: CLAIMS.iter().filter_map(refuted).collect() }
}

fn sized((garment, size): (&str, &str)) -> Sized {
    Sized { garment: garment.into(), size: size.into() }
}

fn range(tables: &Tables, of: (&str, &str), simulator: Simulator, low: f64, high: f64) -> Refuted {
    let chis: Vec<f64> = (0..6).flat_map(|subject| tables.chis(&sized(of), simulator, subject)).collect();
    let (least, most) = chis.iter().fold((f64::MAX, f64::MIN), |(l, m), &chi| (l.min(chi), m.max(chi)));
    (least < low - ROUNDING || most > high + ROUNDING).then(|| format!("chi from {} to {}", three(least), three(most)))
}

fn favours(tables: &Tables, of: (&str, &str), simulator: Simulator, subjects: &[usize], figure: Figure) -> Refuted {
    let of = sized(of);
    let other = if simulator == Fem { Hybrid } else { Fem };
    let not = subjects.iter().filter(|&&s| figure(tables, &of, simulator, s) >= figure(tables, &of, other, s));
    let cells: Vec<String> = not
        .map(|&s| {
            let [fem, hybrid] = [Fem, Hybrid].map(|simulator| three(figure(tables, &of, simulator, s)));
            format!("{} ({fem} fem, {hybrid} hybrid)", SUBJECTS[s])
        })
        .collect();
    (!cells.is_empty()).then(|| format!("not on {}", cells.join(", ")))
}

/// Accuracy by bending angle (Table 4-1) where bent is not more accurate than flat.
fn bending(tables: &Tables) -> Refuted {
    let error = |degrees: f64| {
        let cells = tables.prepositions.iter().filter(|cell| cell.bend_deg == degrees);
        mean(&cells.map(|cell| (cell.chi - 1.0).abs()).collect::<Vec<_>>())
    };
    let [flat, less, more] = [0.0, 120.0, 180.0].map(error);
    (less > flat || more > flat)
        .then(|| format!("mean |chi - 1|: 180 degrees {more:.4}, flat {flat:.4}, 120 degrees {less:.4}"))
}

/// Measurements of the trousers S, except the crotch, whose mean |chi - 1| over all subjects is greater for Hybrid-GS.
fn legs(tables: &Tables) -> Refuted {
    let of = sized(("male_trousers", "s"));
    let errors = |simulator| {
        let rows = tables.table(&of, simulator).into_iter().filter(|row| !row.name.starts_with("Crotch"));
        let error =
            |row: &crate::audit::tables::Row| mean(&(0..6).map(|s| (row.ratio(s) - 1.0).abs()).collect::<Vec<_>>());
        rows.map(|row| (row.name.clone(), error(row))).collect::<Vec<_>>()
    };
    let pairs = errors(Fem).into_iter().zip(errors(Hybrid));
    let worse: Vec<String> = pairs
        .filter(|((_, fem), (_, hybrid))| hybrid > fem)
        .map(|((name, fem), (_, hybrid))| format!("{name} ({} fem, {} hybrid)", three(fem), three(hybrid)))
        .collect();
    (!worse.is_empty()).then(|| format!("not {}", worse.join(", ")))
}

/// Subjects on whom the EI of the trousers M differs between the simulators by more than [`EQUIVALENT`].
fn equivalence(tables: &Tables) -> Refuted {
    let of = sized(("male_trousers", "m"));
    let apart: Vec<String> = [1, 2, 3]
        .into_iter()
        .map(|s| (s, EI(tables, &of, Fem, s), EI(tables, &of, Hybrid, s)))
        .filter(|(_, fem, hybrid)| (fem - hybrid).abs() > EQUIVALENT)
        .map(|(s, fem, hybrid)| format!("{} ({} fem, {} hybrid)", SUBJECTS[s], three(fem), three(hybrid)))
        .collect();
    (!apart.is_empty()).then(|| format!("EI differs on {}", apart.join(", ")))
}
