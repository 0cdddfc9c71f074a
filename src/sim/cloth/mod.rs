//! Cloth: the mesh of a garment with its elastic energies, sewn or unsewn.

pub mod arcs;
pub mod band;
pub mod bending;
pub mod element;
mod fours;
pub mod gathers;
pub mod law;
pub mod membrane;
pub mod part;
pub mod slack;

use geom::constants::Constant;
use std::collections::BTreeMap;

use crate::{Fabric, SimError, sewing};
use geom::{V2, V3};
use linalg::PairList;
use pattern::Garment;

use arcs::{Arcs, Laid};
use band::Bands;
use bending::{Bending, Flap, Hinge, Plate};
use element::Element;
use gathers::Gathers;
use law::Orthotropic;
use membrane::Membrane;

/// Coulomb coefficients.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Friction {
    /// On the body and the floor.
    pub body: f64,
    pub cloth: f64,
}

impl Friction {
    pub fn of(fabric: &Fabric) -> Self {
        Self { body: fabric.friction_body, cloth: fabric.friction_self }
    }
}

/// Mechanical model of a garment. Its *simulated* vertices are groups of garment vertices that are sewn together.
#[derive(Clone, Debug)]
pub struct Cloth {
    pub vertex_of: Vec<usize>,
    /// Triangles over simulated vertices, in the garment's order.
    pub triangles: Vec<[usize; 3]>,
    /// Lumped masses, kg.
    pub masses: Vec<f64>,
    /// Lumped rest areas, m2: a third of each adjacent triangle.
    pub areas: Vec<f64>,
    pub frictions: Vec<Friction>,
    pub membrane: Membrane,
    pub bending: Bending,
    /// Reinforced edges, as elastic threads along them.
    pub bands: Bands,
}

impl Cloth {
    /// Vertices are merged as `vertex_of` says; its values are 0..n without gaps. Fails where a triangle of the pattern
    /// mesh has no area.
    pub fn new(garment: &Garment, fabric: &Fabric, vertex_of: Vec<usize>) -> Result<Self, SimError> {
        Self::of_layers(garment, &[(garment.pieces.len(), fabric)], vertex_of)
    }

    /// Several garments in one mesh. `layers` gives the number of pieces and the fabric of each, in the order of the
    /// pieces.
    pub fn of_layers(garment: &Garment, layers: &[(usize, &Fabric)], vertex_of: Vec<usize>) -> Result<Self, SimError> {
        let count = vertex_of.iter().max().map_or(0, |m| m + 1);
        let mut elements = Vec::with_capacity(garment.triangles.len());
        let (mut areas, mut densities) = (vec![0.0; count], vec![0.0; count]);
        let mut frictions = vec![Friction { body: 0.0, cloth: 0.0 }; count];
        let mut plates = PlateBuilder::default();
        let gathers = Gathers::of(garment);
        let of_pieces = layers.iter().enumerate().flat_map(|(law, (pieces, fabric))| vec![(law, *fabric); *pieces]);
        for (piece, (law, fabric)) in garment.pieces.iter().zip(of_pieces) {
            for t in piece.triangles.clone() {
                let corners = garment.triangles[t];
                let vertices = corners.map(|v| vertex_of[v]);
                let drawn = corners.map(|v| garment.rest[v]);
                let rest = gathers.shape(corners, drawn);
                let element = Element::new(vertices, rest, piece.grain)
                    .ok_or_else(|| SimError::Degenerate { piece: piece.id.clone(), at: drawn[0] })?
                    .of_law(law);
                // Gathered cloth has the mass of the cut cloth, so the area is that in the pattern.
                let area = 0.5 * (drawn[1] - drawn[0]).perp(&(drawn[2] - drawn[0]));
                for v in vertices {
                    areas[v] += area / 3.0;
                    (densities[v], frictions[v]) = (fabric.density_kg_m2, Friction::of(fabric));
                }
                plates.add(vertices, rest, piece.grain, fabric);
                elements.push(element);
            }
        }
        let laws = layers.iter().map(|(_, fabric)| Orthotropic::of(fabric));
        let membrane = Membrane::new(laws.collect(), elements);
        let arcs = Arcs::new(&plates.laid, &plates.plates, &plates.hinges, &membrane.pairs, count);
        let membrane = membrane.with_arcs(arcs);
        Ok(Self {
            triangles: membrane.elements.iter().map(Element::vertices).collect(),
            masses: areas.iter().zip(&densities).map(|(area, density)| area * density).collect(),
            areas,
            frictions,
            bending: plates.finish(&membrane.pairs),
            membrane,
            bands: Bands::new(garment, &gathers, &vertex_of),
            vertex_of,
        })
    }

