//! A garment that is ready to sew: triangulated pieces in their planes, seams as vertex pairs, measurement paths.
//!
//! Every piece is drawn as seen from outside, with `v` up towards the neck. Counter-clockwise triangles therefore face
//! outwards once sewn.

use std::collections::BTreeMap;
use std::ops::Range;

use geom::{V2, V3};

/// Part of the garment, which decides where the piece is placed about the body. Left and right are the subject's.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Role {
    Front,
    Back,
    SleeveRight,
    SleeveLeft,
    LegFrontRight,
    LegFrontLeft,
    LegBackRight,
    LegBackLeft,
    /// Leg in one piece.
    LegRight,
    /// Leg in one piece.
    LegLeft,
    /// Ends in a seam.
    BodiceFront,
    /// Ends in a seam.
    BodiceBack,
    SkirtFront,
    SkirtBack,
    Waistband,
    Other,
}

impl Role {
    /// In the order in which they are offered.
    pub const ALL: [Self; 16] = [
        Self::Front,
        Self::Back,
        Self::SleeveRight,
        Self::SleeveLeft,
        Self::LegFrontRight,
        Self::LegFrontLeft,
        Self::LegBackRight,
        Self::LegBackLeft,
        Self::LegRight,
        Self::LegLeft,
        Self::BodiceFront,
        Self::BodiceBack,
        Self::SkirtFront,
        Self::SkirtBack,
        Self::Waistband,
        Self::Other,
    ];

    /// Name in seam files.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Front => "front",
            Self::Back => "back",
            Self::SleeveRight => "sleeve_right",
            Self::SleeveLeft => "sleeve_left",
            Self::LegFrontRight => "leg_front_right",
            Self::LegFrontLeft => "leg_front_left",
            Self::LegBackRight => "leg_back_right",
            Self::LegBackLeft => "leg_back_left",
            Self::LegRight => "leg_right",
            Self::LegLeft => "leg_left",
            Self::BodiceFront => "bodice_front",
            Self::BodiceBack => "bodice_back",
            Self::SkirtFront => "skirt_front",
            Self::SkirtBack => "skirt_back",
            Self::Waistband => "waistband",
            Self::Other => "other",
        }
    }

    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|role| role.as_str() == name)
    }
}

/// One triangulated piece: its ranges in the garment's arrays.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct PieceMesh {
    /// Such as `front`, `sleeve_right`.
    pub id: String,
    pub role: Role,
    /// Range in [`Garment::rest`].
    pub vertices: Range<usize>,
    /// Range in [`Garment::triangles`].
    pub triangles: Range<usize>,
    /// Unit vector of the warp in the piece's plane.
    pub grain: V2,
    /// Vertices of the named edges, counter-clockwise, with the corners at both ends.
    pub edges: BTreeMap<String, Vec<usize>>,
}

/// Pairs of vertices that become one when sewn.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct SeamMesh {
    pub name: String,
    /// In order along the seam.
    pub pairs: Vec<[usize; 2]>,
}

impl SeamMesh {
    /// Segments between neighbouring pairs. Where one side passes a corner, the other may repeat its vertex or jump.
    pub fn stitches(&self) -> impl Iterator<Item = [[usize; 2]; 2]> {
        self.pairs.windows(2).map(|ends| [0, 1].map(|side| [ends[0][side], ends[1][side]]))
    }
}

/// Barycentric coordinates in one triangle. The weights sum to 1.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct MaterialPoint {
    pub vertices: [usize; 3],
    pub weights: [f64; 3],
}

impl MaterialPoint {
    pub fn at(&self, positions: &[V3]) -> V3 {
        (0..3).map(|k| positions[self.vertices[k]] * self.weights[k]).sum()
    }

    pub fn at_rest(&self, rest: &[V2]) -> V2 {
        (0..3).map(|k| rest[self.vertices[k]] * self.weights[k]).sum()
    }
}

/// Connected measurement line within one piece.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct MaterialLine {
    /// At least two, in order.
    pub points: Vec<MaterialPoint>,
    /// Pattern length of each segment: the arc of the drawn curve, not its chord. One fewer than `points`.
    pub arc_m: Vec<f64>,
}

