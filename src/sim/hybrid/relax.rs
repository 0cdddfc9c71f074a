//! Steps of a sewn garment against a body: its size, gravity, bending, contact.
//!
//! Contact pushes the cloth out of the body, but it can be made to yield: where the cloth is stretched by more than a little,
//! contact weakens step by step until it is not. Where the pattern is large enough nothing changes; where it is too small the
//! body wins no more: the cloth goes back to its size and into the body.

use super::elastic::{Elastic, Pull};
use super::layers::Layers;
use super::rows::Rows;
use super::sewn::Sewn;
use super::walls::Walls;
use crate::geom::{DistanceField, TriMesh, V3};
use crate::pattern::{Garment, Measurement};
use crate::sim::cloth::Cloth;
use crate::sim::{Fabric, SimError};

/// Parameters of the steps of pop-up and drape.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct RelaxParams {
    /// Distance from the skin at which cloth is pushed, m.
    pub offset_m: f64,
    /// Membrane stiffness that gravity and bending are set against, N/m. Higher than any cloth's at rest: size is kept.
    pub stiffness_n_m: f64,
    /// Weight of contact, per area and over the stiffness, 1/m2.
    pub contact: f64,
    /// Weight of a free vertex's last place, likewise: how far a step goes.
    pub hold: f64,
    /// Weight of a control: that of a strip of cloth this wide along it, m.
    pub control_width_m: f64,
    /// Stretch of the cloth beyond which contact yields.
    pub yield_stretch: f64,
    /// Bending rigidity at least, N m: keeps folds wider than the mesh.
    pub least_bending_nm: f64,
    /// Share of the last step's movement that the next one begins with: slow modes, such as a whole front coming
    /// forward, take a few steps instead of dozens.
    pub momentum: f64,
    /// Steps between two looks at who is in contact.
    pub refresh: u32,
}

impl Default for RelaxParams {
    fn default() -> Self {
        Self {
            offset_m: 2e-3,
            stiffness_n_m: 500.0,
            contact: 400.0,
            hold: 1.0,
            control_width_m: 0.5,
            yield_stretch: 2e-3,
            least_bending_nm: 5e-5,
            momentum: 0.85,
            refresh: 5,
        }
    }
}

/// Standard gravity, m/s2.
const GRAVITY: f64 = 9.80665;

/// A garment under way from the body's surface to its rest.
pub struct Relaxation<'a> {
    params: RelaxParams,
    field: &'a DistanceField,
    elastic: Elastic,
    /// Rest areas of the sewn vertices, m2.
    areas: Vec<f64>,
    /// Weight of each sewn vertex over the membrane's stiffness, m.
    weight: Vec<f64>,
    rows: Rows,
    walls: Walls,
    /// Vertices that had the weight of contact at the last look.
    touching: Vec<bool>,
    /// Greatest depth that contact still pushes against at each sewn vertex, m.
    most_m: Vec<f64>,
    /// Position of each sewn vertex, m.
    pub x: Vec<V3>,
    /// Displacement of the last step, m.
    last: Vec<V3>,
    layers: Layers,
    /// What lengths of controls are multiplied by.
    pub control: f64,
    /// Below this height cloth lies on the feet and need not close around them, m.
    feet_m: f64,
    steps: u32,
}

/// A place on the way of a garment to which it can go back.
#[derive(Clone, Debug)]
pub struct Place {
    x: Vec<V3>,
    last: Vec<V3>,
    most_m: Vec<f64>,
    steps: u32,
}

/// What a step does besides keeping size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Push {
    /// Whether contact pushes without limit.
    pub unlimited: bool,
    /// Share of its weight that the cloth has.
    pub gravity: f64,
    /// Size that it wants: 0 as it was sewn, 1 the pattern's.
    pub share: f64,
}

