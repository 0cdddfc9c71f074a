//! Bodies from pictures: the person in them, silhouettes, and the girths between two views.

pub mod facing;
mod outline;
pub mod pictures;
mod sections;
mod segment;
mod silhouette;
mod trunk;
