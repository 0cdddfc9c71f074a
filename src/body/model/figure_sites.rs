//! Tape sites on the skin of a figure.

use crate::measure::landmarks::{self, Side};
use crate::measure::sites::{self, Sites};
use crate::measure::tape::{self, Neck};
use crate::shape::figure::Figure;
use crate::{BodyError, Dimension};
use geom::{TriMesh, V3};

/// Chest, hip and neck are found as on any mesh, so that the mesh measures what was fitted. Shoulder and waist are
/// known from the figure.
pub(super) fn find(mesh: &TriMesh, figure: &Figure) -> Result<Sites, BodyError> {
    let (atlas, h) = (figure.atlas, figure.stature());
    let crotch = crotch(mesh, figure)?;
    let trunk = mesh.part(|p| p.z > 0.63 * h && p.z < 0.82 * h);
    let chest = sites::chest_level(&trunk, 0.0, h, crotch, 0.0).unwrap_or(atlas.chest * h);
    let pelvis = mesh.part(|p| p.z > crotch && p.z < crotch + 0.11 * h);
    let upper = mesh.part(|p| p.z > 0.75 * h);
    let neck = tape::neck(&upper, 0.83 * h, 0.90 * h, 0.0).ok_or_else(|| missing("neck", 0.87 * h))?;
    let level = Sites {
        floor: 0.0,
        crown: h,
        middle: 0.0,
        crotch,
        hip: sites::hip_level(&pelvis, crotch, h, 0.0).unwrap_or_else(|| figure.hip()),
        waist: atlas.waist * h,
        underbust: underbust(&trunk, chest, figure),
        chest,
        neck,
        shoulder: [V3::zeros(); 2],
        back_neck: V3::zeros(),
        upper_sd: [0.0; 2],
        upper_arm: None,
    };
    hold(mesh, figure, &level)
}

/// Greatest distance of the under-bust level from the section that its girth adjusts, as a share of stature. Judgement:
/// farther away, that section would hardly change the girth.
const UNDERBUST_OFF: f64 = 0.012;

/// If its girth is given, the level stays near the section that is fitted to the girth.
fn underbust(trunk: &TriMesh, chest: f64, figure: &Figure) -> f64 {
    let found = sites::underbust_level(trunk, chest, figure.stature(), 0.0);
    if !figure.profile.is_given(Dimension::UnderbustGirth) {
        return found;
    }
    let (meant, off) = (figure.underbust(), UNDERBUST_OFF * figure.stature());
    found.clamp(meant - off, meant + off)
}

fn missing(part: &'static str, height: f64) -> BodyError {
    BodyError::MissingPart { part, height_m: height }
}

fn crotch(mesh: &TriMesh, figure: &Figure) -> Result<f64, BodyError> {
    let (meant, h) = (figure.crotch(), figure.stature());
    let (low, high) = (meant - 0.06 * h, meant + 0.06 * h);
    let groin = mesh.part(|p| p.z > low && p.z < high);
    landmarks::crotch(&groin, low, high, 0.0).ok_or_else(|| missing("crotch", meant))
}

/// Sites on a changed skin: levels of chest, hip and neck are kept, the others are found again.
pub(super) fn hold(mesh: &TriMesh, figure: &Figure, before: &Sites) -> Result<Sites, BodyError> {
    let h = figure.stature();
    let upper = mesh.part(|p| p.z > 0.75 * h && p.z < 0.95 * h);
    let back_neck = landmarks::median_point(&upper, figure.back_neck_height(), 0.0, Side::Back);
    let shoulder = |sign: f64| {
        landmarks::shoulder_top(&upper, sign * figure.shoulder_x(), 0.86 * h)
            .ok_or_else(|| missing("shoulder", figure.atlas.shoulder * h))
    };
    let girth = tape::girth_round(&upper, before.neck.centre, before.neck.along());
    Ok(Sites {
        crotch: crotch(mesh, figure)?,
        neck: Neck { girth: girth.ok_or_else(|| missing("neck", before.neck.height))?, ..before.neck },
        shoulder: [shoulder(1.0)?, shoulder(-1.0)?],
        back_neck: back_neck.ok_or_else(|| missing("nape", figure.back_neck_height()))?,
        upper_arm: Some(figure.upper_arm()),
        ..before.clone()
    })
}
