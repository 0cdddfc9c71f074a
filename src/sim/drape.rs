//! Result of both simulators, and their progress reports.

use geom::V3;

#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Stage {
    Sewn,
    /// The pieces have the size of the pattern again, in Hybrid-GS only.
    Popup,
    Drape,
}

impl Stage {
    /// Name in SQL.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Sewn => "sewn",
            Self::Popup => "popup",
            Self::Drape => "drape",
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Step {
    /// Number over all levels.
    pub iteration: u32,
    /// 0 is the coarsest.
    pub level: u32,
    /// Root mean square of the residual forces, over the mean weight of a vertex.
    pub residual: f64,
    /// Greatest gap.
    pub seam_gap_m: f64,
    pub e_chi: f64,
}

/// Sewn garment on a body.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Drape {
    pub stage: Stage,
    /// Positions of the garment vertices; those of a seam pair coincide.
    pub positions: Vec<V3>,
    /// True if the residual reached its tolerance with all seams closed.
    pub converged: bool,
    /// Iterations over all levels.
    pub iterations: u32,
    /// Root mean square of the residual forces, over the mean weight of a vertex.
    pub residual: f64,
    /// Of a vertex, edge or face sample into the body; 0 where there is none.
    pub penetration_max_m: f64,
    /// Greatest distance between the two vertices of a seam pair.
    pub seam_gap_max_m: f64,
    /// Edge-triangle intersections of the cloth with itself.
    pub self_crossings: usize,
    /// Force with which braces hold the garment up by its top edge; `None` where it holds by itself.
    pub braced_n: Option<f64>,
    /// True if no step of the line search found a lower energy, though the residual was above its tolerance.
    #[serde(default)]
    pub is_stuck: bool,
    /// Simulated vertices after sewing; each welded group counts once.
    pub welded_vertices: usize,
    pub history: Vec<Step>,
    /// In order, where the simulator distinguishes them.
    pub earlier: Vec<Staged>,
    /// Of a drape that was carried into another pose: positions that the vertices would have, had they kept their
    /// places on the body.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub kept: Option<Vec<V3>>,
}

#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Staged {
    pub stage: Stage,
    pub positions: Vec<V3>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// `sew`, `drape`, ...
    pub phase: &'static str,
    /// Estimated share of the work that is done, 0 to 1. It never decreases.
    pub fraction: f64,
    pub step: Step,
}

/// Receives progress and may ask the simulation to stop.
pub trait Monitor {
    /// Called after each step; should return quickly.
    fn progress(&mut self, progress: &Progress);
    /// `true` ends the simulation between two steps with an error.
    fn cancelled(&self) -> bool {
        false
    }
    /// `true` has a garment with open seams or another fault simulated again from other starts. Each attempt takes as
    /// long as the first.
    fn tries_again(&self) -> bool {
        true
    }
    /// `true` asks for [`Monitor::snapshot`] now.
    fn wants_snapshot(&mut self) -> bool {
        false
    }
    fn snapshot(&mut self, _positions: &[V3]) {}
}

/// Ignores everything and never stops a simulation.
#[derive(Clone, Copy, Debug, Default)]
pub struct Silent;

impl Monitor for Silent {
    fn progress(&mut self, _: &Progress) {}
}
