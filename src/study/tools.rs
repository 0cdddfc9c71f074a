//! What needs no study: looking into pattern files, meshing a style, building and measuring bodies.

use std::path::{Path, PathBuf};

use crate::error::{Result, StudyError};
use crate::seams::check as sewing;
pub use crate::spec::file::SourceFile;
use body;
use pattern::{Garment, Piece, drawing, garmentcode, source};
use render::{self, Camera, Frame, Layer, Material, Scene};

pub use crate::seams::check::{CHECK_EDGE_MM, SizeCheck, check_study};
pub use crate::seams::desk::{Desk, DeskEdge, DeskPiece, DeskSeam, Proposed, desk, edit_seams, propose};
pub use crate::seams::workpiece::{DeskLength, LaidOut, SeamStep, Workpiece, seam_home, write_seams};
pub use body::{
    Accuracy, Body, Doubt, Evaluation, Girths, LengthUnit, Mass, Measured, Measurements, Pictured, PicturedLevel, Pose,
    Scan, Sex, write_obj,
};
pub use pattern::check::{Finding, of_garment as garment_findings};
pub use pattern::draft::Model;
pub use pattern::dxf::Unit;
pub use pattern::inspect::{FileReport, PieceReport};
pub use pattern::propose::Proposal;
pub use pattern::seam_edit::Edit as SeamEdit;
pub use pattern::{MeshQuality, Style};
pub use render::View;
pub use sim::Fabric;
pub use sim::fabric::Stretched;

/// Writes files into a folder, which is made where it is missing; returns their paths.
///
/// # Errors
/// When the folder or a file cannot be written.
pub fn write_files(folder: &Path, files: &[(String, Vec<u8>)]) -> Result<Vec<PathBuf>> {
    let mut paths = Vec::new();
    for (name, bytes) in files {
        let path = folder.join(name);
        let parent = path.parent().unwrap_or(folder);
        std::fs::create_dir_all(parent).map_err(StudyError::io(parent))?;
        std::fs::write(&path, bytes).map_err(StudyError::io(&path))?;
        paths.push(path);
    }
    Ok(paths)
}

/// The DXF files and GarmentCode specifications below a folder, by path.
pub(crate) fn drawings(folder: &Path) -> Result<Vec<PathBuf>> {
    let mut found = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).map_err(StudyError::io(&folder))? {
            let entry = entry.map_err(StudyError::io(&folder))?;
            let kind = entry.file_type().map_err(StudyError::io(entry.path()))?;
            let is_dxf = entry.path().extension().is_some_and(|extension| extension.eq_ignore_ascii_case("dxf"));
            // Other JSON lies beside patterns too; specifications are named so by the program that writes them.
            let is_drawing = is_dxf || entry.path().to_string_lossy().ends_with("_specification.json");
            match kind {
                kind if kind.is_dir() => folders.push(entry.path()),
                _ if is_drawing => found.push(entry.path()),
                _ => {}
            }
        }
    }
    found.sort();
    Ok(found)
}

/// A style from the files of a pattern and its seams; `size` picks one where the pattern holds several.
///
/// # Errors
/// When a file cannot be read, names no unit while none is given, or does not fit the other.
pub fn style(pattern: &Path, seams: Option<&Path>, size: Option<&str>, unit: Option<Unit>) -> Result<Style> {
    let seams = seams.map(SourceFile::read).transpose()?;
    read_style(&SourceFile::read_pattern(pattern)?, seams.as_ref(), size, unit)
}

/// What a person should know of a pattern and its seams that is no error.
///
/// # Errors
/// As [`style`].
pub fn findings(pattern: &Path, seams: &Path, size: Option<&str>, unit: Option<Unit>) -> Result<Vec<Finding>> {
    sewing::of_files(&SourceFile::read_pattern(pattern)?, &SourceFile::read(seams)?, size, unit)
}

