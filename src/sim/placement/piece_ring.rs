//! Rings of pieces about the trunk: gores, the halves of a circle skirt, a circle skirt or a tube of one piece.
//!
//! A ring is cut open at one seam and developed into the plane, each piece moved so that its side lies on that of the
//! piece before. The rigid motion that takes the side at one end onto the side at the other tells the shape: a rotation
//! about the tip of a sector, or a translation along a strip.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use nalgebra::{Isometry2, Matrix2, Point2, Rotation2};

use super::attachment::Similarity;
use super::interval::{bounds, front, middle};
use super::layout::Joins;
use super::rows::{self, InRow};
use geom::V2;

geom::constants! {
    "placement.ring",
    /// Greatest rms distance of the two sides of a seam in a ring that is laid out flat.
    const FLAT_M: f64 = 0.03;
    /// Rotation below which a motion counts as a translation.
    const SHIFT_RAD: f64 = 0.05;
    /// Displacement of a ring's middle by the motion of its ends, over the rms distance of its points from there, below
    /// which the ring goes all round. Along a strip it is 1.5 or more.
    const CLOSED: f64 = 0.5;
    /// Displacement of points by a motion over their distance from its centre, below which the centre is poorly
    /// determined.
    const SURE: f64 = 0.15;
    /// Weight of the ring's middle over that of a side's line in the least squares for the point where the lines meet.
    const UNSURE: f64 = 1e-3;
    /// Sum of the vectors from the tip to a piece's vertices, over the sum of their lengths, below which the piece goes
    /// all round the tip.
    const ALL_ROUND: f64 = 0.01;
}

/// Pieces each of which is sewn to the next, and the last to the first; or one piece sewn to itself.
pub struct Ring {
    members: Vec<Member>,
    /// Takes the first piece's side at the cut onto the last one's.
    closing: Isometry2<f64>,
    /// Seam at the cut, the last piece's vertices first.
    cut: Vec<[usize; 2]>,
}

struct Member {
    piece: usize,
    /// From the piece's plane to that of the ring.
    motion: Isometry2<f64>,
    /// Seam to the member before, its vertices first; none of the first.
    seam: Vec<[usize; 2]>,
}

pub enum Flat {
    Sector(Vec<Polar>),
    /// To the right of the middle and up.
    Strip(Vec<(usize, V2)>),
    Rows(Vec<InRow>),
}

#[derive(Clone, Copy, Debug)]
pub struct Polar {
    pub vertex: usize,
    /// Counter-clockwise from the middle, rad.
    pub angle: f64,
    /// m.
    pub radius: f64,
}

impl Flat {
    /// Angle of a sector; 0 for a strip.
    pub fn turn_rad(&self) -> f64 {
        match self {
            Self::Sector(points) => {
                let [low, high] = bounds(points.iter().map(|p| p.angle));
                high - low
            }
            Self::Strip(_) => 0.0,
            Self::Rows(points) => {
                let [least, most] = bounds(points.iter().map(|p| p.row_m));
                let [top, hem] = bounds(points.iter().map(|p| p.below_m));
                ((most - least) / (hem - top)).min(TAU)
            }
        }
    }

    /// Length of the upper edge: nearest the tip of a sector, or all along a strip.
    pub fn inner_m(&self) -> f64 {
        match self {
            Self::Sector(points) => self.turn_rad() * bounds(points.iter().map(|p| p.radius))[0],
            Self::Strip(points) => {
                let [left, right] = bounds(points.iter().map(|(_, p)| p.x));
                right - left
            }
            Self::Rows(points) => bounds(points.iter().map(|p| p.row_m))[0],
        }
    }
}

/// Seam between two pieces or within one, in however many parts.
struct Link {
    pieces: [usize; 2],
    /// The first piece's vertex comes first.
    pairs: Vec<[usize; 2]>,
}

