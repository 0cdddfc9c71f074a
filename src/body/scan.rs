//! Bodies from scans: aligned, cleaned, repaired and measured.

use super::measure::{self, Girths};
use super::{BodyError, Imported, LengthUnit, Sex, import, repair};

/// A body scan in the world frame, with what the tape reads on it.
#[derive(Clone, Debug, PartialEq)]
pub struct Scan {
    /// The scan: upright, facing `y`, without strays and floor; smoothed where it was rough, its holes closed.
    pub imported: Imported,
    /// Measurements.
    pub girths: Girths,
}

/// Reads and measures a body scan (OBJ, PLY or STL) of any orientation; the unit is given or told from the height, the
/// sex places the waist.
///
/// # Errors
/// Those of [`import`], and [`BodyError::MissingPart`] where a part of the body is not found.
pub fn from_scan(bytes: &[u8], unit: Option<LengthUnit>, sex: Option<Sex>) -> Result<Scan, BodyError> {
    let mut imported = import(bytes, unit)?;
    repair::repair(&mut imported.mesh, &mut imported.notes);
    let floor = imported.mesh.bounds().map_or(0.0, |(low, _)| low.z);
    imported.mesh.positions.iter_mut().for_each(|p| p.z -= floor);
    let girths = measure::measure(&imported.mesh, sex)?;
    Ok(Scan { imported, girths })
}

#[cfg(test)]
#[path = "scan_tests.rs"]
mod tests;
