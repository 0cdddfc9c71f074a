//! Feature mapping (5.2.1): the corners of a piece's outline onto features of the body, lengths preserved.
//!
//! The outline is read by what its stretches are sewn to, not by names: a seam between front and back that runs upright is a
//! side, one that runs across is a shoulder; what lies between a side and a shoulder is an armhole, and so on. Points are
//! then found in this order: shoulder ends on the shoulder line (Algorithm 5.1), underarm and hem down the side line,
//! neck on the centre line; for trousers the fork on the crotch, the waist above it, the hem down the inseam.

use std::collections::BTreeMap;

use super::form::{Form, Tube};
use super::outline::{self, Chain, Partner};
use crate::body::{Body, Layer};
use crate::geom::V3;
use crate::pattern::{Garment, Role};
use crate::sim::{SimError, sewing};

/// Auxiliary points on a hem, waist or opening: it is a curve round the body, which three points keep level.
const AUXILIARY: usize = 3;

/// A corner or auxiliary point of a piece: a boundary vertex and its place on the form, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Feature {
    /// Garment vertex.
    pub vertex: usize,
    /// Place on the form, m.
    pub place: V3,
}

/// A piece's outline and the features along it, both counter-clockwise.
#[derive(Clone, Debug)]
pub struct Mapped {
    /// Boundary vertices, beginning with the first feature's.
    pub ring: Vec<usize>,
    /// Features in order along the ring.
    pub features: Vec<Feature>,
}

/// What kind of garment it is, as far as mapping goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Hangs from shoulders or waist: tops, dresses, skirts.
    Hung,
    /// Trousers.
    Legs,
}

/// Kind of a garment.
///
/// # Errors
/// [`SimError::CannotPlace`] for a piece that belongs to neither kind, or to the other one.
pub fn kind(garment: &Garment) -> Result<Kind, SimError> {
    let kind_of = |role: Role| match role {
        Role::LegFrontRight | Role::LegFrontLeft | Role::LegBackRight | Role::LegBackLeft => Some(Kind::Legs),
        Role::Waistband | Role::Other => None,
        _ => Some(Kind::Hung),
    };
    let first = garment.pieces.first().and_then(|p| kind_of(p.role)).unwrap_or(Kind::Hung);
    let strange = garment.pieces.iter().find(|p| kind_of(p.role) != Some(first));
    match strange {
        None => Ok(first),
        Some(piece) => Err(SimError::CannotPlace {
            piece: piece.id.clone(),
            role: piece.role,
            accepted: match first {
                Kind::Hung => "front, back, sleeve, bodice and skirt pieces",
                Kind::Legs => "leg pieces",
            },
        }),
    }
}

/// Side of the trunk that a piece lies on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Face {
    /// Front.
    Front,
    /// Back.
    Back,
    /// All round a limb.
    Round,
}

/// Side of the trunk that pieces of a role lie on.
#[must_use]
pub fn face(role: Role) -> Face {
    match role {
        Role::Front | Role::BodiceFront | Role::SkirtFront | Role::LegFrontRight | Role::LegFrontLeft => Face::Front,
        Role::Back | Role::BodiceBack | Role::SkirtBack | Role::LegBackRight | Role::LegBackLeft => Face::Back,
        _ => Face::Round,
    }
}

/// Whether a piece is the lower part of a dress, or a skirt.
fn is_skirt(role: Role) -> bool {
    matches!(role, Role::SkirtFront | Role::SkirtBack)
}

/// A point of a tube: line and parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
struct OnTube {
    line: f64,
    along: f64,
}

