//! The mannequin: the template skin carried to a figure, fitted to the tape, with its control mesh.

pub mod build;
pub mod control;
pub mod control_cut;
pub mod control_file;
mod figure_sites;
mod fit;
mod limb_tape;
mod template;
