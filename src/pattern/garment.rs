//! A garment ready to sew: triangulated pieces in their own planes, seams as vertex pairs, measurement paths.
//!
//! Every piece is drawn seen from its outside, `v` up towards the neck (against the direction in which the garment
//! hangs), so that counter-clockwise triangles face outwards once sewn.

use std::collections::BTreeMap;
use std::ops::Range;

use geom::{V2, V3};

/// What a piece is worn as; decides how it is placed about the body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Role {
    /// Front of the trunk.
    Front,
    /// Back of the trunk.
    Back,
    /// Sleeve of the subject's right arm.
    SleeveRight,
    /// Sleeve of the subject's left arm.
    SleeveLeft,
    /// Front of the right leg.
    LegFrontRight,
    /// Front of the left leg.
    LegFrontLeft,
    /// Back of the right leg.
    LegBackRight,
    /// Back of the left leg.
    LegBackLeft,
    /// Right leg in one piece.
    LegRight,
    /// Left leg in one piece.
    LegLeft,
    /// Front of a bodice that ends in a seam.
    BodiceFront,
    /// Back of a bodice that ends in a seam.
    BodiceBack,
    /// Front of a skirt.
    SkirtFront,
    /// Back of a skirt.
    SkirtBack,
    /// Band round the waist.
    Waistband,
    /// None of these, or not known.
    Other,
}

impl Role {
    /// All, as they are offered.
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

    /// Its name in seam files.
    #[must_use]
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

    /// The role of a name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|role| role.as_str() == name)
    }
}

/// One triangulated piece: ranges into the garment's arrays.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct PieceMesh {
    /// Identifier within the garment (`front`, `sleeve_right`, ...).
    pub id: String,
    /// How it is worn.
    pub role: Role,
    /// Its vertices in [`Garment::rest`].
    pub vertices: Range<usize>,
    /// Its triangles in [`Garment::triangles`].
    pub triangles: Range<usize>,
    /// Unit vector of the warp (grain line) in the piece's plane.
    pub grain: V2,
    /// Vertices of the named boundary edges, counter-clockwise, both end corners included.
    pub edges: BTreeMap<String, Vec<usize>>,
}

/// A seam: pairs of garment vertices that are one vertex after sewing.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct SeamMesh {
    /// Name in the seam file.
    pub name: String,
    /// Vertex pairs, in order along the seam.
    pub pairs: Vec<[usize; 2]>,
}

impl SeamMesh {
    /// What lies between neighbouring pairs: of either side the two garment vertices. Where one side goes on to its next edge, the other
    /// may stand still or leap.
    pub fn stitches(&self) -> impl Iterator<Item = [[usize; 2]; 2]> {
        self.pairs.windows(2).map(|ends| [0, 1].map(|side| [ends[0][side], ends[1][side]]))
    }
}

/// A point of the cloth: a weighted mean of three vertices of one triangle (weights sum to 1).
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct MaterialPoint {
    /// Vertices of the triangle, by their index in the garment.
    pub vertices: [usize; 3],
    /// Barycentric weight of each vertex.
    pub weights: [f64; 3],
}

impl MaterialPoint {
    /// The point's place when the garment's vertices are at `positions`.
    #[must_use]
    pub fn at(&self, positions: &[V3]) -> V3 {
        (0..3).map(|k| positions[self.vertices[k]] * self.weights[k]).sum()
    }

    /// The point's place in its piece's plane.
    #[must_use]
    pub fn at_rest(&self, rest: &[V2]) -> V2 {
        (0..3).map(|k| rest[self.vertices[k]] * self.weights[k]).sum()
    }
}

/// A connected stretch of cloth along which is measured, within one piece.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct MaterialLine {
    /// Points in order; at least two.
    pub points: Vec<MaterialPoint>,
    /// Pattern length of each segment, m: the arc of the drawn curve, not its chord. One fewer than `points`.
    pub arc_m: Vec<f64>,
}

impl MaterialLine {
    /// Length (m) when the garment's vertices are at `positions`; `rest` are their places in the pieces' planes.
    ///
    /// Each segment stretches by the ratio of its arcs (`arcs`); that ratio scales the arc of the drawn curve, so that an
    /// unstretched garment has its pattern length exactly, however coarse its mesh.
    #[must_use]
    pub fn length_m(&self, rest: &[V2], positions: &[V3]) -> f64 {
        let ways = |points: &[V3]| -> Vec<V3> { points.windows(2).map(|ends| ends[1] - ends[0]).collect() };
        let flat = ways(&self.points.iter().map(|p| p.at_rest(rest).push(0.0)).collect::<Vec<_>>());
        let draped = ways(&self.points.iter().map(|p| p.at(positions)).collect::<Vec<_>>());
        let steps: Vec<f64> = flat.iter().map(V3::norm).collect();
        let [flat, draped] = [flat, draped].map(|ways| arcs(&ways, &steps));
        self.arc_m.iter().zip(flat.iter().zip(&draped)).map(|(arc, (flat, draped))| arc * draped / flat).sum()
    }

    /// The line in a garment whose vertices are called otherwise.
    fn renumbered(&self, name: impl Fn(&usize) -> usize) -> Self {
        let point = |point: &MaterialPoint| MaterialPoint { vertices: point.vertices.map(|v| name(&v)), ..*point };
        Self { points: self.points.iter().map(point).collect(), ..self.clone() }
    }

    /// The line after its cloth was drawn elsewhere.
    fn redrawn(&self, before: &[V2], after: &[V2]) -> Self {
        let chords = |rest: &[V2]| -> Vec<f64> {
            self.points.windows(2).map(|ends| (ends[1].at_rest(rest) - ends[0].at_rest(rest)).norm()).collect()
        };
        let ratios = chords(after).into_iter().zip(chords(before)).map(|(after, before)| after / before);
        Self { arc_m: self.arc_m.iter().zip(ratios).map(|(arc, ratio)| arc * ratio).collect(), ..self.clone() }
    }
}

