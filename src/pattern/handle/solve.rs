//! Solver for the factors of the points that give way ([`Plan::gives`]), so that the conditions on lengths hold:
//! Newton's method with the step of least norm.

use std::collections::{BTreeMap, BTreeSet};

use super::plan::{Condition, Move, Plan, Span, Term};
use super::rig::{Displacement, Rig};
use crate::style::{EdgeRef, Style};
use geom::polyline::Polyline;

const DIFFERENCE_M: f64 = 1e-6;
/// Residual below which a condition holds: a thousandth of the accepted change of a seam or length.
const HOLDS_M: f64 = 1e-7;
/// Newton takes two or three.
const MOST_STEPS: usize = 12;
/// Regularisation of the normal matrix J J^T, for linearly dependent conditions.
const REGULAR: f64 = 1e-9;

pub struct SeamResidual {
    pub seam: usize,
    /// Change of the difference between the lengths of its sides.
    pub off_m: f64,
}

pub struct Solved {
    pub lines: BTreeMap<usize, Vec<Polyline>>,
    pub seams: Vec<SeamResidual>,
    pub conditions_m: Vec<f64>,
}

/// Adds enough vertices on the edges that a plan bends.
pub fn refined(style: &Style, plan: &Plan) -> Style {
    let moves: Vec<Move> = all_moves(plan).copied().collect();
    Rig::new(style, moves.iter()).refined(&moves)
}

fn all_moves(plan: &Plan) -> impl Iterator<Item = &Move> {
    plan.moves.iter().chain(plan.gives.iter().flatten())
}

/// Drives the points of a plan, and lets the others give way as far as the conditions require.
pub fn solved(style: &Style, plan: &Plan, amount_m: f64) -> Solved {
    // The displacement of a give is zero at the driven points, but not at the points of other gives.
    let displacement = |moves: &[Move]| Rig::new(style, plan.moves.iter().chain(moves)).displacement(moves);
    let touched: Vec<usize> = all_moves(plan).map(|moved| moved.at.edge.piece).collect();
    let seams = seam_conditions(style, &touched);
    let conditions: Vec<&Condition> = plan.conditions.iter().chain(seams.iter().map(|(_, c)| c)).collect();
    let system = System {
        style,
        touched: touched.iter().copied().collect(),
        drive: Rig::new(style, plan.moves.iter()).displacement(&plan.moves),
        gives: plan.gives.iter().map(|give| displacement(give)).collect(),
        conditions,
        amount_m,
    };
    let mut given = vec![0.0; plan.gives.len()];
    for _ in 0..MOST_STEPS {
        let missed = system.missed(&given);
        if missed.iter().all(|miss| miss.abs() < HOLDS_M) {
            break;
        }
        let step = least_step(&system.slopes(&given, &missed), &missed);
        given.iter_mut().zip(step).for_each(|(given, step)| *given -= step);
    }
    let missed = system.missed(&given);
    let (conditions_m, of_seams) = missed.split_at(plan.conditions.len());
    Solved {
        lines: system.lines(&given),
        seams: seams
            .iter()
            .zip(of_seams)
            .map(|((seam, _), off_m)| SeamResidual { seam: *seam, off_m: *off_m })
            .collect(),
        conditions_m: conditions_m.to_vec(),
    }
}

/// The two sides keep their length difference, for every seam with an affected piece.
fn seam_conditions(style: &Style, touched: &[usize]) -> Vec<(usize, Condition)> {
    let is_touched = |edge: &EdgeRef| touched.contains(&edge.piece);
    let seams = style.seams.iter().enumerate().filter(|(_, seam)| seam.a.iter().chain(&seam.b).any(is_touched));
    seams
        .map(|(number, seam)| {
            let side = |chain: &[EdgeRef], factor: f64| -> Vec<Term> {
                chain.iter().map(|edge| Term::whole(*edge, factor)).collect()
            };
            let terms = [side(&seam.a, 1.0), side(&seam.b, -1.0)].concat();
            (number, Condition { terms, change: 0.0 })
        })
        .collect()
}

struct System<'a> {
    style: &'a Style,
    touched: BTreeSet<usize>,
    drive: Displacement,
    gives: Vec<Displacement>,
    conditions: Vec<&'a Condition>,
    amount_m: f64,
}

