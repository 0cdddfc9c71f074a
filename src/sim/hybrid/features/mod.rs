//! Feature mapping (5.2.1): the corners of a piece's outline onto features of the body, lengths preserved.
//!
//! The stretches of an outline are classified by the pieces that they are sewn to, not by names. An upright seam
//! between front and back is a side seam, one that runs across is a shoulder seam. The stretch between a side and a
//! shoulder is an armhole, and so on. Points are then found in this order: shoulder ends on the shoulder line
//! (Algorithm 5.1), underarm and hem down the side line, neck on the centre line. For trousers they are the fork on the
//! crotch, the waist above it, the hem down the inseam.

mod limb;
mod line;
mod trunk;

use geom::constants::Constant;
use std::collections::BTreeMap;

use super::form::{Form, Tube};
use super::outline;
use crate::{SimError, sewing};
use body::Body;
use geom::V3;
use pattern::{Garment, Role};

geom::constants! {
    "hybrid.features",
    /// Auxiliary points on a hem, waist or opening: three keep such a curve round the body level.
    const AUXILIARY: usize = 3;
}

/// Corner or auxiliary point of a piece.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Feature {
    pub vertex: usize,
    pub place: V3,
}

/// Outline of a piece and the features along it, both counter-clockwise.
#[derive(Clone, Debug)]
pub struct Mapped {
    /// Boundary vertices, beginning with the first feature's.
    pub ring: Vec<usize>,
    pub features: Vec<Feature>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Hangs from shoulders or waist: tops, dresses, skirts.
    Hung,
    /// Hangs from the waist and goes round each leg: trousers.
    Legs,
    /// Top and trousers in one.
    Suit,
}

pub fn is_leg(role: Role) -> bool {
    is_whole_leg(role)
        || matches!(role, Role::LegFrontRight | Role::LegFrontLeft | Role::LegBackRight | Role::LegBackLeft)
}

fn is_whole_leg(role: Role) -> bool {
    matches!(role, Role::LegRight | Role::LegLeft)
}

/// Fails for a skirt over trousers.
pub fn kind(garment: &Garment) -> Result<Kind, SimError> {
    let first = |is_wanted: fn(Role) -> bool| garment.pieces.iter().find(|piece| is_wanted(piece.role));
    let is_top = |role: Role| !is_leg(role);
    let is_round = |role: Role| is_skirt(role) || matches!(role, Role::Other | Role::Waistband);
    match (first(is_leg), first(is_round), first(is_top)) {
        (None, ..) => Ok(Kind::Hung),
        (Some(_), Some(skirt), _) => Err(SimError::CannotPlace {
            piece: skirt.id.clone(),
            role: skirt.role,
            accepted: "over legs: front, back, sleeve and bodice pieces",
        }),
        (Some(_), None, Some(_)) => Ok(Kind::Suit),
        (Some(_), None, None) => Ok(Kind::Legs),
    }
}

/// Side of the trunk that a piece lies on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Face {
    Front,
    Back,
    /// All round a limb.
    Round,
}

pub fn face(role: Role) -> Face {
    match role {
        Role::Front | Role::BodiceFront | Role::SkirtFront | Role::LegFrontRight | Role::LegFrontLeft => Face::Front,
        Role::Back | Role::BodiceBack | Role::SkirtBack | Role::LegBackRight | Role::LegBackLeft => Face::Back,
        _ => Face::Round,
    }
}

/// Includes the lower part of a dress.
fn is_skirt(role: Role) -> bool {
    matches!(role, Role::SkirtFront | Role::SkirtBack)
}

