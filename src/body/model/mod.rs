//! The mannequin: the template dressed on a figure, fitted to the tape, with its control mesh.

pub mod build;
pub mod control;
pub mod control_cut;
pub mod control_file;
mod fit;
mod limb_tape;
mod template;
