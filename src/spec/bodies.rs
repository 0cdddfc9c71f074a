//! Bodies: built from measurements, read from scans and pictures, posed, measured, drawn.

use std::collections::BTreeMap;
use std::path::Path;

use render::{self, Camera, Frame, Layer, Material, Scene, View};
use store::files::SourceFile;
use store::{InFile, InOrigin, Origin, Result, StudyError};

pub use body::{
    Body, Dimension, Doubt, FigureFound, Figures, Girths, LengthUnit, Mass, Measured, Measurements, Pictured,
    PicturedLevel, Pose, Scan, Sex, write_obj,
};

pub fn build_body(measurements: &Measurements) -> Result<Body> {
    body::build(measurements).origin(Origin::Body)
}

pub fn build_figured(measurements: &Measurements, figures: &Figures) -> Result<Body> {
    body::build_figured(measurements, figures).origin(Origin::Body)
}

/// Reads figures as they are given: `flat_seat`, `flat_seat=strong`, `flat_seat=18`.
pub fn figures<'a>(texts: impl IntoIterator<Item = &'a str>) -> Result<Figures> {
    Figures::read(texts).origin(Origin::Body)
}

/// Report of `body build` on a body: its readings, doubts about the measurements, and its mass.
#[derive(Debug, serde::Serialize)]
pub struct Judgement<'a> {
    #[serde(flatten)]
    pub read: Read<'a>,
    /// Measurements that are rare among people whose other measurements are alike.
    pub doubts: Vec<Doubt>,
    #[serde(flatten)]
    pub mass: Mass,
}

/// Readings on a body, under the keys of `body measure`.
#[derive(Debug, serde::Serialize)]
pub struct Read<'a> {
    #[serde(flatten)]
    pub girths: &'a Girths,
    #[serde(flatten)]
    pub tailor: BTreeMap<&'static str, Option<f64>>,
    /// Figures beside the standard body. `None` for a body that does not stand upright.
    pub figures: Option<Vec<FigureFound>>,
}

/// Readings on a scan, under the keys of `body measure`.
#[derive(Debug, serde::Serialize)]
pub struct ReadScan {
    #[serde(flatten)]
    pub measured: Measured,
    /// Figures beside the standard body. `None` without both feet, or where no standard body is like it.
    pub figures: Option<Vec<FigureFound>>,
}

pub fn read_body(body: &Body) -> Read<'_> {
    let tailor = body.tailor().into_iter().map(|taken| (taken.key, taken.written)).collect();
    Read { girths: &body.girths, tailor, figures: body::figures(body).ok() }
}

pub fn judge_body<'a>(measurements: &Measurements, body: &'a Body) -> Judgement<'a> {
    Judgement {
        read: read_body(body),
        doubts: body::plausibility(measurements),
        mass: Mass::of(body.girths.volume_l(), measurements.get(Dimension::Weight)),
    }
}

/// Infers unit and sex where they are not given.
pub fn read_scan(scan: &SourceFile, unit: Option<LengthUnit>, sex: Option<Sex>) -> Result<Scan> {
    body::from_scan(&scan.bytes, unit, sex).map_err(in_scan(scan))
}

/// Reads as [`read_scan`], and fails where a foot is missing.
pub fn whole_scan(scan: &SourceFile, unit: Option<LengthUnit>, sex: Option<Sex>) -> Result<Scan> {
    let read = read_scan(scan, unit, sex)?;
    read.check_feet().map_err(in_scan(scan))?;
    Ok(read)
}

pub fn measured(scan: &Scan) -> Result<ReadScan> {
    Ok(ReadScan { measured: scan.measured().origin(Origin::Body)?, figures: scan.figures().ok().flatten() })
}

/// Makes a body that can wear garments. Fails where arms or legs are not apart, or the surface does not close.
pub fn scanned_body(source: &SourceFile, scan: Scan) -> Result<Body> {
    scan.into_body().map_err(in_scan(source))
}

pub fn pose_body(body: &Body, pose: Pose) -> Result<Body> {
    body::pose(body, pose).origin(Origin::Body)
}

fn in_scan(scan: &SourceFile) -> impl Fn(body::BodyError) -> StudyError {
    |source| StudyError::refused(Origin::Body, InFile { file: scan.name.clone(), source })
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lens {
    /// Focal length in pixels of the pictures.
    FocalPx(f64),
    /// Vertical field of view.
    FieldDeg(f64),
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PictureCamera {
    pub lens: Lens,
    /// Distance from the person.
    pub distance_m: f64,
}

/// Each picture must show exactly one whole person. Without a camera the pictures count as orthographic.
pub fn read_pictures(
    front: &Path,
    side: &Path,
    camera: Option<PictureCamera>,
    sex: Sex,
    stature_m: f64,
) -> Result<Pictured> {
    let sources = [SourceFile::read(front)?, SourceFile::read(side)?];
    let camera = camera.map(|PictureCamera { lens, distance_m }| match lens {
        Lens::FocalPx(focal_px) => {
            body::picture_height(&sources[0].bytes).map(|height| body::Camera::of_focal(focal_px, height, distance_m))
        }
        Lens::FieldDeg(field_deg) => Ok(body::Camera::of_field(field_deg, distance_m)),
    });
    let camera = camera.transpose().origin(Origin::Body)?;
    body::from_pictures(&sources[0].bytes, &sources[1].bytes, camera.as_ref(), sex, stature_m).origin(Origin::Body)
}

/// Writes the control mesh of a body as files: OBJ of its faces, and JSON with regions, joints, feature points, feature
/// lines and girths as vertex numbers.
pub fn control_files(body: &Body) -> Result<Vec<(String, Vec<u8>)>> {
    let json = body::write_control(body).origin(Origin::Body)?;
    let obj = body.control.write_obj();
    Ok(vec![("control.obj".to_owned(), obj.into_bytes()), ("control.json".to_owned(), json.into_bytes())])
}

/// PNG with the tape lines of girths and other measurements.
pub fn body_picture(body: &Body, view: View, width: u32, height: u32) -> Result<Vec<u8>> {
    let (tapes, lines) = (body.tapes(), body.lines());
    let layers = vec![
        Layer::new(&body.mesh, Material::form()),
        Layer::new(&tapes, Material::hybrid()),
        Layer::new(&lines, Material::fem()),
    ];
    let scene = Scene::new(layers).origin(Origin::Render)?;
    let frame = Frame::enclosing([&body.mesh], f64::from(width) / f64::from(height.max(1)));
    let picture = render::render(&scene, &Camera::new(view, frame), width, height).origin(Origin::Render)?;
    render::png(&picture).origin(Origin::Render)
}
