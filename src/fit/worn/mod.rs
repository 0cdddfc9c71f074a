//! How a garment is worn: what a fitter sees and feels on the body [ISO 20947-2].
//!
//! [`Section`] cuts body and cloth and measures the air between them. [`Hang`] is the balance of hem, waist edge and
//! side seams. [`folds()`] finds what stands off the skin in lines, [`pressed`] sums pressure up over the regions of a
//! body.

mod folds;
mod hang;
mod region;
mod section;

pub use folds::{Fold, Worn, folds};
pub use hang::{Hang, Sides, hang};
pub use region::{Pressed, Region, pressed};
pub use section::{Angle, DIRECTIONS, Section, Site, sites};
