//! The printed tables of the thesis, as plain values.

use rusqlite::{Connection, Row as SqlRow};

use fit::Simulator;
use store::columns::simulator;
use store::{InOrigin, Origin, Result};

pub(super) const SUBJECTS: [&str; 6] = ["i", "ii", "iii", "iv", "v", "vi"];

#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Sized {
    pub garment: String,
    pub size: String,
}

impl std::fmt::Display for Sized {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} {}", self.garment, self.size)
    }
}

#[derive(Clone, Debug, PartialEq)]
pub(super) struct Row {
    pub table: String,
    pub of: Sized,
    pub simulator: Simulator,
    pub no: u32,
    pub name: String,
    pub l2d_mm: f64,
    pub l3d_mm: [f64; 6],
    /// L3D / L2D as printed.
    pub chi: [f64; 6],
    pub mean: f64,
    pub sd: f64,
}

impl Row {
    /// L3D / L2D of a subject (0 to 5), recomputed.
    pub fn ratio(&self, subject: usize) -> f64 {
        self.l3d_mm[subject] / self.l2d_mm
    }

    pub fn place(&self) -> String {
        format!("table {}, row #{} {}", self.table, self.no, self.name)
    }
}

/// A row of a metrics table: E, SD or EI of one garment on six subjects.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Metric {
    pub table: String,
    pub of: Sized,
    pub simulator: Simulator,
    /// `E`, `SD` or `EI`.
    pub metric: String,
    pub printed: [f64; 6],
    pub average: f64,
}

/// Mean or sample standard deviation of the subjects of one sex (Tables 6-3, 6-4), cm.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Summary {
    pub table: String,
    /// Sex that the caption names.
    pub captioned: String,
    /// Sex whose subjects the table summarises.
    pub sex: String,
    /// `mean` or `sd`.
    pub statistic: String,
    /// Chest, waist, hip, across-shoulder, neck, cm.
    pub numbers: [f64; 5],
}

/// A cell of Table 4-1: chi after pre-positioning with a bending angle.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Preposition {
    pub bend_deg: f64,
    pub chi: f64,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) struct Tables {
    pub rows: Vec<Row>,
    pub metrics: Vec<Metric>,
    pub summaries: Vec<Summary>,
    /// Sex of each of the twelve subjects, with chest, waist, hip, across-shoulder and neck, cm.
    pub subjects: Vec<(String, [f64; 5])>,
    pub prepositions: Vec<Preposition>,
}

impl Tables {
    pub fn read(connection: &Connection) -> Result<Self> {
        let rows = "SELECT table_no, garment, size, simulator, measurement_no, measurement, l2d_mm, l3d_mm, chi,
            chi_mean, chi_sd FROM published ORDER BY garment, size, simulator, measurement_no";
        let metrics = "SELECT table_no, garment, size, simulator, metric, by_subject, average FROM published_metric
            ORDER BY garment, size, simulator, metric";
        let summaries = "SELECT table_no, captioned, sex, statistic, chest_cm, waist_cm, hip_cm, across_shoulder_cm,
            neck_cm FROM published_subjects ORDER BY sex, statistic";
        let subjects = "SELECT sex, chest_girth_mm / 10, waist_girth_mm / 10, hip_girth_mm / 10,
            across_shoulder_mm / 10, neck_girth_mm / 10 FROM subject
            WHERE revision = 1 AND (name GLOB 'male-[iv]*' OR name GLOB 'female-[iv]*') ORDER BY name";
        let prepositions =
            "SELECT bend_deg, chi FROM published_preposition ORDER BY bend_deg, measurement, offset_printed";
        Ok(Self {
            rows: all(connection, rows, row)?,
            metrics: all(connection, metrics, metric)?,
            summaries: all(connection, summaries, |row| {
                Ok(Summary {
                    table: row.get(0)?,
                    captioned: row.get(1)?,
                    sex: row.get(2)?,
                    statistic: row.get(3)?,
                    numbers: five(row, 4)?,
                })
            })?,
            subjects: all(connection, subjects, |row| Ok((row.get(0)?, five(row, 1)?)))?,
            prepositions: all(connection, prepositions, |row| {
                Ok(Preposition { bend_deg: row.get(0)?, chi: row.get(1)? })
            })?,
        })
    }

    pub fn garments(&self) -> Vec<Sized> {
        let mut found: Vec<Sized> = self.rows.iter().map(|row| row.of.clone()).collect();
        found.dedup();
        found
    }

    pub fn table(&self, of: &Sized, simulator: Simulator) -> Vec<&Row> {
        self.rows.iter().filter(|row| row.of == *of && row.simulator == simulator).collect()
    }

    /// Chi recomputed from the lengths.
    pub fn chis(&self, of: &Sized, simulator: Simulator, subject: usize) -> Vec<f64> {
        self.table(of, simulator).into_iter().map(|row| row.ratio(subject)).collect()
    }

    /// Mean |chi - 1|, recomputed from the lengths.
    pub fn ei(&self, of: &Sized, simulator: Simulator, subject: usize) -> f64 {
        let chis = self.chis(of, simulator, subject);
        chis.iter().map(|chi| (chi - 1.0).abs()).sum::<f64>() / chis.len() as f64
    }
}

fn all<T>(connection: &Connection, sql: &str, read: impl Fn(&SqlRow<'_>) -> Result<T>) -> Result<Vec<T>> {
    let mut statement = connection.prepare(sql)?;
    let mut rows = statement.query([])?;
    let mut found = Vec::new();
    while let Some(row) = rows.next()? {
        found.push(read(row)?);
    }
    Ok(found)
}

fn row(row: &SqlRow<'_>) -> Result<Row> {
    Ok(Row {
        table: row.get(0)?,
        of: Sized { garment: row.get(1)?, size: row.get(2)? },
        simulator: simulator(row, 3)?,
        no: row.get(4)?,
        name: row.get(5)?,
        l2d_mm: row.get(6)?,
        l3d_mm: six(row, 7)?,
        chi: six(row, 8)?,
        mean: row.get(9)?,
        sd: row.get(10)?,
    })
}

fn metric(row: &SqlRow<'_>) -> Result<Metric> {
    Ok(Metric {
        table: row.get(0)?,
        of: Sized { garment: row.get(1)?, size: row.get(2)? },
        simulator: simulator(row, 3)?,
        metric: row.get(4)?,
        printed: six(row, 5)?,
        average: row.get(6)?,
    })
}

fn six(row: &SqlRow<'_>, column: usize) -> Result<[f64; 6]> {
    let text: String = row.get(column)?;
    serde_json::from_str(&text).origin(Origin::Store)
}

fn five(row: &SqlRow<'_>, first: usize) -> Result<[f64; 5]> {
    let mut numbers = [0.0; 5];
    for (k, number) in numbers.iter_mut().enumerate() {
        *number = row.get(first + k)?;
    }
    Ok(numbers)
}
