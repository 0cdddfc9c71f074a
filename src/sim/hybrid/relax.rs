//! Steps of a sewn garment on a body, under its own elasticity, gravity and contact.
//!
//! Contact pushes the cloth out of the body. Where a ring of cloth is too small to close round the body, the body
//! counts as smaller, all round by as much as the ring needs. There the cloth keeps its size and lies inside the body
//! by an even depth. A garment that is large enough lies outside.

use super::elastic::{Controls, Elastic, Pull};
use super::girth_lines::rings;
use super::give::{Give, Lying};
use super::inset::{Fit, Insets};
use super::layers::{Layers, Parted};
use super::obstacle::Obstacle;
use super::underarms::underarms;
use super::welded_mesh::Sewn;
use crate::cloth::Cloth;
use crate::contact::{ClothContact, ClothContactParams, contact_areas};
use crate::walls::Walls;
use crate::{Fabric, SimError};
use body::Body;
use geom::units::GRAVITY;
use geom::{DistanceField, TriMesh, V3};
use pattern::{Garment, Measurement};

#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct RelaxParams {
    /// Distance from the skin at which cloth is pushed.
    pub offset_m: f64,
    /// Membrane stiffness by which gravity and bending are divided. Higher than that of any cloth at rest, to keep the
    /// size.
    pub stiffness_n_m: f64,
    /// Weight of contact per area and over the stiffness, 1/m2.
    pub contact: f64,
    /// Weight of firm contact at the end, over the stiffness with which its neighbours hold a vertex. With it the cloth
    /// slides no more, as under friction.
    pub firm_contact: f64,
    /// Weight of the last place of a vertex without contact, likewise; it bounds the length of a step.
    pub hold: f64,
    /// Width of the strip of cloth along a control that gives its weight.
    pub control_width_m: f64,
    pub yield_stretch: f64,
    /// Least bending rigidity: it keeps folds wider than the mesh's edges.
    pub least_bending_nm: f64,
    /// Share of the last displacement with which the next step begins. Slow modes, such as the forward motion of a
    /// whole front, then take a few steps instead of dozens.
    pub momentum: f64,
    /// Steps between two updates of the contacts.
    pub refresh: u32,
    pub stride_m: f64,
}

impl Default for RelaxParams {
    fn default() -> Self {
        Self {
            offset_m: 2e-3,
            stiffness_n_m: 500.0,
            contact: 400.0,
            firm_contact: 0.3,
            hold: 1.0,
            control_width_m: 0.5,
            yield_stretch: 2e-3,
            least_bending_nm: 5e-5,
            momentum: 0.85,
            refresh: 5,
            stride_m: 0.1,
        }
    }
}

pub struct Relaxation<'a> {
    params: RelaxParams,
    obstacle: Obstacle<'a>,
    elastic: Elastic,
    /// `None` where cloth may go through cloth.
    self_contact: Option<ClothContact<'a>>,
    /// Rest areas of the sewn vertices, m2.
    areas: Vec<f64>,
    /// Weight of each sewn vertex over the membrane's stiffness, m.
    weight: Vec<f64>,
    insets: Insets,
    /// Insets for tight cloth beside those of rings; `None` where the body gives way to rings alone.
    give: Option<Give>,
    /// Edges with their lengths in the pattern, m.
    sides: Vec<([usize; 2], f64)>,
    walls: Walls,
    /// True for vertices that had the weight of contact at the last update.
    touching: Vec<bool>,
    /// True if that was the weight of firm contact.
    is_firm: bool,
    pub x: Vec<V3>,
    /// Displacement of each vertex in the last step.
    last: Vec<V3>,
    layers: Layers,
    pub control: f64,
    /// Height below which cloth lies on the feet and need not close round them.
    feet_m: f64,
    steps: u32,
}

