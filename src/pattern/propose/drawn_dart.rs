//! Darts that are drawn as inner lines, and not cut into the outline.

use crate::piece::Piece;
use geom::V2;
use geom::polyline::boundary_distance;
use geom::units::mm;

/// Distance below which a line ends on the outline, or meets another.
const MEET_M: f64 = 1e-3;
/// Greatest relative length difference between both sides of a dart.
const UNLIKE: f64 = 0.04;
/// Greatest mouth of a dart, as a share of its sides.
const WIDEST: f64 = 0.7;
/// Least mouth and least side of a dart.
const LEAST_M: [f64; 2] = [4e-3, 30e-3];

/// Widths of the darts drawn inside a piece: their tips lie inside, and their sides end on the outline.
pub fn mouths_m(piece: &Piece) -> Vec<f64> {
    let outline = piece.seam_outline();
    let is_on = |p: &V2| boundary_distance(outline, p) < MEET_M;
    // Sides of darts, from the tip to the outline.
    let mut sides: Vec<[V2; 2]> = Vec::new();
    for line in &piece.internal_lines {
        let (Some(&first), Some(&last)) = (line.first(), line.last()) else { continue };
        match [is_on(&first), is_on(&last)] {
            [true, false] => sides.push([last, first]),
            [false, true] => sides.push([first, last]),
            [true, true] => {
                let tip =
                    line.iter().max_by(|a, b| boundary_distance(outline, a).total_cmp(&boundary_distance(outline, b)));
                sides.extend(tip.filter(|tip| !is_on(tip)).into_iter().flat_map(|&tip| [[tip, first], [tip, last]]));
            }
            [false, false] => {}
        }
    }
    let pairs = (0..sides.len()).flat_map(|k| (k + 1..sides.len()).map(move |other| (k, other)));
    let mouth = |(k, other): (usize, usize)| {
        let ([tip, a], [meets, b]) = (sides[k], sides[other]);
        let [long, short] = {
            let lengths = [(a - tip).norm(), (b - meets).norm()];
            [lengths[0].max(lengths[1]), lengths[0].min(lengths[1])]
        };
        let width = (a - b).norm();
        let is_dart = (tip - meets).norm() < MEET_M
            && long - short < UNLIKE * long
            && (LEAST_M[0]..WIDEST * short).contains(&width)
            && short > LEAST_M[1];
        is_dart.then_some(width)
    };
    pairs.filter_map(mouth).collect()
}

/// `None` without darts drawn inside the piece.
pub fn doubt(name: &str, piece: &Piece) -> Option<String> {
    let mouths = mouths_m(piece);
    let widths: Vec<String> = mouths.iter().map(|m| format!("{:.0} mm", mm(*m))).collect();
    (!widths.is_empty()).then(|| {
        format!(
            "piece `{name}`: is what is drawn inside a dart, of {}? It is not cut into the outline, and is not sewn: what is \
             longer there is eased in",
            widths.join(" and ")
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_lines_from_the_outline_that_meet_inside_are_a_dart() {
        let outline: Vec<V2> = [[0.0, 0.0], [0.25, 0.0], [0.25, 0.4], [0.0, 0.4]].map(V2::from).to_vec();
        let check = |lines: &[&[[f64; 2]]], expect_mm: &[f64]| {
            let internal_lines = lines.iter().map(|line| line.iter().map(|&p| V2::from(p)).collect()).collect();
            let piece = Piece { outline: outline.clone(), internal_lines, ..Piece::default() };
            let found: Vec<f64> = mouths_m(&piece).iter().map(|m| (m * 1e3).round()).collect();
            assert_eq!(found, expect_mm, "{lines:?}");
        };
        // As two lines in either direction, and as one.
        check(&[&[[0.25, 0.2], [0.1, 0.225]], &[[0.1, 0.225], [0.25, 0.25]]], &[50.0]);
        check(&[&[[0.1, 0.225], [0.25, 0.2]], &[[0.1, 0.225], [0.25, 0.25]]], &[50.0]);
        check(&[&[[0.25, 0.2], [0.1, 0.225], [0.25, 0.25]]], &[50.0]);
        // A yoke line, a pocket and a corner of two lines are none.
        check(&[&[[0.0, 0.3], [0.25, 0.3]]], &[]);
        check(&[&[[0.05, 0.1], [0.15, 0.1], [0.15, 0.2], [0.05, 0.1]]], &[]);
        check(&[&[[0.25, 0.1], [0.1, 0.1]], &[[0.1, 0.1], [0.1, 0.0]]], &[]);
    }
}
