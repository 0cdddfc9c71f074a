//! Phase 3: pop-up (5.4). The sewn garment leaves the body's surface and takes its pattern's size, as rigid as possible and
//! under control of every measurement of the style.

use super::relax::{Push, Relaxation};

/// Steps in which it grows, and in which it then comes to rest.
const STEPS: [u32; 2] = [12, 16];

/// Number of steps of the pop-up.
#[must_use]
pub fn steps() -> u32 {
    STEPS[0] + STEPS[1]
}

/// Pops a garment up; calls `each` with it after every step, which ends it early with an error.
///
/// Triangles and controls go from the size they were sewn at to that of the pattern in equal steps. Until then the body
/// pushes the cloth out, or sleeves would swing through the arms while they grow; then it yields.
///
/// # Errors
/// Those of `each`.
pub fn reconstruct<E>(
    relaxation: &mut Relaxation,
    mut each: impl FnMut(&Relaxation) -> Result<(), E>,
) -> Result<(), E> {
    for step in 1..=steps() {
        let share = f64::from(step) / f64::from(STEPS[0]);
        relaxation.step(Push { unlimited: share < 1.0, gravity: 0.0, share: share.min(1.0) });
        each(relaxation)?;
    }
    Ok(())
}