impl Ring {
    /// Pieces sewn to themselves.
    pub fn of_one(joins: &Joins, some: &[usize]) -> Vec<Self> {
        let links = links(joins, some);
        let alone = |&piece: &usize| {
            // Shorter seams of a piece to itself are darts.
            let own = links.iter().filter(|link| link.pieces == [piece, piece]);
            let longest = own.max_by_key(|link| link.pairs.len())?;
            let member = Member { piece, motion: Isometry2::identity(), seam: Vec::new() };
            Some(Self::cut_at(joins, &longest.pairs, vec![member]))
        };
        some.iter().filter_map(alone).collect()
    }

    /// Rings of several pieces among some; their other seams are ignored.
    pub fn of_several(joins: &Joins, some: &[usize]) -> Vec<Self> {
        Self::among(joins, some, &between_pieces(joins, some))
    }

    /// Rings of skirts. Two pieces that are sewn to each other at both sides are a tier, and their seams to other
    /// pieces are ignored as well.
    pub fn of_tiers(joins: &Joins, some: &[usize]) -> Vec<Self> {
        let mut links = between_pieces(joins, some);
        let pairs: Vec<[usize; 2]> = links.iter().map(|link| link.pieces).collect();
        let both_sides = |pair: &[usize; 2]| pairs.iter().filter(|other| *other == pair).count() == 2;
        let tiers: Vec<[usize; 2]> = pairs.iter().copied().filter(both_sides).collect();
        let is_apart = |pair: &[usize; 2]| !tiers.iter().flatten().any(|piece| pair.contains(piece));
        links.retain(|link| tiers.contains(&link.pieces) || is_apart(&link.pieces));
        Self::among(joins, some, &links)
    }

    fn among(joins: &Joins, some: &[usize], links: &[Link]) -> Vec<Self> {
        let mut ends: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for (index, link) in links.iter().enumerate() {
            link.pieces.iter().for_each(|&piece| ends.entry(piece).or_default().push(index));
        }
        some.iter().filter_map(|&first| Self::beginning(joins, links, &ends, first)).collect()
    }

    /// Ring of several pieces in which `first` is the least; each must be sewn to two others, or twice to the only
    /// other.
    fn beginning(joins: &Joins, links: &[Link], ends: &BTreeMap<usize, Vec<usize>>, first: usize) -> Option<Self> {
        let two = |piece: usize| <[usize; 2]>::try_from(ends.get(&piece)?.as_slice()).ok();
        let [mut at, cut] = two(first)?;
        let mut members = vec![Member { piece: first, motion: Isometry2::identity(), seam: Vec::new() }];
        loop {
            let last = members.last()?;
            let (next, seam) = links[at].from(last.piece);
            if at == cut {
                return Some(Self::cut_at(joins, &seam, members));
            }
            let motion = onto(joins, &seam, &last.motion);
            if next < first || misfit_m(joins, &seam, &last.motion, &motion) > FLAT_M {
                return None;
            }
            let [one, other] = two(next)?;
            at = if one == at { other } else { one };
            members.push(Member { piece: next, motion, seam: seam.iter().map(|&[a, b]| [b, a]).collect() });
        }
    }

    fn cut_at(joins: &Joins, seam: &[[usize; 2]], members: Vec<Member>) -> Self {
        let placed = members.last().map_or_else(Isometry2::identity, |last| last.motion);
        Self { closing: onto(joins, seam, &placed), cut: seam.to_vec(), members }
    }

    fn last_side(&self, joins: &Joins) -> Vec<Point2<f64>> {
        let last = self.members.last();
        last.map_or_else(Vec::new, |last| self.cut.iter().map(|pair| last.place(joins, pair[0])).collect())
    }

    pub fn pieces(&self) -> Vec<usize> {
        self.members.iter().map(|member| member.piece).collect()
    }

    /// Lays the ring out with the middle of `in_front`, or of all, at the front.
    pub fn flat(&self, joins: &Joins, in_front: &[usize]) -> Flat {
        if let Some(strips) = self.strips(joins, in_front) {
            return Flat::Rows(rows::laid_out(&strips));
        }
        match self.tip(joins) {
            Some(tip) => Flat::Sector(self.sector(joins, in_front, &tip)),
            None => Flat::Strip(self.strip(joins, in_front)),
        }
    }

