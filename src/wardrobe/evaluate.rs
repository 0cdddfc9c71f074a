//! Accuracy of the measurement of bodies: every body of a folder, measured on each of its sources and compared with its
//! true measurements.
//!
//! The folder holds `manifest.csv` (id, sex, file) and `measurements.csv` (true values, cm). It may hold `scans.csv`
//! (id, file) and `images.csv` (id, kind, view, projection, file, camera).

use std::collections::BTreeMap;
use std::path::Path;

use crate::error::{TableProblem, WardrobeError};
use body::{Camera, Girths, Sex, from_pictures, from_scan};
use geom::units::mm;
use pattern::table;
use store::Result;

/// Values by column.
type Row = BTreeMap<String, String>;

/// A measurement with its column of `measurements.csv`.
type Known = (&'static str, &'static str);

const OF_SCANS: [Known; 14] = [
    ("stature", "stature_cm"),
    ("neck_girth", "neck_girth_cm"),
    ("chest_girth", "chest_girth_cm"),
    ("underbust_girth", "underbust_girth_cm"),
    ("waist_girth", "waist_iso_girth_cm"),
    ("hip_girth", "hip_girth_cm"),
    ("thigh_girth", "thigh_girth_cm"),
    ("upper_arm_girth", "upper_arm_girth_cm"),
    ("across_shoulder", "across_back_shoulder_cm"),
    ("chest_level", "chest_height_cm"),
    ("waist_level", "waist_iso_height_cm"),
    ("hip_level", "hip_height_cm"),
    ("neck_level", "neck_height_cm"),
    ("crotch_level", "crotch_height_cm"),
];

const OF_PICTURES: [Known; 9] = [
    ("neck_girth", "neck_girth_cm"),
    ("chest_girth", "chest_girth_cm"),
    ("waist_girth", "waist_iso_girth_cm"),
    ("hip_girth", "hip_girth_cm"),
    ("chest_level", "chest_height_cm"),
    ("waist_level", "waist_iso_height_cm"),
    ("hip_level", "hip_height_cm"),
    ("neck_level", "neck_height_cm"),
    ("crotch_level", "crotch_height_cm"),
];

/// Errors of one measurement over all bodies.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize)]
pub struct Accuracy {
    /// Number of measurements.
    pub n: usize,
    /// Mean absolute error.
    pub mae_mm: f64,
    /// Greatest absolute error.
    pub max_mm: f64,
    /// Mean error, measured minus true.
    pub bias_mm: f64,
}

/// One body, measured on one source.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Evaluated {
    pub id: String,
    /// `scan`, `silhouette_orthographic`, `silhouette_perspective` or `photo`.
    pub source: &'static str,
    pub files: Vec<String>,
    /// Measured minus true.
    pub errors_mm: BTreeMap<&'static str, f64>,
    pub error: Option<String>,
}

#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Evaluation {
    pub source: BTreeMap<&'static str, BTreeMap<&'static str, Accuracy>>,
    pub bodies: Vec<Evaluated>,
}

/// Measures every body of a folder on its mesh, scans, silhouettes and photographs. A body that cannot be measured is
/// no error: its reason is in the result.
pub fn evaluate(folder: &Path) -> Result<Evaluation> {
    let manifest = table(folder, "manifest.csv")?;
    let truth: BTreeMap<String, Row> =
        table(folder, "measurements.csv")?.into_iter().map(|row| (text(&row, "id").to_owned(), row)).collect();
    let sexes: BTreeMap<&str, Sex> = manifest.iter().map(|row| (text(row, "id"), sex(row))).collect();
    let optional = |name: &str| if folder.join(name).exists() { table(folder, name) } else { Ok(Vec::new()) };
    let mut bodies = Vec::new();
    for row in manifest.iter().chain(&optional("scans.csv")?) {
        let found = |id: &str| sexes.get(id).zip(truth.get(id));
        if let Some((&sex, known)) = found(text(row, "id")) {
            bodies.push(from_mesh(folder, row, sex, known));
        }
    }
    for pair in picture_pairs(&optional("images.csv")?) {
        if let Some((&sex, known)) = sexes.get(pair.id.as_str()).zip(truth.get(&pair.id)) {
            bodies.push(from_pictures_of(folder, pair, sex, known));
        }
    }
    Ok(Evaluation { source: accuracy(&bodies), bodies })
}

fn table(folder: &Path, name: &str) -> Result<Vec<Row>> {
    let path = folder.join(name);
    let refuse = |problem: TableProblem| WardrobeError::Table { path: path.clone(), problem };
    let bytes = std::fs::read(&path).map_err(|error| refuse(error.into()))?;
    let text = table::text(&bytes).map_err(|line| refuse(TableProblem::Encoding(line)))?;
    let mut rows = table::rows(text).into_iter();
    let heads = rows.next().map_or_else(Vec::new, |row| row.cells);
    if !heads.iter().any(|head| head == "id") {
        return Err(refuse(TableProblem::NoId).into());
    }
    let mut read = Vec::new();
    for row in rows {
        if row.cells.len() > heads.len() {
            let (line, cells, columns) = (row.line, row.cells.len(), heads.len());
            return Err(refuse(TableProblem::Cells { line, cells, columns }).into());
        }
        read.push(heads.iter().cloned().zip(row.cells).collect());
    }
    Ok(read)
}

fn text<'a>(row: &'a Row, column: &str) -> &'a str {
    row.get(column).map_or("", String::as_str)
}

