//! The pipeline in earnest: body, garment meshes, simulation and measuring, each stage through the cache.

use crate::sim::Simulator;

/// The simulators there are.
pub const SIMULATORS: [Simulator; 1] = [Simulator::Fem];

/// Versions of the stages, raised whenever one may give other numbers for the same inputs.
const VERSIONS: [(&str, u32); 3] = [("body.version", 1), ("field.version", 1), ("mesh.version", 1)];
/// Version of FEM-GS, likewise.
const FEM_VERSION: u32 = 1;
/// Version of Hybrid-GS, likewise.
const HYBRID_VERSION: u32 = 1;

/// The versions a simulator's results depend on, as inputs.
pub(crate) fn versions(simulator: Simulator) -> impl Iterator<Item = (&'static str, u32)> {
    let own = match simulator {
        Simulator::Fem => FEM_VERSION,
        Simulator::Hybrid => HYBRID_VERSION,
    };
    VERSIONS.into_iter().chain([("sim.version", own)])
}