    /// `None` unless the ring has several pieces, all long and straight.
    fn strips(&self, joins: &Joins, in_front: &[usize]) -> Option<Vec<rows::Strip>> {
        let count = self.members.len();
        // Of each seam in order, the first before the first piece: the vertices of the piece after it and of that
        // before it.
        let cut = self.cut.iter().map(|&[a, b]| [b, a]).collect();
        let seams: Vec<&Vec<[usize; 2]>> =
            std::iter::once(&cut).chain(self.members.iter().skip(1).map(|member| &member.seam)).collect();
        let strip = |(k, member): (usize, &Member)| {
            let own = |k: usize, side: usize| seams[k % count].iter().map(|pair| pair[side]).collect::<Vec<_>>();
            let is_in_front = in_front.contains(&member.piece);
            rows::Strip::of(joins, member.piece, &own(k, 0), &own(k + 1, 1), is_in_front)
        };
        (count > 1).then(|| self.members.iter().enumerate().map(strip).collect())?
    }

    /// Centre of the rotation that takes the ring's ends onto each other; `None` where they are translated.
    fn tip(&self, joins: &Joins) -> Option<Point2<f64>> {
        let points: Vec<V2> =
            self.members.iter().flat_map(|member| member.places(joins)).map(|(_, p)| p.coords).collect();
        let count = points.len().max(1) as f64;
        let middle = points.iter().sum::<V2>() / count;
        let size = (points.iter().map(|p| (p - middle).norm_squared()).sum::<f64>() / count).sqrt();
        let shift = self.closing * Point2::from(middle) - Point2::from(middle);
        let turn = self.closing.rotation;
        // A full circle rotates by nothing about its middle; if its halves differ it is translated a little as well.
        let damping = if shift.norm() < CLOSED * size { SURE * SURE } else { 0.0 };
        if damping == 0.0 && turn.angle().abs() < SHIFT_RAD {
            return None;
        }
        // The point that moves least; of several the nearest to the focus of the sides.
        let middle = self.focus(joins, &middle);
        let shift = self.closing * Point2::from(middle) - Point2::from(middle);
        let apart = Matrix2::identity() - turn.to_rotation_matrix().into_inner();
        let normal = apart.transpose() * apart + Matrix2::identity() * damping;
        normal.lu().solve(&(apart.transpose() * shift)).map(|from_middle| Point2::from(middle + from_middle))
    }

    /// Each side that is sewn to a piece before, and the last at the cut.
    fn sides(&self, joins: &Joins) -> Vec<Vec<Point2<f64>>> {
        let side = |member: &Member| member.seam.iter().map(|pair| member.place(joins, pair[0])).collect();
        self.members.iter().skip(1).map(side).chain([self.last_side(joins)]).collect()
    }

    /// Least-squares intersection of the lines of the sides, regularised towards `middle`.
    fn focus(&self, joins: &Joins, middle: &V2) -> V2 {
        let (mut matrix, mut goal) = (Matrix2::identity() * UNSURE, middle * UNSURE);
        for side in self.sides(joins).into_iter().filter(|side| side.len() > 1) {
            let mean = mean(&side).coords;
            let spread: Matrix2<f64> = side.iter().map(|p| (p.coords - mean) * (p.coords - mean).transpose()).sum();
            let across = spread.symmetric_eigen();
            let normal = across.eigenvectors.column(across.eigenvalues.imin()).into_owned();
            let weight = normal * normal.transpose();
            matrix += weight;
            goal += weight * mean;
        }
        matrix.try_inverse().map_or(*middle, |inverse| inverse * goal)
    }

