//! Toile: a fit-study workbench. Bodies are dressed in sewing patterns by two simulators, each drape is measured
//! against its pattern, and the evidence says which simulator to trust for which fit.
//!
//! The crates are the stages of the pipeline, in the order data flows. [`body`] and [`pattern`] make the inputs.
//! [`sim`] drapes by means of [`linalg`]. [`fit`] measures and judges, [`render`] and [`report`] show. [`store`] keeps
//! it all, [`spec`] reads what a study file asks for, [`wardrobe`] holds what is worn and by whom, [`engine`] runs,
//! [`results`] and [`advice`] answer. [`cli`] and [`tui`] are the two faces. All stand on [`geom`]. SI units inside; millimetres, degrees
//! and milliseconds at the edges.
//!
//! # Dressing a body
//! A man of 1.76 m, the drafted T-shirt in size M, the first fabric of the library, and FEM-GS on a coarse mesh:
//!
//! ```
//! use toile::body::{self, Measurements, Sex};
//! use toile::geom::DistanceField;
//! use toile::measure;
//! use toile::pattern::{Style, draft::Model};
//! use toile::sim::{Silent, fabric, fem};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! // What is not measured is estimated. The field says how far the skin is from any point.
//! let body = body::build(&Measurements::of(Sex::Male, 1.76))?;
//! let field = DistanceField::build(&body.mesh, 0.01)?;
//!
//! // Pieces and seams make a style; a style is meshed, and keeps its measurements.
//! let medium = &Model::Tshirt.drafts()[1];
//! let style = Style::read(&medium.pieces, Model::Tshirt.seams(), "tshirt.seams.toml")?;
//! let garment = style.mesh(0.05)?;
//!
//! // The garment is placed, sewn and draped; meshes go from coarse to fine, here there is one.
//! let cotton = &fabric::library()[0];
//! let drape = fem::simulate(&body, &field, &[garment.clone()], cotton, &fem::Params::default(), &mut Silent)?;
//!
//! // chi is a length on the drape over its length in the pattern: 1 where nothing is stretched.
//! let chis = measure::measure(&garment, &drape.positions);
//! let metrics = measure::metrics(&chis).ok_or("no measurements")?;
//! assert!(drape.converged && metrics.n == 9 && metrics.ei < 0.02);
//! # Ok(())
//! # }
//! ```
//!
//! `examples/dress.rs` does the same on finer meshes and writes a file for Blender; `examples/compare.rs` sets both simulators
//! beside each other. [`engine`] shows how a whole study is queued and run.

pub use geom::{self, units};

pub use body;
pub use pattern;

pub use linalg;
pub use sim;

pub use fit::{self, measure};

pub use render;
pub use report;

pub use advice;
pub use engine;
pub use results;
pub use spec;
pub use store;
pub use wardrobe;

pub use cli;
pub use tui;
