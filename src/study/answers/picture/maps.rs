//! What colours the cloth: stretch, tension, pressure, gap and chi, each on one fixed scale so that all pictures compare.

use nalgebra::Matrix2;

use geom::units::GRAVITY;
use geom::{TriMesh, V3};
use pattern::Garment;
use render::Scale;
use sim::cloth::Cloth;
use sim::cloth::law::Tensor;
use sim::{Fabric, SimError, sewing};

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
    /// Pressure of the cloth on the body, kPa; of FEM-GS, which alone brings the two into balance.
    Pressure,
    /// Gap between cloth and body, mm.
    Gap,
    /// chi of each measurement, along where it is measured.
    Chi,
}

/// Stretch at the ends of its colour scale, %.
const STRETCH_REACH: f64 = 8.0;
/// Tension at the end of its colour scale, N/m: a strip 1 cm wide that carries 100 g.
const TENSION_REACH: f64 = 100.0;
/// Pressure at the end of its colour scale, kPa: where clothes begin to be felt as tight; compression stockings press 2 to 4.
const PRESSURE_REACH_KPA: f64 = 2.0;
/// chi at the ends of its colour scale, to both sides of 1, as in the report's tables.
const CHI_REACH: f64 = 0.15;
/// Gap at the ends of its colour scale, mm; below 0 the cloth lies within the body.
const GAP_REACH_MM: f64 = 100.0;

impl Map {
    /// All maps.
    pub const ALL: [Self; 7] =
        [Self::Plain, Self::Check, Self::Stretch, Self::Tension, Self::Pressure, Self::Gap, Self::Chi];

    /// Name on screens and in the command line.
    #[must_use]
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Plain => "plain",
            Self::Check => "check",
            Self::Stretch => "stretch",
            Self::Tension => "tension",
            Self::Pressure => "pressure",
            Self::Gap => "gap",
            Self::Chi => "chi",
        }
    }

    /// What its colours mean; `None` where they mean nothing.
    #[must_use]
    pub fn scale(self) -> Option<Scale> {
        match self {
            Self::Plain | Self::Check => None,
            Self::Stretch => Some(Scale::diverging(0.0, STRETCH_REACH, "stretch", "%")),
            Self::Tension => Some(Scale::rising(TENSION_REACH, "tension", "N/m")),
            Self::Pressure => Some(Scale::rising(PRESSURE_REACH_KPA, "pressure", "kPa")),
            Self::Gap => Some(Scale::diverging(0.0, GAP_REACH_MM, "gap", "mm")),
            Self::Chi => Some(Scale::diverging(1.0, CHI_REACH, "chi", "")),
        }
    }
}

/// The sewn cloth of a garment, and where its vertices are when the garment's are at `positions`.
///
/// # Errors
/// When a triangle of the pattern mesh has no area.
pub(super) fn sewn(garment: &Garment, fabric: &Fabric, positions: &[V3]) -> Result<(Cloth, Vec<V3>), SimError> {
    let cloth = Cloth::new(garment, fabric, sewing::welded(garment))?;
    let x = cloth.weld(positions);
    Ok((cloth, x))
}

/// Greatest principal stretch at each vertex, % beyond 1: the root of the greater eigenvalue of `C = I + 2 E`.
pub(super) fn stretches(garment: &Garment, (cloth, x): &(Cloth, Vec<V3>)) -> Vec<f64> {
    let stretch = |strain: &Matrix2<f64>| (1.0 + 2.0 * greater_eigenvalue(strain)).max(0.0).sqrt();
    at_vertices(garment, cloth, cloth.membrane.strains(x).iter().map(|strain| 100.0 * (stretch(strain) - 1.0)))
}

/// Greatest principal tension at each vertex, N/m, never below 0: the greater eigenvalue of the Cauchy membrane force
/// `F S F^T / J`, which is that of `S C / J`.
pub(super) fn tensions(garment: &Garment, (cloth, x): &(Cloth, Vec<V3>)) -> Vec<f64> {
    let tension = |strain: Matrix2<f64>| {
        let c = Matrix2::identity() + strain * 2.0;
        let stress = cloth.membrane.material.stress(Tensor::of(&strain)).matrix();
        let area_ratio = c.determinant().max(0.0).sqrt().max(1e-6);
        (greater_eigenvalue(&(stress * c)) / area_ratio).max(0.0)
    };
    at_vertices(garment, cloth, cloth.membrane.strains(x).into_iter().map(tension))
}

