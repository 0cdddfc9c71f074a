//! Levels at which a garment is too small to close on the body, whatever a simulator makes of it: stretched cloth or cloth
//! inside the body.
//!
//! A level plane cuts the draped cloth in a ring round the trunk. The length of that ring on the flat pattern is the
//! girth of the garment there.

use std::collections::BTreeMap;
use std::fmt;

use body::{Body, Joint};
use geom::units::mm;
use geom::{V2, V3};
use pattern::{Garment, Role};
use sim::cloth::law::Fibre;
use sim::{Fabric, sewing};

/// Least shortfall that is told: people and patterns are measured to 5 mm.
const LEAST_M: f64 = 5e-3;
/// Tension round the trunk up to which cloth is worn stretched, N/m: a third of a kilopascal on a waist of 0.9 m, far
/// below what a waistband presses with. Light cotton stretches by 2 % under it, an interlock by two thirds.
const WORN_N_M: f64 = 50.0;
/// Distance of the planes that are tried above and below a level.
const STEP_M: f64 = 10e-3;
/// Directions from the axis of the trunk, in each of which a ring must lie.
const DIRECTIONS: usize = 72;

#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct TooSmall {
    pub level: String,
    pub height_m: f64,
    /// Tape girth of the body.
    pub body_girth_m: f64,
    /// Length on the pattern of the cloth that goes round the body.
    pub garment_girth_m: f64,
}

impl TooSmall {
    pub fn shortfall_m(&self) -> f64 {
        self.body_girth_m - self.garment_girth_m
    }
}

impl fmt::Display for TooSmall {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [lacks, cloth, round] = [self.shortfall_m(), self.garment_girth_m, self.body_girth_m].map(mm);
        write!(f, "too small at the {} by {lacks:.0} mm: {cloth:.0} mm of cloth go round {round:.0} mm", self.level)
    }
}

/// Levels at which a draped garment is too small, from the chest down: at the level itself, or, where no cloth goes round
/// it, where the most is lacking nearer to this level than to its neighbours. `positions` in m.
pub fn too_small(body: &Body, garment: &Garment, fabric: &Fabric, positions: &[V3]) -> Vec<TooSmall> {
    let levels = &body.levels;
    let named = [
        ("chest", levels.chest_m),
        ("underbust", levels.underbust_m),
        ("waist", levels.waist_m),
        ("hip", levels.hip_m),
    ];
    let trunk = Trunk::new(body, garment, positions);
    let lacking = |level: &str, height_m: f64, ring_m: Option<f64>| {
        let garment_girth_m = ring_m?;
        let body_girth_m = body.trunk_girth_at(height_m)?;
        let found = TooSmall { level: level.to_owned(), height_m, body_girth_m, garment_girth_m };
        let is_lacking = found.shortfall_m() > LEAST_M && tension_n_m(fabric, &found) > WORN_N_M;
        is_lacking.then_some(found)
    };
    let rings_m = named.map(|(_, height_m)| trunk.ring_m(height_m));
    let mut found: Vec<Option<TooSmall>> =
        named.iter().zip(rings_m).map(|(&(level, height_m), ring_m)| lacking(level, height_m, ring_m)).collect();
    for k in 0..named.len() {
        // A band just above or below a level is told there, unless it is a part of what is told of a neighbour.
        let beside = [k.checked_sub(1), (k + 1 < named.len()).then_some(k + 1)];
        if rings_m[k].is_some() || beside.into_iter().flatten().any(|other| found[other].is_some()) {
            continue;
        }
        let (level, height_m) = named[k];
        let to = |other: Option<usize>, end: f64| other.map_or(end, |other| 0.5 * (height_m + named[other].1));
        let [above, below] = beside;
        let (low, high) = (to(below, levels.crotch_m), to(above, height_m + STEP_M));
        let count = ((high - low) / STEP_M).floor() as usize;
        let heights_m = (0..=count).map(|step| high - STEP_M * step as f64);
        let near = heights_m.filter_map(|height_m| lacking(level, height_m, trunk.ring_m(height_m)));
        found[k] = near.reduce(|most, near| if near.shortfall_m() > most.shortfall_m() { near } else { most });
    }
    found.into_iter().flatten().collect()
}

