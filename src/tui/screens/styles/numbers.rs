//! Numbers of edges that stay while questions are answered: an answer may turn a piece round or part its edges otherwise,
//! and would number them anew.

use crate::screens::styles::pieces::centre;
use wardrobe::seams::DeskPiece;

/// Greatest difference in length between an edge and itself after an answer, mm: lengths are told in tenths.
const SAME_MM: f64 = 0.5;

/// Gives the edges of pieces the numbers that they had before, by their lengths and places on the piece. Edges that are
/// new get numbers that no edge had. Pieces with edges that have no name keep their own numbers: these are the names.
pub fn keep_numbers(before: &[DeskPiece], now: &mut [DeskPiece]) {
    for piece in now.iter_mut().filter(|piece| piece.edges.iter().all(|edge| edge.name.is_some())) {
        let Some(before) = before.iter().find(|before| before.id == piece.id) else { continue };
        let [(olds, was), (news, is)] = [before, &*piece].map(|piece| (&piece.edges, centre(piece)));
        let all = (0..news.len()).flat_map(|new| (0..olds.len()).map(move |old| (new, old)));
        let same = all.filter(|(new, old)| (news[*new].length_mm - olds[*old].length_mm).abs() <= SAME_MM);
        let away = |(new, old): (usize, usize)| {
            let [[x, y], [a, b]] = [news[new].middle()[0], olds[old].middle()[0]];
            (x - is[0] - a + was[0]).hypot(y - is[1] - b + was[1])
        };
        let mut pairs: Vec<(usize, usize)> = same.collect();
        pairs.sort_by(|a, b| away(*a).total_cmp(&away(*b)));
        let mut kept: Vec<Option<usize>> = vec![None; news.len()];
        let mut is_taken = vec![false; olds.len()];
        // The nearest pairs first: a new edge may be as long as an old one.
        for (new, old) in pairs {
            if kept[new].is_none() && !is_taken[old] {
                (kept[new], is_taken[old]) = (Some(olds[old].number), true);
            }
        }
        let mut fresh = olds.iter().map(|edge| edge.number).max().unwrap_or(0) + 1..;
        for (edge, number) in piece.edges.iter_mut().zip(kept) {
            edge.number = number.or_else(|| fresh.next()).unwrap_or(edge.number);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pattern::Role;
    use wardrobe::seams::DeskEdge;

    /// A piece with straight edges between some corners, numbered from 1, with names or without.
    fn piece(corners: &[[f64; 2]], is_named: bool) -> DeskPiece {
        let edge = |k: usize| {
            let line_mm = vec![corners[k], corners[(k + 1) % corners.len()]];
            let length_mm = (line_mm[1][0] - line_mm[0][0]).hypot(line_mm[1][1] - line_mm[0][1]);
            let name = is_named.then(|| format!("edge_{k}"));
            DeskEdge { number: k + 1, name, line_mm, length_mm, seam: None, notches_mm: vec![] }
        };
        let edges = (0..corners.len()).map(edge).collect();
        DeskPiece { id: "sleeve".into(), role: Role::Other, turned_deg: 0.0, edges }
    }

    #[test]
    fn edges_keep_their_numbers_where_they_stay() {
        let square = [[0.0, 0.0], [100.0, 0.0], [100.0, 60.0], [0.0, 60.0]];
        let turned = [square[2], square[3], square[0], square[1]];
        let parted = [square[0], [40.0, 0.0], square[1], square[2], square[3]];
        let moved = square.map(|[x, y]| [x + 500.0, y - 80.0]);
        let check = |now: &[[f64; 2]], is_named: bool, expect: &[usize]| {
            let mut pieces = [piece(now, is_named)];
            keep_numbers(&[piece(&square, true)], &mut pieces);
            let numbers: Vec<usize> = pieces[0].edges.iter().map(|edge| edge.number).collect();
            assert_eq!(numbers, expect, "{now:?}");
        };
        check(&square, true, &[1, 2, 3, 4]);
        check(&turned, true, &[3, 4, 1, 2]);
        check(&moved, true, &[1, 2, 3, 4]);
        // The two parts of the first edge are 40 mm and 60 mm long, and those of 60 mm stay where they are.
        check(&parted, true, &[5, 6, 2, 3, 4]);
        check(&turned, false, &[1, 2, 3, 4]);
    }
}