/// True if pieces of a role are worn below the waist.
fn is_low(role: Role) -> bool {
    is_skirt(role) || is_leg(role)
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct OnTube {
    line: f64,
    along: f64,
}

/// Fails with [`SimError::CannotMap`] where an outline is not that of a piece of its role.
pub fn features(body: &Body, form: &Form, garment: &Garment) -> Result<Vec<Mapped>, SimError> {
    let partners = outline::partners(garment);
    let mut pieces = Vec::new();
    for piece in &garment.pieces {
        let cannot = |reason| SimError::CannotMap { piece: piece.id.clone(), reason };
        let ring = outline::boundary(garment, piece).ok_or_else(|| cannot("its outline is not one closed line"))?;
        let chains = outline::chains(&ring, &partners);
        pieces.push((ring, chains));
    }
    let mut mapper = Mapper { body, form, garment, welded: sewing::welded(garment), places: BTreeMap::new() };
    let mut order: Vec<usize> = (0..pieces.len()).collect();
    // The trunk comes first: sleeves hang on bodices, skirts and legs as well.
    order.sort_by_key(|&p| (face(garment.pieces[p].role) == Face::Round, is_low(garment.pieces[p].role)));
    // Shoulders and underarms of all trunk pieces before anything is hung on them.
    for &p in &order {
        let piece = &garment.pieces[p];
        let found = match piece.role {
            Role::SleeveRight => mapper.sleeve(p, &pieces[p].1, 0),
            Role::SleeveLeft => mapper.sleeve(p, &pieces[p].1, 1),
            Role::LegFrontRight | Role::LegBackRight => mapper.leg(p, &pieces[p].1, 0),
            Role::LegFrontLeft | Role::LegBackLeft => mapper.leg(p, &pieces[p].1, 1),
            Role::LegRight => mapper.whole_leg(p, &pieces[p].1, 0),
            Role::LegLeft => mapper.whole_leg(p, &pieces[p].1, 1),
            Role::Other | Role::Waistband => mapper.wrap(p, &pieces[p].1),
            _ => mapper.trunk(p, &pieces[p].1),
        };
        found.map_err(|reason| SimError::CannotMap { piece: piece.id.clone(), reason })?;
    }
    let mapped = pieces.into_iter().enumerate().map(|(p, (ring, _))| {
        mapper.along(ring).ok_or(SimError::CannotMap {
            piece: garment.pieces[p].id.clone(),
            reason: "fewer than three of its corners have a place on the body",
        })
    });
    mapped.collect()
}

/// Search for the features of a piece, with the reason where they are not found.
type Found = Result<(), &'static str>;

struct Mapper<'a> {
    body: &'a Body,
    form: &'a Form,
    garment: &'a Garment,
    welded: Vec<usize>,
    places: BTreeMap<usize, V3>,
}

impl Mapper<'_> {
    fn set(&mut self, vertex: usize, place: V3) {
        self.places.entry(self.welded[vertex]).or_insert(place);
    }

    fn place(&self, vertex: usize) -> Option<V3> {
        self.places.get(&self.welded[vertex]).copied()
    }

    fn v(&self, vertex: usize) -> f64 {
        self.garment.rest[vertex].y
    }

    fn along(&self, mut ring: Vec<usize>) -> Option<Mapped> {
        let start = ring.iter().position(|&v| self.place(v).is_some())?;
        ring.rotate_left(start);
        let features: Vec<Feature> =
            ring.iter().filter_map(|&vertex| Some(Feature { vertex, place: self.place(vertex)? })).collect();
        (features.len() >= 3).then_some(Mapped { ring, features })
    }

    /// Places the joints of a line round a tube, at which one of the pieces that it is sewn to ends and the next
    /// begins.
    fn joints(&mut self, tube: &Tube, vertices: &[usize], joints: &[usize], on_tube: &dyn Fn(f64) -> OnTube) {
        let whole = outline::length_m(self.garment, vertices);
        for joint in joints {
            let Some(index) = vertices.iter().position(|v| v == joint) else { continue };
            let OnTube { line, along } = on_tube(outline::length_m(self.garment, &vertices[..=index]) / whole);
            let [before, after] = [line.floor(), line.ceil()].map(|l| tube.at(&self.form.mesh, l as i32, along));
            self.set(*joint, before.lerp(&after, line - line.floor()));
        }
    }

    /// Places auxiliary points along a line round a tube, by their share of its length, and its ends if they have no
    /// place yet.
    fn round(&mut self, tube: &Tube, vertices: &[usize], on_tube: &dyn Fn(f64) -> OnTube) {
        let whole = outline::length_m(self.garment, vertices);
        let point = |share: f64| {
            let OnTube { line, along } = on_tube(share);
            tube.at(&self.form.mesh, line.round() as i32, along)
        };
        let places: Vec<(f64, V3)> =
            (0..=AUXILIARY + 1).map(|k| k as f64 / (AUXILIARY + 1) as f64).map(|share| (share, point(share))).collect();
        // A line that is sewn to a placed one shares its points.
        let inner = &vertices[1..vertices.len() - 1];
        let taken = inner.iter().any(|&v| self.place(v).is_some());
        for (share, place) in places {
            let is_end = share == 0.0 || share == 1.0;
            if is_end || !taken {
                let vertex = line::nth(self.garment, vertices, share * whole);
                self.set(vertex, place);
            }
        }
    }
}

pub(crate) fn constants() -> Vec<Constant> {
    [limb::CONSTANTS, CONSTANTS, trunk::CONSTANTS].concat()
}
