//! Replacement of the outlines of a style. Notches, corners and measurements move along.

use std::collections::BTreeMap;

use super::Change;
use super::field::Field;
use super::solve::carried;
use crate::style::{EdgePoint, EdgeRef, PathPart, Style};
use geom::V2;
use geom::polyline::{Polyline, self_crossing};

/// Replaces edges by lines with as many vertices. Returns also the displacement fields of these pieces.
pub fn with_lines(style: &Style, lines: BTreeMap<usize, Vec<Polyline>>) -> Change {
    let (mut moved, mut fields) = (style.clone(), BTreeMap::new());
    for (piece, lines) in lines {
        let outline = style.pieces[piece].outline();
        let changed = &mut moved.pieces[piece];
        for (edge, line) in changed.edges.iter_mut().zip(lines) {
            edge.corners.iter_mut().for_each(|arc| *arc = carried(&edge.line, &line, *arc));
            edge.line = line;
        }
        let field = Field::new(outline, &changed.outline());
        changed.notches.iter_mut().for_each(|notch| notch.at = field.carried(notch.at));
        changed.corners.iter_mut().for_each(|corner| *corner = field.carried(*corner));
        fields.insert(piece, field);
    }
    let paths =
        moved.measurements.iter_mut().map(|m| &mut m.path).chain(moved.fit_levels.iter_mut().map(|(_, path)| path));
    for part in paths.flatten() {
        if let PathPart::Line(ends) = part {
            ends.iter_mut().for_each(|at| *at = carried_point(style, &moved.pieces, *at));
        }
    }
    let lengths_m: Vec<f64> = moved.measurements.iter().map(|m| moved.path_length_m(&m.path)).collect();
    moved.measurements.iter_mut().zip(lengths_m).for_each(|(m, length_m)| m.l2d_m = length_m);
    Change { style: moved, fields }
}

fn carried_point(style: &Style, pieces: &[crate::style::StylePiece], at: EdgePoint) -> EdgePoint {
    let EdgeRef { piece, edge } = at.edge;
    EdgePoint { arc_m: carried(&style.edge(at.edge).line, &pieces[piece].edges[edge].line, at.arc_m), ..at }
}

/// First piece whose outline crosses itself after the change only, with the crossing.
pub fn new_crossing(before: &Style, after: &Style) -> Option<(String, V2)> {
    let pairs = before.pieces.iter().zip(&after.pieces).filter(|(before, after)| before.edges != after.edges);
    let mut crossings = pairs.filter_map(|(before, after)| {
        let at = self_crossing(&after.outline())?;
        self_crossing(&before.outline()).is_none().then(|| (after.id.clone(), at))
    });
    crossings.next()
}