/// The features of every piece of a garment.
///
/// # Errors
/// [`SimError::CannotMap`] when an outline is not that of a piece of its role.
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
    // Sleeves hang on bodices, skirts too: trunk first.
    order.sort_by_key(|&p| (face(garment.pieces[p].role) == Face::Round, is_skirt(garment.pieces[p].role)));
    // Shoulders and underarms of all trunk pieces before anything is hung on them.
    for &p in &order {
        let piece = &garment.pieces[p];
        let found = match piece.role {
            Role::SleeveRight => mapper.sleeve(p, &pieces[p].1, 0),
            Role::SleeveLeft => mapper.sleeve(p, &pieces[p].1, 1),
            Role::LegFrontRight | Role::LegBackRight => mapper.leg(p, &pieces[p].1, 0),
            Role::LegFrontLeft | Role::LegBackLeft => mapper.leg(p, &pieces[p].1, 1),
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

type Found = Result<(), &'static str>;

struct Mapper<'a> {
    body: &'a Body,
    form: &'a Form,
    garment: &'a Garment,
    welded: Vec<usize>,
    /// Place of each welded vertex that is a feature.
    places: BTreeMap<usize, V3>,
}

/// A seam of a trunk piece with a piece of the other face, or with its other half.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Key {
    Side,
    Shoulder,
    Centre,
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

    /// The features along a ring, which is turned to begin with one.
    fn along(&self, mut ring: Vec<usize>) -> Option<Mapped> {
        let start = ring.iter().position(|&v| self.place(v).is_some())?;
        ring.rotate_left(start);
        let features: Vec<Feature> =
            ring.iter().filter_map(|&vertex| Some(Feature { vertex, place: self.place(vertex)? })).collect();
        (features.len() >= 3).then_some(Mapped { ring, features })
    }

    /// A front or back piece, whole or half, with or without shoulders.
    fn trunk(&mut self, piece: usize, chains: &[Chain]) -> Found {
        let own = face(self.garment.pieces[piece].role);
        let keys: Vec<Option<Key>> = chains.iter().map(|chain| self.key(own, chain)).collect();
        let count = |key: Key| keys.iter().filter(|k| **k == Some(key)).count();
        if count(Key::Side) + count(Key::Centre) != 2 || count(Key::Side) == 0 {
            return Err("it is not sewn to the other face of the trunk along two sides, or one and a centre seam");
        }
        let start = keys.iter().position(Option::is_some).ok_or("nothing is sewn to it")?;
        let n = chains.len();
        // Shoulders give the places from which sides are measured, sides those of bottoms.
        let groups = groups(&keys, start);
        for (chain, key) in chains.iter().zip(&keys) {
            if *key == Some(Key::Shoulder) {
                self.shoulder(own, chain);
            }
        }
        if count(Key::Shoulder) == 0 {
            self.hang_from_waist(own, chains, &keys);
        }
        for (chain, key) in chains.iter().zip(&keys) {
            if *key == Some(Key::Side) {
                self.side(own, chain, chains, &keys)?;
            }
        }
        for (before, inner, after) in groups {
            let (Some(a), Some(b)) = (keys[before], keys[after]) else { continue };
            let up = |c: usize| chains[c].chord(self.garment).y > 0.0;
            let vertices = joined(inner.iter().map(|&i| &chains[i % n]));
            if vertices.len() < 2 {
                continue;
            }
            match (a, up(before), b, up(after)) {
                (Key::Shoulder, ..) | (_, _, Key::Shoulder, _) => {
                    if a != Key::Side && b != Key::Side {
                        self.neck(own, &vertices, chains, &keys);
                    }
                }
                (_, false, _, true) => self.level(own, &vertices)?,
                (_, true, _, false) => self.level(own, &vertices)?,
                _ => return Err("its seams do not run round it as those of a front or back"),
            }
        }
        Ok(())
    }

    fn key(&self, own: Face, chain: &Chain) -> Option<Key> {
        let Partner::Piece(other) = chain.partner else { return None };
        let other = face(self.garment.pieces[other].role);
        let chord = chain.chord(self.garment);
        match (own, other) {
            (Face::Front, Face::Back) | (Face::Back, Face::Front) => {
                Some(if chord.y.abs() > chord.x.abs() { Key::Side } else { Key::Shoulder })
            }
            (a, b) if a == b && chord.y.abs() > chord.x.abs() => Some(Key::Centre),
            _ => None,
        }
    }

    /// Wearer's side (0 right, 1 left) of a key seam: seen from outside, the front's `+u` is the left, the back's the right.
    fn wearer_side(&self, own: Face, chain: &Chain) -> usize {
        // Counter-clockwise, seams at +u run upwards.
        let plus = chain.chord(self.garment).y > 0.0;
        usize::from((own == Face::Front) == plus)
    }

    /// Ends of a shoulder seam onto the shoulder line (Algorithm 5.1), and beyond its end down the arm.
    fn shoulder(&mut self, own: Face, chain: &Chain) {
        let side = self.wearer_side(own, chain);
        let (outer, inner) = if chain.chord(self.garment).y > 0.0 {
            (chain.first(), chain.last())
        } else {
            (chain.last(), chain.first())
        };
        let (neck, armscye) = self.shoulder_line(side);
        let (line, seam) = ((armscye - neck).norm(), chain.length_m(self.garment));
        if seam < line {
            // Shorter than the body's: centred on it.
            let start = 0.5 * (1.0 - seam / line);
            self.set(inner, neck.lerp(&armscye, start));
            self.set(outer, neck.lerp(&armscye, 1.0 - start));
        } else {
            self.set(inner, neck);
            let arm = &self.form.arms[side];
            let along = arm.further(&self.form.mesh, TOP_OF_ARM, 0.0, seam - line);
            self.set(outer, arm.at(&self.form.mesh, TOP_OF_ARM, along.min(MOST_DROP)));
        }
    }

    /// Side neck point and shoulder point of the control mesh.
    fn shoulder_line(&self, side: usize) -> (V3, V3) {
        let control = &self.body.control;
        let neck = control.ring_vertex(Layer::NeckBase, 12 * side);
        (self.form.mesh.positions[neck], self.form.arms[side].at(&self.form.mesh, TOP_OF_ARM, 0.0))
    }

    /// Places the tops of the sides of a piece without shoulders at the waist, unless a bodice has placed them.
    fn hang_from_waist(&mut self, own: Face, chains: &[Chain], keys: &[Option<Key>]) {
        for (chain, _) in chains.iter().zip(keys).filter(|(_, key)| **key == Some(Key::Side)) {
            let side = self.wearer_side(own, chain);
            let top = if chain.chord(self.garment).y > 0.0 { chain.last() } else { chain.first() };
            let along = self.form.trunk.at_height(&self.form.mesh, 12 * side as i32, self.body.levels.waist_m);
            self.set(top, self.form.trunk.at(&self.form.mesh, 12 * side as i32, along));
        }
    }

    /// The upper end of a side at the depth of the armhole, the lower end down the side line by the seam's length.
    fn side(&mut self, own: Face, chain: &Chain, chains: &[Chain], keys: &[Option<Key>]) -> Found {
        let side = self.wearer_side(own, chain);
        let up = chain.chord(self.garment).y > 0.0;
        let (top, bottom) = if up { (chain.last(), chain.first()) } else { (chain.first(), chain.last()) };
        let line = 12 * side as i32;
        let (mesh, trunk) = (&self.form.mesh, &self.form.trunk);
        let start = match self.place(top) {
            Some(place) => trunk.at_height(mesh, line, place.z),
            None => {
                let shoulder = chains
                    .iter()
                    .zip(keys)
                    .find(|(c, key)| **key == Some(Key::Shoulder) && self.wearer_side(own, c) == side);
                let (shoulder, _) = shoulder.ok_or("a side has no shoulder above it")?;
                let outer = if up { shoulder.first() } else { shoulder.last() };
                let depth = self.v(outer) - self.v(top);
                let from = self.place(outer).ok_or("a side has no shoulder above it")?;
                let axilla = trunk.at(mesh, line, 0.0).z;
                trunk.at_height(mesh, line, (from.z - depth).max(axilla - MOST_DEPTH_M))
            }
        };
        let end = trunk.further(mesh, line, start, chain.length_m(self.garment));
        let places = [trunk.at(mesh, line, start), trunk.at(mesh, line, end)];
        self.set(top, places[0]);
        self.set(bottom, places[1]);
        Ok(())
    }

    /// The lowest point of a neckline on the centre line, at its depth below the side neck point.
    fn neck(&mut self, own: Face, vertices: &[usize], chains: &[Chain], keys: &[Option<Key>]) {
        let (first, last) = (vertices[0], vertices[vertices.len() - 1]);
        let shoulder = chains.iter().zip(keys).find(|(_, key)| **key == Some(Key::Shoulder));
        let Some((shoulder, _)) = shoulder else { return };
        let inner = if shoulder.chord(self.garment).y > 0.0 { shoulder.last() } else { shoulder.first() };
        let Some(side_neck) = self.place(inner) else { return };
        // A half piece ends at the centre, a whole one passes it at its middle.
        let middle = if self.place(first).is_none() {
            first
        } else if self.place(last).is_none() {
            last
        } else {
            let u = 0.5 * (self.garment.rest[first].x + self.garment.rest[last].x);
            let off = |v: &usize| (self.garment.rest[*v].x - u).abs();
            *vertices.iter().min_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or(&first)
        };
        let z = side_neck.z - (self.v(inner) - self.v(middle));
        self.set(middle, self.on_centre(own, z));
    }

    /// The point of the centre line, from the neck's base down, at the height `z`.
    fn on_centre(&self, own: Face, z: f64) -> V3 {
        let index = if own == Face::Front { 6 } else { 18 };
        let control = &self.body.control;
        let mut line = vec![control.ring_vertex(Layer::NeckBase, index)];
        line.extend(self.form.trunk.line(index as i32));
        let points: Vec<V3> = line.into_iter().map(|v| self.form.mesh.positions[v]).collect();
        let below = points.iter().position(|p| p.z <= z);
        match below {
            Some(0) => points[0],
            Some(k) => points[k].lerp(&points[k - 1], (z - points[k].z) / (points[k - 1].z - points[k].z)),
            None => points[points.len() - 1],
        }
    }

    /// A hem or waist line round the trunk between two placed ends, with auxiliary points.
    fn level(&mut self, own: Face, vertices: &[usize]) -> Found {
        let ends = [vertices[0], vertices[vertices.len() - 1]];
        let lines = ends.map(|v| self.place(v).map(|p| self.trunk_line(own, &p)));
        // The end without a place is at the centre.
        let centre = if own == Face::Front { 6.0 } else { 18.0 };
        let placed = ends.iter().find_map(|v| self.place(*v)).ok_or("a hem or waist line has no end on the body")?;
        let along = |line: f64, z: f64| self.form.trunk.at_height(&self.form.mesh, line as i32, z);
        let points = [0, 1].map(|k| {
            let line = lines[k].unwrap_or(centre);
            let z = self.place(ends[k]).unwrap_or(placed).z;
            OnTube { line, along: along(line, z) }
        });
        let trunk = self.form.trunk.clone();
        self.round(&trunk, vertices, &between(points));
        Ok(())
    }

    /// The line of the trunk on which a point at its side or centre lies: 0 to 12 in front, 12 to 24 behind.
    fn trunk_line(&self, own: Face, place: &V3) -> f64 {
        let half_width = 0.02;
        let front = own == Face::Front;
        if place.x > half_width {
            if front { 0.0 } else { 24.0 }
        } else if place.x < -half_width {
            12.0
        } else if front {
            6.0
        } else {
            18.0
        }
    }

    /// Auxiliary points along a line round a tube, given by share of its length; ends without a place get theirs.
    fn round(&mut self, tube: &Tube, vertices: &[usize], on_tube: &dyn Fn(f64) -> OnTube) {
        let whole = outline::length_m(self.garment, vertices);
        let point = |share: f64| {
            let OnTube { line, along } = on_tube(share);
            tube.at(&self.form.mesh, line.round() as i32, along)
        };
        let places: Vec<(f64, V3)> =
            (0..=AUXILIARY + 1).map(|k| k as f64 / (AUXILIARY + 1) as f64).map(|share| (share, point(share))).collect();
        // A line sewn to one that is placed takes its points.
        let inner = &vertices[1..vertices.len() - 1];
        let taken = inner.iter().any(|&v| self.place(v).is_some());
        for (share, place) in places {
            let is_end = share == 0.0 || share == 1.0;
            if is_end || !taken {
                let at = nth(self.garment, vertices, share * whole);
                self.set(at, place);
            }
        }
    }

    /// A sleeve in one piece: its opening round the arm at the length of the underarm seam.
    fn sleeve(&mut self, piece: usize, chains: &[Chain], side: usize) -> Found {
        let is_underarm = |c: &Chain| c.partner == Partner::Piece(piece);
        let underarms: Vec<usize> = (0..chains.len()).filter(|&i| is_underarm(&chains[i])).collect();
        let &[a, b] = underarms.as_slice() else {
            return Err("a sleeve must be one piece with one underarm seam");
        };
        let up = |i: usize| chains[i].chord(self.garment).y > 0.0;
        let (rising, falling) = match (up(a), up(b)) {
            (true, false) => (a, b),
            (false, true) => (b, a),
            _ => return Err("its underarm seam does not run along both sides of it"),
        };
        let opening = joined(run(falling, rising, chains));
        let cap = joined(run(rising, falling, chains));
        let underarm = self.place(chains[rising].last()).ok_or("its underarm is not sewn to a side seam")?;
        let top = cap.iter().copied().find(|&v| self.place(v).is_some_and(|p| p != underarm));
        let top = top.ok_or("its cap is not sewn to a shoulder")?;
        let arm = self.form.arms[side].clone();
        let mesh = &self.form.mesh;
        let root = arm.at(mesh, UNDER_ARM, 0.0);
        let left = chains[rising].length_m(self.garment) - (root - underarm).norm();
        let below = arm.further(mesh, UNDER_ARM, 0.0, left.max(LEAST_SLEEVE_M));
        // Over the top of the arm, from the shoulder by the sleeve's height there.
        let start = arm.at(mesh, TOP_OF_ARM, 0.0);
        let shoulder = self.place(top).map_or(0.0, |p| (p - start).norm());
        let height = self.v(top) - self.v(nth(self.garment, &opening, 0.5 * outline::length_m(self.garment, &opening)));
        let above = arm.further(mesh, TOP_OF_ARM, 0.0, shoulder + height.max(LEAST_SLEEVE_M));
        // On the right, +u is the front: from below over the back, the top and the front.
        let turn = if side == 0 { -24.0 } else { 24.0 };
        self.round(&arm, &opening, &|share| OnTube {
            line: f64::from(UNDER_ARM) + turn * share,
            along: below + (above - below) * 0.5 * (1.0 - (share * std::f64::consts::TAU).cos()),
        });
        Ok(())
    }

    /// A front or back of one leg.
    fn leg(&mut self, piece: usize, chains: &[Chain], side: usize) -> Found {
        let own = face(self.garment.pieces[piece].role);
        let role_of = |chain: &Chain| match chain.partner {
            Partner::Piece(p) => Some(self.garment.pieces[p].role),
            Partner::Free => None,
        };
        let is_own_leg = |role: Role| {
            let right = matches!(role, Role::LegFrontRight | Role::LegBackRight);
            right == (side == 0)
        };
        // Seen from outside, the front's +u is the wearer's left: the right leg's inseam.
        let inseam_rises = (own == Face::Front) == (side == 0);
        let up = |chain: &Chain| chain.chord(self.garment).y > 0.0;
        let find = |wanted: &dyn Fn(&Chain) -> bool| chains.iter().position(wanted);
        let own_leg = |c: &Chain| role_of(c).is_some_and(is_own_leg);
        let inseam = find(&|c| own_leg(c) && up(c) == inseam_rises).ok_or("it has no inseam")?;
        let outseam = find(&|c| own_leg(c) && up(c) != inseam_rises).ok_or("it has no outseam")?;
        let crotch = find(&|c| role_of(c).is_some_and(|r| !is_own_leg(r))).ok_or("it has no crotch seam")?;
        let (hem, waist) = if inseam_rises {
            (joined(run(outseam, inseam, chains)), joined(run(crotch, outseam, chains)))
        } else {
            (joined(run(inseam, outseam, chains)), joined(run(outseam, crotch, chains)))
        };
        if hem.len() < 2 || waist.len() < 2 {
            return Err("it has no hem or no waist line");
        }
        let fork = if inseam_rises { chains[inseam].last() } else { chains[inseam].first() };
        let (centre, outer) =
            if inseam_rises { (waist[0], waist[waist.len() - 1]) } else { (waist[waist.len() - 1], waist[0]) };
        let mesh = &self.form.mesh;
        let tube = self.form.legs[side].clone();
        let inner_line = if side == 0 { 12 } else { 0 };
        let fork_place = {
            let sides = [self.form.legs[0].at(mesh, 12, 0.0), self.form.legs[1].at(mesh, 0, 0.0)];
            sides[0].lerp(&sides[1], 0.5)
        };
        // Waist: as high above the fork as the pattern has it.
        let rise = self.v(centre) - self.v(fork);
        let trunk = self.form.trunk.clone();
        let (line_c, line_o) = match (own, side) {
            (Face::Front, 0) => (6.0, 0.0),
            (Face::Front, _) => (6.0, 12.0),
            (_, 0) => (18.0, 24.0),
            (_, _) => (18.0, 12.0),
        };
        let z = self.place(centre).map_or(fork_place.z + rise, |p| p.z);
        let z_outer = self.place(outer).map_or(z + self.v(outer) - self.v(centre), |p| p.z);
        let on = |line: f64, z: f64| OnTube { line, along: trunk.at_height(mesh, line as i32, z) };
        let (at_centre, at_outer) = (on(line_c, z), on(line_o, z_outer));
        let reach = (fork_place - tube.at(mesh, inner_line, 0.0)).norm();
        let along = tube.further(mesh, inner_line, 0.0, chains[inseam].length_m(self.garment) - reach);
        self.set(fork, fork_place);
        let waist_ends = if inseam_rises { [at_centre, at_outer] } else { [at_outer, at_centre] };
        self.round(&trunk, &waist, &between(waist_ends));
        // Lines 0 to 12 run over the front, 12 to 24 over the back; the hem runs counter-clockwise with them.
        let start = if own == Face::Front { 0.0 } else { 12.0 };
        let hem_ends = [OnTube { line: start, along }, OnTube { line: start + 12.0, along }];
        self.round(&tube, &hem, &between(hem_ends));
        Ok(())
    }
}

