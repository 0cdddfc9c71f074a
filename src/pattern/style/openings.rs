//! Default measurements of a style: its free openings and its seams.

use std::collections::BTreeMap;

use super::{EdgeRef, PathPart, Style, StyleMeasurement};
use crate::garment::MeasurementKind;

/// Length difference from which the longer side of a seam counts as eased into the shorter one.
const EASED_M: f64 = 1e-3;

/// In a chain, an end stands for the whole edge, walked to it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct EdgeEnd {
    pub edge: EdgeRef,
    pub is_last: bool,
}

impl EdgeEnd {
    pub fn new(edge: EdgeRef, is_last: bool) -> Self {
        Self { edge, is_last }
    }

    pub fn other(self) -> Self {
        Self { is_last: !self.is_last, ..self }
    }
}

impl Style {
    /// Replaces the measurements by one for each opening and one for each seam. An opening is a closed chain of free
    /// edges, such as a hem, a neckline or a sleeve opening. A seam is measured along `a`, or along `b` if `a` is eased
    /// or gathered into it. It is a girth if its ends meet, as at an armhole.
    pub fn measure_openings_and_seams(&mut self) {
        let meets = self.meeting_corners();
        let mut found: Vec<(String, MeasurementKind, bool, Vec<EdgeRef>)> = Vec::new();
        for opening in self.openings(&|_| true) {
            let name = match opening.as_slice() {
                &[only] => self.edge_name(only),
                &[first, second] => format!("{} + {}", self.edge_name(first), self.edge_name(second)),
                all => format!("{} and {} more", self.edge_name(all[0]), all.len() - 1),
            };
            found.push((format!("opening {name}"), MeasurementKind::ClosedGirth, true, opening));
        }
        for seam in &self.seams {
            let length_m = |side: &[EdgeRef]| -> f64 { side.iter().map(|edge| self.edge(*edge).line.length()).sum() };
            let is_eased = length_m(&seam.a) > length_m(&seam.b) + EASED_M;
            let side = if is_eased { &seam.b } else { &seam.a };
            let kind = if meets.close(side) { MeasurementKind::ClosedGirth } else { MeasurementKind::OpenLength };
            found.push((format!("seam {}", seam.name), kind, false, side.clone()));
        }
        let measured = found.into_iter().enumerate().map(|(k, (name, kind, is_free_edge, edges))| {
            let path: Vec<PathPart> = edges.into_iter().map(PathPart::Edge).collect();
            StyleMeasurement { no: k as u32 + 1, name, kind, l2d_m: self.path_length_m(&path), is_free_edge, path }
        });
        self.measurements = measured.collect();
    }

    /// Closed chains of edges that are free if only some pieces are present, in the order of the sewn garment. An edge
    /// whose chain does not close is left out.
    pub(crate) fn openings(&self, is_there: &dyn Fn(usize) -> bool) -> Vec<Vec<EdgeRef>> {
        let partners = self.partners(is_there);
        let mut openings: Vec<Vec<EdgeRef>> = Vec::new();
        for piece in (0..self.pieces.len()).filter(|piece| is_there(*piece)) {
            for edge in 0..self.pieces[piece].edges.len() {
                let first = EdgeRef { piece, edge };
                let is_new = !openings.iter().any(|opening| opening.contains(&first));
                if is_new && !partners.contains_key(&EdgeEnd::new(first, true)) {
                    openings.extend(self.opening_from(first, &partners));
                }
            }
        }
        openings
    }

    fn opening_from(&self, first: EdgeRef, partners: &BTreeMap<EdgeEnd, EdgeEnd>) -> Option<Vec<EdgeRef>> {
        let mut opening = vec![first];
        // From the end just reached, the walk passes the corner to the next edge. If that is sewn, it crosses the seam.
        let mut at = EdgeEnd::new(first, true);
        // A chain that closes passes each end at most once.
        for _ in 0..2 * self.pieces.iter().map(|piece| piece.edges.len()).sum::<usize>() {
            let next = self.over_corner(at);
            match partners.get(&next) {
                Some(&across) => at = across,
                None if next.edge == first => return Some(opening),
                None => {
                    opening.push(next.edge);
                    at = next.other();
                }
            }
        }
        None
    }

    fn meeting_corners(&self) -> Corners {
        let mut first = 0;
        let offsets = self.pieces.iter().map(|piece| {
            let offset = first;
            first += piece.edges.len();
            (offset, piece.edges.len())
        });
        let offsets: Vec<(usize, usize)> = offsets.collect();
        let mut corners = Corners { offsets, least: (0..first).collect() };
        let partners = self.partners(&|_| true);
        // The number of rounds is that of the seams that meet in one point, so it is small.
        loop {
            let before = corners.least.clone();
            for (end, partner) in &partners {
                let [corner, other] = [corners.at(*end), corners.at(*partner)];
                let both = corners.least[corner].min(corners.least[other]);
                (corners.least[corner], corners.least[other]) = (both, both);
            }
            if before == corners.least {
                return corners;
            }
        }
    }

    /// End of the neighbouring edge of the piece at the same corner.
    pub(crate) fn over_corner(&self, EdgeEnd { edge: EdgeRef { piece, edge }, is_last }: EdgeEnd) -> EdgeEnd {
        let n = self.pieces[piece].edges.len();
        let edge = if is_last { (edge + 1) % n } else { (edge + n - 1) % n };
        EdgeEnd::new(EdgeRef { piece, edge }, !is_last)
    }