#[derive(Clone, Debug)]
pub struct Place {
    x: Vec<V3>,
    last: Vec<V3>,
    steps: u32,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Push {
    pub firm: bool,
    pub gravity: f64,
    /// Rest size: 0 as it was sewn, 1 the pattern's.
    pub share: f64,
    pub closer_m: f64,
}

impl<'a> Relaxation<'a> {
    pub fn new(
        field: &'a DistanceField,
        garment: &Garment,
        sewn: &'a Sewn,
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
        let mut obstacle = Obstacle::new(field, params.offset_m, sewn.x.len());
        let x = lifted(&mut obstacle, &sewn.x);
        let touching = touching(&mut obstacle, &walls, params.offset_m, &x);
        let weights = soft_weights(&params, &cloth.areas, &touching);
        let open: Vec<[usize; 2]> = garment
            .seams
            .iter()
            .flat_map(|seam| &seam.pairs)
            .map(|pair| pair.map(|v| sewn.vertex_of[v]))
            .filter(|[a, b]| a != b)
            .collect();
        let controls = Controls { measurements: controls, weight: params.control_width_m };
        let elastic = Elastic::new(garment, &sewn.vertex_of, &x, controls, &bending, open, weights)
            .ok_or_else(|| SimError::Degenerate { piece: garment.name.clone(), at: garment.rest[0] })?;
        let weight = cloth.masses.iter().map(|m| m * GRAVITY / params.stiffness_n_m).collect();
        Ok(Self {
            params,
            obstacle,
            elastic,
            self_contact: None,
            areas: cloth.areas,
            weight,
            insets: Insets::default(),
            give: None,
            sides: sides(garment, sewn),
            walls,
            touching,
            is_firm: false,
            last: vec![V3::zeros(); x.len()],
            layers: Layers::new(&sewn.triangles),
            control: 1.0,
            feet_m: f64::MIN,
            x,
            steps: 0,
        })
    }

    /// Keeps cloth from going through other cloth, except the two sides of open seams.
    pub fn kept_apart(mut self, garment: &Garment, sewn: &'a Sewn) -> Self {
        let layers = ClothContactParams::default();
        let areas = contact_areas(garment, &sewn.vertex_of, &self.areas, 2.0 * layers.thickness_m);
        let contact = ClothContact::new(layers, &sewn.triangles, areas);
        let open = self.elastic.open();
        self.self_contact = Some(if open.is_empty() { contact } else { contact.but_near(open.iter().copied()) });
        self
    }

    /// Lets the body give way to all tight cloth, and not to rings alone.
    pub fn giving_way(self) -> Self {
        Self { give: Some(Give::new(self.x.len())), ..self }
    }

    /// Lets the body keep its size below the ankles.
    pub fn over_feet(self, ankles_m: f64) -> Self {
        Self { feet_m: ankles_m, ..self }
    }

    /// Lifts out vertices that soft contact left inside the body. Cloth that lies deeper would lose its size by that.
    pub fn lift_out(&mut self) {
        let mut lifted = |(v, p): (usize, &V3)| {
            let (depth, out) = self.obstacle.contact_at(LEAST_CLEARANCE_M, v, p);
            p + out * if depth < MOST_LIFT_M { depth } else { 0.0 }
        };
        let goal: Vec<V3> = self.x.iter().enumerate().map(&mut lifted).collect();
        if let Some(contact) = &mut self.self_contact {
            contact.update(&self.x);
        }
        self.go_to(&goal);
    }

    /// Moves the cloth to `x` and out of the body; returns the rms movement, m.
    pub fn put(&mut self, x: Vec<V3>) -> f64 {
        let from = std::mem::replace(&mut self.x, x);
        for (v, p) in self.x.iter_mut().enumerate() {
            let (depth, out) = self.obstacle.contact(v, p);
            *p += out * depth;
        }
        (from.iter().zip(&self.x).map(|(a, b)| (a - b).norm_squared()).sum::<f64>() / from.len() as f64).sqrt()
    }

    pub fn judge(&mut self, body: &Body, garment: &Garment, sewn: &Sewn) {
        let rings = rings(body, garment, sewn, &self.x);
        let is_hung = !underarms(garment).is_empty();
        self.insets = Insets::judged(rings, &body.mesh, &self.x, self.fit(), is_hung);
        self.shrink();
    }