impl MaterialLine {
    /// Length of the drape at `positions`: the sum of `arc_m` times the stretch of each segment, which is its arc on
    /// the drape divided by its arc in the flat mesh (`arcs`). An unstretched garment has its pattern length exactly,
    /// however coarse its mesh.
    pub fn length_m(&self, rest: &[V2], positions: &[V3]) -> f64 {
        let ways = |points: &[V3]| -> Vec<V3> { points.windows(2).map(|ends| ends[1] - ends[0]).collect() };
        let flat = ways(&self.points.iter().map(|p| p.at_rest(rest).push(0.0)).collect::<Vec<_>>());
        let draped = ways(&self.points.iter().map(|p| p.at(positions)).collect::<Vec<_>>());
        let steps: Vec<f64> = flat.iter().map(V3::norm).collect();
        let [flat, draped] = [flat, draped].map(|ways| arcs(&ways, &steps));
        self.arc_m.iter().zip(flat.iter().zip(&draped)).map(|(arc, (flat, draped))| arc * draped / flat).sum()
    }

    fn renumbered(&self, name: impl Fn(&usize) -> usize) -> Self {
        let point = |point: &MaterialPoint| MaterialPoint { vertices: point.vertices.map(|v| name(&v)), ..*point };
        Self { points: self.points.iter().map(point).collect(), ..self.clone() }
    }

    /// Each arc changes as its chord does.
    fn redrawn(&self, before: &[V2], after: &[V2]) -> Self {
        let chords = |rest: &[V2]| -> Vec<f64> {
            self.points.windows(2).map(|ends| (ends[1].at_rest(rest) - ends[0].at_rest(rest)).norm()).collect()
        };
        let ratios = chords(after).into_iter().zip(chords(before)).map(|(after, before)| after / before);
        Self { arc_m: self.arc_m.iter().zip(ratios).map(|(arc, ratio)| arc * ratio).collect(), ..self.clone() }
    }
}

/// Bound of the excess of a squared arc over its squared chord, as a share of the squared rest length. The excess e
/// saturates as e / (1 + e / bound).
const MOST_EXCESS: f64 = 0.1;

/// Arc lengths of the segments of a smooth line, m, from chord vectors `ways` and rest lengths `steps`, m.
fn arcs(ways: &[V3], steps: &[f64]) -> Vec<f64> {
    ways.iter().zip(excesses(ways, steps)).map(|(way, excess)| (way.norm_squared() + excess).sqrt()).collect()
}

/// Excess of the squared arc of each segment of a smooth line over its squared chord, m2. `ways` are the chord vectors,
/// `steps` the rest lengths of the segments, m.
///
/// For an arc of length s and curvature kappa, arc^2 - chord^2 = s^4 kappa^2 / 12 to leading order. The curvature at a
/// point is the finite difference of `way / step` on both sides. That of a segment is the mean of its ends.
pub fn excesses(ways: &[V3], steps: &[f64]) -> Vec<f64> {
    let bend = |i: usize| {
        let [before, after] = [i - 1, i].map(|k| ways[k] / steps[k].max(f64::MIN_POSITIVE));
        (after - before) * (2.0 / (steps[i - 1] + steps[i]).max(f64::MIN_POSITIVE))
    };
    let bends: Vec<V3> = (1..steps.len()).map(bend).collect();
    let excess = |i: usize| {
        let ends = [i.checked_sub(1), Some(i)].map(|k| k.and_then(|k| bends.get(k)));
        let known = ends.iter().flatten().count().max(1) as f64;
        let curvature = ends.into_iter().flatten().sum::<V3>() / known;
        let squared = steps[i].powi(2);
        let excess = squared * squared * curvature.norm_squared() / 12.0;
        excess / (1.0 + excess / (MOST_EXCESS * squared).max(f64::MIN_POSITIVE))
    };
    (0..steps.len()).map(excess).collect()
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MeasurementKind {
    ClosedGirth,
    OpenLength,
}

/// Traced on the mesh.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Measurement {
    /// 1 for `#1`.
    pub no: u32,
    pub name: String,
    pub kind: MeasurementKind,
    /// True along an edge that is in no seam.
    pub is_free_edge: bool,
    /// Pattern length: the sum of all arcs.
    pub l2d_m: f64,
    /// Lines whose lengths are summed.
    pub runs: Vec<MaterialLine>,
}

