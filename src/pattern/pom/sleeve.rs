//! Points of measure of a sleeve.

use super::anatomy::{Anatomy, BELOW_ARMHOLE_M, BESIDE_M, Chain, Part};
use super::ways::Heading;
use super::{Point, PointOfMeasure};
use crate::propose::Hand;
use crate::style::openings::EdgeEnd;
use crate::style::{EdgePoint, EdgeRef, PathPart};

/// The right one if there are two.
pub struct Sleeve<'a> {
    anatomy: &'a Anatomy<'a>,
    hand: Hand,
    /// Path down the sleeve from the shoulder point.
    way: Option<Vec<PathPart>>,
}

impl<'a> Sleeve<'a> {
    /// `None` for a style without sleeves. `shoulder_points` lie on its armhole seams.
    pub fn of(anatomy: &'a Anatomy<'a>, shoulder_points: &[EdgePoint]) -> Option<Self> {
        let hand = Hand::BOTH.into_iter().find(|hand| anatomy.parts.contains(&Part::Sleeve(*hand)))?;
        let on_cap = shoulder_points.iter().find_map(|point| {
            anatomy.ways.across(*point).filter(|at| anatomy.parts[at.edge.piece] == Part::Sleeve(hand))
        });
        // In a sleeve of two panels, the upper seam may run straight down from the shoulder point.
        let beside = |at: EdgePoint| {
            let length_m = anatomy.length_m(&[at.edge]);
            [0.0, BESIDE_M, -BESIDE_M].map(|by_m| EdgePoint { arc_m: (at.arc_m + by_m).clamp(0.0, length_m), ..at })
        };
        let walk = |at: EdgePoint| anatomy.ways.walk(at, Heading::Down, |_| false);
        let down = on_cap.and_then(|at| beside(at).into_iter().find_map(walk));
        Some(Self { anatomy, hand, way: down.map(|way| way.parts) })
    }

    fn holds(&self, piece: usize) -> bool {
        self.anatomy.parts[piece] == Part::Sleeve(self.hand)
    }

    pub fn points(&self) -> Vec<PointOfMeasure> {
        let anatomy = self.anatomy;
        let openings = anatomy.style().openings(&|piece| self.holds(piece));
        let (caps, lower): (Vec<&Vec<EdgeRef>>, Vec<&Vec<EdgeRef>>) =
            openings.iter().partition(|opening| opening.iter().any(|edge| self.is_sewn_to_trunk(*edge)));
        let mut found = Vec::new();
        if let [end] = lower.as_slice() {
            let cuff = anatomy.beyond(end, |piece| self.holds(piece));
            found.extend(cuff.map(|cuff| anatomy.along_edges(Point::HalfCuff, &cuff, 0.5)));
        }
        let Some(cap) = caps.first() else { return found };
        found.extend(self.way.clone().map(|way| anatomy.along_path(Point::SleeveLength, way, 1.0)));
        let path = self.round_from(cap, BELOW_ARMHOLE_M);
        found.extend(path.map(|path| anatomy.along_path(Point::HalfBicep, path, 0.5)));
        found
    }

    fn round_from(&self, cap: &[EdgeRef], below_m: f64) -> Option<Vec<PathPart>> {
        let below = self.underarm(cap).and_then(|seam| self.anatomy.along(&seam, below_m));
        below.and_then(|at| self.anatomy.ways.round(at))
    }

    /// Path round the sleeve at a distance below the armhole along the underarm seam, m. `None` past the end of the seam.
    pub fn round_below_armhole(&self, below_m: f64) -> Option<Vec<PathPart>> {
        let openings = self.anatomy.style().openings(&|piece| self.holds(piece));
        let cap = openings.iter().find(|opening| opening.iter().any(|edge| self.is_sewn_to_trunk(*edge)))?;
        self.round_from(cap, below_m)
    }

    /// Path round the sleeve at a distance above its lower edge along the arm, m.
    pub fn round_above_cuff(&self, above_m: f64) -> Option<Vec<PathPart>> {
        let length_m = self.anatomy.style().path_length_m(self.way.as_ref()?);
        self.round(length_m - above_m)
    }

    fn is_sewn_to_trunk(&self, edge: EdgeRef) -> bool {
        let anatomy = self.anatomy;
        anatomy.ways.partners(edge).iter().any(|other| matches!(anatomy.parts[other.piece], Part::Trunk(_)))
    }

    /// Path round the sleeve at a distance from the shoulder point along the arm, m. `None` past the end of the sleeve.
    pub fn round(&self, along_m: f64) -> Option<Vec<PathPart>> {
        self.anatomy.ways.round_through(self.anatomy.ways.along(self.way.as_ref()?, along_m)?)
    }

    /// Underarm seam, directed downwards: of the seams below the cap, the one that begins lowest.
    fn underarm(&self, cap: &[EdgeRef]) -> Option<Chain> {
        let anatomy = self.anatomy;
        let mut found: Vec<(f64, Chain)> = Vec::new();
        for seam in &anatomy.style().seams {
            if !seam.a.iter().chain(&seam.b).all(|edge| self.holds(edge.piece)) {
                continue;
            }
            let chain: Chain = seam.a.iter().map(|edge| EdgeEnd::new(*edge, true)).collect();
            let back: Chain = chain.iter().rev().map(|step| step.other()).collect();
            for chain in [chain, back] {
                let top = chain[0].other();
                if cap.contains(&anatomy.style().over_corner(top).edge) {
                    // Key: distance of the beginning of the seam along the arm.
                    let down = anatomy.ways.down(top.edge.piece)?;
                    found.push((anatomy.place(top).dot(&down), chain));
                }
            }
        }
        found.into_iter().max_by(|seam, other| seam.0.total_cmp(&other.0)).map(|(_, chain)| chain)
    }
}