    /// Ends of every edge sewn among some pieces, each with the end that it meets: across the seam or, inside a side of
    /// several edges, of the next edge of that side.
    fn partners(&self, is_there: &dyn Fn(usize) -> bool) -> BTreeMap<EdgeEnd, EdgeEnd> {
        let mut partners = BTreeMap::new();
        for seam in self.seams.iter().filter(|seam| seam.a.iter().chain(&seam.b).all(|edge| is_there(edge.piece))) {
            // Ends in the order of sewing.
            let ends = |chain: &[EdgeRef], is_forwards: bool| -> Vec<[EdgeEnd; 2]> {
                chain.iter().map(|&edge| [EdgeEnd::new(edge, !is_forwards), EdgeEnd::new(edge, is_forwards)]).collect()
            };
            let (a, b) = (ends(&seam.a, true), ends(&seam.b, seam.b_forwards));
            for side in [&a, &b] {
                for pair in side.windows(2) {
                    partners.insert(pair[0][1], pair[1][0]);
                    partners.insert(pair[1][0], pair[0][1]);
                }
            }
            if let ([a_first, ..], [.., a_last], [b_first, ..], [.., b_last]) = (&a[..], &a[..], &b[..], &b[..]) {
                for (of_a, of_b) in [(a_first[0], b_first[0]), (a_last[1], b_last[1])] {
                    partners.insert(of_a, of_b);
                    partners.insert(of_b, of_a);
                }
            }
        }
        partners
    }
}

/// Corners of all pieces, each with the least index of the corners that it meets.
struct Corners {
    /// First corner of each piece, and number of its corners.
    offsets: Vec<(usize, usize)>,
    least: Vec<usize>,
}

impl Corners {
    fn at(&self, EdgeEnd { edge: EdgeRef { piece, edge }, is_last }: EdgeEnd) -> usize {
        let (offset, n) = self.offsets[piece];
        offset + if is_last { (edge + 1) % n } else { edge }
    }

    fn close(&self, edges: &[EdgeRef]) -> bool {
        let mut ends: BTreeMap<usize, usize> = BTreeMap::new();
        for end in edges.iter().flat_map(|edge| [EdgeEnd::new(*edge, false), EdgeEnd::new(*edge, true)]) {
            *ends.entry(self.least[self.at(end)]).or_default() += 1;
        }
        ends.values().all(|count| count % 2 == 0)
    }
}

#[cfg(test)]
mod tests {
    use super::PathPart;
    use crate::Style;
    use crate::draft::Model;
    use crate::garment::MeasurementKind;
    use geom::units::mm;

    #[test]
    fn a_gathered_seam_is_measured_along_the_side_that_it_is_gathered_into() {
        let draft = Model::Tshirt.drafts().swap_remove(0);
        let mut style = Style::read(&draft.pieces, Model::Tshirt.seams(), "a.toml").expect("it is a style");
        let seam = style.seams.iter().position(|seam| seam.a.len() == 1 && seam.b.len() == 2).expect("an armhole");
        // One of two edges that a cap is sewn to: what is left is about half as long.
        style.seams[seam].b.pop();
        let (name, held) = (format!("seam {}", style.seams[seam].name), style.seams[seam].b.clone());
        style.measure_openings_and_seams();
        let measured = style.measurements.iter().find(|m| m.name == name).expect("it is measured");
        assert_eq!(measured.path, held.into_iter().map(PathPart::Edge).collect::<Vec<_>>());
    }

    #[test]
    fn openings_of_the_drafted_styles_are_their_free_girths() {
        let check = |model: Model, expect: &[(usize, usize)]| {
            // (number of edges, published number of the free girth of that length, 0 for none).
            let draft = model.drafts().swap_remove(0);
            let mut style = Style::read(&draft.pieces, model.seams(), "a.toml").expect("it is a style");
            let published = style.measurements.clone();
            style.measure_openings_and_seams();
            let openings: Vec<_> = style.measurements.iter().filter(|m| m.is_free_edge).collect();
            assert_eq!(openings.len(), expect.len(), "{model:?}: {openings:?}");
            for (opening, &(edges, no)) in openings.iter().zip(expect) {
                let is_girth = opening.kind == MeasurementKind::ClosedGirth;
                assert!(is_girth && opening.path.len() == edges, "{model:?}: {}", opening.name);
                let length = mm(published[no - 1].l2d_m);
                assert!((mm(opening.l2d_m) - length).abs() < 0.1, "{model:?}: {} for #{no}", opening.name);
            }
            assert_eq!(style.measurements.len(), openings.len() + style.seams.len());
        };
        check(Model::Tshirt, &[(2, 1), (3, 6), (1, 2), (1, 2)]);
        check(Model::Trousers, &[(4, 5), (2, 6), (2, 6)]);
        check(Model::Dress, &[(2, 4), (2, 5), (2, 4), (2, 1)]);
    }

    #[test]
    fn seams_whose_ends_meet_are_girths() {
        let check = |model: Model, expect: &[&str]| {
            let draft = model.drafts().swap_remove(0);
            let mut style = Style::read(&draft.pieces, model.seams(), "a.toml").expect("it is a style");
            style.measure_openings_and_seams();
            let girths =
                style.measurements.iter().filter(|m| m.kind == MeasurementKind::ClosedGirth && !m.is_free_edge);
            assert_eq!(girths.map(|m| m.name.as_str()).collect::<Vec<_>>(), expect, "{model:?}");
            let garment = style.mesh(30e-3).expect("it meshes");
            let found = crate::check::of_garment(&style, &garment);
            assert!(
                found.iter().all(|finding| finding.kind != crate::check::FindingKind::Loop),
                "{model:?}: {found:?}"
            );
        };
        check(Model::Tshirt, &["seam armhole_right", "seam armhole_left"]);
        check(Model::Trousers, &[]);
        check(Model::Dress, &[]);
    }
}
