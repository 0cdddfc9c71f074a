//! Phase 1: every piece onto the surface of the form (5.2).
//!
//! Features, then shortest paths between them, then the patch that the paths bound. Patch and piece are both mapped
//! harmonically onto a disc (a convex polygon on the unit circle) and thereby onto each other (cross-parameterisation,
//! 5.2.3). The thesis maps the patch onto the pattern. Armholes and necks are concave, though, and a harmonic map onto
//! a concave domain may fold. Onto a disc it is bijective.

use std::collections::BTreeMap;

use super::assemble::{Assembly, assemble};
use super::continuation;
use super::features::{self, Face, Kind, Mapped};
use super::form::Form;
use super::harmonic;
use super::locate::Locator;
use super::outline;
use super::patch::{self, Patch};
use super::path::{PathGraph, Taken};
use super::untangle::untangle;
use crate::{SimError, sewing};
use body::{Body, Region};
use geom::{TriMesh, V2, V3};
use pattern::{Garment, PieceMesh, Role};

geom::constants! {
    "hybrid.mapping",
    /// Points on each edge in path searches. Odd, so that an edge across the median plane has its middle.
    pub const PATH_POINTS: usize = 9;
    /// Cosine beyond which a face looks away from a piece's side, and the piece does not run over it.
    const AWAY: f64 = 0.4;
}

#[derive(Clone, Debug)]
pub struct OnForm {
    /// Positions of the garment vertices; the two sides of a seam coincide.
    pub positions: Vec<V3>,
    /// Triangles whose outside still faces the form.
    pub flips: usize,
    /// Faces of the form under each piece; pieces that lie side by side are joined.
    pub patches: Vec<Vec<usize>>,
}

/// Lays a garment on the form of its kind. Fails with [`SimError::CannotPlace`] and [`SimError::CannotMap`] before the
/// long computations.
pub fn map(body: &Body, garment: &Garment) -> Result<OnForm, SimError> {
    let assembly = assemble(garment);
    let joined = &assembly.garment;
    let form = match features::kind(joined)? {
        Kind::Hung => Form::hung(body),
        Kind::Legs => Form::legs(body),
        Kind::Suit => Form::suit(body),
    };
    let graph = PathGraph::new(&form.mesh, PATH_POINTS);
    let (pieces, ends): (Vec<Mapped>, Vec<Vec<usize>>) =
        features::features(body, &form, joined)?.into_iter().map(|piece| on_nodes(&graph, piece)).unzip();
    let mut paths = Paths::new(&form, &graph, ends);
    let partners = outline::partners(joined);
    let count = joined.rest.len();
    let mut laid = Laid { x: vec![V3::zeros(); count], outwards: vec![V3::zeros(); count] };
    // Trunk pieces come first: sleeves take the paths of the armholes from them.
    let mut order: Vec<usize> = (0..pieces.len()).collect();
    order.sort_by_key(|&p| features::face(joined.pieces[p].role) == Face::Round);
    let mut patches = vec![Vec::new(); pieces.len()];
    paths.find_underarms(joined, &pieces, &partners);
    for p in order {
        let cannot = |reason| SimError::CannotMap { piece: joined.pieces[p].id.clone(), reason };
        let outline = paths.outline(joined, p, &pieces[p], &partners).map_err(cannot)?;
        let patch = patch::cut(&graph, &outline.nodes).map_err(cannot)?;
        lay(joined, &joined.pieces[p], &outline, &patch, &mut laid)
            .ok_or_else(|| cannot("its patch of the body's surface has no harmonic map"))?;
        patches[p] = patch.face_of;
    }
    let (positions, flips) = spread(garment, &assembly, &laid)?;
    Ok(OnForm { positions, flips, patches })
}

