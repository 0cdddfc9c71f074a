//! What goes round a limb in rings, and in which order: wide skirts, their tiers, gores, flared cuffs.

use std::cmp::Reverse;
use std::f64::consts::TAU;

use super::layout::Joins;
use super::limb::Limb;
use super::ring::{Flat, Ring};
use super::round::{self, Held};
use super::{Placing, follow, trunk};
use pattern::{Role, SeamMesh};

geom::constants! {
    "placement.tiers",
    /// Turn of a ring from which on it goes round as one, rad: as two sheets it comes to rest as a tent, not in folds.
    const WIDE_RAD: f64 = 0.35 * TAU;
    /// Turn of two halves sewn to each other from which on they go round a limb as one, rad: cuffs and peplums of half circles.
    const FLARED_RAD: f64 = 1.0;
    /// What is this many times as long as the narrowest that a skirt is gathered into goes round as one: as two sheets, strips gathered
    /// four times cannot be sewn, nor three tiers each gathered by half.
    const GATHERED: f64 = 1.8;
    /// Longest inner edge of a wide ring that hangs from the neck, as a cape does, m.
    const NECK_M: f64 = 0.55;
}

/// Pieces that go round a limb, laid out flat.
pub struct Round {
    pub pieces: Vec<usize>,
    flat: Flat,
}

impl Round {
    /// Whether the pieces of a skirt would lie badly as two sheets.
    fn is_wide(&self) -> bool {
        self.pieces.len() > 2 || self.flat.turn_rad() > WIDE_RAD
    }
}

impl Placing<'_> {
    /// Some rings laid out flat, the middle of their fronts at the front.
    fn laid_out(&self, rings: &[Ring]) -> Vec<Round> {
        let fronts = self.joins.worn_as(&trunk::FRONTS);
        rings.iter().map(|ring| Round { pieces: ring.pieces(), flat: ring.flat(&self.joins, &fronts) }).collect()
    }

    /// Two halves of no role sewn to each other that flare: of cuffs, peplums.
    pub fn flared_halves(&self) -> Vec<Round> {
        let rings = self.laid_out(&Ring::of_tiers(&self.joins, &self.joins.worn_as(&[Role::Other])));
        rings.into_iter().filter(|ring| ring.flat.turn_rad() > FLARED_RAD).collect()
    }

    /// Rings of fronts and backs that would lie badly as two sheets.
    pub fn wide_rings(&self) -> Vec<Round> {
        let others = self.laid_out(&Ring::of_several(&self.joins, &self.joins.worn_as(&trunk::TOPS)));
        let sides = [trunk::FRONTS, trunk::BACKS].map(|roles| self.joins.worn_as(&roles));
        let is_of_one_side =
            |ring: &Round| sides.iter().any(|side| ring.pieces.iter().all(|piece| side.contains(piece)));
        // What is narrower at its upper edge hangs from the neck.
        let is_skirt =
            |ring: &Round| (ring.flat.turn_rad() > WIDE_RAD || is_of_one_side(ring)) && ring.flat.inner_m() > NECK_M;
        self.wide_skirts().into_iter().chain(others.into_iter().filter(is_skirt)).collect()
    }

    /// Wide rings of a skirt, and narrow ones that hang from them.
    fn wide_skirts(&self) -> Vec<Round> {
        let joins = &self.joins;
        let mut skirts = joins.worn_as(&[Role::SkirtFront, Role::SkirtBack]);
        skirts.retain(|&piece| !follow::is_in_a_slit(joins, piece));
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

    /// Length of what a ring is gathered into, m, by the seam that gathers it most; of its own upper edge where none does.
    fn gathered_m(&self, ring: &Round) -> f64 {
        let Joins { garment, piece_of, .. } = &self.joins;
        let length = |seam: &SeamMesh, side: usize| {
            let of = |[a, b]: [usize; 2]| (garment.rest[b] - garment.rest[a]).norm();
            seam.stitches().map(|sides| of(sides[side])).sum::<f64>()
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

    /// Wide rings go round the trunk below what they are sewn to, and so do gores; where no piece has a place then, the largest of
    /// all rings does.
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

    /// Whether a ring of pieces without a role can be the gores of a skirt: more than two, as wide as a trunk, and on no limb.
    fn are_gores(&self, ring: &Round) -> bool {
        let partners = (0..self.limb.len()).filter(|&p| !self.joins.to_any(p, &ring.pieces).is_empty());
        let is_on_limb = partners.filter_map(|p| self.limb[p].as_ref()).any(|limb| *limb != self.about_trunk());
        ring.pieces.len() > 2 && ring.flat.inner_m() > NECK_M && !is_on_limb
    }

    /// Rolls rings from the top down: what is sewn most to what has a place comes next, of what is sewn to nothing the narrowest.
    fn tiers(&mut self, mut rings: Vec<Round>) {
        while let Some(next) = (0..rings.len()).min_by(|&a, &b| {
            let rank = |k: usize| (Reverse(self.held(&rings[k], &self.about_trunk()).len()), rings[k].flat.inner_m());
            let ((held_a, a), (held_b, b)) = (rank(a), rank(b));
            held_a.cmp(&held_b).then(a.total_cmp(&b))
        }) {
            self.roll(&rings.remove(next));
        }
    }

    /// The vertices of a ring that are sewn to what has a place, with the coordinates of that about a limb.
    fn held(&self, ring: &Round, limb: &Limb) -> Vec<Held> {
        let placed = self.placed();
        let pairs = ring.pieces.iter().flat_map(|&p| self.joins.to_any(p, &placed));
        pairs.map(|[own, v]| (own, limb.coordinates(&self.positions[v]))).collect()
    }

    /// Rolls a ring about the trunk below what it is sewn to, and no further out.
    fn roll(&mut self, ring: &Round) {
        let trunk = self.about_trunk();
        let held = self.held(ring, &trunk);
        let (top, within) = match held.as_slice() {
            [] => (self.form.body.levels.waist_m, Some(self.gathered_m(ring) / (TAU * round::ROUND))),
            held => (round::mean(held, |p| p.2), Some(round::mean(held, |p| p.1))),
        };
        let places = round::place(&self.form, &ring.flat, top, within);
        self.assign(&ring.pieces, &trunk, places);
    }

    /// Rolls a ring about a limb, next to what it is sewn to.
    pub fn roll_about(&mut self, ring: &Round, limb: &Limb) {
        let places = round::place_about(&self.form, limb, &ring.flat, &self.held(ring, limb));
        self.assign(&ring.pieces, limb, places);
    }
}
