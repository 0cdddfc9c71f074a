//! Automatic placement, the preposition of 4.2: every piece before, behind or about the limb that it is worn on.
//!
//! Pieces of one side of the trunk or of a leg are laid out flat as they are sewn (`layout`), then bent as one. Sleeves
//! go about the arms. Circle skirts, their tiers, gores and pieces that are sewn to themselves go round the trunk
//! (`tiers`, `piece_ring`, `round`). Any other piece is placed by the pieces that it is sewn to (`attachment`).

mod arm;
mod attachment;
mod body_parts;
mod ellipse;
mod folded;
mod interval;
mod layout;
mod leg;
mod limb;
mod piece_ring;
mod round;
mod rows;
mod tiers;
mod trunk;

pub(crate) fn constants() -> Vec<Constant> {
    [
        arm::CONSTANTS,
        ellipse::CONSTANTS,
        folded::CONSTANTS,
        attachment::CONSTANTS,
        body_parts::CONSTANTS,
        layout::CONSTANTS,
        leg::CONSTANTS,
        CONSTANTS,
        piece_ring::CONSTANTS,
        round::CONSTANTS,
        rows::CONSTANTS,
        tiers::CONSTANTS,
        trunk::CONSTANTS,
    ]
    .concat()
}

#[cfg(test)]
mod tests;

use crate::SimError;
use body::Body;
use geom::constants::Constant;
use geom::{V2, V3};
use pattern::{Garment, Role};

pub use self::folded::Folded;
use arm::Sleeve;
use attachment::Follower;
use body_parts::Form;
use layout::{Joins, Part, Sheet};
use leg::Leg;
use limb::Limb;
use tiers::Round;
use trunk::Bent;

#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Bend {
    /// Offset `mu`: the middle of a trunk piece starts `mu H / 2` before the trunk's centre, `H` the body depth (4.18).
    /// `None`: the least offset that clears the body all along the piece and brings its sides to the body's sides.
    pub offset_mu: Option<f64>,
    /// Angle over which trunk pieces are bent (4.6). `None`: half an ellipse as wide as the body.
    pub bend_angle_rad: Option<f64>,
}

impl Bend {
    /// The thesis's arc for slim bodies; `None` where the study asks for an offset or an angle.
    pub fn otherwise(&self) -> Option<Self> {
        let follows_body = self.offset_mu.is_none() && self.bend_angle_rad.is_none();
        follows_body.then_some(Self { bend_angle_rad: Some(OTHER_BEND_RAD), ..*self })
    }
}

/// Positions of all garment vertices before sewing. Fails for a piece without a role that is sewn to no piece with one.
pub fn place(body: &Body, garment: &Garment, bend: &Bend) -> Result<Vec<V3>, SimError> {
    let mut placing = Placing {
        form: Form::of(body),
        joins: Joins::of(garment),
        positions: vec![V3::zeros(); garment.rest.len()],
        limb: vec![None; garment.pieces.len()],
    };
    let wide = placing.wide_rings();
    placing.trunk(&wide, bend);
    placing.legs();
    placing.arms();
    placing.rings(wide);
    placing.followers()?;
    Ok(placing.positions)
}

geom::constants! {
    "placement",
    /// Share of a piece's seams to placed pieces that a second piece sewn to it must have, where the two are halves of
    /// one part.
    const TWIN: f64 = 0.75;
    /// Angle of the other bend: that of [T] for slim bodies.
    const OTHER_BEND_RAD: f64 = 2.0 * std::f64::consts::PI / 3.0;
}

struct Placing<'a> {
    form: Form<'a>,
    joins: Joins<'a>,
    positions: Vec<V3>,
    /// Limb of each piece placed so far.
    limb: Vec<Option<Limb>>,
}

