//! Bodies from scans: aligned, cleaned, repaired and measured.

mod features;

use crate::files::import::import;
use crate::measure::{lengths, sites, tape};
use crate::model::figured::{self, FigureFound};
use crate::photo::facing;
use crate::repair;
use crate::repair::feet::Feet;
use crate::{Body, BodyError, Girths, Imported, LengthUnit, Measured, Sex};
use geom::{TriMesh, V3};

/// Distance of the trunk from the origin, to front or back, beyond which the body is moved there, m. Judgement.
const OFF_AXIS: f64 = 0.04;

#[derive(Clone, Debug, PartialEq)]
pub struct Scan {
    /// Scan: upright, facing `y`, without stray pieces and floor, smoothed if it was rough, with its holes closed.
    pub imported: Imported,
    /// Sex, given or estimated from neck, hip and waist girth.
    pub sex: Sex,
    pub girths: Girths,
    feet: Feet,
}

/// Reads and measures a body scan (OBJ, PLY, STL or GLB) of any orientation. Without a unit, it is inferred from the
/// height. The sex, given or estimated, decides the height of the waist.
pub fn from_scan(bytes: &[u8], unit: Option<LengthUnit>, sex: Option<Sex>) -> Result<Scan, BodyError> {
    let mut imported = import(bytes, unit)?;
    let feet = repair::repair(&mut imported.mesh, &mut imported.notes)?;
    let (low, high) = imported.mesh.bounds().unwrap_or((V3::zeros(), V3::zeros()));
    let middle = sites::trunk_middle(&imported.mesh, low.z, high.z - low.z);
    let forward = if middle.y.abs() > OFF_AXIS { middle.y } else { 0.0 };
    imported.mesh.positions.iter_mut().for_each(|p| *p -= V3::new(middle.x, forward, low.z));
    if !feet.stand() {
        imported.notes.extend(face_front(&mut imported.mesh, sex));
    }
    let (sites, told) = sites::find_sites(&imported.mesh, sex, feet)?;
    if sex.is_none() {
        let name = if told == Sex::Male { "man" } else { "woman" };
        imported.notes.push(format!("measured as a {name}, by neck, hip and waist girth: the sex was not given"));
    }
    let mut girths = sites::girths_at(&imported.mesh, &sites)?;
    lengths::add_limbs(&imported.mesh, &sites, told, &mut girths);
    girths.keep_known(feet);
    Ok(Scan { imported, sex: told, girths, feet })
}

/// Turns a body without feet to the front by its trunk. Returns a note for the user. `None` if it faced the front.
fn face_front(mesh: &mut TriMesh, sex: Option<Sex>) -> Option<String> {
    let (low, high) = mesh.bounds()?;
    let floor = sites::usual_floor(mesh, [low, high])?;
    let middle = |height: f64| {
        let outline = tape::trunk_outline(mesh, floor + height * (high.z - floor), 0.0)?;
        let (front, back) = tape::depth_range(&outline);
        Some((front + back) / 2.0)
    };
    let sexes = [Sex::Male, Sex::Female].into_iter().filter(|candidate| sex.is_none_or(|sex| sex == *candidate));
    match sexes.map(|sex| facing::by_middles(middle, sex)).sum::<i32>().signum() {
        1 => None,
        -1 => {
            mesh.positions.iter_mut().for_each(|p| *p = V3::new(-p.x, -p.y, p.z));
            Some("turned by 180 degrees: belly and buttocks pointed backwards".to_owned())
        }
        _ => Some("which way it faces is not told without feet: it is taken as it is".to_owned()),
    }
}

impl Scan {
    pub fn measured(&self) -> Result<Measured, BodyError> {
        lengths::of_scan(&self.imported.mesh, self.sex, self.feet, self.girths.clone())
    }

    /// Figures beside the standard body. `None` without both feet, whose stature is unknown.
    pub fn figures(&self) -> Result<Option<Vec<FigureFound>>, BodyError> {
        if self.feet == Feet::BOTH { figured::of_mesh(&self.imported.mesh, self.sex).map(Some) } else { Ok(None) }
    }

    /// Refuses a scan without both feet, whose stature or shape is unknown, so that it cannot represent a subject.
    pub fn check_feet(&self) -> Result<(), BodyError> {
        if self.feet == Feet::BOTH { Ok(()) } else { Err(BodyError::Feet) }
    }

    pub fn into_body(self) -> Result<Body, BodyError> {
        self.check_feet()?;
        if !self.imported.mesh.is_closed_manifold() {
            return Err(BodyError::Open { problem: "parts of it cross or branch".to_owned() });
        }
        features::describe(self.sex, self.imported.mesh)
    }
}

#[cfg(test)]
mod tests;
