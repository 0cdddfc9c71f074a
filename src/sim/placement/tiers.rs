//! Rings of pieces about a limb and their order: wide skirts, their tiers, gores, flared cuffs.

use std::cmp::Reverse;
use std::f64::consts::TAU;

use super::layout::Joins;
use super::limb::Limb;
use super::piece_ring::{Flat, Ring};
use super::round::{self, Held};
use super::{Placing, attachment, trunk};
use pattern::{Role, SeamMesh};

geom::constants! {
    "placement.tiers",
    /// Angle of a ring from which on it goes round as one: as two sheets it comes to rest as a tent, not in folds.
    const WIDE_RAD: f64 = 0.35 * TAU;
    /// Angle of two halves sewn to each other from which on they go round a limb as one: cuffs and peplums of half
    /// circles.
    const FLARED_RAD: f64 = 1.0;
    /// Length of a ring over the narrowest edge that a skirt is gathered into from which on it goes round as one. As
    /// two sheets, strips gathered four times cannot be sewn, nor three tiers each gathered by half.
    const GATHERED: f64 = 1.8;
    /// Longest inner edge of a wide ring that hangs from the neck, as a cape does.
    const NECK_M: f64 = 0.55;
}

pub struct Round {
    pub pieces: Vec<usize>,
    flat: Flat,
}

impl Round {
    /// True if the pieces of a skirt would drape badly as two sheets.
    fn is_wide(&self) -> bool {
        self.pieces.len() > 2 || self.flat.turn_rad() > WIDE_RAD
    }
}

