//! The form that a garment is laid on: the control mesh, modified for the hang of the garment (5.2.4).
//!
//! A garment falls straight from the widest level above. The trunk's profile is therefore made convex between hip and
//! chest, line by line. This keeps the two largest girths and interpolates the layers between them. Below the hip a
//! tube continues to the floor, wide enough for both legs. Trousers lie on the unmodified legs.

use body::{Body, ControlMesh, Layer, RING, Region};
use geom::{TriMesh, V3};

geom::constants! {
    "hybrid.form",
    /// Height between the rings below the hip.
    const SKIRT_STEP_M: f64 = 0.06;
    /// Height of the tube's lower end.
    const SKIRT_END_M: f64 = 0.03;
}

/// Rings of equally many vertices, one below the other, or one farther out on a limb than the other.
#[derive(Clone, Debug)]
pub struct Tube {
    rings: Vec<[usize; RING]>,
}

impl Tube {
    fn of(control: &ControlMesh, layers: &[Layer]) -> Self {
        let ring = |&layer: &Layer| std::array::from_fn(|i| control.ring_vertex(layer, i));
        Self { rings: layers.iter().map(ring).collect() }
    }

    /// Vertices of line `index` (modulo the ring) from the first ring to the last.
    pub fn line(&self, index: i32) -> impl Iterator<Item = usize> + '_ {
        self.rings.iter().map(move |ring| ring[index.rem_euclid(RING as i32) as usize])
    }

    pub fn end(&self) -> f64 {
        (self.rings.len() - 1) as f64
    }

    /// Point on line `index` at parameter `along`: 0 on the first ring, 1 on the second, and so on.
    pub fn at(&self, mesh: &TriMesh, index: i32, along: f64) -> V3 {
        let along = along.clamp(0.0, self.end());
        let below = (along as usize).min(self.rings.len() - 2);
        let i = index.rem_euclid(RING as i32) as usize;
        let [a, b] = [below, below + 1].map(|ring| mesh.positions[self.rings[ring][i]]);
        a.lerp(&b, along - below as f64)
    }

    /// Parameter of the point `length_m` along line `index` beyond parameter `from`.
    pub fn further(&self, mesh: &TriMesh, index: i32, from: f64, length_m: f64) -> f64 {
        let points: Vec<V3> = self.line(index).map(|v| mesh.positions[v]).collect();
        let (mut along, mut left) = (from.max(0.0), length_m);
        while along < self.end() {
            let ring = along as usize;
            let segment = (points[ring + 1] - points[ring]).norm().max(1e-9);
            let rest = segment * (ring as f64 + 1.0 - along);
            if left <= rest {
                return along + left / segment;
            }
            left -= rest;
            along = ring as f64 + 1.0;
        }
        self.end()
    }

    pub fn at_height(&self, mesh: &TriMesh, index: i32, z: f64) -> f64 {
        let heights: Vec<f64> = self.line(index).map(|v| mesh.positions[v].z).collect();
        let below = heights.iter().position(|&h| h <= z);
        match below {
            Some(0) => 0.0,
            Some(k) => k as f64 - (z - heights[k]) / (heights[k - 1] - heights[k]),
            None => self.end(),
        }
    }
}

/// Surface to lay pieces on.
#[derive(Clone, Debug)]
pub struct Form {
    /// Vertices of the control mesh keep their numbers.
    pub mesh: TriMesh,
    pub regions: Vec<Region>,
    /// From the axilla down.
    pub trunk: Tube,
    /// Right and left, from the armscye to the wrist.
    pub arms: [Tube; 2],
    /// Right and left, from the thigh to the foot.
    pub legs: [Tube; 2],
}

const TRUNK: [Layer; 6] = [Layer::Axilla, Layer::Chest, Layer::UnderBust, Layer::Waist, Layer::Abdomen, Layer::Hip];

impl Form {
    /// Form for tops, dresses and skirts.
    pub fn hung(body: &Body) -> Self {
        use Region::*;
        let regions = [Neck, Shoulders, Chest, Abdomen, UpperArmRight, ForearmRight, UpperArmLeft, ForearmLeft];
        let mut form = Self::of(&body.control, &regions);
        form.widen();
        form.add_skirt(&body.control);
        form
    }

    /// Form for trousers.
    pub fn legs(body: &Body) -> Self {
        use Region::*;
        let mut form = Self::of(&body.control, &[Chest, Abdomen, Pelvis, ThighRight, ShankRight, ThighLeft, ShankLeft]);
        form.straighten_feet();
        form
    }

    /// Form for tops and trousers in one.
    pub fn suit(body: &Body) -> Self {
        use Region::*;
        let trunk = [Neck, Shoulders, Chest, Abdomen, Pelvis];
        let limbs =
            [UpperArmRight, ForearmRight, UpperArmLeft, ForearmLeft, ThighRight, ShankRight, ThighLeft, ShankLeft];
        let mut form = Self::of(&body.control, &[&trunk[..], &limbs].concat());
        form.straighten_feet();
        form
    }

