//! People: their dimensions, the survey of adults, and estimates of what was not measured.

pub mod dimension;
pub mod draw;
pub mod figures;
pub mod foreign;
pub mod likely;
pub mod profile;
pub mod survey;