    fn sector(&self, joins: &Joins, in_front: &[usize], tip: &Point2<f64>) -> Vec<Polar> {
        let mut points = Vec::new();
        let mut fronts = Vec::new();
        // Of the member before: the angle of its middle, and that of each of its vertices from there.
        let mut before: (f64, BTreeMap<usize, f64>) = (0.0, BTreeMap::new());
        let cut = mean(&self.last_side(joins));
        for member in &self.members {
            let polar = member.polar(joins, tip, &cut);
            let own: BTreeMap<usize, f64> = polar.iter().map(|p| (p.vertex, p.angle)).collect();
            let apart = |&[a, b]: &[usize; 2]| before.1[&b] - own[&a];
            let middle = before.0 + member.seam.iter().map(apart).sum::<f64>() / member.seam.len().max(1) as f64;
            points.extend(polar.into_iter().map(|p| Polar { angle: middle + p.angle, ..p }));
            if in_front.contains(&member.piece) {
                fronts.push(middle);
            }
            before = (middle, own);
        }
        let front = front(&fronts, middle(points.iter().map(|p| p.angle)));
        points.iter_mut().for_each(|p| p.angle -= front);
        points
    }

    fn strip(&self, joins: &Joins, in_front: &[usize]) -> Vec<(usize, V2)> {
        let up = joins.up(self.members[0].piece, V2::y());
        let upright = Rotation2::rotation_between(&up, &V2::y());
        let upright = |member: &Member| -> Vec<(usize, V2)> {
            member.places(joins).into_iter().map(|(v, p)| (v, upright * p.coords)).collect()
        };
        let members: Vec<Vec<(usize, V2)>> = self.members.iter().map(upright).collect();
        let in_front = self.members.iter().zip(&members).filter(|(member, _)| in_front.contains(&member.piece));
        let fronts: Vec<f64> = in_front.map(|(_, points)| middle(points.iter().map(|(_, p)| p.x))).collect();
        let points: Vec<(usize, V2)> = members.into_iter().flatten().collect();
        let front = front(&fronts, middle(points.iter().map(|(_, p)| p.x)));
        points.into_iter().map(|(v, p)| (v, V2::new(p.x - front, p.y))).collect()
    }
}

impl Member {
    /// In the ring's plane.
    fn places(&self, joins: &Joins) -> Vec<(usize, Point2<f64>)> {
        let vertices = joins.garment.pieces[self.piece].vertices.clone();
        vertices.map(|v| (v, self.place(joins, v))).collect()
    }

    fn place(&self, joins: &Joins, v: usize) -> Point2<f64> {
        self.motion * Point2::from(joins.garment.rest[v])
    }

    /// Angle 0 is in the piece's middle, or opposite `cut` where the piece goes all round the tip.
    fn polar(&self, joins: &Joins, tip: &Point2<f64>, cut: &Point2<f64>) -> Vec<Polar> {
        let places = self.places(joins);
        let mean: V2 = places.iter().map(|(_, p)| p - tip).sum();
        let far: f64 = places.iter().map(|(_, p)| (p - tip).norm()).sum();
        if mean.norm() >= ALL_ROUND * far {
            let polar = |(v, p): &(usize, Point2<f64>)| Polar {
                vertex: *v,
                angle: angle(&mean, &(p - tip)),
                radius: (p - tip).norm(),
            };
            return places.iter().map(polar).collect();
        }
        // Both sides of the cut lie where the angle jumps. The triangles of a vertex tell on which side of the cut it
        // is.
        let opposite = tip - cut;
        let mut within: BTreeMap<usize, V2> = BTreeMap::new();
        for triangle in &joins.garment.triangles[joins.garment.pieces[self.piece].triangles.clone()] {
            let centre = triangle.iter().map(|&v| joins.garment.rest[v]).sum::<V2>() / 3.0;
            for &v in triangle {
                *within.entry(v).or_default() += self.motion * Point2::from(centre) - tip;
            }
        }
        let polar = |(v, p): &(usize, Point2<f64>)| {
            let side = within.get(v).map_or(0.0, |within| opposite.perp(within));
            let angle = angle(&opposite, &(p - tip)).abs().copysign(side);
            Polar { vertex: *v, angle, radius: (p - tip).norm() }
        };
        places.iter().map(polar).collect()
    }
}