impl<'a> Relaxation<'a> {
    /// Starts from a sewn garment.
    ///
    /// # Errors
    /// [`SimError::Degenerate`].
    pub fn new(
        field: &'a DistanceField,
        garment: &Garment,
        sewn: &Sewn,
        fabric: &Fabric,
        controls: &[&Measurement],
        walls: Walls,
        params: RelaxParams,
    ) -> Result<Self, SimError> {
        let stiff = Fabric {
            bending_warp_nm: fabric.bending_warp_nm.max(params.least_bending_nm),
            bending_weft_nm: fabric.bending_weft_nm.max(params.least_bending_nm),
            ..fabric.clone()
        };
        let cloth = Cloth::new(garment, &stiff, sewn.vertex_of.clone())?;
        let pairs = cloth.bending.pairs.pairs().iter().zip(&cloth.bending.entries);
        let bending: Vec<([usize; 2], f64)> =
            pairs.map(|(pair, entry)| (*pair, entry / params.stiffness_n_m)).collect();
        let x = lifted(field, params.offset_m, &sewn.x);
        let touching = touching(field, params.offset_m, &walls, &x);
        let weights = weights(&params, &cloth.areas, &touching);
        let elastic = Elastic::new(garment, &sewn.vertex_of, &x, controls, params.control_width_m, &bending, weights)
            .ok_or_else(|| SimError::Degenerate { piece: garment.name.clone(), at: garment.rest[0] })?;
        let weight = cloth.masses.iter().map(|m| m * GRAVITY / params.stiffness_n_m).collect();
        let rows = Rows::new(garment, sewn);
        let most_m = vec![f64::MAX; x.len()];
        Ok(Self {
            params,
            field,
            elastic,
            areas: cloth.areas,
            weight,
            rows,
            walls,
            touching,
            most_m,
            last: vec![V3::zeros(); x.len()],
            layers: Layers::new(&sewn.triangles),
            control: 1.0,
            feet_m: f64::MIN,
            x,
            steps: 0,
        })
    }

    /// Says how high the ankles are, m: below them contact does not yield.
    #[must_use]
    pub fn over_feet(self, ankles_m: f64) -> Self {
        Self { feet_m: ankles_m, ..self }
    }

    /// Lifts cloth out of the body where it is not too small for it and lies shallow: what contact, which is soft, left inside.
    /// What lies deeper would lose its size.
    pub fn lift_out(&mut self) {
        let stretch = self.rows.stretch(&self.elastic, &self.x);
        for (p, stretch) in self.x.iter_mut().zip(stretch) {
            if stretch < 0.0 || p.z < self.feet_m {
                let (depth, out) = contact(self.field, LEAST_CLEARANCE_M, p);
                *p += out * if depth < MOST_LIFT_M { depth } else { 0.0 };
            }
        }
    }

    /// Judges anew where the garment is too small for a body: there contact yields.
    pub fn judge(&mut self, body: &TriMesh) {
        self.rows.judge(body, &self.x, self.params.offset_m, self.params.yield_stretch);
    }

    /// Where it is now.
    #[must_use]
    pub fn place(&self) -> Place {
        Place { x: self.x.clone(), last: self.last.clone(), most_m: self.most_m.clone(), steps: self.steps }
    }

    /// Goes back to a place.
    pub fn go_back(&mut self, place: &Place) {
        self.x.clone_from(&place.x);
        self.last.clone_from(&place.last);
        self.most_m.clone_from(&place.most_m);
        self.steps = place.steps;
    }

    /// Pulls cloth apart that runs through itself; returns how many edges still do.
    pub fn part_layers(&mut self, rounds: u32) -> usize {
        self.layers.part(&mut self.x, rounds)
    }

