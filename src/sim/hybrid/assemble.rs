//! Pieces joined for the mapping: all that lie on one side of the trunk, on one leg or on one arm become one piece.
//!
//! Fronts cut in halves or with darts, skirts with their waistbands and sleeves in two pieces are sewn together
//! beforehand. They are laid flat again with least distortion, as rigid as possible. Pieces that only hang on such
//! pieces (cuffs, collars, bands that join both legs) are left to [`super::continuation`].

use std::collections::{BTreeMap, BTreeSet};

use super::elastic::{Controls, Elastic, Pull};
use crate::sewing;
use geom::{V2, V3};
use pattern::{Garment, PieceMesh, Role, SeamMesh};

geom::constants! {
    "hybrid.assemble",
    const FLATTENING: u32 = 12;
    /// Weight of a vertex's place meanwhile, over that of its triangles: just enough to keep the pieces where they are.
    const HOLD: f64 = 1e-6;
}

/// Garment in as few pieces as the body needs.
#[derive(Clone, Debug)]
pub struct Assembly {
    /// Joined pieces, flat, with the seams that are still open; without measurements.
    pub garment: Garment,
    /// Vertex of the joined pieces for each of the garment as cut; `None` on pieces that follow.
    pub vertex_of: Vec<Option<usize>>,
    pub followers: Vec<usize>,
}

struct Stretch {
    pieces: [usize; 2],
    name: String,
    pairs: Vec<[usize; 2]>,
}

pub fn assemble(garment: &Garment) -> Assembly {
    let stretches = stretches(garment);
    let parts = parts(garment, &stretches);
    let marks = Marks::new(garment, &stretches, &parts);
    let is_inner = |s: &Stretch| {
        let [a, b] = s.pieces.map(|p| parts[p]);
        a.is_some() && a == b && closes(garment, &marks, a, s)
    };
    let (inner, outer): (Vec<Stretch>, Vec<Stretch>) = stretches.into_iter().partition(is_inner);
    let sewn = sewing::welded(&Garment { seams: seams(&inner, |v| v), ..garment.clone() });
    let groups = groups(&parts, &inner);
    let flat = flat(garment, &sewn, &groups, &inner);
    Numbered::new(garment, &sewn, &groups).assembly(garment, &parts, &groups, &flat, &outer, &marks)
}

/// Seams, parted where a side goes over to another piece.
fn stretches(garment: &Garment) -> Vec<Stretch> {
    let piece_of = |v: usize| garment.pieces.iter().position(|p| p.vertices.contains(&v)).unwrap_or(usize::MAX);
    let mut found: Vec<Stretch> = Vec::new();
    for seam in &garment.seams {
        let mut last = None;
        for &pair in &seam.pairs {
            let pieces = pair.map(piece_of);
            if last != Some(pieces) {
                found.push(Stretch { pieces, name: seam.name.clone(), pairs: Vec::new() });
                last = Some(pieces);
            }
            if let Some(stretch) = found.last_mut() {
                stretch.pairs.push(pair);
            }
        }
    }
    found
}

/// Part of the body that each piece lies on, named by a role; `None` for pieces that follow.
fn parts(garment: &Garment, stretches: &[Stretch]) -> Vec<Option<Role>> {
    let own = |p: &PieceMesh| (!matches!(p.role, Role::Waistband | Role::Other)).then_some(p.role);
    let mut parts: Vec<Option<Role>> = garment.pieces.iter().map(own).collect();
    if parts.iter().all(Option::is_none) {
        // Of a garment without roles, as a circle skirt, the largest piece goes round the trunk.
        let largest = (0..parts.len()).max_by_key(|&p| garment.pieces[p].triangles.len());
        if let Some(largest) = largest {
            parts[largest] = Some(Role::Other);
        }
        return parts;
    }
    let worn = parts.clone();
    for (band, part) in parts.iter_mut().enumerate().filter(|(p, _)| garment.pieces[*p].role == Role::Waistband) {
        let sides = |s: &Stretch| match s.pieces {
            [a, b] if a == band => worn[b],
            [a, b] if b == band => worn[a],
            _ => None,
        };
        let on: BTreeSet<Role> = stretches.iter().filter_map(sides).collect();
        let is_skirt = |role: &&Role| matches!(role, Role::SkirtFront | Role::SkirtBack);
        let skirts: Vec<&Role> = on.iter().filter(is_skirt).collect();
        let is_leg = |role: &Role| super::features::is_leg(*role);
        *part = match (skirts.as_slice(), on.iter().collect::<Vec<_>>().as_slice()) {
            ([skirt], _) => Some(**skirt),
            ([], [trunk]) if !is_leg(trunk) => Some(**trunk),
            _ => None,
        };
    }
    parts
}