/// Greatest excess of a squared arc over a share of the squared step.
const MOST_EXCESS: f64 = 0.1;

/// Lengths of the arcs along a smooth line that goes these `ways` from point to point, and is `steps` long between them where it is not
/// stretched, m.
fn arcs(ways: &[V3], steps: &[f64]) -> Vec<f64> {
    ways.iter().zip(excesses(ways, steps)).map(|(way, excess)| (way.norm_squared() + excess).sqrt()).collect()
}

/// By how much the squared arcs between points of a smooth line exceed the squared chords, m2: the line goes these `ways` from point to
/// point, and is `steps` long between them where it is not stretched.
///
/// A chord of a circle is shorter than its arc: squared, by the fourth power of the step times the squared curvature over 12. Curvature at
/// a point is told by the ways to its neighbours, along a step by the mean of its ends.
#[must_use]
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

/// Whether a measurement goes once round or from one end to another.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MeasurementKind {
    /// A closed loop round body or limb.
    ClosedGirth,
    /// A length with two ends.
    OpenLength,
}

/// A measurement of the style, laid on the mesh.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Measurement {
    /// Number in the style (`#1` ...).
    pub no: u32,
    /// Name in the style, such as `Neck Opening`.
    pub name: String,
    /// Loop or length.
    pub kind: MeasurementKind,
    /// Whether it runs along an edge that no seam holds.
    pub is_free_edge: bool,
    /// Pattern length L2D, m: the sum of all arcs.
    pub l2d_m: f64,
    /// Where it runs; the lengths of the runs add up.
    pub runs: Vec<MaterialLine>,
}

impl Measurement {
    /// Length L3D (m) when the garment's vertices are at `positions`; `rest` are their places in the pieces' planes.
    #[must_use]
    pub fn length_m(&self, rest: &[V2], positions: &[V3]) -> f64 {
        self.runs.iter().map(|run| run.length_m(rest, positions)).sum()
    }
}

/// Girth of the pattern at a body level, from the style's fit-reference measurement.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct FitLevel {
    /// Body level (`chest`, `hip`, ...).
    pub level: String,
    /// Pattern girth there, m.
    pub girth_m: f64,
    /// Where it runs on the mesh, the lengths adding up; empty where it does not lie on the cloth throughout.
    #[serde(default)]
    pub runs: Vec<MaterialLine>,
}

/// What strengthens an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Band {
    /// A knitted rib, often cut shorter than the edge it is sewn to.
    Rib,
    /// A tape sewn along.
    Tape,
    /// The edge turned over and sewn.
    Hem,
    /// A band round the waist.
    Waistband,
}

/// A strengthened stretch of an edge.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Reinforcement {
    /// What strengthens it.
    pub band: Band,
    /// Force per relative elongation, N.
    pub stiffness_n: f64,
    /// Length of the band over that of the edge.
    pub length_factor: f64,
    /// Garment vertices along the edge, in order.
    pub vertices: Vec<usize>,
}

/// A sewable garment of one size, meshed.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Garment {
    /// Name of the style, from its seam file.
    pub name: String,
    /// Name of the size; empty where the file names none.
    pub size: String,
    /// Pieces with the ranges of their vertices and triangles.
    pub pieces: Vec<PieceMesh>,
    /// Vertex positions in their pieces' planes, m.
    pub rest: Vec<V2>,
    /// Vertices of each triangle, counter-clockwise seen from outside.
    pub triangles: Vec<[usize; 3]>,
    /// Seams as pairs of vertices that become one.
    pub seams: Vec<SeamMesh>,
    /// Measurements of the style, laid on the mesh.
    pub measurements: Vec<Measurement>,
    /// Pattern girths for the fit.
    pub fit_levels: Vec<FitLevel>,
    /// Edges that a band strengthens, as chains of vertices.
    #[serde(default)]
    pub reinforcements: Vec<Reinforcement>,
    /// Edge length asked of the mesher, m.
    pub edge_length_m: f64,
}

/// A place on a piece, as messages name it.
#[derive(Clone, Debug, PartialEq)]
pub struct Spot {
    /// Identifier of the piece.
    pub piece: String,
    /// Point of the piece's plane, m.
    pub at: V2,
}

impl std::fmt::Display for Spot {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} about ({:.0}, {:.0}) mm", self.piece, 1e3 * self.at.x, 1e3 * self.at.y)
    }
}

impl Garment {
    /// Where some vertices lie: the piece that holds most of them, and the middle of those; `None` where there are none.
    #[must_use]
    pub fn spot(&self, vertices: &[usize]) -> Option<Spot> {
        let of = |piece: &PieceMesh| -> Vec<V2> {
            vertices.iter().filter(|v| piece.vertices.contains(v)).map(|&v| self.rest[v]).collect()
        };
        let held = self.pieces.iter().rev().map(|piece| (piece, of(piece)));
        let (piece, points) = held.filter(|(_, points)| !points.is_empty()).max_by_key(|(_, points)| points.len())?;
        Some(Spot { piece: piece.id.clone(), at: points.iter().sum::<V2>() / points.len() as f64 })
    }

    /// Garments as one, sewn to each other nowhere: pieces, vertices and triangles in their order.
    #[must_use]
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

    /// The garment with its vertices elsewhere in their pieces' planes: arcs of measurements change as their chords do.
    #[must_use]
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

    /// The garment without some of its pieces, measured nowhere, and for each of its vertices the one that it was.
    #[must_use]
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
