//! Reinforced edges: ribs, tapes, hems and waistbands, as elastic threads along edges of the mesh.
//!
//! Between two neighbouring vertices at a distance `L` in the pattern a band has the rest length `L' = factor L`. Its
//! energy is `k/2 (l/L' - 1)^2 L'`, J, with the present distance `l` and the stiffness `k` in N. The stiffness matrix
//! of a slack band has no transverse part, since that would be negative.

use nalgebra::Matrix3;
use wide::f32x4;

use super::gathers::Gathers;
use super::part::Part;
use geom::V3;
use linalg::PairList;
use linalg::quad::{self, Block};
use pattern::Garment;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Link {
    /// They share a triangle.
    pub vertices: [usize; 2],
    pub length_m: f64,
    /// Force `k` per relative elongation.
    pub stiffness_n: f64,
}

impl Link {
    /// Tension (N) and unit direction from the first end to the second.
    fn pull(&self, x: &[V3]) -> (f64, V3) {
        let d = x[self.vertices[1]] - x[self.vertices[0]];
        let length = d.norm();
        (self.stiffness_n * (length / self.length_m - 1.0), d / length.max(f64::MIN_POSITIVE))
    }
}

#[derive(Clone, Debug, Default)]
pub struct Bands {
    links: Vec<Link>,
}

impl Bands {
    /// Collects the bands of a garment whose vertices are merged as `vertex_of` says. `gathers` gives the rest lengths
    /// of gathered edges.
    pub fn new(garment: &Garment, gathers: &Gathers, vertex_of: &[usize]) -> Self {
        let mut links = Vec::new();
        for r in &garment.reinforcements {
            for ends in r.vertices.windows(2) {
                let ends = [ends[0], ends[1]];
                let drawn = garment.rest[ends[1]] - garment.rest[ends[0]];
                let length_m = r.length_factor * gathers.length_m(ends, drawn);
                let vertices = ends.map(|v| vertex_of[v]);
                if vertices[0] != vertices[1] && length_m > 0.0 {
                    links.push(Link { vertices, length_m, stiffness_n: r.stiffness_n });
                }
            }
        }
        Self { links }
    }

    pub fn part(&self, part: &Part) -> Self {
        let renamed = |link: &Link| Some(Link { vertices: part.names(link.vertices)?, ..*link });
        Self { links: self.links.iter().filter_map(renamed).collect() }
    }

    /// J.
    pub fn energy(&self, x: &[V3]) -> f64 {
        let energy_j =
            |link: &Link| 0.5 * link.pull(x).0.powi(2) / link.stiffness_n.max(f64::MIN_POSITIVE) * link.length_m;
        self.links.iter().map(energy_j).sum()
    }

    /// N.
    pub fn add_forces(&self, x: &[V3], forces: &mut [V3]) {
        for link in &self.links {
            let (tension, direction) = link.pull(x);
            forces[link.vertices[0]] += direction * tension;
            forces[link.vertices[1]] -= direction * tension;
        }
    }

    /// As [`Membrane::assemble_towards`](super::membrane::Membrane::assemble_towards): adds the forces (N) of the
    /// tensions at `end` in excess of those that a linear solve at `x` predicts, and to the blocks of the membrane the
    /// axial stiffness. The ends of each link are among its pairs.
    pub fn assemble_towards(
        &self,
        x: &[V3],
        end: &[V3],
        pairs: &PairList,
        forces: &mut [V3],
        blocks: &mut [Block<f32x4>],
    ) {
        for link in &self.links {
            let [i, j] = link.vertices;
            let stiffness = link.stiffness_n / link.length_m;
            let ((before, along), (after, direction)) = (link.pull(x), link.pull(end));
            let foreseen = before + stiffness * along.dot(&(end[j] - end[i] - (x[j] - x[i])));
            forces[i] += direction * (after - foreseen);
            forces[j] -= direction * (after - foreseen);
            if let Some(slot) = pairs.slot(i, j) {
                quad::subtract(&mut blocks[slot], &(direction * direction.transpose() * stiffness));
            }
        }
    }

    /// Adds off-diagonal stiffness (N/m) to the blocks of the membrane, among whose pairs are the ends of each link.
    pub fn add_stiffness(&self, x: &[V3], pairs: &PairList, blocks: &mut [Block<f32x4>]) {
        for link in &self.links {
            let [i, j] = link.vertices;
            let (tension, direction) = link.pull(x);
            let along = direction * direction.transpose();
            let sideways = tension.max(0.0) / (x[j] - x[i]).norm().max(f64::MIN_POSITIVE);
            if let Some(slot) = pairs.slot(i, j) {
                let stretched = along * (link.stiffness_n / link.length_m);
                quad::subtract(&mut blocks[slot], &(stretched + (Matrix3::identity() - along) * sideways));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cloth::Cloth;
    use crate::laboratory::{self, sheets};
    use crate::sewing::unsewn;
    use crate::testing::{check_forces, fabric};
    use pattern::garment::{Band, Reinforcement};

    fn ribbed() -> (Garment, Vec<V3>) {
        let mut garment = laboratory::garment(sheets::sheet(3, 3, 0.02));
        let rib = Reinforcement { band: Band::Rib, stiffness_n: 25.0, length_factor: 0.9, vertices: vec![0, 1, 2, 3] };
        garment.reinforcements.push(rib);
        let x = garment.rest.iter().map(|p| V3::new(p.x, p.y, 0.0)).collect();
        (garment, x)
    }

    #[test]
    fn forces_and_stiffness_are_the_energys() {
        let (garment, flat) = ribbed();
        let bands = Bands::new(&garment, &Gathers::of(&garment), &unsewn(&garment));
        let x = sheets::shaken(&flat, 1e-3, 9);
        let mut forces = vec![V3::zeros(); x.len()];
        bands.add_forces(&x, &mut forces);
        check_forces(|x| bands.energy(x), &forces, &x, 1e-7, 1e-6);
        let pairs = PairList::new([[0, 1], [1, 2], [2, 3]]);
        let mut blocks = vec![[f32x4::ZERO; 3]; 3];
        bands.add_stiffness(&x, &pairs, &mut blocks);
        let force = |d: f64| {
            let mut moved = x.clone();
            moved[1].z += d;
            let mut forces = vec![V3::zeros(); x.len()];
            bands.add_forces(&moved, &mut forces);
            forces[0]
        };
        let block = quad::matrix(&blocks[0]);
        let column = -(force(1e-7) - force(-1e-7)) / 2e-7;
        assert!((column - block.column(2)).norm() < 1e-6 * block.norm());
    }

    #[test]
    fn a_stretched_rib_pulls_its_ends_together() {
        let (garment, _) = ribbed();
        let cloth = Cloth::new(&garment, &fabric(), unsewn(&garment)).expect("sound");
        let stretched: Vec<V3> = garment.rest.iter().map(|p| V3::new(1.1 * p.x, p.y, 0.0)).collect();
        let energy = cloth.bands.energy(&stretched);
        // (1.1 / 0.9 - 1)^2 * 25 N / 2 over a band of 54 mm.
        let expected = 12.5 * (1.1 / 0.9 - 1.0_f64).powi(2) * 0.054;
        assert!((energy / expected - 1.0).abs() < 1e-9, "{energy} for {expected}");
        let mut forces = vec![V3::zeros(); stretched.len()];
        cloth.bands.add_forces(&stretched, &mut forces);
        assert!(forces[0].x > 0.0 && (forces[0] + forces[3]).norm() < 1e-12 && forces[1].norm() < 1e-9);
    }
}