/// Features of a piece with their nodes. A feature on the node of the one before is left out, as at the sides of a
/// waist that miss each other by a millimetre.
fn on_nodes(graph: &PathGraph, mut piece: Mapped) -> (Mapped, Vec<usize>) {
    let nodes: Vec<usize> = piece.features.iter().map(|f| graph.nearest(&f.place, |_| true).unwrap_or(0)).collect();
    let n = nodes.len();
    let kept: Vec<usize> = (0..n).filter(|&k| nodes[k] != nodes[(k + n - 1) % n]).collect();
    piece.features = kept.iter().map(|&k| piece.features[k]).collect();
    (piece, kept.into_iter().map(|k| nodes[k]).collect())
}

struct Outline {
    nodes: Vec<usize>,
    /// Place of each node on the circle, as a share of the whole turn.
    turns: Vec<f64>,
    boundary: Vec<OnBoundary>,
}

struct OnBoundary {
    vertex: usize,
    domain: V2,
    place: V3,
}

/// Paths on the form, each searched once: the two sides of a seam share it.
struct Paths<'a> {
    form: &'a Form,
    graph: &'a PathGraph<'a>,
    normals: Vec<V3>,
    /// Path by the two pieces that meet there and the two end nodes.
    found: BTreeMap<([usize; 2], [usize; 2]), Vec<usize>>,
    taken: Taken,
    ends: Vec<Vec<usize>>,
}

impl<'a> Paths<'a> {
    fn new(form: &'a Form, graph: &'a PathGraph<'a>, ends: Vec<Vec<usize>>) -> Self {
        let mut taken = Taken::default();
        ends.iter().flatten().for_each(|&n| taken.add_node(n));
        Self { form, graph, normals: form.mesh.triangle_normals(), found: BTreeMap::new(), taken, ends }
    }

    fn outline(
        &mut self,
        garment: &Garment,
        piece: usize,
        mapped: &Mapped,
        partners: &BTreeMap<[usize; 2], usize>,
    ) -> Result<Outline, &'static str> {
        let ring = &mapped.ring;
        let whole =
            outline::length_m(garment, ring) + (garment.rest[ring[0]] - garment.rest[ring[ring.len() - 1]]).norm();
        let ends = self.ends[piece].clone();
        let index_of = |vertex: usize| ring.iter().position(|&v| v == vertex).unwrap_or(0);
        let mut outline = Outline { nodes: Vec::new(), turns: Vec::new(), boundary: Vec::new() };
        let mut done = 0.0;
        for (k, feature) in mapped.features.iter().enumerate() {
            let next = (k + 1) % ends.len();
            let (from, to) = (index_of(feature.vertex), index_of(mapped.features[next].vertex));
            let to = if to <= from { to + ring.len() } else { to };
            let vertices: Vec<usize> = (from..=to).map(|i| ring[i % ring.len()]).collect();
            // The partner is that of the middle: the first millimetre may belong to another seam.
            let [a, b] = [vertices[(vertices.len() - 1) / 2], vertices[vertices.len().div_ceil(2)]];
            let pair = [a.min(b), a.max(b)];
            let partner = partners.get(&pair).copied().unwrap_or(usize::MAX);
            let path = self.path(garment, [piece, partner], [ends[k], ends[next]])?;
            if path.len() < 2 {
                return Err("two of its corners come to lie on one point of the body");
            }
            let share = outline::length_m(garment, &vertices) / whole;
            outline.add(self.graph, garment, &path, &vertices, done, share);
            done += share;
        }
        Ok(outline)
    }

    /// Finds the paths of the seams that a piece has with itself before all others. An underarm seam leaves the trunk
    /// between the two halves of its armhole, whose paths must not meet above it.
    fn find_underarms(&mut self, garment: &Garment, pieces: &[Mapped], partners: &BTreeMap<[usize; 2], usize>) {
        for (piece, mapped) in pieces.iter().enumerate() {
            for (k, feature) in mapped.features.iter().enumerate() {
                let index = mapped.ring.iter().position(|&v| v == feature.vertex).unwrap_or(0);
                let (a, b) = (feature.vertex, mapped.ring[(index + 1) % mapped.ring.len()]);
                if partners.get(&[a.min(b), a.max(b)]) == Some(&piece) {
                    let ends = [self.ends[piece][k], self.ends[piece][(k + 1) % mapped.features.len()]];
                    // A missing path is reported with the outline of the piece.
                    let _ = self.path(garment, [piece, piece], ends);
                }
            }
        }
    }

    fn path(&mut self, garment: &Garment, pieces: [usize; 2], ends: [usize; 2]) -> Result<Vec<usize>, &'static str> {
        let sorted = |[a, b]: [usize; 2]| [a.min(b), a.max(b)];
        let key = (sorted(pieces), sorted(ends));
        let path = match self.found.get(&key) {
            Some(path) => path.clone(),
            None => {
                let role = garment.pieces[pieces[0]].role;
                let [a, b] = key.1;
                let path = self
                    .graph
                    .shortest_within(a, b, |face| self.touches(role, face), &self.taken)
                    .or_else(|| {
                        let region = |face: usize| touches(role, self.form.regions[face]);
                        self.graph.shortest_within(a, b, region, &self.taken)
                    })
                    .ok_or("two of its corners are not connected on the part of the body that it can touch")?;
                self.taken.add(self.graph, &path);
                self.found.insert(key, path.clone());
                path
            }
        };
        Ok(if path[0] == ends[0] { path } else { path.into_iter().rev().collect() })
    }

    fn touches(&self, role: Role, face: usize) -> bool {
        can_touch(role, self.form.regions[face], &self.normals[face])
    }
}

