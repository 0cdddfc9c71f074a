//! Control mesh [T 3.2.2]: rings of 24 vertices in the planes of the critical girths, joined by quadrilaterals.
//! Topology and vertex order are the same for all bodies.

use crate::{Joint, Landmarks, Skeleton};
use geom::{TriMesh, V3};

/// Number of vertices of a ring. In horizontal rings vertex 0 is on the subject's right and vertex 6 in front. In rings
/// of the arms vertex 4 is below and vertex 10 in front.
pub const RING: usize = 24;

pub(super) const YOKE: usize = 5;

/// Number of rows of the yoke between armpit and neck base. With these, the armhole has as many vertices as a ring.
pub(super) const YOKE_ROWS: usize = 3;

/// First vertex of front and back yoke in a horizontal ring.
pub(super) const YOKE_START: [usize; 2] = [4, 16];

/// The 14 regions of the body [T, figure 3-10].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, serde::Serialize, serde::Deserialize)]
pub enum Region {
    Head,
    Neck,
    Shoulders,
    Chest,
    Abdomen,
    Pelvis,
    UpperArmRight,
    ForearmRight,
    UpperArmLeft,
    ForearmLeft,
    ThighRight,
    ShankRight,
    ThighLeft,
    ShankLeft,
}

/// Critical girths in the order of their rings: legs, trunk, arms.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, serde::Serialize, serde::Deserialize)]
pub enum Layer {
    FootRight,
    AnkleRight,
    CalfRight,
    KneeRight,
    MidThighRight,
    ThighRight,
    FootLeft,
    AnkleLeft,
    CalfLeft,
    KneeLeft,
    MidThighLeft,
    ThighLeft,
    Hip,
    Abdomen,
    Waist,
    UnderBust,
    Chest,
    Axilla,
    NeckBase,
    Neck,
    Mouth,
    HeadGirth,
    ArmscyeRight,
    UpperArmRight,
    ElbowRight,
    ForearmRight,
    WristRight,
    ArmscyeLeft,
    UpperArmLeft,
    ElbowLeft,
    ForearmLeft,
    WristLeft,
}

impl Layer {
    pub const ALL: [Self; 32] = {
        use Layer::*;
        [
            FootRight,
            AnkleRight,
            CalfRight,
            KneeRight,
            MidThighRight,
            ThighRight,
            FootLeft,
            AnkleLeft,
            CalfLeft,
            KneeLeft,
            MidThighLeft,
            ThighLeft,
            Hip,
            Abdomen,
            Waist,
            UnderBust,
            Chest,
            Axilla,
            NeckBase,
            Neck,
            Mouth,
            HeadGirth,
            ArmscyeRight,
            UpperArmRight,
            ElbowRight,
            ForearmRight,
            WristRight,
            ArmscyeLeft,
            UpperArmLeft,
            ElbowLeft,
            ForearmLeft,
            WristLeft,
        ]
    };
}

/// Coarse mesh of rings on the skin. Its vertices are the rings of [`Layer::ALL`], the rows of the yoke (front, then
/// back, from below), and the ends (right and left sole, crown, right and left hand).
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct ControlMesh {
    /// Vertex positions on the fine mesh, m.
    pub positions: Vec<V3>,
    /// Vertex indices of each face, counter-clockwise seen from outside: four, or three at ends and crotch.
    pub faces: Vec<Vec<usize>>,
    pub regions: Vec<Region>,
}

impl ControlMesh {
    pub fn triangulated(&self) -> TriMesh {
        let fans = self.faces.iter().flat_map(|face| (2..face.len()).map(|k| [face[0], face[k - 1], face[k]]));
        TriMesh { positions: self.positions.clone(), triangles: fans.collect() }
    }

    pub fn ring(&self, layer: Layer) -> std::ops::Range<usize> {
        let start = layer as usize * RING;
        start..start + RING
    }

    /// Index of vertex `i`, modulo [`RING`], of the ring of a girth.
    pub fn ring_vertex(&self, layer: Layer, i: usize) -> usize {
        layer as usize * RING + i % RING
    }

    /// Mean of the vertices of a ring [T 3.1], m.
    pub fn ring_centre(&self, layer: Layer) -> V3 {
        self.positions[self.ring(layer)].iter().sum::<V3>() / RING as f64
    }

