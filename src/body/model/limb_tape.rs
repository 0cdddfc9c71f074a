//! The tape on limbs with known axes.

use crate::measure::sites::Sites;
use crate::measure::slices::steps;
use crate::measure::tape;
use crate::shape::figure::Figure;
use crate::{Dimension, Girths};
use geom::section::{Plane, section};
use geom::{TriMesh, V2, V3};

/// Half range of heights in which the greatest calf girth and the least ankle girth are sought / stature. Judgement.
const CALF_REACH: f64 = 0.03;
const ANKLE_REACH: f64 = 0.012;

/// Height of the ankle girth / stature. Judgement.
const ANKLE: f64 = 0.072;

/// Sites of the tape on right arm and leg, m.
pub(super) struct LimbSites {
    stature: f64,
    knee: f64,
    calf: f64,
    shoulder: V3,
    /// Centres of forearm (where thickest), elbow and wrist.
    forearm: V3,
    elbow: V3,
    wrist: V3,
    /// Axes of the arm: outwards, forwards, down the arm.
    axes: [V3; 3],
}

impl LimbSites {
    pub fn of(figure: &Figure, sites: &Sites) -> Self {
        let [elbow, wrist, _] = figure.arm_lengths();
        let axes = figure.arm_axes();
        let joint = figure.shoulder_joint();
        let on_axis = |t: f64| joint + axes[2] * t;
        let [knee, calf] = figure.knee_and_calf();
        let forearm = on_axis(elbow + 0.2 * (wrist - elbow));
        let (elbow, wrist) = (on_axis(elbow), on_axis(wrist));
        Self { stature: figure.stature(), knee, calf, shoulder: sites.shoulder[0], forearm, elbow, wrist, axes }
    }

    pub fn read(&self, mesh: &TriMesh, girths: &mut Girths) {
        let h = self.stature;
        let shank = mesh.part(|p| p.z < self.knee + 0.03 * h && p.x > 0.0);
        let leg = |z: f64| tape::leg_girth(&shank, z, 0.0);
        girths.set(Dimension::KneeGirth, leg(self.knee));
        let calf = steps(self.calf - CALF_REACH * h, self.calf + CALF_REACH * h, 6).filter_map(leg);
        girths.set(Dimension::CalfGirth, calf.max_by(f64::total_cmp));
        let ankle = steps((ANKLE - ANKLE_REACH) * h, (ANKLE + ANKLE_REACH) * h, 4).filter_map(leg);
        girths.set(Dimension::AnkleGirth, ankle.min_by(f64::total_cmp));
        let arm = mesh.part(|p| (p - self.forearm).norm() < 0.2 * h);
        let round = |centre: V3| tape::girth_round(&arm, centre, self.axes[2]);
        girths.set(Dimension::ForearmGirth, round(self.forearm));
        girths.set(Dimension::WristGirth, round(self.wrist));
        girths.set(Dimension::ArmLength, self.arm_length(&arm));
    }

    /// Length of the tape from the shoulder point along the outside of elbow and wrist, m.
    fn arm_length(&self, arm: &TriMesh) -> Option<f64> {
        let outside = |centre: V3| {
            let plane = Plane { origin: centre, u: self.axes[1], v: self.axes[0] };
            let outlines = section(arm, &plane);
            let outline = outlines.iter().find(|outline| outline.contains(V2::zeros()))?;
            outline.points.iter().max_by(|a, b| a.y.total_cmp(&b.y)).map(|p| plane.lift(*p))
        };
        let (elbow, wrist) = (outside(self.elbow)?, outside(self.wrist)?);
        Some((elbow - self.shoulder).norm() + (wrist - elbow).norm())
    }
}