/// Points at which the underarm seams of sleeves meet the trunk.
struct Marks {
    welded: Vec<usize>,
    /// Welded vertices at which sleeves in pieces are left open: those at the sides of the trunk, or the nearest to
    /// them.
    roots: BTreeSet<usize>,
}

impl Marks {
    fn new(garment: &Garment, stretches: &[Stretch], parts: &[Option<Role>]) -> Self {
        let welded = sewing::welded(garment);
        let sides = sides(garment, stretches, &welded);
        let mut roots = BTreeSet::new();
        for sleeve in [Role::SleeveRight, Role::SleeveLeft] {
            let is_within =
                |s: &&Stretch| s.pieces[0] != s.pieces[1] && s.pieces.iter().all(|p| parts[*p] == Some(sleeve));
            let ends = stretches.iter().filter(is_within).flat_map(|s| [s.pairs[0][0], s.pairs[s.pairs.len() - 1][0]]);
            let ends: Vec<(usize, f64)> =
                ends.map(|v| (welded[v], off_side_m(garment, &welded, &sides, welded[v]))).collect();
            let nearest = ends.iter().map(|end| end.1).fold(f64::MAX, f64::min);
            roots.extend(ends.iter().filter(|end| end.1 == nearest && nearest < f64::MAX).map(|end| end.0));
        }
        Self { welded, roots }
    }

    fn is_underarm(&self, stretch: &Stretch) -> bool {
        stretch.pairs.iter().any(|pair| self.roots.contains(&self.welded[pair[0]]))
    }
}

fn is_sleeve(role: Role) -> bool {
    matches!(role, Role::SleeveRight | Role::SleeveLeft)
}

fn off_side_m(garment: &Garment, welded: &[usize], sides: &BTreeSet<usize>, sewn: usize) -> f64 {
    let mut nearest = f64::MAX;
    for piece in garment.pieces.iter().filter(|p| !is_sleeve(p.role)) {
        let places = |is_wanted: &dyn Fn(usize) -> bool| -> Vec<V2> {
            piece.vertices.clone().filter(|&v| is_wanted(welded[v])).map(|v| garment.rest[v]).collect()
        };
        let at_sides = places(&|w| sides.contains(&w));
        for own in places(&|w| w == sewn) {
            nearest = at_sides.iter().map(|side| (side - own).norm()).fold(nearest, f64::min);
        }
    }
    nearest
}

fn sides(garment: &Garment, stretches: &[Stretch], welded: &[usize]) -> BTreeSet<usize> {
    use super::features::{Face, face};
    let mut sides = BTreeSet::new();
    for stretch in stretches {
        let faces = stretch.pieces.map(|p| face(garment.pieces[p].role));
        if !matches!(faces, [Face::Front, Face::Back] | [Face::Back, Face::Front]) {
            continue;
        }
        let ends = [stretch.pairs[0][0], stretch.pairs[stretch.pairs.len() - 1][0]].map(|v| garment.rest[v]);
        let chord = ends[1] - ends[0];
        if chord.y.abs() > chord.x.abs() {
            sides.extend(stretch.pairs.iter().map(|pair| welded[pair[0]]));
        }
    }
    sides
}

/// True if a stretch between pieces of one part is sewn beforehand. A dart is; the seam that makes a tube of a sleeve
/// is not.
fn closes(garment: &Garment, marks: &Marks, part: Option<Role>, stretch: &Stretch) -> bool {
    let [a, b] = stretch.pieces;
    if a == b {
        let is_edge = |[v, w]: [usize; 2]| {
            let own = &garment.triangles[garment.pieces[a].triangles.clone()];
            v == w || own.iter().any(|t| t.contains(&v) && t.contains(&w))
        };
        return stretch.pairs.iter().any(|pair| is_edge(*pair));
    }
    match part {
        Some(role) if is_sleeve(role) => !marks.is_underarm(stretch),
        _ => true,
    }
}