/// The pieces of one size of a pattern file, or of all of a folder.
pub(crate) fn pieces(pattern: &SourceFile, size: Option<&str>, unit: Option<Unit>) -> Result<Vec<Piece>> {
    let mut pieces = Vec::new();
    for part in pattern.parts() {
        let file = source::read(&part.bytes, &part.name, unit).map_err(StudyError::stage("pattern"))?;
        // A file of one size need not name it as the study does.
        let size = size.filter(|_| file.sizes().len() > 1);
        pieces.extend(file.to_sew(size).map_err(StudyError::stage("pattern"))?);
    }
    Ok(pieces)
}

/// The unit of a name in a study file.
pub(crate) fn unit_of(name: &str) -> Option<Unit> {
    [Unit::Mm, Unit::Cm, Unit::In].into_iter().find(|unit| unit.as_str() == name)
}

/// [`style`] from files already read.
pub(crate) fn read_style(
    pattern: &SourceFile,
    seams: Option<&SourceFile>,
    size: Option<&str>,
    unit: Option<Unit>,
) -> Result<Style> {
    let mut style = if pattern.holds_seams() {
        let read = garmentcode::read(&pattern.bytes, &pattern.name).map_err(StudyError::stage("pattern"))?;
        let mut style = read.style();
        if let Some(seams) = seams {
            style.measure(&seams.bytes, &seams.name).map_err(StudyError::stage("pattern"))?;
        }
        style
    } else {
        let Some(seams) = seams else {
            let message = format!("{}: holds no seams; give its seam file (`seams`, or --seams FILE)", pattern.name);
            return Err(StudyError::Stage { stage: "pattern", message });
        };
        let pieces = pieces(pattern, size, unit)?;
        Style::read(&pieces, &seams.bytes, &seams.name).map_err(StudyError::stage("pattern"))?
    };
    if style.measurements.is_empty() {
        style.measure_openings_and_seams();
    }
    Ok(style)
}

/// A style's mesh at an edge length, m, and how good its triangles are.
///
/// # Errors
/// When the edge length is out of range or the outline cannot be meshed.
pub fn mesh(style: &Style, edge_length_m: f64) -> Result<(Garment, MeshQuality)> {
    let garment = style.mesh(edge_length_m).map_err(StudyError::stage("mesh"))?;
    let quality = MeshQuality::of(&garment).ok_or_else(|| StudyError::stage("mesh")("no triangles"))?;
    Ok((garment, quality))
}

/// The style's pieces on a sheet, as SVG with numbered measurements.
#[must_use]
pub fn sheet(style: &Style) -> String {
    drawing::svg(style)
}

/// The files of a drafted style: a DXF a size and the seam file.
#[must_use]
pub fn drafted(model: Model) -> Vec<(String, Vec<u8>)> {
    model.files()
}

/// Measurements from a TOML file with those of a study's `[[subject]]`.
///
/// # Errors
/// Everything that is wrong with the file, at once.
pub fn read_measurements(path: &Path) -> Result<Measurements> {
    let text = std::fs::read_to_string(path).map_err(StudyError::io(path))?;
    crate::spec::file::measurements(path, &text)
}

/// A body built from measurements.
///
/// # Errors
/// When a measurement is impossible.
pub fn build_body(measurements: &Measurements) -> Result<Body> {
    body::build(measurements).map_err(StudyError::stage("body"))
}

/// A built body beside what was asked: the keys of `body measure`, what is doubtful, and its mass.
#[derive(Debug, serde::Serialize)]
pub struct Judgement<'a> {
    /// What the tape reads.
    #[serde(flatten)]
    pub girths: &'a Girths,
    /// Measurements that few people alike have.
    pub doubts: Vec<Doubt>,
    /// Mass from the volume.
    #[serde(flatten)]
    pub mass: Mass,
}

/// Judges a built body.
#[must_use]
pub fn judge_body<'a>(measurements: &Measurements, body: &'a Body) -> Judgement<'a> {
    Judgement {
        girths: &body.girths,
        doubts: body::plausibility(measurements),
        mass: Mass::of(body.girths.volume_l, measurements.weight_kg),
    }
}

/// Reads and measures a body scan, its unit and sex told from it where they are not given.
///
/// # Errors
/// When it cannot be read or is no standing person.
pub fn read_scan(scan: &SourceFile, unit: Option<LengthUnit>, sex: Option<Sex>) -> Result<Scan> {
    body::from_scan(&scan.bytes, unit, sex).map_err(of_scan(scan))
}

