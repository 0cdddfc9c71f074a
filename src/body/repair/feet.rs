//! Detection of missing feet in a scan. Scanners lose feet and pipelines cut them off, and the rest then stands on its
//! ankles as if on the floor.
//!
//! A foot is longer than any part of the leg above it is deep. It is sought at the lower end of each leg, before holes
//! are closed.

use geom::{TriMesh, V2, V3, hull};

/// Height of the examined end of a leg, as a share of the height of the mesh. No instep is higher.
const END: f64 = 0.06;

/// Least length of a foot / stature. People have 0.15, with a standard deviation of 0.005 [Gordon 2014], model bodies
/// at least 0.132. A leg cut 40 mm above the floor has at most 0.128 left, one cut at the ankle 0.09.
const FOOT: f64 = 0.130;

/// The same for a leg without a hole: a shoe or a raised heel shortens what stands on the floor. Judgement.
const CLOSED_FOOT: f64 = 0.115;

/// A hole is the end of a leg if it is as low as the leg, up to this share of the height, and at least as long as this
/// share of the end of the leg. Judgement.
const AS_LOW: f64 = 0.005;
const WHOLE_END: f64 = 0.5;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Feet {
    pub right: bool,
    pub left: bool,
}

impl Feet {
    pub const BOTH: Self = Self { right: true, left: true };

    pub fn of(mesh: &TriMesh, rims: &[Vec<usize>]) -> Self {
        let Some((low, high)) = mesh.bounds() else { return Self::BOTH };
        let middle = (low.x + high.x) / 2.0;
        let has = |side: f64| has_foot(mesh, rims, high.z - low.z, |p| side * (p.x - middle) > 0.0);
        Self { right: has(1.0), left: has(-1.0) }
    }

    /// True if the floor is known, because at least one foot stands on it.
    pub fn stand(self) -> bool {
        self.right || self.left
    }

    /// Note for the user on missing feet. `None` if both are there.
    pub fn note(self) -> Option<String> {
        let note = match (self.right, self.left) {
            (true, true) => return None,
            (false, false) => {
                "the feet are missing, so that the floor is not known: the volume, heights, and what is placed by a share of the stature \
                 (waist, upper arm, knee, calf, ankle, shoulders, tailor's lengths) are left out"
            }
            (false, true) => {
                "the right foot is missing: the volume, and the girths of that leg below the knee are left out"
            }
            (true, false) => "the left foot is missing: the volume is left out",
        };
        Some(note.to_owned())
    }
}

fn has_foot(mesh: &TriMesh, rims: &[Vec<usize>], height: f64, is_of: impl Fn(&V3) -> bool) -> bool {
    let side = || mesh.positions.iter().filter(|p| is_of(p));
    let low = side().map(|p| p.z).fold(f64::INFINITY, f64::min);
    let end = reach(side().filter(|p| p.z < low + END * height).map(V3::xy));
    let is_end = |rim: &Vec<usize>| {
        let points = || rim.iter().map(|&i| mesh.positions[i]);
        let is_low = points().any(|p| is_of(&p) && p.z < low + AS_LOW * height);
        is_low && reach(points().map(|p| p.xy())) > WHOLE_END * end
    };
    let least = if rims.iter().any(is_end) { FOOT } else { CLOSED_FOOT };
    end >= least * height
}

/// Greatest distance between two of some points.
fn reach(points: impl Iterator<Item = V2>) -> f64 {
    let hull = hull::convex_hull(&points.collect::<Vec<_>>());
    let pairs = hull.iter().enumerate().flat_map(|(i, a)| hull[i + 1..].iter().map(move |b| (a - b).norm()));
    pairs.fold(0.0, f64::max)
}
