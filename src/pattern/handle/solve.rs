//! How far what gives way must move for lengths to hold: Newton's method, by the least displacement.

use std::collections::{BTreeMap, BTreeSet};

use super::plan::{Condition, Move, Plan, Span};
use super::rig::{Displacement, Rig};
use crate::style::{EdgeRef, Style};
use geom::polyline::Polyline;

/// Step of the differences by which lengths are differentiated, m.
const DIFFERENCE_M: f64 = 1e-6;
/// Residual at which lengths hold, m: a thousandth of what a seam may be off.
const HOLDS_M: f64 = 1e-7;
/// Most steps; two or three are the rule.
const MOST_STEPS: usize = 12;
/// What is added to the squares of the conditions, so that those that say the same twice do no harm.
const REGULAR: f64 = 1e-9;

/// A style whose outlines are displaced.
pub struct Solved {
    /// Lines of all edges of the pieces that are touched.
    pub lines: BTreeMap<usize, Vec<Polyline>>,
    /// By how much each seam's sides differ more than before, m, by the seam's number.
    pub seams_m: Vec<(usize, f64)>,
    /// By how much each of the plan's conditions is missed, m.
    pub conditions_m: Vec<f64>,
}

/// The style with vertices enough on the edges that a plan bends.
pub fn refined(style: &Style, plan: &Plan) -> Style {
    let moves: Vec<Move> = all_moves(plan).copied().collect();
    Rig::new(style, moves.iter()).refined(&moves)
}

fn all_moves(plan: &Plan) -> impl Iterator<Item = &Move> {
    plan.moves.iter().chain(plan.gives.iter().flatten())
}

/// Moves a plan's places by an amount, m, and what gives way as far as its conditions ask.
pub fn solved(style: &Style, plan: &Plan, amount_m: f64) -> Solved {
    // What gives way has knots of its own, and does not hold what moves beside it.
    let displacement = |moves: &[Move]| Rig::new(style, plan.moves.iter().chain(moves)).displacement(moves);
    let touched: Vec<usize> = all_moves(plan).map(|one| one.at.edge.piece).collect();
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
        seams_m: seams.iter().map(|(seam, _)| *seam).zip(of_seams.iter().copied()).collect(),
        conditions_m: conditions_m.to_vec(),
    }
}

/// Of every seam with a piece that is touched: its sides differ as before.
fn seam_conditions(style: &Style, touched: &[usize]) -> Vec<(usize, Condition)> {
    let is_touched = |edge: &EdgeRef| touched.contains(&edge.piece);
    let seams = style.seams.iter().enumerate().filter(|(_, seam)| seam.a.iter().chain(&seam.b).any(is_touched));
    seams
        .map(|(number, seam)| {
            let side = |chain: &[EdgeRef], sign: f64| -> Vec<(Span, f64)> {
                chain.iter().map(|edge| (Span::whole(*edge), sign)).collect()
            };
            let spans = [side(&seam.a, 1.0), side(&seam.b, -1.0)].concat();
            (number, Condition { spans, change: 0.0 })
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
    /// The edges of the touched pieces, displaced.
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

    /// By how much each condition is missed, m.
    fn missed(&self, given: &[f64]) -> Vec<f64> {
        let mut kept = BTreeMap::new();
        let mut change_m = |span: &Span| {
            let before = &self.style.edge(span.edge).line;
            let after = kept.entry(span.edge).or_insert_with(|| self.line(span.edge, given));
            let [from, to] = span.arcs_m.map(|arc| arc.min(before.length()));
            carried(before, after, to) - carried(before, after, from) - (to - from)
        };
        let mut miss = |condition: &&Condition| {
            let changed: f64 = condition.spans.iter().map(|(span, sign)| sign * change_m(span)).sum();
            changed - condition.change * self.amount_m
        };
        self.conditions.iter().map(&mut miss).collect()
    }

    /// Change of what is missed with each give; one row a condition.
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

/// Arc length, m, on a line whose vertices moved, of the point that had another before.
pub fn carried(before: &Polyline, after: &Polyline, arc_m: f64) -> f64 {
    let arcs = before.arcs();
    let next = arcs.partition_point(|arc| *arc <= arc_m).clamp(1, arcs.len() - 1);
    let (low, high) = (arcs[next - 1], arcs[next]);
    let share = if high > low { ((arc_m - low) / (high - low)).clamp(0.0, 1.0) } else { 0.0 };
    after.arcs()[next - 1] + share * (after.arcs()[next] - after.arcs()[next - 1])
}

/// The least change of the gives that takes away what is missed, as far as they can.
fn least_step(rows: &[Vec<f64>], missed: &[f64]) -> Vec<f64> {
    let n = missed.len();
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    // Cholesky factor of the products of the rows, a lower triangle.
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
