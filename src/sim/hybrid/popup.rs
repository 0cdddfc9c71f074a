//! Phase 3: pop-up (5.4). The sewn garment leaves the body's surface and takes its pattern's size, as rigid as possible and
//! under control of every measurement of the style.

use std::cmp::Ordering;

use super::relax::{Push, Relaxation};
use super::sewn::Sewn;
use super::silhouette::Silhouette;
use body::Body;
use geom::V3;
use pattern::Garment;

geom::constants! {
    "hybrid.popup",
    /// Steps in which it grows, and in which it then comes to rest.
    const STEPS: [u32; 2] = [12, 16];
    /// Times that the controls are set anew in a step, at most.
    const CORRECTIONS: u32 = 2;
    /// What a change of all controls' lengths changes their mean by, at first guess.
    const RESPONSE: f64 = 0.7;
    /// Least and greatest response that a correction may have found, over that guess.
    const FOUND: [f64; 2] = [0.3, 2.0];
    /// Error that counts as none.
    const NONE: f64 = 2e-5;
}

/// Number of steps of the pop-up.
#[must_use]
pub fn steps() -> u32 {
    STEPS[0] + STEPS[1]
}

/// How the size comes back.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Backend {
    /// As rigid as possible with the pattern as rest shape, every measurement under control.
    #[default]
    Rigid,
    /// Pyramid coordinates between free edges of the pattern's length [T 5.4].
    Pyramid,
}

/// A sewn garment.
#[derive(Clone, Copy)]
pub struct Cloth<'a> {
    /// The garment as cut, whose sizes it takes back.
    pub garment: &'a Garment,
    /// The same with the seams welded.
    pub sewn: &'a Sewn,
}

/// Pops a garment up with one of the backends; calls `each` with it and the rms movement (m) after every step, which ends it
/// early with an error. `error` is how far the garment is from its size on average, signed.
///
/// # Errors
/// Those of `each`.
pub fn reconstruct<E>(
    backend: Backend,
    cloth: Cloth,
    relaxation: &mut Relaxation,
    body: &Body,
    error: impl Fn(&[V3]) -> f64,
    mut each: impl FnMut(&Relaxation, f64) -> Result<(), E>,
) -> Result<(), E> {
    match backend {
        Backend::Rigid => rigid(cloth, relaxation, body, error, each),
        Backend::Pyramid => {
            let silhouette = Silhouette::new(cloth.garment, cloth.sewn);
            for step in 1..=steps() {
                let left = f64::from(STEPS[0].saturating_sub(step)) + 1.0;
                if step == STEPS[0] {
                    relaxation.judge(body, cloth.garment, cloth.sewn);
                }
                let next = silhouette.step(&relaxation.x, 1.0 / left);
                let moved = relaxation.put(next);
                each(relaxation, moved)?;
            }
            Ok(())
        }
    }
}

/// Pops up as rigid as possible.
///
/// Triangles and controls go from the size they were sewn at to that of the pattern in equal steps. Until then the body
/// pushes the cloth out, or sleeves would swing through the arms while they grow; then it yields where the garment is too small.
/// A step that would go past the size, on its momentum or because controls are soft, or lead away from it, is done again with
/// the controls' lengths set against that.
fn rigid<E>(
    cloth: Cloth,
    relaxation: &mut Relaxation,
    body: &Body,
    error: impl Fn(&[V3]) -> f64,
    mut each: impl FnMut(&Relaxation, f64) -> Result<(), E>,
) -> Result<(), E> {
    let mut last = error(&relaxation.x);
    for step in 1..=steps() {
        let share = f64::from(step) / f64::from(STEPS[0]);
        let push = Push { firm: false, gravity: 0.0, share: share.min(1.0), closer_m: 0.0 };
        match step.cmp(&STEPS[0]) {
            Ordering::Less => {}
            Ordering::Equal => relaxation.judge(body, cloth.garment, cloth.sewn),
            Ordering::Greater => relaxation.correct(),
        }
        let before = relaxation.place();
        let mut moved = relaxation.step(push);
        let mut now = error(&relaxation.x);
        let (mut response, mut tries) = (RESPONSE, 0);
        while !is_nearer(now, last) && tries < CORRECTIONS {
            let change = (0.5 * last - now) / response;
            relaxation.go_back(&before);
            relaxation.control += change;
            moved = relaxation.step(push);
            let next = error(&relaxation.x);
            response = ((next - now) / change).clamp(FOUND[0] * RESPONSE, FOUND[1] * RESPONSE);
            now = next;
            tries += 1;
        }
        last = now;
        each(relaxation, moved)?;
    }
    Ok(())
}

/// Whether an error is smaller than the last and has not changed sides, or is none.
fn is_nearer(now: f64, last: f64) -> bool {
    now.abs() < NONE || (now.abs() <= last.abs() && now * last >= 0.0)
}