impl Measurement {
    pub fn length_m(&self, rest: &[V2], positions: &[V3]) -> f64 {
        self.runs.iter().map(|run| run.length_m(rest, positions)).sum()
    }
}

/// Pattern girth at a body level, from the `fit` entry of the style.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct FitLevel {
    /// Such as `chest` or `hip`.
    pub level: String,
    pub girth_m: f64,
    /// Lines whose lengths are summed. Empty if the path leaves the cloth somewhere.
    #[serde(default)]
    pub runs: Vec<MaterialLine>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Band {
    /// Often cut shorter than the edge it is sewn to.
    Rib,
    Tape,
    Hem,
    Waistband,
}

#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Reinforcement {
    pub band: Band,
    /// Force per relative elongation.
    pub stiffness_n: f64,
    /// Ratio of the band to the edge.
    pub length_factor: f64,
    /// In order along the edge.
    pub vertices: Vec<usize>,
}

/// A sewable garment of one size, meshed.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Garment {
    pub name: String,
    /// Empty if the file names none.
    pub size: String,
    pub pieces: Vec<PieceMesh>,
    /// Positions in the planes of the pieces, m.
    pub rest: Vec<V2>,
    /// Counter-clockwise seen from outside.
    pub triangles: Vec<[usize; 3]>,
    pub seams: Vec<SeamMesh>,
    pub measurements: Vec<Measurement>,
    pub fit_levels: Vec<FitLevel>,
    #[serde(default)]
    pub reinforcements: Vec<Reinforcement>,
    /// Target of the mesher.
    pub edge_length_m: f64,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Spot {
    pub piece: String,
    /// In the piece's plane, m.
    pub at: V2,
}

impl std::fmt::Display for Spot {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} about ({:.0}, {:.0}) mm", self.piece, 1e3 * self.at.x, 1e3 * self.at.y)
    }
}

impl Garment {
    /// Piece that holds most of the vertices, and their mean position on it. `None` without vertices.
    pub fn spot(&self, vertices: &[usize]) -> Option<Spot> {
        let points_in = |piece: &PieceMesh| -> Vec<V2> {
            vertices.iter().filter(|v| piece.vertices.contains(v)).map(|&v| self.rest[v]).collect()
        };
        let held = self.pieces.iter().rev().map(|piece| (piece, points_in(piece)));
        let (piece, points) = held.filter(|(_, points)| !points.is_empty()).max_by_key(|(_, points)| points.len())?;
        Some(Spot { piece: piece.id.clone(), at: points.iter().sum::<V2>() / points.len() as f64 })
    }

    /// Joins garments without sewing them. Pieces, vertices and triangles keep their order.
    pub fn beside(garments: &[&Self]) -> Self {
        let names: Vec<&str> = garments.iter().map(|garment| garment.name.as_str()).collect();
        let edge_length_m = garments.iter().map(|garment| garment.edge_length_m).fold(f64::MAX, f64::min);
        let mut all = Self { name: names.join(" and "), edge_length_m, ..Self::default() };
        for garment in garments {
            let (vertex, triangle) = (all.rest.len(), all.triangles.len());
            let moved = |v: &usize| v + vertex;
            let laid = |runs: &[MaterialLine]| runs.iter().map(|run| run.renumbered(moved)).collect();
            all.pieces.extend(garment.pieces.iter().map(|piece| PieceMesh {
                vertices: piece.vertices.start + vertex..piece.vertices.end + vertex,
                triangles: piece.triangles.start + triangle..piece.triangles.end + triangle,
                edges:
                    piece.edges.iter().map(|(name, edge)| (name.clone(), edge.iter().map(moved).collect())).collect(),
                ..piece.clone()
            }));
            all.rest.extend(&garment.rest);
            all.triangles.extend(garment.triangles.iter().map(|corners| corners.map(|v| v + vertex)));
            let pairs = |seam: &SeamMesh| seam.pairs.iter().map(|pair| pair.map(|v| v + vertex)).collect();
            all.seams.extend(garment.seams.iter().map(|seam| SeamMesh { pairs: pairs(seam), ..seam.clone() }));
            let measured = |m: &Measurement| Measurement { runs: laid(&m.runs), ..m.clone() };
            all.measurements.extend(garment.measurements.iter().map(measured));
            let levels = garment.fit_levels.iter().map(|level| FitLevel { runs: laid(&level.runs), ..level.clone() });
            all.fit_levels.extend(levels);
            all.reinforcements.extend(
                garment
                    .reinforcements
                    .iter()
                    .map(|band| Reinforcement { vertices: band.vertices.iter().map(moved).collect(), ..band.clone() }),
            );
        }
        all
    }