/// Tension of cloth stretched across its grain to the girth of the body.
fn tension_n_m(fabric: &Fabric, found: &TooSmall) -> f64 {
    let stretch = found.body_girth_m / found.garment_girth_m;
    let law = match fabric.stretched {
        Some(law) => Fibre::stiffening(fabric.membrane_weft_n_m, law.membrane_weft_n_m, law.stretch),
        None => Fibre::linear(fabric.membrane_weft_n_m),
    };
    stretch * law.stress(0.5 * (stretch * stretch - 1.0))
}

/// The cloth on the trunk: all pieces but sleeves.
struct Trunk<'a> {
    garment: &'a Garment,
    positions: &'a [V3],
    triangles: Vec<[usize; 3]>,
    /// Sewn vertex of each vertex.
    sewn: Vec<usize>,
    axis: V3,
}

/// Part of a section in one triangle.
struct Cut {
    /// Sewn edges of the mesh at both ends.
    edges: [[usize; 2]; 2],
    /// Directions of the ends from the axis of the trunk, radians.
    angles: [f64; 2],
    /// Length on the pattern.
    flat_m: f64,
}

impl<'a> Trunk<'a> {
    fn new(body: &Body, garment: &'a Garment, positions: &'a [V3]) -> Self {
        let pieces = garment.pieces.iter().filter(|p| !matches!(p.role, Role::SleeveRight | Role::SleeveLeft));
        let triangles = pieces.flat_map(|piece| &garment.triangles[piece.triangles.clone()]).copied().collect();
        Self { garment, positions, triangles, sewn: sewing::welded(garment), axis: body.skeleton.at(Joint::Waist) }
    }

    /// Length on the pattern of the shortest ring that a level plane cuts; `None` without a ring.
    fn ring_m(&self, height_m: f64) -> Option<f64> {
        let cuts: Vec<Cut> = self.triangles.iter().filter_map(|triangle| self.cut(triangle, height_m)).collect();
        let rings = connected(&cuts).into_iter().filter(|part| goes_round(part.iter().map(|&cut| &cuts[cut])));
        rings.map(|ring| ring.iter().map(|&cut| cuts[cut].flat_m).sum::<f64>()).reduce(f64::min)
    }

    fn cut(&self, triangle: &[usize; 3], height_m: f64) -> Option<Cut> {
        let mut ends: Vec<([usize; 2], f64, V2)> = Vec::new();
        for k in 0..3 {
            let (a, b) = (triangle[k], triangle[(k + 1) % 3]);
            let (below, above) = (self.positions[a].z - height_m, self.positions[b].z - height_m);
            if (below < 0.0) == (above < 0.0) {
                continue;
            }
            let share = below / (below - above);
            let at = self.positions[a].lerp(&self.positions[b], share) - self.axis;
            let (u, v) = (self.sewn[a], self.sewn[b]);
            let flat = self.garment.rest[a].lerp(&self.garment.rest[b], share);
            ends.push(([u.min(v), u.max(v)], at.y.atan2(at.x), flat));
        }
        let [(first, from, a), (second, to, b)] = ends[..] else { return None };
        Some(Cut { edges: [first, second], angles: [from, to], flat_m: (b - a).norm() })
    }
}

/// Groups of cuts that share edges.
fn connected(cuts: &[Cut]) -> Vec<Vec<usize>> {
    let mut of_edge: BTreeMap<[usize; 2], Vec<usize>> = BTreeMap::new();
    for (number, cut) in cuts.iter().enumerate() {
        cut.edges.iter().for_each(|edge| of_edge.entry(*edge).or_default().push(number));
    }
    let mut is_found = vec![false; cuts.len()];
    let mut groups = Vec::new();
    for start in 0..cuts.len() {
        if std::mem::replace(&mut is_found[start], true) {
            continue;
        }
        let mut group = vec![start];
        let mut at = 0;
        while let Some(&number) = group.get(at) {
            for &other in cuts[number].edges.iter().flat_map(|edge| &of_edge[edge]) {
                if !std::mem::replace(&mut is_found[other], true) {
                    group.push(other);
                }
            }
            at += 1;
        }
        groups.push(group);
    }
    groups
}

