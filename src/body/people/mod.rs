//! What is known of people: their dimensions, the survey of adults, and the person behind some measurements.

pub mod dimension;
pub mod draw;
pub mod foreign;
pub mod likely;
pub mod profile;
pub mod survey;