    fn fit(&self) -> Fit {
        Fit { offset_m: self.params.offset_m, share: self.params.yield_stretch }
    }

    pub fn judge_again(&mut self, body: &TriMesh) {
        self.insets.judge_again(body, &self.x, self.fit());
        self.give_way(true);
        self.shrink();
    }

    pub fn correct(&mut self) {
        self.insets.correct(&self.x, self.params.yield_stretch);
        self.give_way(false);
        self.shrink();
    }

    /// Lets the body give way to tight cloth that lies on it; `is_judged` is true where that is judged anew.
    fn give_way(&mut self, is_judged: bool) {
        let Some(give) = &mut self.give else { return };
        let stretches = self.elastic.stretches(&self.x);
        let reach_m = self.params.offset_m + LET_GO_M;
        let mut touches = |(v, p): (usize, &V3)| self.obstacle.contact_at(reach_m, v, p).0 > 0.0;
        let touches: Vec<bool> = self.x.iter().enumerate().map(&mut touches).collect();
        let lying = Lying { stretches: &stretches, touches: &touches, sides: &self.sides };
        if is_judged {
            give.judge(&lying);
        }
        give.correct(&lying, self.params.yield_stretch);
    }

    fn shrink(&mut self) {
        let own = self.give.as_ref().map_or_else(|| vec![0.0; self.x.len()], |give| give.now_m.clone());
        let mut insets = self.insets.of_vertices(own, &self.sides);
        insets.iter_mut().zip(&self.x).filter(|(_, p)| p.z < self.feet_m).for_each(|(inset, _)| *inset = 0.0);
        self.obstacle.shrink(insets);
    }

    pub fn place(&self) -> Place {
        Place { x: self.x.clone(), last: self.last.clone(), steps: self.steps }
    }

    pub fn go_back(&mut self, place: &Place) {
        self.x.clone_from(&place.x);
        self.last.clone_from(&place.last);
        self.steps = place.steps;
    }

    pub fn part_layers(&mut self, rounds: u32) -> Parted {
        self.layers.part(&mut self.x, rounds)
    }

    /// Returns the rms movement of the vertices, m.
    pub fn step(&mut self, push: Push) -> f64 {
        let ways_out = self.self_contact.as_mut().map_or_else(Vec::new, |contact| {
            contact.update(&self.x);
            contact.ways_out(&self.x)
        });
        if push.firm || (self.steps > 0 && self.steps.is_multiple_of(self.params.refresh)) {
            self.look_for_contacts(push.firm, &ways_out);
        }
        self.steps += 1;
        let from: Vec<V3> = self.x.iter().zip(&self.last).map(|(p, d)| p + d * self.params.momentum).collect();
        let mut target = |(v, p): (usize, &V3)| {
            let (depth, out) = self.obstacle.contact(v, p);
            let apart = ways_out.get(v).copied().flatten().map_or(*p, |way| self.x[v] + way);
            let target = apart + out * depth;
            self.walls.back(v, &target, self.params.offset_m).unwrap_or(target)
        };
        let targets: Vec<V3> = from.iter().enumerate().map(&mut target).collect();
        let loads: Vec<V3> = self.weight.iter().map(|w| V3::new(0.0, 0.0, -w * push.gravity)).collect();
        let Push { share, closer_m, .. } = push;
        let pull = Pull { targets: &targets, loads: &loads, share, control: self.control, closer_m };
        let mut next = self.elastic.step(&from, &pull);
        for (to, from) in next.iter_mut().zip(&self.x) {
            let way = *to - from;
            *to = from + way * (self.params.stride_m / way.norm()).min(1.0);
        }
        let before = self.x.clone();
        self.go_to(&next);
        self.last = self.x.iter().zip(&before).map(|(a, b)| a - b).collect();
        (self.last.iter().map(V3::norm_squared).sum::<f64>() / self.x.len() as f64).sqrt()
    }