    /// Moves the vertices in the planes of their pieces. Arcs of measurements scale with their chords.
    pub fn with_rest(&self, rest: Vec<V2>) -> Self {
        let redrawn = |line: &MaterialLine| line.redrawn(&self.rest, &rest);
        let length = |runs: &[MaterialLine]| runs.iter().flat_map(|run| &run.arc_m).sum::<f64>();
        let measurements = self.measurements.iter().map(|measurement| {
            let runs: Vec<MaterialLine> = measurement.runs.iter().map(redrawn).collect();
            Measurement { l2d_m: length(&runs), runs, ..measurement.clone() }
        });
        let fit_levels = self.fit_levels.iter().map(|level| {
            let runs: Vec<MaterialLine> = level.runs.iter().map(redrawn).collect();
            let girth_m = if runs.is_empty() { level.girth_m } else { length(&runs) };
            FitLevel { girth_m, runs, ..level.clone() }
        });
        let (measurements, fit_levels) = (measurements.collect(), fit_levels.collect());
        Self { measurements, fit_levels, rest, ..self.clone() }
    }

    /// Returns the garment without the pieces and without measurements, and the original index of each vertex.
    pub fn without(&self, gone: &[usize]) -> (Self, Vec<usize>) {
        let mut kept: Vec<usize> = Vec::new();
        let mut number = vec![None; self.rest.len()];
        let mut rest = Self {
            pieces: Vec::new(),
            rest: Vec::new(),
            triangles: Vec::new(),
            seams: Vec::new(),
            measurements: Vec::new(),
            fit_levels: Vec::new(),
            reinforcements: Vec::new(),
            ..self.clone()
        };
        for (_, piece) in self.pieces.iter().enumerate().filter(|(index, _)| !gone.contains(index)) {
            let (vertex, triangle) = (kept.len(), rest.triangles.len());
            for v in piece.vertices.clone() {
                number[v] = Some(kept.len());
                kept.push(v);
            }
            let moved = |v: usize| v - piece.vertices.start + vertex;
            rest.triangles.extend(self.triangles[piece.triangles.clone()].iter().map(|corners| corners.map(moved)));
            let edges = piece.edges.iter().map(|(name, edge)| (name.clone(), edge.iter().map(|&v| moved(v)).collect()));
            rest.pieces.push(PieceMesh {
                vertices: vertex..kept.len(),
                triangles: triangle..rest.triangles.len(),
                edges: edges.collect(),
                ..piece.clone()
            });
        }
        rest.rest = kept.iter().map(|&v| self.rest[v]).collect();
        let both = |pair: &[usize; 2]| Some([number[pair[0]]?, number[pair[1]]?]);
        let seams = self
            .seams
            .iter()
            .map(|seam| SeamMesh { pairs: seam.pairs.iter().filter_map(both).collect(), ..seam.clone() });
        rest.seams = seams.filter(|seam| !seam.pairs.is_empty()).collect();
        let all = |band: &Reinforcement| {
            let vertices: Option<Vec<usize>> = band.vertices.iter().map(|&v| number[v]).collect();
            Some(Reinforcement { vertices: vertices?, ..band.clone() })
        };
        rest.reinforcements = self.reinforcements.iter().filter_map(all).collect();
        (rest, kept)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roles_are_called_as_files_call_them() {
        for role in Role::ALL {
            let written = toml::Value::try_from(role).expect("a word");
            assert_eq!(written.as_str(), Some(role.as_str()));
            assert_eq!(Role::from_name(role.as_str()), Some(role));
        }
    }
}