impl Placing<'_> {
    fn put(&mut self, sheet: &Sheet, limb: &Limb, at: impl Fn(V2) -> V3) {
        let places: Vec<(usize, V3)> = sheet.points(self.joins.garment).map(|(v, p)| (v, at(p))).collect();
        self.assign(&sheet.pieces(), limb, places);
    }

    fn assign(&mut self, pieces: &[usize], limb: &Limb, places: impl IntoIterator<Item = (usize, V3)>) {
        for (v, place) in places {
            self.positions[v] = place;
        }
        for &piece in pieces {
            self.limb[piece] = Some(limb.clone());
        }
    }

    fn placed(&self) -> Vec<usize> {
        (0..self.limb.len()).filter(|&p| self.limb[p].is_some()).collect()
    }

    fn about_trunk(&self) -> Limb {
        Limb::straight(self.form.trunk_axis())
    }

    fn trunk(&mut self, wide: &[Round], bend: &Bend) {
        let sheets = trunk_sheets(&self.joins, &wide.iter().flat_map(|ring| ring.pieces.clone()).collect::<Vec<_>>());
        for (k, side) in [1.0, -1.0].into_iter().enumerate() {
            if sheets[k].parts.is_empty() {
                continue;
            }
            let is_alone = sheets[1 - k].parts.is_empty();
            let bent = Bent::new(&self.form, &self.joins, &sheets[k], side, is_alone, bend);
            self.put(&sheets[k], &self.about_trunk(), |p| bent.at(p));
        }
    }

    fn legs(&mut self) {
        for hand in [1.0, -1.0] {
            let others = self.joins.worn_as(&leg::roles(-hand));
            let sheet = |(role, side)| {
                let parts = self.joins.worn_as(&[role]).into_iter().map(|p| Part::new(p, self.joins.up(p, V2::y())));
                (Sheet::beside(Sheet::lay(&self.joins, parts.collect()), self.joins.garment), side)
            };
            let sheets = leg::roles(hand).into_iter().zip(leg::FACES).map(sheet);
            let sheets = sheets.filter(|(sheet, _)| !sheet.parts.is_empty());
            let leg = Leg::new(&self.form, &self.joins, hand, sheets, &others);
            let limb = Limb::straight(self.form.leg_axis(hand));
            let sheets: Vec<_> = leg.places().map(|(sheet, places)| (sheet.pieces(), places)).collect();
            for (pieces, places) in sheets {
                self.assign(&pieces, &limb, places);
            }
        }
    }

    fn arms(&mut self) {
        for hand in [1.0, -1.0] {
            let sleeve = Sleeve::new(&self.form, &self.joins, hand);
            for (sheet, middle) in &sleeve.parts {
                self.put(sheet, &sleeve.limb, |p| sleeve.at(p, *middle));
            }
        }
    }

    /// Places each piece that is left by the placed pieces that it is sewn to, the longest seams first; halves that
    /// flare go together.
    fn followers(&mut self) -> Result<(), SimError> {
        let halves = self.flared_halves();
        while let Some(open) = self.limb.iter().position(Option::is_none) {
            let next = self.next_followers();
            let Follower { piece, limb, .. } = next.first().ok_or_else(|| self.cannot_place(open))?;
            let is_open = |ring: &&Round| ring.pieces.iter().all(|&p| self.limb[p].is_none());
            if let Some(ring) = halves.iter().filter(is_open).find(|ring| ring.pieces.contains(piece)) {
                self.roll_about(ring, limb);
                continue;
            }
            let places = |follower| {
                let room_rad = Follower::room_rad(follower, &next, &self.positions);
                attachment::place(&self.form, &self.joins, follower, room_rad, &self.positions)
            };
            let places: Vec<Vec<V3>> = next.iter().map(places).collect();
            for (Follower { piece, limb, .. }, places) in next.iter().zip(places) {
                let vertices = self.joins.garment.pieces[*piece].vertices.clone();
                self.assign(&[*piece], limb, vertices.zip(places));
            }
        }
        Ok(())
    }

    /// Unplaced piece with the longest seams to placed ones. About the trunk also a second piece that is sewn to it and
    /// has about as long seams to them, as the other half of a hood. Placed by the first it would lie beyond it, not
    /// beside it. The halves of a cuff are to lie so.
    fn next_followers(&self) -> Vec<Follower> {
        let placed = self.placed();
        let loose = (0..self.limb.len()).rev().filter(|&p| self.limb[p].is_none());
        let seams: Vec<_> = loose.map(|p| (p, self.joins.to_any(p, &placed))).collect();
        let Some((first, most)) = seams.iter().max_by_key(|(_, pairs)| pairs.len()) else { return Vec::new() };
        let is_next = |(p, pairs): &&(usize, Vec<[usize; 2]>)| {
            let is_twin = pairs.len() as f64 > TWIN * most.len() as f64 && !self.joins.between(*first, *p).is_empty();
            !pairs.is_empty() && (p == first || (is_twin && self.limb_of_partners(*p) == self.about_trunk()))
        };
        let follower = |(piece, pairs): &(usize, Vec<[usize; 2]>)| {
            let limb = self.limb_of_partners(*piece);
            Follower { piece: *piece, pairs: pairs.clone(), limb }
        };
        let mut next: Vec<Follower> = seams.iter().filter(is_next).map(follower).collect();
        next.sort_by_key(|follower| follower.piece != *first);
        next
    }

    fn limb_of_partners(&self, piece: usize) -> Limb {
        let partners = self.placed().into_iter().filter(|&p| !self.joins.between(piece, p).is_empty());
        let mut limbs = partners.filter_map(|p| self.limb[p].as_ref());
        // A piece that joins several limbs goes about the trunk, and so does half a waistband on one leg.
        let is_waist = self.joins.garment.pieces[piece].role == Role::Waistband;
        let first = limbs.next().filter(|_| !is_waist);
        let only = first.filter(|first| limbs.all(|limb| limb == *first));
        only.cloned().unwrap_or_else(|| self.about_trunk())
    }

    fn cannot_place(&self, piece: usize) -> SimError {
        let piece = &self.joins.garment.pieces[piece];
        let accepted = "pieces of the trunk and the legs by role, sleeves that are sewn to an armhole, pieces that go round the \
            trunk one after the other, any other piece that is sewn to one of these; this one is sewn to none";
        SimError::CannotPlace { piece: piece.id.clone(), role: piece.role, accepted }
    }
}

