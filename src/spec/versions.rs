//! Versions of the stages. They are inputs of every job, so that a changed method makes its products again.

use crate::parameters;
use fit::Simulator;

/// Versions of the stages. A stage's number rises whenever it may give other results for the same inputs.
pub const VERSIONS: [(&str, u32); 3] = [("body.version", 7), ("field.version", 4), ("mesh.version", 9)];
/// Version of the measurement of scans, an input only of subjects that are scans.
pub(crate) const SCAN_VERSION: u32 = 3;
/// Version of the measurement of drapes. When it rises, stored drapes are measured again without a simulation.
const MEASURE_VERSION: u32 = 1;
/// Version of the simulators. Their default parameters are inputs of their own
/// ([`default_hash`](parameters::default_hash)).
const SIM_VERSION: u32 = 48;

/// Spacing of the distance field's nodes: the 99th percentile of its error is then about 0.1 mm.
pub const FIELD_SPACING_M: f64 = 0.005;

/// Inputs of every job besides those from the study: versions and parameters of the stages.
pub(crate) fn versions(simulator: Simulator) -> Vec<(&'static str, String)> {
    let mut versions: Vec<_> = VERSIONS.iter().map(|(name, version)| (*name, version.to_string())).collect();
    versions.push(("field.spacing_mm", (FIELD_SPACING_M * 1e3).to_string()));
    versions.push(("measure.version", MEASURE_VERSION.to_string()));
    versions.push(("sim.version", SIM_VERSION.to_string()));
    versions.push(("sim.parameters", parameters::default_hash(simulator)));
    versions
}
