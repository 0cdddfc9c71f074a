//! Insets of the body for tight cloth that no ring represents: at armholes, necklines, cuffs, low waists.
//!
//! Cloth that lies on the body and is stretched there lacks room. The body counts as smaller for it, vertex by vertex,
//! until it is stretched no more. Tight cloth then lies inside the body and keeps its size, as rings do.

geom::constants! {
    "hybrid.give",
    /// Correction of an inset per stretch: a share of the radius of trunk and limbs.
    const GAIN_M: f64 = 0.06;
    /// Stretch beyond which cloth that lies on the body counts as tight: its weight stretches hanging cloth by less.
    const TIGHT: f64 = 0.02;
    /// Greatest inset: with more an arm would have no inside left.
    const MOST_M: f64 = 0.04;
    /// Rounds of averaging with neighbours: the stretches of single triangles fluctuate.
    const SHARED: u32 = 4;
}

#[derive(Clone, Debug)]
pub struct Give {
    pub now_m: Vec<f64>,
    /// True for vertices that the body gives way to.
    gives: Vec<bool>,
    was_tight: Vec<bool>,
}

pub struct Lying<'a> {
    /// Greatest principal stretch less 1 at each vertex.
    pub stretches: &'a [f64],
    /// True for vertices that lie on the body with its present insets.
    pub touches: &'a [bool],
    pub sides: &'a [([usize; 2], f64)],
}

impl Give {
    pub fn new(count: usize) -> Self {
        Self { now_m: vec![0.0; count], gives: vec![false; count], was_tight: vec![false; count] }
    }

    /// Judges which vertices the body gives way to: those that lie on it and were tight at the last judgement as well.
    /// Cloth that is tight only once is still moving out of the body.
    pub fn judge(&mut self, lying: &Lying) {
        let shared = lying.shared();
        let was = std::mem::take(&mut self.was_tight);
        self.was_tight = (0..shared.len()).map(|v| lying.touches[v] && shared[v] > TIGHT).collect();
        let lasts = |v: usize| self.was_tight[v] && was[v];
        self.gives = (0..shared.len()).map(|v| self.now_m[v] > 0.0 || lasts(v)).collect();
    }

    pub fn correct(&mut self, lying: &Lying, share: f64) {
        let shared = lying.shared();
        for (v, now) in self.now_m.iter_mut().enumerate().filter(|(v, _)| self.gives[*v]) {
            let lack = shared[v] - share;
            if lying.touches[v] || lack < 0.0 {
                *now = (*now + GAIN_M * lack).clamp(0.0, MOST_M);
            }
        }
    }
}

impl Lying<'_> {
    fn shared(&self) -> Vec<f64> {
        let mut shared = self.stretches.to_vec();
        for _ in 0..SHARED {
            let (mut sums, mut counts) = (shared.clone(), vec![1.0; shared.len()]);
            for &([a, b], _) in self.sides {
                sums[a] += shared[b];
                sums[b] += shared[a];
                counts[a] += 1.0;
                counts[b] += 1.0;
            }
            shared = sums.iter().zip(&counts).map(|(sum, count)| sum / count).collect();
        }
        shared
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sides() -> Vec<([usize; 2], f64)> {
        (1..10).map(|v| ([v - 1, v], 0.01)).collect()
    }

    #[test]
    fn the_body_gives_way_to_what_stays_tight_and_comes_back_where_it_is_slack() {
        let sides = sides();
        let lying = |stretches, touches| Lying { stretches, touches, sides: &sides };
        let (tight, slack, on, off) = ([0.1; 10], [-0.1; 10], [true; 10], [false; 10]);
        let mut give = Give::new(10);
        give.judge(&lying(&tight, &on));
        give.correct(&lying(&tight, &on), 0.0);
        assert!(give.now_m.iter().all(|now| *now == 0.0), "tight once: {:?}", give.now_m);
        give.judge(&lying(&tight, &on));
        give.correct(&lying(&tight, &on), 0.0);
        assert!(give.now_m.iter().all(|now| (now - 0.1 * GAIN_M).abs() < 1e-9), "{:?}", give.now_m);
        for _ in 0..100 {
            give.correct(&lying(&tight, &on), 0.0);
        }
        assert!(give.now_m.iter().all(|now| *now == MOST_M));
        // Cloth that does not touch needs no greater inset; slack cloth is pushed out again.
        give.correct(&lying(&tight, &off), 0.0);
        assert!(give.now_m.iter().all(|now| *now == MOST_M));
        for _ in 0..100 {
            give.correct(&lying(&slack, &off), 0.0);
        }
        assert!(give.now_m.iter().all(|now| *now == 0.0));
    }

    #[test]
    fn single_triangles_do_not_count() {
        let sides = sides();
        let mut stretches = [0.0; 10];
        stretches[5] = 0.05;
        let lying = Lying { stretches: &stretches, touches: &[true; 10], sides: &sides };
        let mut give = Give::new(10);
        give.judge(&lying);
        give.judge(&lying);
        give.correct(&lying, 0.0);
        assert!(give.now_m.iter().all(|now| *now == 0.0), "{:?}", give.now_m);
    }
}