fn trunk_sheets(joins: &Joins, without: &[usize]) -> [Sheet; 2] {
    let [in_front, behind] = [&trunk::FRONTS, &trunk::BACKS].map(|roles| {
        let pieces = joins.worn_as(roles).into_iter();
        pieces.filter(|&piece| !without.contains(&piece) && !attachment::is_in_a_slit(joins, piece)).collect::<Vec<_>>()
    });
    let lay = |own: &[usize], other: &[usize]| {
        // A band between two pieces of this side lies with them.
        let bands = joins.worn_as(&[Role::Waistband, Role::Other]).into_iter();
        let is_between = |&band: &usize| {
            let count = own.iter().filter(|&&p| !joins.between(band, p).is_empty()).count();
            let is_waist = joins.garment.pieces[band].role == Role::Waistband;
            count > usize::from(!is_waist) && joins.to_any(band, other).is_empty()
        };
        let pieces = own.iter().copied().chain(bands.filter(is_between));
        Sheet::lay(joins, pieces.map(|p| Part::new(p, joins.up(p, V2::y()))).collect())
    };
    let [fronts, backs] = [lay(&in_front, &behind), lay(&behind, &in_front)];
    // The parts of a side that is not in one, as open fronts, are ordered by their seams to the other side.
    let garment = joins.garment;
    if fronts.len() >= backs.len() {
        let back = Sheet::beside(backs, garment);
        [Sheet::beside(ordered(joins, fronts, &back), garment), back]
    } else {
        let front = Sheet::beside(fronts, garment);
        let backs = ordered(joins, backs, &front);
        [front, Sheet::beside(backs, garment)]
    }
}

fn ordered(joins: &Joins, sheets: Vec<Sheet>, other: &Sheet) -> Vec<Sheet> {
    let there = other.pieces();
    let place = |sheet: &Sheet| {
        let pairs = sheet.parts.iter().flat_map(|part| joins.to_any(part.piece, &there));
        let opposite = |[_, b]: [usize; 2]| {
            let part = other.parts.iter().find(|part| part.piece == joins.piece_of[b]);
            part.map(|part| part.at(joins.garment.rest[b]).x)
        };
        let places: Vec<f64> = pairs.filter_map(opposite).collect();
        places.iter().sum::<f64>() / places.len().max(1) as f64
    };
    let mut placed: Vec<(f64, Sheet)> = sheets.into_iter().map(|sheet| (place(&sheet), sheet)).collect();
    // Seen from outside, the right of one side is the left of the other.
    placed.sort_by(|a, b| b.0.total_cmp(&a.0));
    placed.into_iter().map(|(_, sheet)| sheet).collect()
}