    /// Names and vertex indices.
    pub fn feature_points(&self) -> Vec<(&'static str, usize)> {
        use Layer::*;
        let median = [
            (Hip, ["centre front hip", "centre back hip"]),
            (Waist, ["centre front waist", "centre back waist"]),
            (Chest, ["centre front chest", "centre back chest"]),
            (NeckBase, ["front neck point", "back neck point"]),
        ];
        let mut points = Vec::new();
        for (layer, [front, back]) in median {
            points.extend([(front, self.ring_vertex(layer, 6)), (back, self.ring_vertex(layer, 18))]);
        }
        points.extend([
            ("right bust point", self.ring_vertex(Chest, 4)),
            ("left bust point", self.ring_vertex(Chest, 8)),
            ("right side neck point", self.ring_vertex(NeckBase, 0)),
            ("left side neck point", self.ring_vertex(NeckBase, 12)),
            ("right shoulder point", self.ring_vertex(ArmscyeRight, 16)),
            ("left shoulder point", self.ring_vertex(ArmscyeLeft, 16)),
            ("right armpit", self.ring_vertex(ArmscyeRight, 4)),
            ("left armpit", self.ring_vertex(ArmscyeLeft, 4)),
            ("crown", Self::end(2)),
        ]);
        points
    }

    pub(crate) fn snap(&mut self, landmarks: &Landmarks) {
        use Layer::*;
        let exact = [
            (NeckBase, 6, landmarks.front_neck),
            (NeckBase, 18, landmarks.back_neck),
            (NeckBase, 0, landmarks.side_neck[0]),
            (NeckBase, 12, landmarks.side_neck[1]),
            (Chest, 4, landmarks.bust[0]),
            (Chest, 8, landmarks.bust[1]),
            (ArmscyeRight, 16, landmarks.shoulder[0]),
            (ArmscyeLeft, 16, landmarks.shoulder[1]),
            (ArmscyeRight, 4, landmarks.armpit[0]),
            (ArmscyeLeft, 4, landmarks.armpit[1]),
        ];
        for (layer, i, point) in exact {
            let vertex = self.ring_vertex(layer, i);
            self.positions[vertex] = point;
        }
    }

    /// Feature lines along the body: name, and vertex indices from above. Girths are lines too, given by the rings.
    pub fn feature_lines(&self) -> Vec<(&'static str, Vec<usize>)> {
        use Layer::*;
        let trunk = [NeckBase, Axilla, Chest, UnderBust, Waist, Abdomen, Hip];
        let down =
            |layers: &[Layer], i: usize| layers.iter().map(|&layer| self.ring_vertex(layer, i)).collect::<Vec<_>>();
        let right_leg = [ThighRight, MidThighRight, KneeRight, CalfRight, AnkleRight];
        let left_leg = [ThighLeft, MidThighLeft, KneeLeft, CalfLeft, AnkleLeft];
        let side = |i: usize, leg: &[Layer]| [down(&trunk[4..], i), down(leg, i)].concat();
        vec![
            ("centre front", down(&trunk, 6)),
            ("centre back", down(&trunk, 18)),
            ("right outseam", side(0, &right_leg)),
            ("left outseam", side(12, &left_leg)),
            ("right inseam", down(&right_leg, 12)),
            ("left inseam", down(&left_leg, 0)),
            ("right shoulder line", vec![self.ring_vertex(NeckBase, 0), self.ring_vertex(ArmscyeRight, 16)]),
            ("left shoulder line", vec![self.ring_vertex(NeckBase, 12), self.ring_vertex(ArmscyeLeft, 16)]),
        ]
    }

    /// Joints [T 3.1]: centres of the rings between regions, and of the last rings of head, hands and feet.
    pub fn skeleton(&self) -> Skeleton {
        use Layer::*;
        let rings = [
            (Joint::Pelvis, Hip),
            (Joint::Waist, Waist),
            (Joint::Chest, Axilla),
            (Joint::Neck, NeckBase),
            (Joint::Head, HeadGirth),
            (Joint::ShoulderRight, ArmscyeRight),
            (Joint::ElbowRight, ElbowRight),
            (Joint::WristRight, WristRight),
            (Joint::ShoulderLeft, ArmscyeLeft),
            (Joint::ElbowLeft, ElbowLeft),
            (Joint::WristLeft, WristLeft),
            (Joint::HipRight, ThighRight),
            (Joint::KneeRight, KneeRight),
            (Joint::AnkleRight, AnkleRight),
            (Joint::HipLeft, ThighLeft),
            (Joint::KneeLeft, KneeLeft),
            (Joint::AnkleLeft, AnkleLeft),
        ];
        let mut joints = [V3::zeros(); 17];
        for (joint, layer) in rings {
            joints[joint as usize] = self.ring_centre(layer);
        }
        Skeleton { joints }
    }

    /// Index of a yoke vertex: `side` 0 is front and 1 back, `row` counts from below, `place` along the row.
    pub(super) fn yoke(side: usize, row: usize, place: usize) -> usize {
        Layer::ALL.len() * RING + (side * YOKE_ROWS + row) * YOKE + place
    }

    /// Index of an end vertex: right sole, left sole, crown, right hand, left hand.
    pub(crate) fn end(i: usize) -> usize {
        Layer::ALL.len() * RING + 2 * YOKE_ROWS * YOKE + i
    }
}
