//! Fields on a sewn drape: stretch, tension and contact pressure at its vertices.

use nalgebra::Matrix2;

use crate::cloth::Cloth;
use crate::cloth::law::Tensor;
use crate::{Fabric, SimError, sewing};
use geom::units::GRAVITY;
use geom::{TriMesh, V3};
use pattern::Garment;

/// Sewn garment at rest, with its mechanical model.
pub struct Sewn<'a> {
    garment: &'a Garment,
    cloth: Cloth,
    /// Vertices of a seam are merged.
    pub mesh: TriMesh,
}

impl<'a> Sewn<'a> {
    pub fn new(garment: &'a Garment, fabric: &Fabric, positions: &[V3]) -> Result<Self, SimError> {
        let cloth = Cloth::new(garment, fabric, sewing::welded(garment))?;
        let mesh = TriMesh { positions: cloth.weld(positions), triangles: cloth.triangles.clone() };
        Ok(Self { garment, cloth, mesh })
    }

    /// Averages values of the garment's vertices over those that are sewn together.
    pub fn welded(&self, values: &[f64]) -> Vec<f64> {
        let mut sums = vec![(0.0, 0.0); self.mesh.positions.len()];
        for (value, &vertex) in values.iter().zip(&self.cloth.vertex_of) {
            sums[vertex].0 += value;
            sums[vertex].1 += 1.0;
        }
        sums.into_iter().map(|(sum, count)| sum / f64::max(count, 1.0)).collect()
    }

    /// Greater principal stretch at each vertex, less 1: the root of the greater eigenvalue of `C = I + 2 E`.
    pub fn stretches_pct(&self) -> Vec<f64> {
        let stretch = |strain: &Matrix2<f64>| (1.0 + 2.0 * greater_eigenvalue(strain)).max(0.0).sqrt();
        let strains = self.cloth.membrane.strains(&self.mesh.positions);
        self.at_vertices(strains.iter().map(|strain| 100.0 * (stretch(strain) - 1.0)))
    }

    /// Greater principal tension at each vertex, at least 0: the greater eigenvalue of the Cauchy membrane force `F S
    /// F^T / J`, which equals that of `S C / J`.
    pub fn tensions_n_m(&self) -> Vec<f64> {
        let tension = |(triangle, strain): (usize, Matrix2<f64>)| {
            let c = Matrix2::identity() + strain * 2.0;
            let stress = self.cloth.membrane.law(triangle).stress(Tensor::of(&strain)).matrix();
            let area_ratio = c.determinant().max(0.0).sqrt().max(1e-6);
            (greater_eigenvalue(&(stress * c)) / area_ratio).max(0.0)
        };
        self.at_vertices(self.cloth.membrane.strains(&self.mesh.positions).into_iter().enumerate().map(tension))
    }

    /// Contact pressure at each vertex of the sewn cloth, at least 0. In equilibrium the contact force is the negative
    /// of elastic forces and weight. The pressure is its component along the vertex normal, over the area of the
    /// vertex. Away from the body it is near 0.
    pub fn welded_pressures_kpa(&self) -> Vec<f64> {
        let (cloth, x) = (&self.cloth, &self.mesh.positions);
        let mut forces: Vec<V3> = cloth.masses.iter().map(|mass| V3::new(0.0, 0.0, -mass * GRAVITY)).collect();
        cloth.add_forces(x, &mut forces);
        let normals = self.mesh.vertex_normals();
        let pressing: Vec<f64> = forces.iter().zip(&normals).map(|(force, normal)| -force.dot(normal)).collect();
        let mut areas = vec![0.0; x.len()];
        for triangle in &self.mesh.triangles {
            let [a, b, c] = triangle.map(|v| x[v]);
            triangle.iter().for_each(|v| areas[*v] += (b - a).cross(&(c - a)).norm() / 6.0);
        }
        // Contact forces act on single vertices. Forces and areas are therefore summed over the triangles around each
        // vertex.
        let mut sums = vec![(0.0, 0.0); x.len()];
        for triangle in &self.mesh.triangles {
            let force: f64 = triangle.iter().map(|v| pressing[*v]).sum();
            let area: f64 = triangle.iter().map(|v| areas[*v]).sum();
            for vertex in triangle {
                sums[*vertex].0 += force;
                sums[*vertex].1 += area;
            }
        }
        let pressure = |(force, area): (f64, f64)| if area > 0.0 { (1e-3 * force / area).max(0.0) } else { 0.0 };
        sums.into_iter().map(pressure).collect()
    }

    /// [`Self::welded_pressures_kpa`] at each vertex of the garment.
    pub fn pressures_kpa(&self) -> Vec<f64> {
        let welded = self.welded_pressures_kpa();
        self.cloth.vertex_of.iter().map(|vertex| welded[*vertex]).collect()
    }