    /// Takes a share of the membrane stiffness ([`Orthotropic::slackened`]), and all of the bending stiffness.
    pub fn slackened(mut self, share: f64) -> Self {
        self.membrane = self.membrane.with_laws(|law| law.slackened(share));
        self
    }

    pub fn add_forces(&self, x: &[V3], forces: &mut [V3]) {
        self.membrane.add_forces(x, forces);
        self.bending.add_forces(x, forces);
        self.bands.add_forces(x, forces);
    }

    pub fn len(&self) -> usize {
        self.masses.len()
    }

    pub fn is_empty(&self) -> bool {
        self.masses.is_empty()
    }

    pub fn unweld(&self, x: &[V3]) -> Vec<V3> {
        self.vertex_of.iter().map(|&v| x[v]).collect()
    }

    /// Positions of the simulated vertices: means over the garment vertices of each group.
    pub fn weld(&self, positions: &[V3]) -> Vec<V3> {
        sewing::merged(&self.vertex_of, positions)
    }
}

struct OpenSide {
    opposite: usize,
    flap: Flap,
    plate: usize,
    side: usize,
}

#[derive(Default)]
struct PlateBuilder {
    open: BTreeMap<[usize; 2], OpenSide>,
    hinges: Vec<Hinge>,
    plates: Vec<Plate>,
    laid: Vec<Laid>,
}

impl PlateBuilder {
    /// `rest` is counter-clockwise, `grain` the unit warp direction.
    fn add(&mut self, vertices: [usize; 3], rest: [V2; 3], grain: V2, fabric: &Fabric) {
        let plate = self.plates.len();
        let weft = V2::new(grain.y, -grain.x);
        let normal = |k: usize| {
            let side = (rest[(k + 1) % 3] - rest[k]).normalize();
            let outward = V2::new(side.y, -side.x);
            V2::new(outward.dot(&weft), outward.dot(&grain))
        };
        let area = 0.5 * (rest[1] - rest[0]).perp(&(rest[2] - rest[0]));
        let local = rest.map(|p| V2::new(p.dot(&weft), p.dot(&grain)));
        self.laid.push(Laid { vertices, rest: local, across: [None; 3] });
        let rigidities_nm = [fabric.bending_weft_nm, fabric.bending_warp_nm];
        let normals = [normal(0), normal(1), normal(2)];
        self.plates.push(Plate { area, rigidities_nm, normals, hinges: [None; 3] });
        for k in 0..3 {
            let order = [k, (k + 1) % 3, (k + 2) % 3];
            let [a, b, opposite] = order.map(|m| vertices[m]);
            let [ra, rb, rc] = order.map(|m| rest[m]);
            match self.open.remove(&[b, a]) {
                // The neighbour traverses the shared edge in the opposite direction.
                Some(OpenSide { opposite: other, flap, plate: neighbour, side }) => {
                    self.laid[neighbour].across[side] = Some([plate, k]);
                    self.laid[plate].across[k] = Some([neighbour, side]);
                    self.plates[neighbour].hinges[side] = Some(self.hinges.len());
                    self.plates[plate].hinges[k] = Some(self.hinges.len());
                    self.hinges.push(Hinge::new([b, a, other, opposite], [flap, Flap { rest: [rb, ra, rc] }]));
                }
                None => {
                    let flap = Flap { rest: [ra, rb, rc] };
                    self.open.insert([a, b], OpenSide { opposite, flap, plate, side: k });
                }
            }
        }
    }

    fn finish(&self, sides: &PairList) -> Bending {
        Bending::new(&self.hinges, &self.plates, sides)
    }
}

pub(crate) fn constants() -> Vec<Constant> {
    [arcs::CONSTANTS, bending::CONSTANTS, gathers::CONSTANTS, law::CONSTANTS, slack::CONSTANTS].concat()
}
