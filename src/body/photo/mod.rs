//! Bodies from pictures: segmentation, silhouettes, and girths from two views.

pub mod camera;
pub mod facing;
mod outline;
pub mod pictures;
mod sections;
mod segment;
mod silhouette;
mod trunk;

use crate::BodyError;

fn refused(view: &'static str, problem: impl Into<String>) -> BodyError {
    BodyError::Picture { view, problem: problem.into() }
}