impl Link {
    /// Piece at the other end, and the pairs with the vertices of `piece` first.
    fn from(&self, piece: usize) -> (usize, Vec<[usize; 2]>) {
        if piece == self.pieces[0] {
            (self.pieces[1], self.pairs.clone())
        } else {
            (self.pieces[0], self.pairs.iter().map(|&[a, b]| [b, a]).collect())
        }
    }

    /// True if both links join the same pieces and share a vertex.
    fn meets(&self, other: &Self) -> bool {
        let shares = |p: &[usize; 2]| other.pairs.iter().any(|q| p[0] == q[0] || p[1] == q[1]);
        self.pieces == other.pieces && self.pairs.iter().any(shares)
    }
}

fn between_pieces(joins: &Joins, some: &[usize]) -> Vec<Link> {
    links(joins, some).into_iter().filter(|link| link.pieces[0] != link.pieces[1]).collect()
}

fn links(joins: &Joins, some: &[usize]) -> Vec<Link> {
    let link = |&[a, b]: &[usize; 2]| match [a, b].map(|v| joins.piece_of[v]) {
        [p, q] if p <= q => Link { pieces: [p, q], pairs: vec![[a, b]] },
        [p, q] => Link { pieces: [q, p], pairs: vec![[b, a]] },
    };
    let mut links: Vec<Link> = Vec::new();
    for seam in &joins.garment.seams {
        let mut parts: Vec<Link> = Vec::new();
        for pair in seam.pairs.iter().map(link).filter(|pair| pair.pieces.iter().all(|piece| some.contains(piece))) {
            match parts.last_mut() {
                Some(part) if part.pieces == pair.pieces => part.pairs.extend(pair.pairs),
                _ => parts.push(pair),
            }
        }
        for mut part in parts {
            let (joined, apart): (Vec<Link>, Vec<Link>) = links.into_iter().partition(|link| link.meets(&part));
            part.pairs.extend(joined.into_iter().flat_map(|link| link.pairs));
            links = apart;
            links.push(part);
        }
    }
    links
}

/// Counter-clockwise, rad.
fn angle(from: &V2, to: &V2) -> f64 {
    from.perp(to).atan2(from.dot(to))
}

fn mean(points: &[Point2<f64>]) -> Point2<f64> {
    Point2::from(points.iter().map(|p| p.coords).sum::<V2>() / points.len().max(1) as f64)
}

fn onto(joins: &Joins, pairs: &[[usize; 2]], placed: &Isometry2<f64>) -> Isometry2<f64> {
    let rest = &joins.garment.rest;
    let own: Vec<V2> = pairs.iter().map(|pair| rest[pair[1]]).collect();
    let goals: Vec<V2> = pairs.iter().map(|pair| (placed * Point2::from(rest[pair[0]])).coords).collect();
    Similarity::of(&own, &goals).motion()
}