/// Pressure at each vertex, kPa, never below 0: what a drape at rest needs besides its own forces and its weight to stay where
/// it is, along its normal and over its area. On the body that is what the body holds it up with; elsewhere it is near 0.
pub(super) fn pressures((cloth, x): &(Cloth, Vec<V3>)) -> Vec<f64> {
    let mut forces: Vec<V3> = cloth.masses.iter().map(|mass| V3::new(0.0, 0.0, -mass * GRAVITY)).collect();
    cloth.membrane.add_forces(x, &mut forces);
    cloth.bending.add_forces(x, &mut forces);
    cloth.bands.add_forces(x, &mut forces);
    let sewn = TriMesh { positions: x.clone(), triangles: cloth.triangles.clone() };
    let normals = sewn.vertex_normals();
    let pressing: Vec<f64> = forces.iter().zip(&normals).map(|(force, normal)| -force.dot(normal)).collect();
    let mut areas = vec![0.0; sewn.positions.len()];
    for triangle in &sewn.triangles {
        let [a, b, c] = triangle.map(|v| sewn.positions[v]);
        triangle.iter().for_each(|v| areas[*v] += (b - a).cross(&(c - a)).norm() / 6.0);
    }
    // Contacts hold single vertices: forces and areas are summed over the triangles round each.
    let mut sums = vec![(0.0, 0.0); sewn.positions.len()];
    for triangle in &sewn.triangles {
        let force: f64 = triangle.iter().map(|v| pressing[*v]).sum();
        let area: f64 = triangle.iter().map(|v| areas[*v]).sum();
        for vertex in triangle {
            sums[*vertex].0 += force;
            sums[*vertex].1 += area;
        }
    }
    let pressure = |(force, area): (f64, f64)| if area > 0.0 { (1e-3 * force / area).max(0.0) } else { 0.0 };
    cloth.vertex_of.iter().map(|v| pressure(sums[*v])).collect()
}

/// chi of the measurements at the vertices of the triangles they run through; no number elsewhere.
pub(super) fn chis(garment: &Garment, positions: &[V3]) -> Vec<f64> {
    let mut chis = vec![f64::NAN; positions.len()];
    for measurement in &garment.measurements {
        let chi = measurement.length_m(&garment.rest, positions) / measurement.l2d_m;
        for point in measurement.runs.iter().flat_map(|run| &run.points) {
            point.vertices.iter().for_each(|v| chis[*v] = chi);
        }
    }
    chis
}

/// The greater of the two real eigenvalues, from trace and determinant.
fn greater_eigenvalue(m: &Matrix2<f64>) -> f64 {
    let half = 0.5 * m.trace();
    half + (half * half - m.determinant()).max(0.0).sqrt()
}