/// By the face's region and normal (5.2.2, figure 5-12).
pub fn can_touch(role: Role, region: Region, normal: &V3) -> bool {
    let forward = normal.y / normal.norm();
    touches(role, region)
        && match features::face(role) {
            Face::Front => forward > -AWAY,
            Face::Back => forward < AWAY,
            Face::Round => true,
        }
}

fn touches(role: Role, region: Region) -> bool {
    use Region::*;
    let arm = |right: bool| match region {
        UpperArmRight | ForearmRight => right,
        UpperArmLeft | ForearmLeft => !right,
        ThighRight | ShankRight | ThighLeft | ShankLeft | Head => false,
        _ => true,
    };
    let leg = |right: bool| match region {
        ThighRight | ShankRight => right,
        ThighLeft | ShankLeft => !right,
        Pelvis | Abdomen | Chest => true,
        _ => false,
    };
    match role {
        Role::SleeveRight => arm(true),
        Role::SleeveLeft => arm(false),
        Role::LegFrontRight | Role::LegBackRight | Role::LegRight => leg(true),
        Role::LegFrontLeft | Role::LegBackLeft | Role::LegLeft => leg(false),
        _ => arm(true) || arm(false),
    }
}

impl Outline {
    fn add(&mut self, graph: &PathGraph, garment: &Garment, path: &[usize], vertices: &[usize], done: f64, share: f64) {
        let places: Vec<V3> = path.iter().map(|&node| graph.position(node)).collect();
        let arcs = cumulated(places.windows(2).map(|ends| (ends[1] - ends[0]).norm()));
        let whole = arcs[arcs.len() - 1].max(f64::MIN_POSITIVE);
        for (node, arc) in path.iter().zip(&arcs).take(path.len() - 1) {
            self.nodes.push(*node);
            self.turns.push(done + share * arc / whole);
        }
        let rest = cumulated(vertices.windows(2).map(|e| (garment.rest[e[1]] - garment.rest[e[0]]).norm()));
        let length = rest[rest.len() - 1].max(f64::MIN_POSITIVE);
        for (vertex, arc) in vertices.iter().zip(&rest).take(vertices.len() - 1) {
            let along = arc / length * whole;
            let k = arcs.partition_point(|&a| a <= along).clamp(1, arcs.len() - 1);
            let t = (along - arcs[k - 1]) / (arcs[k] - arcs[k - 1]).max(f64::MIN_POSITIVE);
            // On the chord between two nodes, so that patch and piece have the same polygon as domain.
            let turn = |node: usize| on_circle(done + share * arcs[node] / whole);
            let (domain, place) = (turn(k - 1).lerp(&turn(k), t), places[k - 1].lerp(&places[k], t));
            self.boundary.push(OnBoundary { vertex: *vertex, domain, place });
        }
    }
}