impl System<'_> {
    fn lines(&self, given: &[f64]) -> BTreeMap<usize, Vec<Polyline>> {
        let edges = |piece: usize| (0..self.style.pieces[piece].edges.len()).map(move |edge| EdgeRef { piece, edge });
        let lines =
            self.touched.iter().map(|piece| (*piece, edges(*piece).map(|edge| self.line(edge, given)).collect()));
        lines.collect()
    }

    fn line(&self, edge: EdgeRef, given: &[f64]) -> Polyline {
        let line = &self.style.edge(edge).line;
        let mut points = line.points().to_vec();
        let gives = self.gives.iter().zip(given.iter().copied());
        for (fields, share) in
            [(&self.drive, self.amount_m)].into_iter().chain(gives).filter(|(_, share)| *share != 0.0)
        {
            if let Some(moved) = fields.get(&edge.piece) {
                points.iter_mut().zip(&moved[edge.edge]).for_each(|(p, by)| *p += by * share);
            }
        }
        Polyline::new(points).unwrap_or_else(|| line.clone())
    }

    fn missed(&self, given: &[f64]) -> Vec<f64> {
        let mut kept = BTreeMap::new();
        let mut change_m = |span: &Span| {
            let before = &self.style.edge(span.edge).line;
            let after = kept.entry(span.edge).or_insert_with(|| self.line(span.edge, given));
            let [from, to] = span.arcs_m.map(|arc| arc.min(before.length()));
            carried(before, after, to) - carried(before, after, from) - (to - from)
        };
        let mut miss = |condition: &&Condition| {
            let changed: f64 = condition.terms.iter().map(|term| term.factor * change_m(&term.span)).sum();
            changed - condition.change * self.amount_m
        };
        self.conditions.iter().map(&mut miss).collect()
    }

    /// Jacobian by finite differences: one row for each condition, one column for each give.
    fn slopes(&self, given: &[f64], missed: &[f64]) -> Vec<Vec<f64>> {
        let mut rows = vec![vec![0.0; given.len()]; missed.len()];
        for k in 0..given.len() {
            let mut beside = given.to_vec();
            beside[k] += DIFFERENCE_M;
            for (row, (after, before)) in rows.iter_mut().zip(self.missed(&beside).iter().zip(missed)) {
                row[k] = (after - before) / DIFFERENCE_M;
            }
        }
        rows
    }
}

/// Arc length on the line after of the point at `arc_m` on the line before, m.
pub fn carried(before: &Polyline, after: &Polyline, arc_m: f64) -> f64 {
    let arcs = before.arcs();
    let next = arcs.partition_point(|arc| *arc <= arc_m).clamp(1, arcs.len() - 1);
    let (low, high) = (arcs[next - 1], arcs[next]);
    let share = if high > low { ((arc_m - low) / (high - low)).clamp(0.0, 1.0) } else { 0.0 };
    after.arcs()[next - 1] + share * (after.arcs()[next] - after.arcs()[next - 1])
}

/// Least-norm change of the factors that removes the residuals r to first order: J^T (J J^T + e I)^-1 r, with the
/// Jacobian J in `rows`.
pub fn least_step(rows: &[Vec<f64>], missed: &[f64]) -> Vec<f64> {
    let n = missed.len();
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    // Lower Cholesky factor of J J^T + e I.
    let mut factor = vec![vec![0.0; n]; n];
    for i in 0..n {
        for j in 0..=i {
            let product = dot(&rows[i], &rows[j]) + if i == j { REGULAR } else { 0.0 };
            let rest = product - dot(&factor[i][..j], &factor[j][..j]);
            factor[i][j] = if i == j { rest.max(REGULAR).sqrt() } else { rest / factor[j][j] };
        }
    }
    let mut weights = missed.to_vec();
    for i in 0..n {
        let known: f64 = (0..i).map(|j| factor[i][j] * weights[j]).sum();
        weights[i] = (weights[i] - known) / factor[i][i];
    }
    for i in (0..n).rev() {
        let known: f64 = (i + 1..n).map(|j| factor[j][i] * weights[j]).sum();
        weights[i] = (weights[i] - known) / factor[i][i];
    }
    let width = rows.first().map_or(0, Vec::len);
    (0..width).map(|k| rows.iter().zip(&weights).map(|(row, weight)| row[k] * weight).sum()).collect()
}
