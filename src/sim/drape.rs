//! Result of both simulators, and their progress reports.

use geom::V3;

/// Stage of a simulation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Stage {
    /// All seams are closed.
    Sewn,
    /// The pieces have the size of the pattern again (pop-up), in Hybrid-GS only.
    Popup,
    /// The garment is at rest on the body.
    Drape,
}

impl Stage {
    /// Name in SQL.
    #[must_use]
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Sewn => "sewn",
            Self::Popup => "popup",
            Self::Drape => "drape",
        }
    }
}

/// One recorded step of a simulation.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Step {
    /// Iteration number, over all levels.
    pub iteration: u32,
    /// Mesh level, 0 the coarsest.
    pub level: u32,
    /// Root mean square of the residual forces, over the mean weight of a vertex.
    pub residual: f64,
    /// Greatest seam gap, m.
    pub seam_gap_m: f64,
    /// Mean chi over the measurements.
    pub e_chi: f64,
}

/// A sewn garment on a body.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Drape {
    /// Last stage that the simulation reached.
    pub stage: Stage,
    /// World position of each garment vertex, m; the vertices of a seam pair coincide.
    pub positions: Vec<V3>,
    /// True if the residual reached its tolerance with all seams closed.
    pub converged: bool,
    /// Iterations over all levels.
    pub iterations: u32,
    /// Root mean square of the residual forces, over the mean weight of a vertex.
    pub residual: f64,
    /// Greatest penetration of a vertex, edge or face sample into the body, m; 0 where there is none.
    pub penetration_max_m: f64,
    /// Greatest distance between the two vertices of a seam pair, m.
    pub seam_gap_max_m: f64,
    /// Number of edge-triangle intersections of the cloth with itself.
    pub self_crossings: usize,
    /// Force with which braces hold the garment up by its top edge, N; `None` where it holds by itself.
    pub braced_n: Option<f64>,
    /// True if the line search found no lower energy in any step, though the residual was above its tolerance.
    #[serde(default)]
    pub is_stuck: bool,
    /// Number of simulated vertices after sewing; each welded group counts once.
    pub welded_vertices: usize,
    /// Recorded steps of the simulation.
    pub history: Vec<Step>,
    /// Earlier stages, in order, where the simulator distinguishes them.
    pub earlier: Vec<Staged>,
    /// Of a drape that was carried into another pose: positions that the vertices would have, had they kept their
    /// places on the body, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub kept: Option<Vec<V3>>,
}

/// Garment at the end of a stage.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Staged {
    /// Stage that had ended.
    pub stage: Stage,
    /// World position of each garment vertex, m.
    pub positions: Vec<V3>,
}

/// Progress of a simulation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Phase of the work (`sew`, `drape`, ...).
    pub phase: &'static str,
    /// Estimated share of the work that is done, 0 to 1. It never decreases.
    pub fraction: f64,
    /// The latest step.
    pub step: Step,
}

/// Receives progress and may ask the simulation to stop. The caller of a simulation implements it.
pub trait Monitor {
    /// Receives the progress after each step. It should return quickly.
    fn progress(&mut self, progress: &Progress);
    /// Returns `true` to end the simulation between two steps with an error.
    fn cancelled(&self) -> bool {
        false
    }
    /// Returns `true` to have a garment with open seams or another fault simulated again from other starts. Each
    /// attempt takes as long as the first.
    fn tries_again(&self) -> bool {
        true
    }
    /// Returns `true` to be sent the positions now by [`Monitor::snapshot`].
    fn wants_snapshot(&mut self) -> bool {
        false
    }
    /// Receives the present positions of the garment, m.
    fn snapshot(&mut self, _positions: &[V3]) {}
}

/// A monitor that ignores everything and never stops a simulation.
#[derive(Clone, Copy, Debug, Default)]
pub struct Silent;

impl Monitor for Silent {
    fn progress(&mut self, _: &Progress) {}
}
