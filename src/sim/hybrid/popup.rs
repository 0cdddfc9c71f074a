//! Phase 3: pop-up (5.4). The sewn garment leaves the body's surface and takes its pattern's size, as rigid as possible and
//! under control of every measurement of the style.

use super::relax::{Push, Relaxation};

/// Steps of the pop-up.
pub const STEPS: u32 = 20;

/// Pops a garment up; calls `each` with the positions after every step, which ends it early with an error.
///
/// The controls get to their lengths halfway, so that the cloth around them can follow. Until then the body pushes the cloth
/// out, or sleeves would swing through the arms while they grow; then it yields.
///
/// # Errors
/// Those of `each`.
pub fn reconstruct<E>(
    relaxation: &mut Relaxation,
    mut each: impl FnMut(&Relaxation) -> Result<(), E>,
) -> Result<(), E> {
    for step in 1..=STEPS {
        let share = 2.0 * f64::from(step) / f64::from(STEPS);
        relaxation.step(Push { unlimited: share < 1.0, gravity: 0.0, share: share.min(1.0) });
        each(relaxation)?;
    }
    Ok(())
}