/// True if cuts lie in every direction from the axis.
fn goes_round<'c>(cuts: impl Iterator<Item = &'c Cut>) -> bool {
    let mut is_covered = [false; DIRECTIONS];
    let bin = std::f64::consts::TAU / DIRECTIONS as f64;
    for cut in cuts {
        let [from, to] = cut.angles;
        // The short way between both ends.
        let way = (to - from + std::f64::consts::PI).rem_euclid(std::f64::consts::TAU) - std::f64::consts::PI;
        let steps = 1 + (way.abs() / bin).ceil() as usize;
        for step in 0..=steps {
            let angle = (from + way * step as f64 / steps as f64).rem_euclid(std::f64::consts::TAU);
            is_covered[(angle / bin) as usize % DIRECTIONS] = true;
        }
    }
    is_covered.iter().all(|is_covered| *is_covered)
}

#[cfg(test)]
mod tests {
    use super::*;
    use body::{Measurements, Sex};
    use pattern::garmentcode;
    use serde_json::{Value, json};
    use sim::fabric;

    /// Tube of two panels, 30 cm long.
    fn tube(girth_cm: f64) -> Garment {
        let half = 0.5 * girth_cm;
        let edges: Vec<Value> = (0..4).map(|k| json!({ "endpoints": [k, (k + 1) % 4] })).collect();
        let panel = |z: f64| {
            let corners = [[0.0, 0.0], [half, 0.0], [half, 30.0], [0.0, 30.0]];
            json!({ "translation": [0, 0, z], "rotation": [0, 0, 0], "vertices": corners, "edges": edges })
        };
        let side = |panel: &str, edge: usize| json!({ "panel": panel, "edge": edge });
        let document = json!({
            "pattern": {
                "panels": { "skirt_front": panel(20.0), "skirt_back": panel(-20.0) },
                "stitches": [
                    [side("skirt_front", 1), side("skirt_back", 3)],
                    [side("skirt_front", 3), side("skirt_back", 1)]
                ]
            },
            "properties": { "curvature_coords": "relative", "units_in_meter": 100 }
        });
        let read = garmentcode::read(document.to_string().as_bytes(), "tube").expect("a specification");
        read.style().mesh(0.04).expect("a mesh")
    }

    #[test]
    fn a_tube_is_too_small_where_the_body_is_wider_than_its_cloth() {
        let body = body::build(&Measurements::of(Sex::Female, 1.65)).expect("a body");
        let axis = body.skeleton.at(Joint::Waist);
        let hip_m = body.trunk_girth_at(body.levels.hip_m).expect("a girth");
        // Stretched round the body, or drawn on a circle of its own size inside: the pattern counts.
        let check = |garment: &Garment, radius_m: f64, fabric: &str, expect: Option<f64>| {
            let [left, right] = garment.rest.iter().fold([f64::MAX, f64::MIN], |[l, r], p| [l.min(p.x), r.max(p.x)]);
            let low = garment.rest.iter().map(|p| p.y).fold(f64::MAX, f64::min);
            let mut positions = vec![V3::zeros(); garment.rest.len()];
            for piece in &garment.pieces {
                let turn = if piece.role == Role::SkirtBack { 1.0 } else { 0.0 };
                for &v in garment.triangles[piece.triangles.clone()].iter().flatten() {
                    let p = garment.rest[v];
                    let angle = std::f64::consts::PI * (turn + (p.x - left) / (right - left));
                    let at =
                        V3::new(radius_m * angle.cos(), radius_m * angle.sin(), p.y - low + body.levels.hip_m - 0.15);
                    positions[v] = V3::new(axis.x, axis.y, 0.0) + at;
                }
            }
            let fabric = fabric::library().into_iter().find(|known| known.name == fabric).expect("a fabric");
            let found = too_small(&body, garment, &fabric, &positions);
            let lacks = found.iter().find(|found| found.level == "hip").map(TooSmall::shortfall_m);
            match expect {
                Some(expect) => {
                    assert!(lacks.is_some_and(|lacks| (lacks - expect).abs() < 1e-3), "{lacks:?}, {expect}")
                }
                None => assert_eq!(lacks, None),
            }
        };
        let (small, wide) = (tube(100.0 * hip_m - 8.0), tube(100.0 * hip_m + 8.0));
        check(&small, hip_m / std::f64::consts::TAU, "cotton_shirting_light", Some(0.08));
        check(&small, 0.8 * hip_m / std::f64::consts::TAU, "cotton_shirting_light", Some(0.08));
        check(&small, hip_m / std::f64::consts::TAU, "interlock_tshirt", None);
        check(&wide, 0.8 * hip_m / std::f64::consts::TAU, "cotton_shirting_light", None);
    }
}
