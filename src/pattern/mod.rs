//! The pattern (PDM, thesis 3.3): from DXF and a seam file to a sewable garment mesh and its pattern lengths.

pub mod garment;

pub use garment::{FitLevel, Garment, MaterialPoint, Measurement, MeasurementKind, PieceMesh, Role, Run, SeamMesh};