fn cumulated(lengths: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut sum = 0.0;
    std::iter::once(0.0)
        .chain(lengths.map(|l| {
            sum += l;
            sum
        }))
        .collect()
}

fn on_circle(turn: f64) -> V2 {
    let (sin, cos) = (turn * std::f64::consts::TAU).sin_cos();
    V2::new(cos, sin)
}

struct Laid {
    x: Vec<V3>,
    outwards: Vec<V3>,
}

/// `None` if piece or patch has no harmonic map.
fn lay(garment: &Garment, piece: &PieceMesh, outline: &Outline, patch: &Patch, laid: &mut Laid) -> Option<()> {
    let fixed = patch.boundary.iter().zip(&outline.turns).map(|(&v, &turn)| (v, on_circle(turn))).collect();
    let surface = harmonic::map(&patch.mesh.positions, &patch.mesh.triangles, &fixed)?;
    let first = piece.vertices.start;
    let flat: Vec<V3> = garment.rest[piece.vertices.clone()].iter().map(|p| V3::new(p.x, p.y, 0.0)).collect();
    let triangles: Vec<[usize; 3]> =
        garment.triangles[piece.triangles.clone()].iter().map(|t| t.map(|v| v - first)).collect();
    let fixed: BTreeMap<usize, V2> = outline.boundary.iter().map(|p| (p.vertex - first, p.domain)).collect();
    let domain = harmonic::map(&flat, &triangles, &fixed)?;
    let locator = Locator::new(&surface, &patch.mesh.triangles);
    for (v, place) in piece.vertices.clone().zip(domain) {
        let (t, weights) = locator.locate(place)?;
        let [a, b, c] = patch.mesh.triangles[t].map(|w| patch.mesh.positions[w]);
        laid.x[v] = a * weights[0] + b * weights[1] + c * weights[2];
        laid.outwards[v] = (b - a).cross(&(c - a)).try_normalize(0.0).unwrap_or_else(V3::zeros);
    }
    for &OnBoundary { vertex, place, .. } in &outline.boundary {
        laid.x[vertex] = place;
    }
    Some(())
}

/// Places the pieces as cut where the joined ones lie, continues them onto the others, and turns flipped triangles
/// back.
fn spread(garment: &Garment, assembly: &Assembly, laid: &Laid) -> Result<(Vec<V3>, usize), SimError> {
    let mut positions: Vec<V3> = assembly.vertex_of.iter().map(|v| v.map_or_else(V3::zeros, |v| laid.x[v])).collect();
    continuation::place(garment, &assembly.followers, &mut positions)?;
    let welded = sewing::welded(garment);
    let count = welded.iter().max().map_or(0, |m| m + 1);
    let (mut x, mut outwards, mut copies) = (vec![V3::zeros(); count], vec![V3::zeros(); count], vec![0.0; count]);
    for (v, &sewn) in welded.iter().enumerate() {
        x[sewn] += positions[v];
        copies[sewn] += 1.0;
        outwards[sewn] += assembly.vertex_of[v].map_or_else(V3::zeros, |v| laid.outwards[v]);
    }
    x.iter_mut().zip(&copies).for_each(|(sum, n)| *sum /= *n);
    let triangles: Vec<[usize; 3]> = garment.triangles.iter().map(|t| t.map(|v| welded[v])).collect();
    // Pieces that follow have their own normals.
    let own = TriMesh { positions: positions.clone(), triangles: garment.triangles.clone() }.vertex_normals();
    for &piece in &assembly.followers {
        garment.pieces[piece].vertices.clone().for_each(|v| outwards[welded[v]] += own[v]);
    }
    let flips = untangle(&triangles, &outwards, &mut x);
    welded.iter().zip(&mut positions).for_each(|(&sewn, p)| *p = x[sewn]);
    Ok((positions, flips))
}