    /// Moves as far as the contact of the cloth with itself allows, in legs between which contacts are sought.
    fn go_to(&mut self, goal: &[V3]) {
        let Some(contact) = &mut self.self_contact else {
            self.x.copy_from_slice(goal);
            return;
        };
        for _ in 0..MOST_LEGS {
            let way: Vec<V3> = goal.iter().zip(&self.x).map(|(to, from)| to - from).collect();
            let share = contact.free_share(&way).clamp(0.0, 1.0);
            self.x.iter_mut().zip(&way).for_each(|(p, d)| *p += d * share);
            contact.keep_apart(&mut self.x);
            contact.stop(&mut self.x);
            if share == 1.0 {
                break;
            }
            contact.update(&self.x);
        }
    }

    /// Updates the weights of the vertices if enough of them have come into contact or left it.
    fn look_for_contacts(&mut self, firm: bool, ways_out: &[Option<V3>]) {
        let mut now = touching(&mut self.obstacle, &self.walls, self.params.offset_m, &self.x);
        now.iter_mut().zip(ways_out).for_each(|(touches, way)| *touches |= way.is_some());
        // Firm contact brings cloth out of contact. It must be held there all the same.
        for (v, touches) in now.iter_mut().enumerate().filter(|(v, _)| firm && self.touching[*v]) {
            *touches |= self.obstacle.contact_at(self.params.offset_m + LET_GO_M, v, &self.x[v]).0 > 0.0;
        }
        let changed = now.iter().zip(&self.touching).filter(|(a, b)| a != b).count();
        if firm != self.is_firm || changed as f64 > SAME_CONTACTS * now.len() as f64 {
            let mut weights = soft_weights(&self.params, &self.areas, &now);
            if firm {
                let touching = weights.iter_mut().zip(self.elastic.held()).zip(&now).filter(|(_, touches)| **touches);
                touching.for_each(|((weight, held), _)| *weight = self.params.firm_contact * held);
            }
            self.elastic.set_weights(weights);
            (self.touching, self.is_firm) = (now, firm);
        }
    }
}

geom::constants! {
    "hybrid.relax",
    /// Share of the vertices whose contact may change before the matrix is factorised again.
    const SAME_CONTACTS: f64 = 0.01;
    /// Distance beyond the offset at which firm contact lets go.
    const LET_GO_M: f64 = 1e-3;
    /// Least distance from the skin to which cloth that is large enough is lifted in the end.
    const LEAST_CLEARANCE_M: f64 = 1e-3;
    const MOST_LIFT_M: f64 = 3e-3;
    /// Greatest number of legs of a step, after each of which contacts of the cloth with itself are sought.
    const MOST_LEGS: usize = 4;
}

fn sides(garment: &Garment, sewn: &Sewn) -> Vec<([usize; 2], f64)> {
    let edges_of = |&[a, b, c]: &[usize; 3]| [[a, b], [b, c], [c, a]];
    let side =
        |[a, b]: [usize; 2]| ([sewn.vertex_of[a], sewn.vertex_of[b]], (garment.rest[a] - garment.rest[b]).norm());
    garment.triangles.iter().flat_map(edges_of).map(side).collect()
}

/// Pieces are laid on the control mesh, which lies partly inside the fine one.
fn lifted(obstacle: &mut Obstacle, x: &[V3]) -> Vec<V3> {
    let mut lift = |(v, p): (usize, &V3)| {
        let (depth, out) = obstacle.contact(v, p);
        p + out * depth
    };
    x.iter().enumerate().map(&mut lift).collect()
}

fn touching(obstacle: &mut Obstacle, walls: &Walls, offset_m: f64, x: &[V3]) -> Vec<bool> {
    let mut touches = |(v, p): (usize, &V3)| obstacle.contact(v, p).0 > 0.0 || walls.back(v, p, offset_m).is_some();
    x.iter().enumerate().map(&mut touches).collect()
}

/// Weights of contact for vertices in contact, lower ones for the others.
fn soft_weights(params: &RelaxParams, areas: &[f64], touching: &[bool]) -> Vec<f64> {
    touching.iter().zip(areas).map(|(touches, a)| a * if *touches { params.contact } else { params.hold }).collect()
}