/// A value of each triangle as the mean over the triangles round each vertex, weighted by their area: constant-strain
/// triangles alternate about the true field, their nodal mean recovers it. Vertices of no triangle get 0.
fn at_vertices(garment: &Garment, cloth: &Cloth, values: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut sums = vec![(0.0, 0.0); garment.rest.len()];
    let triangles = garment.pieces.iter().flat_map(|piece| &garment.triangles[piece.triangles.clone()]);
    for ((triangle, element), value) in triangles.zip(&cloth.membrane.elements).zip(values) {
        for vertex in triangle {
            sums[*vertex].0 += element.area * value;
            sums[*vertex].1 += element.area;
        }
    }
    sums.into_iter().map(|(sum, area)| if area > 0.0 { sum / area } else { 0.0 }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use geom::V2;
    use pattern::SeamMesh;
    use pattern::garment::{MaterialLine, MaterialPoint, Measurement, MeasurementKind, PieceMesh, Role};

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

    /// A fabric of 2 kN/m along the weft and 4 along the warp.
    fn plain() -> Fabric {
        let stiffness =
            Fabric { membrane_weft_n_m: 2000.0, membrane_warp_n_m: 4000.0, ..sim::fabric::library()[0].clone() };
        Fabric { shear_n_m: 100.0, stretched: None, ..stiffness }
    }

    fn worn(fabric: &Fabric, deform: &dyn Fn(V2) -> V3) -> (Cloth, Vec<V3>) {
        sewn(&square(), fabric, &deformed(deform)).expect("a square")
    }

    fn deformed(deform: &dyn Fn(V2) -> V3) -> Vec<V3> {
        square().rest.iter().map(|&p| deform(p)).collect()
    }

    #[test]
    fn stretch_is_that_of_the_deformation_and_blind_to_rotation() {
        let check = |deform: &dyn Fn(V2) -> V3, expected: f64| {
            let found = stretches(&square(), &worn(&plain(), deform));
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
        let check = |deform: &dyn Fn(V2) -> V3, expected: f64| {
            let found = tensions(&square(), &worn(&plain(), deform));
            assert!(found.iter().all(|t| (t - expected).abs() < 1e-9), "{found:?}, not {expected}");
        };
        // Pulled to 1.02: Green strain (1.02^2 - 1) / 2, Cauchy force 1.02 S.
        let force = |modulus: f64| modulus * (1.02f64.powi(2) - 1.0) / 2.0 * 1.02;
        check(&|p| V3::new(1.02 * p.x, 0.0, p.y), force(2000.0));
        check(&|p| V3::new(p.x, 1.02 * p.y, 0.0), force(4000.0));
        check(&|p| V3::new(0.95 * p.x, 0.9 * p.y, 0.0), 0.0);
        check(&|p| V3::new(p.y, 0.0, p.x), 0.0);
    }

    /// A tube of cloth round a cylinder, its grain up, its ends sewn together.
    fn tube(radius: f64, around: usize, rows: usize, edge: f64) -> Garment {
        let at = |row: usize, column: usize| row * (around + 1) + column;
        let mut tube = square();
        tube.rest = (0..rows * (around + 1))
            .map(|k| {
                V2::new(
                    (k % (around + 1)) as f64 * std::f64::consts::TAU * radius / around as f64,
                    (k / (around + 1)) as f64 * edge,
                )
            })
            .collect();
        tube.triangles = (0..rows - 1)
            .flat_map(|row| (0..around).map(move |column| (row, column)))
            .flat_map(|(row, column)| {
                let corners = [at(row, column), at(row, column + 1), at(row + 1, column + 1), at(row + 1, column)];
                [[corners[0], corners[1], corners[2]], [corners[0], corners[2], corners[3]]]
            })
            .collect();
        tube.pieces[0].vertices = 0..tube.rest.len();
        tube.pieces[0].triangles = 0..tube.triangles.len();
        tube.seams =
            vec![SeamMesh { pairs: (0..rows).map(|row| [at(row, 0), at(row, around)]).collect(), name: "back".into() }];
        tube
    }

    /// Hoop tension over radius [Laplace's law]: what a stretched tube presses with.
    #[test]
    fn a_stretched_tube_presses_with_its_tension_over_its_radius() {
        const RADIUS: f64 = 0.15;
        const STRETCH: f64 = 1.03;
        let tube = tube(RADIUS, 60, 12, 0.016);
        let worn = |p: &V2| {
            let (sin, cos) = (p.x / RADIUS).sin_cos();
            V3::new(STRETCH * RADIUS * cos, STRETCH * RADIUS * sin, p.y)
        };
        let positions: Vec<V3> = tube.rest.iter().map(worn).collect();
        let fabric = sim::fabric::library()[0].clone();
        let worn = sewn(&tube, &fabric, &positions).expect("a tube");
        let (found, tension) = (pressures(&worn), tensions(&tube, &worn));
        let strain = Tensor { weft: 0.5 * (STRETCH * STRETCH - 1.0), warp: 0.0, shear: 0.0 };
        let hoop = STRETCH * worn.0.membrane.material.stress(strain).weft;
        let pressure = 1e-3 * hoop / (STRETCH * RADIUS);
        // Away from the free ends, whose vertices have less cloth above or below them.
        for v in 4 * 61..8 * 61 {
            assert!((tension[v] - hoop).abs() < 0.01 * hoop, "{v}: {} N/m, not {hoop}", tension[v]);
            assert!((found[v] - pressure).abs() < 0.01 * pressure, "{v}: {} kPa, not {pressure}", found[v]);
        }
    }

    #[test]
    fn chi_stands_where_it_is_measured_and_nowhere_else() {
        let mut garment = square();
        let corner =
            |v: usize| MaterialPoint { vertices: [0, 1, 2], weights: [0, 1, 2].map(|k| f64::from(u8::from(k == v))) };
        garment.measurements = vec![Measurement {
            no: 1,
            name: "width".into(),
            kind: MeasurementKind::OpenLength,
            is_free_edge: true,
            l2d_m: 1.0,
            runs: vec![MaterialLine { points: vec![corner(0), corner(1)], arc_m: vec![1.0] }],
        }];
        let found = chis(&garment, &deformed(&|p| V3::new(1.1 * p.x, 0.0, p.y)));
        assert!(found[..3].iter().all(|chi| (chi - 1.1).abs() < 1e-12) && found[3].is_nan(), "{found:?}");
    }
}
