//! Sewing patterns ([T 3.3], pattern design module): reads a pattern file and a seam file, and makes a garment mesh
//! that is ready to sew, with its pattern lengths.

pub mod allowance;
pub mod arrange;
pub mod check;
mod curve;
pub mod draft;
pub mod drawing;
pub mod dxf;
pub mod features;
#[cfg(test)]
mod fuzz_tests;
pub mod garment;
pub mod garmentcode;
pub mod grade;
pub mod handle;
pub mod info;
pub mod inspect;
pub mod mesh;
pub mod piece;
pub mod pom;
pub mod progression;
pub mod propose;
pub mod recogniser;
pub mod scale;
pub mod seam_edit;
pub mod seams;
pub mod size_order;
pub mod source;
pub mod spec_sheet;
pub mod style;
pub mod table;
pub(crate) mod trade;
mod unfold;
pub mod workbook;

pub use garment::{
    Band, FitLevel, Garment, MaterialLine, MaterialPoint, Measurement, MeasurementKind, PieceMesh, Reinforcement, Role,
    SeamMesh, Spot,
};
pub use handle::{Handle, HandleError};
pub use mesh::{MeshError, MeshQuality};
pub use piece::{Notch, Piece};
pub use seams::StyleError;
pub use style::Style;