    /// Takes one step; returns the rms movement of the vertices, m.
    pub fn step(&mut self, push: Push) -> f64 {
        if self.steps > 0 && self.steps.is_multiple_of(self.params.refresh) {
            self.look_for_contacts();
        }
        self.steps += 1;
        let from: Vec<V3> = self.x.iter().zip(&self.last).map(|(p, d)| p + d * self.params.momentum).collect();
        let contacts: Vec<(f64, V3)> = from.iter().map(|p| contact(self.field, self.params.offset_m, p)).collect();
        if push.unlimited {
            self.most_m.fill(f64::MAX);
        } else {
            self.give_way(&contacts);
        }
        let target = |((p, (depth, out)), most): ((&V3, &(f64, V3)), &f64)| p + out * depth.min(*most);
        let mut targets: Vec<V3> = from.iter().zip(&contacts).zip(&self.most_m).map(target).collect();
        for (v, target) in targets.iter_mut().enumerate() {
            if let Some(back) = self.walls.back(v, target, self.params.offset_m) {
                *target = back;
            }
        }
        let loads: Vec<V3> = self.weight.iter().map(|w| V3::new(0.0, 0.0, -w * push.gravity)).collect();
        let next = self
            .elastic
            .step(&from, &Pull { targets: &targets, loads: &loads, share: push.share, control: self.control });
        self.last = next.iter().zip(&self.x).map(|(a, b)| a - b).collect();
        self.x = next;
        (self.last.iter().map(V3::norm_squared).sum::<f64>() / self.x.len() as f64).sqrt()
    }

    /// Gives the vertices their weights anew, where enough of them have come into contact or left it.
    fn look_for_contacts(&mut self) {
        let touching = touching(self.field, self.params.offset_m, &self.walls, &self.x);
        let changed = touching.iter().zip(&self.touching).filter(|(a, b)| a != b).count();
        if changed as f64 > SAME_CONTACTS * touching.len() as f64 {
            self.elastic.set_weights(weights(&self.params, &self.areas, &touching));
            self.touching = touching;
        }
    }

    /// Weakens contact where the cloth is stretched too much, and lets it recover where it is not.
    fn give_way(&mut self, contacts: &[(f64, V3)]) {
        let stretch = self.rows.stretch(&self.elastic, &self.x);
        for (v, (depth, _)) in contacts.iter().enumerate() {
            if self.x[v].z < self.feet_m {
                continue;
            }
            let excess = (stretch[v] - self.params.yield_stretch) / self.params.yield_stretch;
            let now = self.most_m[v].min(depth.max(LEAST_PUSH_M));
            self.most_m[v] = now * (1.0 - 0.5 * excess).clamp(0.5, 1.2);
        }
    }
}

/// Share of the vertices whose contact may have changed before the system is factorised again.
const SAME_CONTACTS: f64 = 0.01;
/// Cloth that is large enough is this far from the skin in the end at least, m.
const LEAST_CLEARANCE_M: f64 = 1e-3;
/// Cloth is lifted out by this at most, m.
const MOST_LIFT_M: f64 = 3e-3;
/// Contact that has yielded comes back from this, m.
const LEAST_PUSH_M: f64 = 2e-5;

/// Depth below the offset (m, 0 outside) and the direction out.
fn contact(field: &DistanceField, offset_m: f64, p: &V3) -> (f64, V3) {
    let (distance, gradient) = field.value_and_gradient(p);
    ((offset_m - distance).max(0.0), gradient.try_normalize(1e-9).unwrap_or_else(V3::zeros))
}

/// Positions lifted out of the body: the control mesh, on which pieces are laid, cuts through the fine one.
fn lifted(field: &DistanceField, offset_m: f64, x: &[V3]) -> Vec<V3> {
    let lift = |p: &V3| {
        let (depth, out) = contact(field, offset_m, p);
        p + out * depth
    };
    x.iter().map(lift).collect()
}

/// Which vertices contact acts on: those near the body or beyond a wall.
fn touching(field: &DistanceField, offset_m: f64, walls: &Walls, x: &[V3]) -> Vec<bool> {
    let touches =
        |(v, p): (usize, &V3)| field.value_and_gradient(p).0 < offset_m || walls.back(v, p, offset_m).is_some();
    x.iter().enumerate().map(touches).collect()
}

/// Weights of the vertices' targets: those in contact stay where contact wants them, the others may go.
fn weights(params: &RelaxParams, areas: &[f64], touching: &[bool]) -> Vec<f64> {
    touching.iter().zip(areas).map(|(touches, a)| a * if *touches { params.contact } else { params.hold }).collect()
}
