//! Braces: vertical springs that hold a garment by its top edge, where it would slide off by itself. The vertices of
//! the edge keep their height and move freely sideways.

use nalgebra::Matrix3;

use crate::cloth::Cloth;
use geom::V3;
use geom::mesh::free_edges;
use geom::units::GRAVITY;

geom::constants! {
    "solver.braces",
    /// Range below the highest point of a free edge in which its vertices are held, as a share of the height of the
    /// cloth. A waist is lower in front. The front of a coat that is open all the way down is not held below.
    const TOP_SHARE: f64 = 0.1;
    /// Deflection of the springs under the whole weight.
    const YIELD_M: f64 = 1e-4;
}

/// Vertical springs on vertices. Energy `k/2 (z - z0)^2` each, J.
#[derive(Clone, Debug)]
pub struct Braces {
    /// Vertex and height `z0`, m.
    held: Vec<(usize, f64)>,
    stiffness_n_m: f64,
}

impl Braces {
    pub fn new(cloth: &Cloth, x: &[V3]) -> Self {
        let mut edge: Vec<usize> = free_edges(&cloth.triangles).into_iter().flatten().collect();
        edge.sort_unstable();
        edge.dedup();
        let top = edge.iter().map(|v| x[*v].z).fold(f64::MIN, f64::max);
        let low = x.iter().map(|p| p.z).fold(f64::MAX, f64::min);
        let is_top = |v: &usize| x[*v].z >= top - TOP_SHARE * (top - low);
        let held: Vec<(usize, f64)> = edge.into_iter().filter(is_top).map(|v| (v, x[v].z)).collect();
        let weight = cloth.masses.iter().sum::<f64>() * GRAVITY;
        Self { stiffness_n_m: weight / (YIELD_M * held.len().max(1) as f64), held }
    }

    /// J.
    pub fn energy(&self, x: &[V3]) -> f64 {
        self.held.iter().map(|(v, z)| 0.5 * self.stiffness_n_m * (x[*v].z - z).powi(2)).sum()
    }

    /// N.
    pub fn add_forces(&self, x: &[V3], forces: &mut [V3]) {
        for (v, z) in &self.held {
            forces[*v].z -= self.stiffness_n_m * (x[*v].z - z);
        }
    }

    /// N/m.
    pub fn add_stiffness(&self, diagonal: &mut [Matrix3<f64>]) {
        for (v, _) in &self.held {
            diagonal[*v][(2, 2)] += self.stiffness_n_m;
        }
    }

    pub fn carry_n(&self, x: &[V3]) -> f64 {
        self.held.iter().map(|(v, z)| self.stiffness_n_m * (z - x[*v].z)).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laboratory::sheets::{shaken, sheet};
    use crate::laboratory::{self, Specimen};
    use crate::testing::{check_forces, fabric};
    use geom::V2;

    fn hanging(columns: usize, rows: usize) -> (Specimen, Braces) {
        let upright = |p: &V2| V3::new(p.x, 0.0, p.y);
        let cloth = Specimen::new(sheet(columns, rows, 0.02), &fabric(), upright).expect("a sound mesh");
        let braces = Braces::new(&cloth.cloth, &cloth.positions);
        (cloth, braces)
    }

    #[test]
    fn the_upper_edge_is_held_and_no_more() {
        let check = |columns: usize, rows: usize, expect: usize| {
            let (_, braces) = hanging(columns, rows);
            assert_eq!(braces.held.len(), expect, "{columns} x {rows}");
        };
        check(5, 5, 6);
        check(3, 12, 6);
        check(3, 30, 10);
    }

    #[test]
    fn they_carry_what_hangs_from_them() {
        let (cloth, braces) = hanging(6, 6);
        let x = shaken(&cloth.positions, 1e-3, 3);
        let mut forces = vec![V3::zeros(); x.len()];
        braces.add_forces(&x, &mut forces);
        check_forces(|x| braces.energy(x), &forces, &x, 1e-7, 1e-6);
        let field = laboratory::nowhere();
        let Specimen { cloth, mut positions, .. } = cloth;
        let contact = crate::contact::BodyContact::new(&field, crate::contact::ContactParams::default(), &cloth.areas);
        let mut system = crate::solver::System::new(&cloth, contact, None);
        system.braces = Some(braces);
        laboratory::settle(&mut system, &mut positions, 1e-3, 200);
        let weight = cloth.masses.iter().sum::<f64>() * GRAVITY;
        let carried = system.braces.as_ref().map_or(0.0, |b| b.carry_n(&positions));
        assert!((carried / weight - 1.0).abs() < 1e-2, "{carried} N of {weight}");
    }
}