    /// Puts the foot's ring straight below the ankle's: trouser legs do not follow the instep.
    fn straighten_feet(&mut self) {
        for leg in &self.legs {
            let [ankle, foot] = [leg.rings.len() - 2, leg.rings.len() - 1].map(|k| leg.rings[k]);
            for i in 0..RING {
                let above = self.mesh.positions[ankle[i]];
                self.mesh.positions[foot[i]] = V3::new(above.x, above.y, SKIRT_END_M);
            }
        }
    }

    fn of(control: &ControlMesh, kept: &[Region]) -> Self {
        use Layer::*;
        let mut mesh = TriMesh { positions: control.positions.clone(), triangles: Vec::new() };
        let mut regions = Vec::new();
        for (face, region) in control.faces.iter().zip(&control.regions).filter(|(_, r)| kept.contains(r)) {
            for k in 2..face.len() {
                mesh.triangles.push([face[0], face[k - 1], face[k]]);
                regions.push(*region);
            }
        }
        Self {
            mesh,
            regions,
            trunk: Tube::of(control, &TRUNK),
            arms: [
                Tube::of(control, &[ArmscyeRight, UpperArmRight, ElbowRight, ForearmRight, WristRight]),
                Tube::of(control, &[ArmscyeLeft, UpperArmLeft, ElbowLeft, ForearmLeft, WristLeft]),
            ],
            legs: [
                Tube::of(control, &[ThighRight, MidThighRight, KneeRight, CalfRight, AnkleRight, FootRight]),
                Tube::of(control, &[ThighLeft, MidThighLeft, KneeLeft, CalfLeft, AnkleLeft, FootLeft]),
            ],
        }
    }

    /// Makes the trunk's profile convex from chest to hip: no layer lies inside the straight line between two others.
    fn widen(&mut self) {
        let rings = &self.trunk.rings[1..];
        let axis = rings.iter().flatten().map(|&v| self.mesh.positions[v]).sum::<V3>() / (rings.len() * RING) as f64;
        let radius = |p: &V3| (p - axis).xy().norm();
        for i in 0..RING {
            let line: Vec<V3> = rings.iter().map(|ring| self.mesh.positions[ring[i]]).collect();
            for k in 1..line.len() - 1 {
                let mut widest = line[k];
                for (a, b) in (0..k).flat_map(|a| (k + 1..line.len()).map(move |b| (a, b))) {
                    let straight = line[a].lerp(&line[b], (line[a].z - line[k].z) / (line[a].z - line[b].z));
                    if radius(&straight) > radius(&widest) {
                        widest = straight;
                    }
                }
                self.mesh.positions[rings[k][i]] = widest;
            }
        }
    }

    /// Adds the tube below the hip: the hip's outline, widened where a leg would protrude from it.
    fn add_skirt(&mut self, control: &ControlMesh) {
        use Layer::*;
        let hip: Vec<V3> = control.ring(Hip).map(|v| self.mesh.positions[v]).collect();
        let centre = control.ring_centre(Hip);
        let legs = [
            ThighRight,
            MidThighRight,
            KneeRight,
            CalfRight,
            AnkleRight,
            FootRight,
            ThighLeft,
            MidThighLeft,
            KneeLeft,
            CalfLeft,
            AnkleLeft,
            FootLeft,
        ];
        let below: Vec<V3> = legs.iter().flat_map(|&l| control.ring(l)).map(|v| control.positions[v]).collect();
        let reach = |points: &[V3], d: V3| points.iter().map(|p| (p - centre).dot(&d)).fold(0.0, f64::max);
        let widened: Vec<(V3, f64)> = hip
            .iter()
            .map(|p| {
                let out = V3::new(p.x - centre.x, p.y - centre.y, 0.0);
                let d = out.normalize();
                (out, (reach(&below, d) / reach(&hip, d)).max(1.0))
            })
            .collect();
        let rings = ((centre.z - SKIRT_END_M) / SKIRT_STEP_M).ceil().max(1.0) as usize;
        for k in 1..=rings {
            let share = k as f64 / rings as f64;
            let z = centre.z + (SKIRT_END_M - centre.z) * share;
            let first = self.mesh.positions.len();
            for (out, widest) in &widened {
                let p = centre + out * (1.0 + (widest - 1.0) * share);
                self.mesh.positions.push(V3::new(p.x, p.y, z));
            }
            let ring: [usize; RING] = std::array::from_fn(|i| first + i);
            let above = self.trunk.rings[self.trunk.rings.len() - 1];
            for i in 0..RING {
                let j = (i + 1) % RING;
                self.mesh.triangles.extend([[ring[i], ring[j], above[j]], [ring[i], above[j], above[i]]]);
                self.regions.extend([Region::Pelvis; 2]);
            }
            self.trunk.rings.push(ring);
        }
    }
}
