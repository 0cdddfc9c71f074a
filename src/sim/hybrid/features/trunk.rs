//! Features of the pieces of the trunk: fronts and backs, with or without shoulders.

use super::limb::TOP_OF_ARM;
use super::line::{Group, between, groups, joined};
use super::{Face, Found, Mapper, OnTube, face, is_low};
use crate::hybrid::outline::{Chain, Partner};
use body::Layer;
use geom::V3;
use pattern::Role;

geom::constants! {
    "hybrid.features.trunk",
    /// Share of the way from armscye to the middle of the upper arm up to which a longer shoulder seam reaches onto the
    /// arm. The pop-up restores any length beyond.
    const MOST_DROP: f64 = 0.25;
    /// Greatest depth of an underarm point below the armpit: deeper armholes would leave no arm for the sleeve, and the
    /// pop-up restores their depth.
    const MOST_DEPTH_M: f64 = 0.005;
    /// Distance from the middle within which a point of a trunk lies at its centre.
    const CENTRE_M: f64 = 0.02;
}

/// Seam of a trunk piece with a piece of the other face, or with its other half.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Key {
    Side,
    Shoulder,
    Centre,
}

impl Mapper<'_> {
    /// Maps a front or back piece, whole or half, with or without shoulders.
    pub(super) fn trunk(&mut self, piece: usize, chains: &[Chain]) -> Found {
        let role = self.garment.pieces[piece].role;
        let own = face(role);
        let keys: Vec<Option<Key>> = chains.iter().map(|chain| self.key(role, chain)).collect();
        let count = |key: Key| keys.iter().filter(|k| **k == Some(key)).count();
        if count(Key::Side) + count(Key::Centre) != 2 || count(Key::Side) == 0 {
            return Err("it is not sewn to the other face of the trunk along two sides, or one and a centre seam");
        }
        let start = keys.iter().position(Option::is_some).ok_or("nothing is sewn to it")?;
        let n = chains.len();
        // Sides are measured from the shoulders, hems from the sides.
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
        for Group { before, inner, after } in groups {
            let (Some(a), Some(b)) = (keys[before], keys[after]) else { continue };
            let up = |c: usize| chains[c].chord(self.garment).y > 0.0;
            let vertices = joined(inner.iter().map(|&i| &chains[i % n]));
            let joints: Vec<usize> = inner.iter().skip(1).map(|&i| chains[i % n].first()).collect();
            if vertices.len() < 2 {
                continue;
            }
            match (a, up(before), b, up(after)) {
                (Key::Shoulder, ..) | (_, _, Key::Shoulder, _) => {
                    if a != Key::Side && b != Key::Side {
                        self.neck(own, &vertices, chains, &keys);
                    }
                }
                (_, false, _, true) | (_, true, _, false) => self.level(own, &vertices, &joints)?,
                _ => return Err("its seams do not run round it as those of a front or back"),
            }
        }
        Ok(())
    }

    fn key(&self, role: Role, chain: &Chain) -> Option<Key> {
        let Partner::Piece(other) = chain.partner else { return None };
        let other = self.garment.pieces[other].role;
        let chord = chain.chord(self.garment);
        match (face(role), face(other)) {
            // A waist seam: the sides above it need not meet those below.
            _ if is_low(role) != is_low(other) => None,
            (Face::Front, Face::Back) | (Face::Back, Face::Front) => {
                Some(if chord.y.abs() > chord.x.abs() { Key::Side } else { Key::Shoulder })
            }
            (a, b) if a == b && chord.y.abs() > chord.x.abs() => Some(Key::Centre),
            _ => None,
        }
    }

    /// Wearer's side (0 right, 1 left) of a key seam: seen from outside, the front's `+u` is the left, the back's the
    /// right.
    fn wearer_side(&self, own: Face, chain: &Chain) -> usize {
        // Counter-clockwise, seams at +u run upwards.
        let plus = chain.chord(self.garment).y > 0.0;
        usize::from((own == Face::Front) == plus)
    }

    /// Places a shoulder seam's ends on the shoulder line (Algorithm 5.1), or beyond its end on the arm.
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

    /// Places the upper end of a side at the depth of the armhole, and the lower end down the side line by the seam's
    /// length.
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

    /// Places the lowest point of a neckline on the centre line, at its depth below the side neck point.
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

    /// Point of the centre line, from the neck's base down, at height `z`.
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

    /// Places a hem or waist line round the trunk between its ends, with auxiliary points and the `joints` at which one
    /// of the pieces that it is sewn to ends and the next begins.
    fn level(&mut self, own: Face, vertices: &[usize], joints: &[usize]) -> Found {
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
        self.joints(&trunk, vertices, joints, &between(points));
        Ok(())
    }

    /// Line on which a point at the side or centre lies: 0 to 12 in front, 12 to 24 behind.
    fn trunk_line(&self, own: Face, place: &V3) -> f64 {
        let front = own == Face::Front;
        if place.x > CENTRE_M {
            if front { 0.0 } else { 24.0 }
        } else if place.x < -CENTRE_M {
            12.0
        } else if front {
            6.0
        } else {
            18.0
        }
    }
}
