//! Toile: a fit-study workbench. Bodies are dressed in sewing patterns by two simulators, each drape is measured
//! against its pattern, and the evidence says which simulator to trust for which fit.
//!
//! The crates are the stages of the pipeline, in the order data flows: [`body`] and [`pattern`] make the inputs,
//! [`sim`] drapes by means of [`linalg`], [`fit`] measures and judges, [`render`] and [`report`] show, [`study`] keeps and runs it all,
//! [`cli`] and [`tui`] are its two faces. All stand on [`geom`]. SI units inside; millimetres, degrees and milliseconds at the edges.

pub use geom::{self, units};

pub use body;
pub use pattern;

pub use linalg;
pub use sim;

pub use fit::{self, measure};

pub use render;
pub use report;

pub use study;

pub use cli;
pub use tui;