fn number(row: &Row, column: &str) -> Option<f64> {
    text(row, column).parse().ok().filter(|n: &f64| n.is_finite())
}

fn sex(row: &Row) -> Sex {
    if text(row, "sex").to_ascii_lowercase().starts_with('f') { Sex::Female } else { Sex::Male }
}

fn from_mesh(folder: &Path, row: &Row, sex: Sex, known: &Row) -> Evaluated {
    let file = text(row, "file").to_owned();
    let read = || {
        let bytes = std::fs::read(folder.join(&file)).map_err(|error| format!("{file}: {error}"))?;
        from_scan(&bytes, None, Some(sex)).map_err(|error| error.to_string())
    };
    let found = read().map(|scan| scan_values(&scan.girths));
    let taken = Taken { id: text(row, "id").to_owned(), source: "scan", files: vec![file.clone()] };
    taken.compared(&OF_SCANS, found, known)
}

fn scan_values(girths: &Girths) -> Vec<(&'static str, f64)> {
    let read = |(name, _): Known| Some((name, girths.written(&format!("{name}_mm"))?));
    OF_SCANS.into_iter().filter_map(read).collect()
}

/// Front and side picture of one body from one source.
struct PicturePair<'a> {
    id: String,
    source: &'static str,
    /// Front and side.
    views: [Option<&'a Row>; 2],
}

/// Pairs by body and source, in the order of the table.
fn picture_pairs(images: &[Row]) -> Vec<PicturePair<'_>> {
    let mut pairs: Vec<PicturePair<'_>> = Vec::new();
    for row in images {
        let kind = text(row, "kind");
        let source = match (kind.contains("mask"), kind.contains("photo"), text(row, "projection")) {
            (true, _, _) => continue,
            (_, true, _) => "photo",
            (_, _, "orthographic") => "silhouette_orthographic",
            _ => "silhouette_perspective",
        };
        let id = text(row, "id");
        let known = pairs.iter().position(|pair| pair.id == id && pair.source == source);
        let index = known.unwrap_or_else(|| {
            pairs.push(PicturePair { id: id.to_owned(), source, views: [None, None] });
            pairs.len() - 1
        });
        pairs[index].views[usize::from(text(row, "view") == "side")] = Some(row);
    }
    pairs
}

/// `None` where the table names none.
fn camera(row: &Row) -> Option<Camera> {
    let (focal, height) = (number(row, "focal_px")?, number(row, "height_px")?);
    Some(Camera::of_focal(focal, height as u32, number(row, "cam_distance_cm")? / 100.0))
}

fn from_pictures_of(folder: &Path, pair: PicturePair<'_>, sex: Sex, known: &Row) -> Evaluated {
    let PicturePair { id, source, views } = pair;
    let files = views.iter().flatten().map(|row| text(row, "file").to_owned()).collect();
    let read = || {
        let [Some(front), Some(side)] = views else { return Err("front or side picture is not listed".to_owned()) };
        let bytes = |row: &Row| {
            let file = text(row, "file");
            std::fs::read(folder.join(file)).map_err(|error| format!("{file}: {error}"))
        };
        let stature = number(known, "stature_cm").ok_or("no stature_cm to calibrate with")? / 100.0;
        from_pictures(&bytes(front)?, &bytes(side)?, camera(front).as_ref(), sex, stature).map_err(|e| e.to_string())
    };
    let found = read().map(|pictured| {
        let names = [
            ("neck_girth", "neck_level"),
            ("chest_girth", "chest_level"),
            ("waist_girth", "waist_level"),
            ("hip_girth", "hip_level"),
        ];
        let both = names
            .iter()
            .zip(&pictured.levels)
            .flat_map(|((girth, level), l)| [(*girth, mm(l.girth_m)), (*level, mm(l.level_m))]);
        both.chain([("crotch_level", mm(pictured.crotch_level_m))]).collect()
    });
    Taken { id, source, files }.compared(&OF_PICTURES, found, known)
}

struct Taken {
    id: String,
    source: &'static str,
    files: Vec<String>,
}

impl Taken {
    /// Measured minus true, mm.
    fn compared(
        self,
        columns: &[Known],
        found: std::result::Result<Vec<(&'static str, f64)>, String>,
        known: &Row,
    ) -> Evaluated {
        let Self { id, source, files } = self;
        let truth_mm = |name: &str| {
            let (_, column) = columns.iter().find(|(measurement, _)| *measurement == name)?;
            Some(number(known, column)? * 10.0)
        };
        let error = found.as_ref().err().cloned();
        let values = found.unwrap_or_default();
        let errors_mm = values.into_iter().filter_map(|(name, value)| Some((name, value - truth_mm(name)?))).collect();
        Evaluated { id, source, files, errors_mm, error }
    }
}

fn accuracy(bodies: &[Evaluated]) -> BTreeMap<&'static str, BTreeMap<&'static str, Accuracy>> {
    let mut sources: BTreeMap<&'static str, BTreeMap<&'static str, Accuracy>> = BTreeMap::new();
    for body in bodies {
        let of_source = sources.entry(body.source).or_default();
        for (name, error) in &body.errors_mm {
            let sum = of_source.entry(name).or_default();
            sum.n += 1;
            sum.mae_mm += error.abs();
            sum.bias_mm += error;
            sum.max_mm = sum.max_mm.max(error.abs());
        }
    }
    for sum in sources.values_mut().flat_map(BTreeMap::values_mut) {
        sum.mae_mm /= sum.n as f64;
        sum.bias_mm /= sum.n as f64;
    }
    sources
}

#[cfg(test)]
mod tests;
