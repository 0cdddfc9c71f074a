//! The mannequin: template skin carried to a figure and fitted to the tape, with a control mesh.

pub mod build;
pub mod control;
pub mod control_cut;
pub mod control_file;
mod figure_sites;
pub mod figured;
mod fit;
mod limb_tape;
mod template;