/// Everything that is measured on a scan.
///
/// # Errors
/// When a part of the body is not found.
pub fn measured(scan: &Scan) -> Result<Measured> {
    let lengths = body::lengths(&scan.imported.mesh, Some(scan.sex)).map_err(StudyError::stage("body"))?;
    Ok(Measured { girths: scan.girths.clone(), lengths })
}

/// A scan as a body that wears garments.
///
/// # Errors
/// When arms or legs are not apart, or the surface does not close.
pub fn scanned_body(source: &SourceFile, scan: Scan) -> Result<Body> {
    scan.into_body().map_err(of_scan(source))
}

/// A body in another pose.
///
/// # Errors
/// When its limbs do not reach there, or would touch.
pub fn pose_body(body: &Body, pose: Pose) -> Result<Body> {
    body::pose(body, pose).map_err(StudyError::stage("body"))
}

fn of_scan(scan: &SourceFile) -> impl Fn(body::BodyError) -> StudyError {
    |error| StudyError::Stage { stage: "body", message: format!("{}: {error}", scan.name) }
}

/// Lens of a camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lens {
    /// Focal length in pixels of the pictures.
    FocalPx(f64),
    /// Vertical field of view, degrees.
    FieldDeg(f64),
}

/// Reads a body from a front and a side picture, taken from a distance in metres where a lens is given.
///
/// # Errors
/// When a picture cannot be read, or shows no single person wholly.
pub fn read_pictures(
    front: &Path,
    side: &Path,
    camera: Option<(Lens, f64)>,
    sex: Sex,
    stature_m: f64,
) -> Result<Pictured> {
    let sources = [SourceFile::read(front)?, SourceFile::read(side)?];
    let camera = camera.map(|(lens, distance_m)| match lens {
        Lens::FocalPx(focal_px) => {
            body::picture_height(&sources[0].bytes).map(|height| body::Camera::of_focal(focal_px, height, distance_m))
        }
        Lens::FieldDeg(field_deg) => Ok(body::Camera::of_field(field_deg, distance_m)),
    });
    let camera = camera.transpose().map_err(StudyError::stage("body"))?;
    body::from_pictures(&sources[0].bytes, &sources[1].bytes, camera.as_ref(), sex, stature_m)
        .map_err(StudyError::stage("body"))
}

/// How well the bodies of a folder are measured from each of their sources.
///
/// # Errors
/// When the folder lacks its tables.
pub fn evaluate_bodies(folder: &Path) -> Result<Evaluation> {
    body::evaluate(folder).map_err(StudyError::stage("body"))
}

/// The control mesh of a body as files: OBJ of its faces, and JSON with regions, joints, feature points, feature lines and
/// girths as vertex numbers.
///
/// # Errors
/// When the JSON cannot be written.
pub fn control_files(body: &Body) -> Result<Vec<(String, Vec<u8>)>> {
    let json = body::write_control(body).map_err(|error| StudyError::stage("body")(error.to_string()))?;
    let obj = body.control.write_obj();
    Ok(vec![("control.obj".to_owned(), obj.into_bytes()), ("control.json".to_owned(), json.into_bytes())])
}

/// A picture of a body with the tapes of its girths as PNG bytes.
///
/// # Errors
/// When the mesh cannot be drawn.
pub fn body_picture(body: &Body, view: View, width: u32, height: u32) -> Result<Vec<u8>> {
    let tapes = body.tapes();
    let layers = vec![Layer::new(&body.mesh, Material::form()), Layer::new(&tapes, Material::hybrid())];
    let scene = Scene::new(layers).map_err(StudyError::stage("render"))?;
    let frame = Frame::enclosing([&body.mesh], f64::from(width) / f64::from(height.max(1)));
    let picture =
        render::render(&scene, &Camera::new(view, frame), width, height).map_err(StudyError::stage("render"))?;
    render::png(&picture).map_err(StudyError::stage("render"))
}