/// Line of an arm that runs along its top, and along its underside.
const TOP_OF_ARM: i32 = 16;
const UNDER_ARM: i32 = 4;
/// A sleeve reaches onto the arm by this at least, m.
const LEAST_SLEEVE_M: f64 = 0.02;
/// A shoulder seam that is longer than the shoulder reaches onto the arm, at most by this share of the way from armscye to
/// the middle of the upper arm: what is longer still the pop-up gives back.
const MOST_DROP: f64 = 0.25;
/// An underarm point lies at most this far below the armpit, m: deeper armholes leave no arm for the sleeve, and the
/// pop-up gives them their depth.
const MOST_DEPTH_M: f64 = 0.005;

/// A line round a tube from one point of it to another.
fn between([from, to]: [OnTube; 2]) -> impl Fn(f64) -> OnTube {
    move |share| OnTube {
        line: from.line + (to.line - from.line) * share,
        along: from.along + (to.along - from.along) * share,
    }
}

/// The chains that follow one and precede another.
fn run(from: usize, to: usize, chains: &[Chain]) -> impl Iterator<Item = &Chain> {
    let n = chains.len();
    (1..n).map(move |k| (from + k) % n).take_while(move |&i| i != to).map(|i| &chains[i])
}

/// Groups of chains between key chains, counter-clockwise: key before, those between, key after.
fn groups(keys: &[Option<Key>], start: usize) -> Vec<(usize, Vec<usize>, usize)> {
    let n = keys.len();
    let mut found = Vec::new();
    let mut before = start;
    let mut inner = Vec::new();
    for k in 1..=n {
        let i = (start + k) % n;
        if keys[i].is_some() {
            found.push((before, std::mem::take(&mut inner), i));
            before = i;
        } else {
            inner.push(i);
        }
    }
    found
}

/// Vertices of consecutive chains as one line.
fn joined<'c>(chains: impl Iterator<Item = &'c Chain>) -> Vec<usize> {
    let mut vertices: Vec<usize> = Vec::new();
    for chain in chains {
        let skip = usize::from(!vertices.is_empty());
        vertices.extend(&chain.vertices[skip..]);
    }
    vertices
}

/// The vertex of a line that is nearest to arc length `arc_m`.
fn nth(garment: &Garment, vertices: &[usize], arc_m: f64) -> usize {
    let mut at = 0.0;
    let mut best = (f64::MAX, vertices[0]);
    for (k, &v) in vertices.iter().enumerate() {
        if k > 0 {
            at += (garment.rest[v] - garment.rest[vertices[k - 1]]).norm();
        }
        if (at - arc_m).abs() < best.0 {
            best = ((at - arc_m).abs(), v);
        }
    }
    best.1
}