fn seams(stretches: &[Stretch], number: impl Fn(usize) -> usize) -> Vec<SeamMesh> {
    let seam = |s: &Stretch| SeamMesh { name: s.name.clone(), pairs: s.pairs.iter().map(|p| p.map(&number)).collect() };
    stretches.iter().map(seam).collect()
}

fn groups(parts: &[Option<Role>], inner: &[Stretch]) -> Vec<Vec<usize>> {
    let mut group: Vec<usize> = (0..parts.len()).collect();
    for stretch in inner {
        let [a, b] = stretch.pieces.map(|p| group[p]);
        group.iter_mut().filter(|g| **g == a.max(b)).for_each(|g| *g = a.min(b));
    }
    let mut groups: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (piece, &group) in group.iter().enumerate().filter(|(piece, _)| parts[*piece].is_some()) {
        groups.entry(group).or_default().push(piece);
    }
    groups.into_values().collect()
}

/// Places of the vertices sewn so far, in the plane of the largest piece of their group.
fn flat(garment: &Garment, sewn: &[usize], groups: &[Vec<usize>], inner: &[Stretch]) -> Vec<V2> {
    let mut laid = garment.rest.clone();
    for group in groups.iter().filter(|group| group.len() > 1) {
        beside(garment, group, inner, &mut laid);
    }
    let count = sewn.iter().max().map_or(0, |m| m + 1);
    let mut sums = vec![(V3::zeros(), 0.0); count];
    for (&v, p) in sewn.iter().zip(&laid) {
        sums[v].0 += V3::new(p.x, p.y, 0.0);
        sums[v].1 += 1.0;
    }
    let mut x: Vec<V3> = sums.into_iter().map(|(sum, n)| sum / n).collect();
    if !inner.is_empty() {
        let hold = vec![HOLD; count];
        let none = vec![V3::zeros(); count];
        if let Some(mut elastic) = Elastic::new(garment, sewn, &x, Controls::NONE, &[], vec![], hold) {
            for _ in 0..FLATTENING {
                x = elastic.step(&x, &Pull { targets: &x, loads: &none, share: 1.0, control: 1.0, closer_m: 0.0 });
            }
        }
    }
    x.into_iter().map(|p| p.xy()).collect()
}

/// Lays a group's pieces beside each other as they are sewn; the largest stays where it is.
fn beside(garment: &Garment, group: &[usize], inner: &[Stretch], laid: &mut [V2]) {
    let size = |p: &usize| garment.pieces[*p].triangles.len();
    let Some(&first) = group.iter().max_by_key(|p| size(p)) else { return };
    let mut placed = vec![first];
    while placed.len() < group.len() {
        let pairs_to = |p: usize| -> Vec<[usize; 2]> {
            let towards = |s: &Stretch| match s.pieces {
                [a, b] if a == p && placed.contains(&b) => s.pairs.clone(),
                [a, b] if b == p && placed.contains(&a) => s.pairs.iter().map(|&[v, w]| [w, v]).collect(),
                _ => vec![],
            };
            inner.iter().flat_map(towards).collect()
        };
        let open = group.iter().copied().filter(|p| !placed.contains(p));
        let Some((next, pairs)) = open.map(|p| (p, pairs_to(p))).max_by_key(|(_, pairs)| pairs.len()) else { return };
        let motion = Motion::onto(&pairs, &garment.rest, laid);
        for v in garment.pieces[next].vertices.clone() {
            laid[v] = motion.at(garment.rest[v]);
        }
        placed.push(next);
    }
}

struct Motion {
    from: V2,
    to: V2,
    turn: nalgebra::Rotation2<f64>,
}

impl Motion {
    /// Least-squares motion of the first vertices of pairs, at `rest`, onto the second, at `laid`.
    fn onto(pairs: &[[usize; 2]], rest: &[V2], laid: &[V2]) -> Self {
        let n = pairs.len().max(1) as f64;
        let from = pairs.iter().map(|&[v, _]| rest[v]).sum::<V2>() / n;
        let to = pairs.iter().map(|&[_, w]| laid[w]).sum::<V2>() / n;
        let arms = || pairs.iter().map(|&[v, w]| (rest[v] - from, laid[w] - to));
        let cross: f64 = arms().map(|(a, b)| a.perp(&b)).sum();
        let dot: f64 = arms().map(|(a, b)| a.dot(&b)).sum();
        Self { from, to, turn: nalgebra::Rotation2::new(cross.atan2(dot)) }
    }