    /// Nodal means of values per triangle, weighted by rest areas. The values of constant-strain triangles alternate
    /// about the true field, and the nodal mean recovers it. Vertices without a triangle get 0.
    fn at_vertices(&self, values: impl Iterator<Item = f64>) -> Vec<f64> {
        let garment = self.garment;
        let mut sums = vec![(0.0, 0.0); garment.rest.len()];
        let triangles = garment.pieces.iter().flat_map(|piece| &garment.triangles[piece.triangles.clone()]);
        for ((triangle, element), value) in triangles.zip(&self.cloth.membrane.elements).zip(values) {
            for vertex in triangle {
                sums[*vertex].0 += element.area * value;
                sums[*vertex].1 += element.area;
            }
        }
        sums.into_iter().map(|(sum, area)| if area > 0.0 { sum / area } else { 0.0 }).collect()
    }
}

/// From trace and determinant; both eigenvalues are real.
fn greater_eigenvalue(m: &Matrix2<f64>) -> f64 {
    let half = 0.5 * m.trace();
    half + (half * half - m.determinant()).max(0.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use geom::V2;
    use pattern::SeamMesh;
    use pattern::garment::{PieceMesh, Role};

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

    /// 2 kN/m along the weft and 4 along the warp.
    fn plain() -> Fabric {
        let stiffness =
            Fabric { membrane_weft_n_m: 2000.0, membrane_warp_n_m: 4000.0, ..crate::fabric::library()[0].clone() };
        Fabric { shear_n_m: 100.0, stretched: None, ..stiffness }
    }

    fn worn<'a>(garment: &'a Garment, deform: &dyn Fn(V2) -> V3) -> Sewn<'a> {
        let positions: Vec<V3> = garment.rest.iter().map(|&p| deform(p)).collect();
        Sewn::new(garment, &plain(), &positions).expect("a square")
    }

    #[test]
    fn stretch_is_that_of_the_deformation_and_blind_to_rotation() {
        let check = |deform: &dyn Fn(V2) -> V3, expected: f64| {
            let garment = square();
            let found = worn(&garment, deform).stretches_pct();
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
            let garment = square();
            let found = worn(&garment, deform).tensions_n_m();
            assert!(found.iter().all(|t| (t - expected).abs() < 1e-9), "{found:?}, not {expected}");
        };
        // Pulled to 1.02: Green strain (1.02^2 - 1) / 2, Cauchy force 1.02 S.
        let force = |modulus: f64| modulus * (1.02f64.powi(2) - 1.0) / 2.0 * 1.02;
        check(&|p| V3::new(1.02 * p.x, 0.0, p.y), force(2000.0));
        check(&|p| V3::new(p.x, 1.02 * p.y, 0.0), force(4000.0));
        check(&|p| V3::new(0.95 * p.x, 0.9 * p.y, 0.0), 0.0);
        check(&|p| V3::new(p.y, 0.0, p.x), 0.0);
    }

    fn tube(radius: f64, around: usize, rows: usize, edge: f64) -> Garment {
        let vertex = |row: usize, column: usize| row * (around + 1) + column;
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
                let corners = [
                    vertex(row, column),
                    vertex(row, column + 1),
                    vertex(row + 1, column + 1),
                    vertex(row + 1, column),
                ];
                [[corners[0], corners[1], corners[2]], [corners[0], corners[2], corners[3]]]
            })
            .collect();
        tube.pieces[0].vertices = 0..tube.rest.len();
        tube.pieces[0].triangles = 0..tube.triangles.len();
        let pairs = (0..rows).map(|row| [vertex(row, 0), vertex(row, around)]).collect();
        tube.seams = vec![SeamMesh { pairs, name: "back".into() }];
        tube
    }

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
        let fabric = crate::fabric::library()[0].clone();
        let worn = Sewn::new(&tube, &fabric, &positions).expect("a tube");
        let (found, tension) = (worn.pressures_kpa(), worn.tensions_n_m());
        let strain = Tensor { weft: 0.5 * (STRETCH * STRETCH - 1.0), warp: 0.0, shear: 0.0 };
        let hoop = STRETCH * worn.cloth.membrane.laws()[0].stress(strain).weft;
        let pressure = 1e-3 * hoop / (STRETCH * RADIUS);
        // Away from the free ends, whose vertices have less cloth above or below them.
        for v in 4 * 61..8 * 61 {
            assert!((tension[v] - hoop).abs() < 0.01 * hoop, "{v}: {} N/m, not {hoop}", tension[v]);
            assert!((found[v] - pressure).abs() < 0.01 * pressure, "{v}: {} kPa, not {pressure}", found[v]);
        }
    }
}
