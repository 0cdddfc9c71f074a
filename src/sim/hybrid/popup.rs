//! Phase 3: pop-up (5.4). The sewn garment leaves the body's surface and takes its pattern's size, as rigid as possible
//! and with every measurement of the style under control.

use std::cmp::Ordering;

use super::relax::{Push, Relaxation};
use super::silhouette::Silhouette;
use super::welded_mesh::Sewn;
use body::Body;
use geom::V3;
use pattern::Garment;

geom::constants! {
    "hybrid.popup",
    /// Steps in which it grows, and in which it then comes to rest.
    const STEPS: [u32; 2] = [12, 16];
    const CORRECTIONS: u32 = 2;
    /// First guess for the change of the measurements' mean per change of all controls' lengths.
    const RESPONSE: f64 = 0.7;
    /// Least and greatest response that a correction may find, over `RESPONSE`.
    const FOUND: [f64; 2] = [0.3, 2.0];
    const NONE: f64 = 2e-5;
}

pub fn steps() -> u32 {
    STEPS[0] + STEPS[1]
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Backend {
    /// As rigid as possible with the pattern as rest shape, every measurement under control.
    #[default]
    Rigid,
    /// Pyramid coordinates between free edges of the pattern's length [T 5.4].
    Pyramid,
}

#[derive(Clone, Copy)]
pub struct Cloth<'a> {
    pub garment: &'a Garment,
    pub sewn: &'a Sewn,
}

/// Calls `each` with the garment and the rms movement (m) after every step, which may end it early with an error.
/// `error` gives the signed mean error of the garment's size.
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

/// Triangles and controls grow from the size at which they were sewn to that of the pattern in equal steps. Until then
/// the body keeps its size and pushes the cloth out, or sleeves would swing through the arms. After that it yields
/// where the garment is too small. A step may overshoot the size by its momentum or by the softness of the controls, or
/// lead away from it: it is repeated with corrected lengths of the controls, by the secant method.
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

/// True if an error is no greater than the last and has the same sign, or is none.
fn is_nearer(now: f64, last: f64) -> bool {
    now.abs() < NONE || (now.abs() <= last.abs() && now * last >= 0.0)
}