fn misfit_m(joins: &Joins, pairs: &[[usize; 2]], placed: &Isometry2<f64>, motion: &Isometry2<f64>) -> f64 {
    let rest = |v: usize| Point2::from(joins.garment.rest[v]);
    let squares = pairs.iter().map(|&[a, b]| (placed * rest(a) - motion * rest(b)).norm_squared());
    (squares.sum::<f64>() / pairs.len().max(1) as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use serde_json::json;

    use super::*;
    use pattern::{Garment, garmentcode};

    /// Gores of a sector of an angle, an inner radius that is a little larger on the left half, and a length, cm; each
    /// is drawn after the motion `moved`.
    fn gores(
        count: usize,
        turn_rad: f64,
        [inner, larger]: [f64; 2],
        length: f64,
        moved: impl Fn(usize) -> Isometry2<f64>,
    ) -> Garment {
        let half = 0.5 * turn_rad / count as f64;
        let point = |k: usize, side: f64, radius: f64| {
            let p = moved(k) * (Point2::new(side * half.sin(), -half.cos()) * radius);
            [p.x, p.y]
        };
        let arc = |radius: f64, sweep: u8| json!({ "type": "circle", "params": [radius, 0, sweep] });
        let panel = |k: usize| {
            let inner = if 2 * k < count { inner } else { inner + larger };
            let outer = inner + length;
            let edges = json!([
                { "endpoints": [0, 1], "curvature": arc(outer, 1) },
                { "endpoints": [1, 2] },
                { "endpoints": [2, 3], "curvature": arc(inner, 0) },
                { "endpoints": [3, 0] }
            ]);
            let vertices = [point(k, -1.0, outer), point(k, 1.0, outer), point(k, 1.0, inner), point(k, -1.0, inner)];
            json!({ "translation": [0, 0, 0], "rotation": [0, 0, 0], "vertices": vertices, "edges": edges })
        };
        let name = |k: usize| format!("panel_{}", k % count);
        let panels: serde_json::Map<_, _> = (0..count).map(|k| (name(k), panel(k))).collect();
        let stitch = |k: usize| json!([{ "panel": name(k), "edge": 1 }, { "panel": name(k + 1), "edge": 3 }]);
        let document = json!({
            "pattern": { "panels": panels, "stitches": (0..count).map(stitch).collect::<Vec<_>>() },
            "properties": { "curvature_coords": "relative", "units_in_meter": 100 }
        });
        let read = garmentcode::read(document.to_string().as_bytes(), "gores").expect("a specification");
        read.style().mesh(0.05).expect("a mesh")
    }

    #[test]
    fn gores_are_laid_out_as_the_sector_that_they_were_cut_from() {
        let scattered = |k: usize| Isometry2::new(V2::new(150.0 * k as f64, 20.0), 2.0 * k as f64);
        let check = |count: usize, turn_rad: f64| {
            let (inner, length) = (80.0 / turn_rad, 50.0);
            let garment = gores(count, turn_rad, [inner, 0.0], length, scattered);
            let joins = Joins::of(&garment);
            let all: Vec<usize> = (0..count).collect();
            let rings = Ring::of_several(&joins, &all);
            assert_eq!(rings.len(), 1, "{count} gores");
            let flat = rings[0].flat(&joins, &[]);
            // Arcs are drawn as chords of a few degrees.
            assert!((flat.turn_rad() / turn_rad - 1.0).abs() < 0.01, "{count} gores turn by {}", flat.turn_rad());
            assert!((flat.inner_m() / 0.8 - 1.0).abs() < 0.02, "{count} gores: {} m round", flat.inner_m());
            let Flat::Sector(points) = flat else { panic!("{count} gores are no strip") };
            let places: BTreeMap<usize, (f64, f64)> =
                points.into_iter().map(|p| (p.vertex, (p.angle, p.radius))).collect();
            // Sides meet, but for one seam, which is a whole turn of the sector apart.
            for seam in &garment.seams {
                let apart = |[a, b]: &[usize; 2]| (places[a].0 - places[b].0).abs();
                let [least, most] = bounds(seam.pairs.iter().map(apart));
                let is_cut = most > 0.5 * turn_rad;
                assert!(is_cut || most < 0.03, "{}: {least} to {most} rad apart", seam.name);
                assert!(seam.pairs.iter().all(|[a, b]| (places[a].1 - places[b].1).abs() < 5e-3), "{}", seam.name);
            }
        };
        check(8, 0.25 * TAU);
        check(12, 0.9 * TAU);
        check(2, TAU);
        check(4, 1.5 * TAU);
    }

    #[test]
    fn unlike_halves_go_round_as_well() {
        for (turn_rad, larger) in [(TAU, 2.0), (TAU, -3.0), (0.95 * TAU, 1.0)] {
            let garment = gores(2, turn_rad, [15.0, larger], 55.0, |_| Isometry2::identity());
            let flat = Ring::of_several(&Joins::of(&garment), &[0, 1])[0].flat(&Joins::of(&garment), &[]);
            let turn = flat.turn_rad() / turn_rad;
            assert!((0.9..1.1).contains(&turn), "{larger} cm larger: {turn} of the turn");
        }
    }

    #[test]
    fn a_hem_off_the_middle_leaves_the_tip_at_the_waist() {
        let arc = |radius: f64, large: u8, sweep: u8| json!({ "type": "circle", "params": [radius, large, sweep] });
        // Half circles of 15 cm, 45 cm at the sides, one shorter and one longer than that in the middle.
        let panel = |outer: serde_json::Value| {
            let edges = json!([
                { "endpoints": [0, 1], "curvature": outer },
                { "endpoints": [1, 2] },
                { "endpoints": [2, 3], "curvature": arc(15.0, 0, 0) },
                { "endpoints": [3, 0] }
            ]);
            let vertices = [[-60.0, 0.0], [60.0, 0.0], [15.0, 0.0], [-15.0, 0.0]];
            json!({ "translation": [0, 0, 0], "rotation": [0, 0, 0], "vertices": vertices, "edges": edges })
        };
        let stitch = |a: &str, b: &str| json!([{ "panel": a, "edge": 1 }, { "panel": b, "edge": 3 }]);
        let document = json!({
            "pattern": {
                "panels": { "front": panel(arc(75.0, 0, 1)), "back": panel(arc(62.0, 1, 1)) },
                "stitches": [stitch("front", "back"), stitch("back", "front")]
            },
            "properties": { "curvature_coords": "relative", "units_in_meter": 100 }
        });
        let read = garmentcode::read(document.to_string().as_bytes(), "skirt").expect("a specification");
        let garment = read.style().mesh(0.05).expect("a mesh");
        let joins = Joins::of(&garment);
        let flat = Ring::of_several(&joins, &[0, 1])[0].flat(&joins, &[]);
        assert!((flat.turn_rad() / TAU - 1.0).abs() < 0.01, "{} rad round", flat.turn_rad());
        assert!((flat.inner_m() / (0.15 * TAU) - 1.0).abs() < 0.03, "{} m at the waist", flat.inner_m());
    }

    #[test]
    fn straight_gores_are_a_strip() {
        let garment = gores(6, 0.02, [4000.0, 0.0], 50.0, |k| Isometry2::new(V2::new(30.0 * k as f64, 4000.0), 0.0));
        let joins = Joins::of(&garment);
        let rings = Ring::of_several(&joins, &[0, 1, 2, 3, 4, 5]);
        let flat = rings[0].flat(&joins, &[]);
        assert!(matches!(flat, Flat::Strip(_)));
        assert!((flat.inner_m() - 0.81).abs() < 0.01, "{} m", flat.inner_m());
        // Six gores of 0.135 m, from the left.
        let check = |in_front: &[usize], ends: [f64; 2]| {
            let Flat::Strip(points) = rings[0].flat(&joins, in_front) else { panic!("{in_front:?}: no strip") };
            let found = bounds(points.iter().map(|(_, p)| p.x));
            let is_there = found.iter().zip(ends).all(|(found, end)| (found - end).abs() < 5e-3);
            assert!(is_there, "{in_front:?} in front: {found:?} m to the right of the middle instead of {ends:?}");
        };
        check(&[], [-0.405, 0.405]);
        check(&[0], [-0.0675, 0.7425]);
        check(&[4], [-0.6075, 0.2025]);
        check(&[2, 3], [-0.405, 0.405]);
    }

    #[test]
    fn a_row_is_no_ring() {
        let garment = gores(4, 0.3 * TAU, [40.0, 0.0], 50.0, |_| Isometry2::identity());
        let joins = Joins::of(&garment);
        assert!(Ring::of_several(&joins, &[0, 1, 2]).is_empty());
        assert!(Ring::of_one(&joins, &[0, 1, 2, 3]).is_empty());
    }
}