    fn at(&self, p: V2) -> V2 {
        self.to + self.turn * (p - self.from)
    }
}

struct Numbered {
    /// By vertex sewn so far.
    number: Vec<usize>,
    vertex_of: Vec<Option<usize>>,
    ranges: Vec<std::ops::Range<usize>>,
}

impl Numbered {
    fn new(garment: &Garment, sewn: &[usize], groups: &[Vec<usize>]) -> Self {
        let mut number = vec![usize::MAX; sewn.len()];
        let mut vertex_of = vec![None; sewn.len()];
        let mut ranges = Vec::new();
        let mut count = 0;
        for group in groups {
            let first = count;
            for v in group.iter().flat_map(|&p| garment.pieces[p].vertices.clone()) {
                if number[sewn[v]] == usize::MAX {
                    number[sewn[v]] = count;
                    count += 1;
                }
                vertex_of[v] = Some(number[sewn[v]]);
            }
            ranges.push(first..count);
        }
        Self { number, vertex_of, ranges }
    }

    fn assembly(
        self,
        garment: &Garment,
        parts: &[Option<Role>],
        groups: &[Vec<usize>],
        flat: &[V2],
        outer: &[Stretch],
        marks: &Marks,
    ) -> Assembly {
        let number = |v: usize| self.vertex_of[v].unwrap_or(usize::MAX);
        let mut rest = vec![V2::zeros(); self.ranges.last().map_or(0, |r| r.end)];
        for (sewn, &v) in self.number.iter().enumerate().filter(|(_, v)| **v != usize::MAX) {
            rest[v] = flat[sewn];
        }
        let (mut triangles, mut pieces) = (Vec::new(), Vec::new());
        for (group, vertices) in groups.iter().zip(&self.ranges) {
            let first = triangles.len();
            triangles.extend(
                group
                    .iter()
                    .flat_map(|&p| &garment.triangles[garment.pieces[p].triangles.clone()])
                    .map(|t| t.map(number)),
            );
            let names: Vec<&str> = group.iter().map(|&p| garment.pieces[p].id.as_str()).collect();
            let piece = PieceMesh {
                id: names.join(" + "),
                role: parts[group[0]].unwrap_or(Role::Other),
                vertices: vertices.clone(),
                triangles: first..triangles.len(),
                grain: V2::y(),
                edges: BTreeMap::new(),
            };
            if group.len() > 1 && is_sleeve(piece.role) {
                let open = outer.iter().filter(|s| s.pieces.iter().all(|p| group.contains(p)));
                upright(&mut rest, vertices.clone(), open, marks, number);
            }
            pieces.push(piece);
        }
        let is_worn = |s: &&Stretch| s.pieces.iter().all(|p| parts[*p].is_some());
        let seams = outer.iter().filter(is_worn).map(|s| SeamMesh {
            name: s.name.clone(),
            pairs: s.pairs.iter().map(|pair| pair.map(number)).filter(|[a, b]| a != b).collect(),
        });
        let joined = Garment {
            pieces,
            rest,
            triangles,
            seams: seams.collect(),
            measurements: Vec::new(),
            fit_levels: Vec::new(),
            reinforcements: Vec::new(),
            ..garment.clone()
        };
        let followers = (0..parts.len()).filter(|&p| parts[p].is_none()).collect();
        Assembly { garment: joined, vertex_of: self.vertex_of, followers }
    }
}

/// Turns a sleeve so that its underarm seams run upright, from the opening to the trunk.
fn upright<'s>(
    rest: &mut [V2],
    vertices: std::ops::Range<usize>,
    open: impl Iterator<Item = &'s Stretch>,
    marks: &Marks,
    number: impl Fn(usize) -> usize,
) {
    let mut up = V2::zeros();
    for stretch in open {
        let [first, last] = [stretch.pairs[0], stretch.pairs[stretch.pairs.len() - 1]];
        let sign = if marks.roots.contains(&marks.welded[last[0]]) {
            1.0
        } else if marks.roots.contains(&marks.welded[first[0]]) {
            -1.0
        } else {
            continue;
        };
        for side in 0..2 {
            up += (rest[number(last[side])] - rest[number(first[side])]) * sign;
        }
    }
    if up.norm() > 0.0 {
        let turn = nalgebra::Rotation2::rotation_between(&up, &V2::y());
        rest[vertices].iter_mut().for_each(|p| *p = turn * *p);
    }
}
