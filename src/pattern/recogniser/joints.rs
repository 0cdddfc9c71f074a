//! Vertices of the sewn surface: where the ends of stretches meet, over the seams that are stated.
//!
//! Around an inner vertex of cloth that lies flat the angles sum to 360 degrees, along the boundary mostly to 180.

use super::facts::{Fact, Facts};
use super::stretch::Stretch;

/// Numbers of a pair: six of each end, and whether both parts are joined already.
pub const JOINTS: usize = 13;

/// Round one end of a stretch, over stated seams.
#[derive(Clone, Copy)]
struct Walk {
    /// Sum of the angles.
    angle: f64,
    /// Stretch that is met.
    last: usize,
}

pub struct Joints {
    before: Vec<Walk>,
    behind: Vec<Walk>,
    /// For each stretch, the first part that its part is joined to.
    joined: Vec<usize>,
}

impl Joints {
    pub fn of(stretches: &[Stretch], facts: &Facts) -> Self {
        let partner = |k: usize| match facts.of(k) {
            Some(Fact::Sewn(other)) => Some(other),
            _ => None,
        };
        let walk = |from: usize, angle: fn(&Stretch) -> f64, beside: fn(&Stretch) -> usize| {
            let (mut at, mut sum) = (from, 0.0);
            for _ in 0..stretches.len() {
                sum += angle(&stretches[at]);
                let met = beside(&stretches[at]);
                match partner(met) {
                    Some(next) if met != from => at = next,
                    _ => return Walk { angle: sum, last: met },
                }
            }
            Walk { angle: sum, last: beside(&stretches[at]) }
        };
        let all = 0..stretches.len();
        let mut heads: Vec<usize> = (0..stretches.last().map_or(0, |last| last.part + 1)).collect();
        for (k, other) in all.clone().filter_map(|k| Some((k, partner(k)?))) {
            let [a, b] = [k, other].map(|k| heads[stretches[k].part]);
            heads.iter_mut().filter(|head| **head == a.max(b)).for_each(|head| *head = a.min(b));
        }
        Self {
            before: all.clone().map(|k| walk(k, |stretch| stretch.start_angle, |stretch| stretch.previous)).collect(),
            behind: all.map(|k| walk(k, |stretch| stretch.end_angle, |stretch| stretch.next)).collect(),
            joined: stretches.iter().map(|stretch| heads[stretch.part]).collect(),
        }
    }

    /// Evidence of sewing `i` to `j`.
    pub fn of_pair(&self, i: usize, j: usize) -> [f32; JOINTS] {
        let mut numbers = [0.0; JOINTS];
        numbers[..6].copy_from_slice(&self.end(i, j));
        numbers[6..12].copy_from_slice(&self.end(j, i));
        numbers[12] = f32::from(u8::from(self.joined[i] == self.joined[j]));
        numbers
    }

    /// Of the vertex where `i` begins and `j` ends.
    fn end(&self, i: usize, j: usize) -> [f32; 6] {
        let is_inner = self.before[i].last == j;
        let near = |angle: f64, scale: f64| (-angle.abs() / scale).exp() as f32;
        if is_inner {
            let over = self.before[i].angle - 360.0;
            [near(over, 10.0), near(over, 40.0), (over / 180.0).clamp(-2.0, 2.0) as f32, 0.0, 0.0, 0.0]
        } else {
            let angle = self.before[i].angle + self.behind[j].angle;
            let over = angle - 180.0;
            let is_wide = f32::from(u8::from(angle > 370.0));
            [0.0, 0.0, 0.0, near(over, 10.0), (over / 180.0).clamp(-1.0, 2.0) as f32, is_wide]
        }
    }
}