impl Placing<'_> {
    fn laid_out(&self, rings: &[Ring]) -> Vec<Round> {
        let fronts = self.joins.worn_as(&trunk::FRONTS);
        rings.iter().map(|ring| Round { pieces: ring.pieces(), flat: ring.flat(&self.joins, &fronts) }).collect()
    }

    /// Rings of two flared halves without a role that are sewn to each other: cuffs, peplums.
    pub fn flared_halves(&self) -> Vec<Round> {
        let rings = self.laid_out(&Ring::of_tiers(&self.joins, &self.joins.worn_as(&[Role::Other])));
        rings.into_iter().filter(|ring| ring.flat.turn_rad() > FLARED_RAD).collect()
    }

    /// Rings of fronts and backs that would drape badly as two sheets.
    pub fn wide_rings(&self) -> Vec<Round> {
        let others = self.laid_out(&Ring::of_several(&self.joins, &self.joins.worn_as(&trunk::TOPS)));
        let sides = [trunk::FRONTS, trunk::BACKS].map(|roles| self.joins.worn_as(&roles));
        let is_of_one_side =
            |ring: &Round| sides.iter().any(|side| ring.pieces.iter().all(|piece| side.contains(piece)));
        // A ring with a shorter upper edge hangs from the neck.
        let is_skirt =
            |ring: &Round| (ring.flat.turn_rad() > WIDE_RAD || is_of_one_side(ring)) && ring.flat.inner_m() > NECK_M;
        self.wide_skirts().into_iter().chain(others.into_iter().filter(is_skirt)).collect()
    }

    /// Wide rings of a skirt, and narrow ones that hang from them.
    fn wide_skirts(&self) -> Vec<Round> {
        let joins = &self.joins;
        let mut skirts = joins.worn_as(&[Role::SkirtFront, Role::SkirtBack]);
        skirts.retain(|&piece| !attachment::is_in_a_slit(joins, piece));
        let rings = self.laid_out(&Ring::of_tiers(joins, &skirts));
        let narrowest_m = rings.iter().map(|ring| self.gathered_m(ring)).fold(f64::MAX, f64::min);
        let goes_round = |ring: &Round| ring.is_wide() || ring.flat.inner_m() > GATHERED * narrowest_m;
        let (mut wide, mut narrow): (Vec<Round>, Vec<Round>) = rings.into_iter().partition(goes_round);
        let above = joins.worn_as(&[&trunk::TOPS[..], &[Role::Waistband]].concat());
        let hangs = |ring: &Round, wide: &[Round]| {
            let is_sewn = |pieces: &[usize]| ring.pieces.iter().any(|&p| !joins.to_any(p, pieces).is_empty());
            wide.iter().any(|other| is_sewn(&other.pieces)) && !is_sewn(&above)
        };
        while let Some(next) = narrow.iter().position(|ring| hangs(ring, &wide)) {
            wide.push(narrow.remove(next));
        }
        wide
    }

    /// Length of the edge that a ring is gathered into, by the seam that gathers it most; of its own upper edge where
    /// none does.
    fn gathered_m(&self, ring: &Round) -> f64 {
        let Joins { garment, piece_of, .. } = &self.joins;
        let length = |seam: &SeamMesh, side: usize| {
            let stitch_m = |[a, b]: [usize; 2]| (garment.rest[b] - garment.rest[a]).norm();
            seam.stitches().map(|sides| stitch_m(sides[side])).sum::<f64>()
        };
        let is_own = |seam: &SeamMesh, side: usize| seam.pairs.iter().all(|p| ring.pieces.contains(&piece_of[p[side]]));
        let ratio = |seam: &SeamMesh| match [is_own(seam, 0), is_own(seam, 1)] {
            [true, false] => length(seam, 0) / length(seam, 1),
            [false, true] => length(seam, 1) / length(seam, 0),
            _ => 1.0,
        };
        let ratios = garment.seams.iter().map(ratio).filter(|ratio| ratio.is_finite());
        ring.flat.inner_m() / ratios.fold(1.0, f64::max)
    }

    /// Places wide rings and gores round the trunk below the pieces that they are sewn to. If no piece is placed then,
    /// the largest of all rings goes there.
    pub fn rings(&mut self, wide: Vec<Round>) {
        let others = self.joins.worn_as(&[Role::Other]);
        let several = self.laid_out(&Ring::of_several(&self.joins, &others));
        let (gores, mut rest): (Vec<Round>, Vec<Round>) = several.into_iter().partition(|ring| self.are_gores(ring));
        self.tiers(wide.into_iter().chain(gores).collect());
        if self.limb.iter().all(Option::is_none) {
            rest.extend(self.laid_out(&Ring::of_one(&self.joins, &others)));
            let size =
                |ring: &&Round| ring.pieces.iter().map(|&p| self.joins.garment.pieces[p].vertices.len()).sum::<usize>();
            if let Some(ring) = rest.iter().max_by_key(size) {
                self.roll(ring);
            }
        }
    }

    /// True for more than two pieces without a role, as wide as a trunk, and on no limb.
    fn are_gores(&self, ring: &Round) -> bool {
        let partners = (0..self.limb.len()).filter(|&p| !self.joins.to_any(p, &ring.pieces).is_empty());
        let is_on_limb = partners.filter_map(|p| self.limb[p].as_ref()).any(|limb| *limb != self.about_trunk());
        ring.pieces.len() > 2 && ring.flat.inner_m() > NECK_M && !is_on_limb
    }

    /// Rolls rings from the top down: next comes the ring with the longest seams to placed pieces, and of equals the
    /// narrowest.
    fn tiers(&mut self, mut rings: Vec<Round>) {
        while let Some(next) = (0..rings.len()).min_by(|&a, &b| {
            let rank = |k: usize| (Reverse(self.held(&rings[k], &self.about_trunk()).len()), rings[k].flat.inner_m());
            let ((held_a, a), (held_b, b)) = (rank(a), rank(b));
            held_a.cmp(&held_b).then(a.total_cmp(&b))
        }) {
            self.roll(&rings.remove(next));
        }
    }

    fn held(&self, ring: &Round, limb: &Limb) -> Vec<Held> {
        let placed = self.placed();
        let pairs = ring.pieces.iter().flat_map(|&p| self.joins.to_any(p, &placed));
        pairs.map(|[vertex, v]| Held { vertex, partner: limb.coordinates(&self.positions[v]) }).collect()
    }

    /// Rolls a ring about the trunk below the pieces that it is sewn to, no farther out than they lie.
    fn roll(&mut self, ring: &Round) {
        let trunk = self.about_trunk();
        let held = self.held(ring, &trunk);
        let (top, within) = match held.as_slice() {
            [] => (self.form.body.levels.waist_m, Some(self.gathered_m(ring) / (TAU * round::ROUND))),
            held => (round::mean(held, |p| p.height), Some(round::mean(held, |p| p.radius))),
        };
        let places = round::place(&self.form, &ring.flat, top, within);
        self.assign(&ring.pieces, &trunk, places);
    }

    pub fn roll_about(&mut self, ring: &Round, limb: &Limb) {
        let places = round::place_about(&self.form, limb, &ring.flat, &self.held(ring, limb));
        self.assign(&ring.pieces, limb, places);
    }
}
