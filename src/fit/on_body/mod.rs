//! Fit of a garment on the body, as a fitter sees and feels it [ISO 20947-2].
//!
//! [`Section`] cuts body and cloth, and measures the air gap between them. [`Hang`] is the balance of hem, waist edge
//! and side seams. [`folds()`] finds folds and drag lines. [`pressed`] sums up the pressure on each region of a body.

mod air_gap;
mod balance;
mod folds;
mod pressure;

pub use air_gap::{Angle, DIRECTIONS, Section, Site, sites};
pub use balance::{Hang, Sides, hang};
pub use folds::{Fold, Worn, folds};
pub use pressure::{Pressed, Region, pressed};
