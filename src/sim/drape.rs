//! What both simulators return, and how they report while they run.

use geom::V3;

/// How far a garment has come.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Stage {
    /// All seams are closed.
    Sewn,
    /// The garment has its pattern's size again, in Hybrid-GS alone.
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
    /// Rms residual force over the mean vertex weight.
    pub residual: f64,
    /// Greatest seam gap, m.
    pub seam_gap_m: f64,
    /// Mean chi over the measurements.
    pub e_chi: f64,
}

/// A sewn garment on a body.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Drape {
    /// How far it came.
    pub stage: Stage,
    /// World position of each garment vertex, m; the vertices of a seam pair coincide.
    pub positions: Vec<V3>,
    /// Whether the residual reached its tolerance with all seams closed.
    pub converged: bool,
    /// Iterations over all levels.
    pub iterations: u32,
    /// Rms residual force over the mean vertex weight.
    pub residual: f64,
    /// Deepest penetration of a vertex, edge or face sample into the body, m (0 when none).
    pub penetration_max_m: f64,
    /// Greatest distance between the two vertices of a seam pair, m.
    pub seam_gap_max_m: f64,
    /// Edges that pierce the garment's own cloth.
    pub self_crossings: usize,
    /// Force that holds it up by its top edge, N, where it would slide off by itself.
    pub braced_n: Option<f64>,
    /// Whether no step lowered its energy any more, though it was not at rest.
    #[serde(default)]
    pub is_stuck: bool,
    /// Vertices once sewn (each welded group counts once).
    pub welded_vertices: usize,
    /// The run, step by step.
    pub history: Vec<Step>,
    /// The stages before this one, in order, where the simulator tells them apart.
    pub earlier: Vec<Staged>,
    /// Where its vertices would be, had they kept their places on the body, m; of a drape that was carried into another pose.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub kept: Option<Vec<V3>>,
}

/// A garment as a stage left it.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Staged {
    /// Stage at whose end it was taken.
    pub stage: Stage,
    /// World position of each garment vertex, m.
    pub positions: Vec<V3>,
}

/// What a simulator says while it works.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// What it is doing (`sew`, `drape`, ...).
    pub phase: &'static str,
    /// Share done, 0 to 1, as far as it can be told; never falls.
    pub fraction: f64,
    /// The latest step.
    pub step: Step,
}

/// Receives progress and may ask to stop. Implemented by whoever runs a simulation.
pub trait Monitor {
    /// Called after each step; cheap.
    fn progress(&mut self, progress: &Progress);
    /// Asked between steps; `true` ends the simulation with an error.
    fn cancelled(&self) -> bool {
        false
    }
    /// Whether a garment that ends with open seams or another fault is put on again otherwise: it takes as long each time.
    fn tries_again(&self) -> bool {
        true
    }
    /// Whether a live picture is wanted now; then [`Monitor::snapshot`] follows.
    fn wants_snapshot(&mut self) -> bool {
        false
    }
    /// Positions of the garment at this moment.
    fn snapshot(&mut self, _positions: &[V3]) {}
}

/// Listens to nothing.
#[derive(Clone, Copy, Debug, Default)]
pub struct Silent;

impl Monitor for Silent {
    fn progress(&mut self, _: &Progress) {}
}
