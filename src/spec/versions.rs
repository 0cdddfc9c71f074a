//! Versions of the stages. They are inputs of every job, so that a product of an earlier method is made again.

use crate::parameters;
use fit::Simulator;

/// Versions of the stages, raised whenever one may give other numbers for the same inputs.
pub const VERSIONS: [(&str, u32); 3] = [("body.version", 7), ("field.version", 4), ("mesh.version", 8)];
/// Version of the measurement of scans: an input of the subjects that are scans.
pub(crate) const SCAN_VERSION: u32 = 3;
/// Version of the measurement of drapes. Where it is raised, jobs are measured again on the drapes that are stored.
const MEASURE_VERSION: u32 = 1;
/// Version of the simulators, raised as those of the stages; their default parameters count as inputs by themselves.
const SIM_VERSION: u32 = 47;

/// Spacing of the distance field's nodes, m: the 99th percentile of its error is then about 0.1 mm.
pub const FIELD_SPACING_M: f64 = 0.005;

/// The inputs of every job besides the study's own: versions and parameters of the stages.
pub(crate) fn versions(simulator: Simulator) -> Vec<(&'static str, String)> {
    let mut versions: Vec<_> = VERSIONS.iter().map(|(name, version)| (*name, version.to_string())).collect();
    versions.push(("field.spacing_mm", (FIELD_SPACING_M * 1e3).to_string()));
    versions.push(("measure.version", MEASURE_VERSION.to_string()));
    versions.push(("sim.version", SIM_VERSION.to_string()));
    versions.push(("sim.parameters", parameters::default_hash(simulator)));
    versions
}
