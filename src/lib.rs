//! Toile: a fit-study workbench. Bodies are dressed in sewing patterns by two simulators, each drape is measured
//! against its pattern, and the evidence says which simulator to trust for which fit.
//!
//! The modules are the stages of the pipeline, in the order data flows: [`body`] and [`pattern`] make the inputs,
//! [`sim`] drapes, [`measure`] and [`fit`] judge, [`render`] and [`report`] show, [`study`] keeps and runs it all,
//! [`cli`] and [`tui`] are its two faces. SI units inside; millimetres, degrees and milliseconds at the edges.

pub mod units;

pub mod geom;

pub mod body;
pub mod pattern;

pub mod sim;

pub mod fit;
pub mod measure;

pub mod render;
pub mod report;

pub mod study;

pub mod cli;
pub mod tui;
