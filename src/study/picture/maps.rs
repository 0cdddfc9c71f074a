//! What colours the cloth: stretch, tension and gap, each on one fixed scale so that all pictures compare.

use nalgebra::Matrix2;

use crate::geom::V3;
use crate::pattern::Garment;
use crate::render::Scale;
use crate::sim::cloth::membrane::{Element, Orthotropic};

/// What colours the cloth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Map {
    /// The simulator's own colour.
    Plain,
    /// A woven check of 4 cm in the simulator's colour: it shows the grain and every distortion.
    Check,
    /// Stretch: the greatest principal stretch, in percent beyond the pattern's own size.
    Stretch,
    /// Tension: the greatest principal membrane force, N/m.
    Tension,
    /// Gap between cloth and body, mm.
    Gap,
}

/// Stretch at the ends of its colour scale, %.
const STRETCH_REACH: f64 = 8.0;
/// Tension at the end of its colour scale, N/m: a strip 1 cm wide that carries 100 g.
const TENSION_REACH: f64 = 100.0;
/// Gap at the ends of its colour scale, mm; below 0 the cloth lies within the body.
const GAP_REACH_MM: f64 = 100.0;

impl Map {
    /// All maps.
    pub const ALL: [Self; 5] = [Self::Plain, Self::Check, Self::Stretch, Self::Tension, Self::Gap];

    /// Name on screens and in the command line.
    #[must_use]
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Plain => "plain",
            Self::Check => "check",
            Self::Stretch => "stretch",
            Self::Tension => "tension",
            Self::Gap => "gap",
        }
    }

    /// What its colours mean; `None` where they mean nothing.
    #[must_use]
    pub fn scale(self) -> Option<Scale> {
        match self {
            Self::Plain | Self::Check => None,
            Self::Stretch => Some(Scale::diverging(0.0, STRETCH_REACH, "stretch", "%")),
            Self::Tension => Some(Scale::rising(TENSION_REACH, "tension", "N/m")),
            Self::Gap => Some(Scale::diverging(0.0, GAP_REACH_MM, "gap", "mm")),
        }
    }
}

/// Greatest principal stretch at each vertex, % beyond 1: the root of the greater eigenvalue of `C = F^T F`.
pub(super) fn stretches(garment: &Garment, positions: &[V3]) -> Vec<f64> {
    at_vertices(garment, |element| {
        let f = element.deformation_gradient(positions);
        100.0 * (greater_eigenvalue(&(f.transpose() * f)).sqrt() - 1.0)
    })
}

/// Greatest principal tension at each vertex, N/m, never below 0: the greater eigenvalue of the Cauchy membrane force
/// `F S F^T / J`, which is that of `S C / J`.
pub(super) fn tensions(garment: &Garment, material: &Orthotropic, positions: &[V3]) -> Vec<f64> {
    at_vertices(garment, |element| {
        let f = element.deformation_gradient(positions);
        let c = f.transpose() * f;
        let stress = material.stress(&((c - Matrix2::identity()) * 0.5));
        let area_ratio = c.determinant().max(0.0).sqrt().max(1e-6);
        (greater_eigenvalue(&(stress * c)) / area_ratio).max(0.0)
    })
}

/// The greater of the two real eigenvalues, from trace and determinant.
fn greater_eigenvalue(m: &Matrix2<f64>) -> f64 {
    let half = 0.5 * m.trace();
    half + (half * half - m.determinant()).max(0.0).sqrt()
}

/// A value of each triangle as the mean over the triangles round each vertex, weighted by their area: constant-strain
/// triangles alternate about the true field, their nodal mean recovers it. Vertices of no triangle get 0.
fn at_vertices(garment: &Garment, value: impl Fn(&Element) -> f64) -> Vec<f64> {
    let mut sums = vec![(0.0, 0.0); garment.rest.len()];
    for piece in &garment.pieces {
        for &triangle in &garment.triangles[piece.triangles.clone()] {
            let rest = triangle.map(|v| garment.rest[v]);
            let Some(element) = Element::new(triangle, rest, piece.grain) else { continue };
            let value = value(&element);
            for vertex in triangle {
                sums[vertex].0 += element.area * value;
                sums[vertex].1 += element.area;
            }
        }
    }
    sums.into_iter().map(|(sum, area)| if area > 0.0 { sum / area } else { 0.0 }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::V2;
    use crate::pattern::garment::{PieceMesh, Role};
    use crate::sim::cloth::membrane::Fibre;

    /// A square metre of cloth, its grain along `y`.
    fn square() -> Garment {
        Garment {
            name: String::new(),
            size: String::new(),
            pieces: vec![PieceMesh {
                id: "front".into(),
                role: Role::Front,
                vertices: 0..4,
                triangles: 0..2,
                grain: V2::y(),
                edges: std::collections::BTreeMap::new(),
            }],
            rest: [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(V2::from).to_vec(),
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            seams: vec![],
            measurements: vec![],
            fit_levels: vec![],
            reinforcements: vec![],
            edge_length_m: 1.0,
        }
    }

    fn deformed(deform: &dyn Fn(V2) -> V3) -> Vec<V3> {
        square().rest.iter().map(|&p| deform(p)).collect()
    }

    #[test]
    fn stretch_is_that_of_the_deformation_and_blind_to_rotation() {
        let check = |deform: &dyn Fn(V2) -> V3, expected: f64| {
            let found = stretches(&square(), &deformed(deform));
            assert!(found.iter().all(|s| (s - expected).abs() < 1e-9), "{found:?}, not {expected}");
        };
        check(&|p| V3::new(p.x, p.y, 0.0), 0.0);
        check(&|p| V3::new(0.3, -p.y, p.x), 0.0);
        check(&|p| V3::new(1.2 * p.x, 0.0, 0.9 * p.y), 20.0);
        let sheared = (1.125 + (0.125f64 * 0.125 + 0.25).sqrt()).sqrt();
        check(&|p| V3::new(p.x + 0.5 * p.y, p.y, 0.0), 100.0 * (sheared - 1.0));
    }

    #[test]
    fn tension_is_the_stiffness_along_the_pull_and_none_where_cloth_is_slack() {
        let material = Orthotropic { weft: Fibre::linear(2000.0), c12: 0.0, warp: Fibre::linear(4000.0), shear: 100.0 };
        let check = |deform: &dyn Fn(V2) -> V3, expected: f64| {
            let found = tensions(&square(), &material, &deformed(deform));
            assert!(found.iter().all(|t| (t - expected).abs() < 1e-9), "{found:?}, not {expected}");
        };
        // Pulled to 1.02: Green strain (1.02^2 - 1) / 2, Cauchy force 1.02 S.
        let force = |modulus: f64| modulus * (1.02f64.powi(2) - 1.0) / 2.0 * 1.02;
        check(&|p| V3::new(1.02 * p.x, 0.0, p.y), force(2000.0));
        check(&|p| V3::new(p.x, 1.02 * p.y, 0.0), force(4000.0));
        check(&|p| V3::new(0.95 * p.x, 0.9 * p.y, 0.0), 0.0);
        check(&|p| V3::new(p.y, 0.0, p.x), 0.0);
    }
}
