//! Fit of a garment, size by size: its fit card, and measurements of its drapes.

use serde::Serialize;

use crate::fit_card::{FitCard, fit_cards};
use fit::Simulator;
use store::{JobId, Result, Store};

/// Difference between the heights of a hem below which it counts as level: nobody sees less on a moving person.
const LEVEL_MM: f64 = 5.0;

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Balance {
    /// Such as `hem_front`.
    pub quantity: String,
    pub value: f64,
    /// `mm` or `deg`.
    pub unit: String,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RegionPressure {
    /// Such as `lower_legs`.
    pub region: String,
    /// Area under pressure.
    pub area_cm2: f64,
    pub mean_kpa: f64,
    /// Pressure that 1 % of the area exceeds.
    pub most_kpa: f64,
    /// Pressure that 1 % of the area exceeds.
    pub most_mmhg: f64,
}

/// A fold or drag line: a line along which the cloth stands off the skin.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FoldLine {
    /// `fold` or `drag_line`.
    pub kind: String,
    pub length_mm: f64,
    pub from_vertical_deg: f64,
    /// Height of the fold's middle above the floor.
    pub height_mm: f64,
    /// Direction of the fold's middle from the front towards the subject's right.
    pub side_deg: f64,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WornPoint {
    pub point: String,
    pub flat_mm: f64,
    /// Flat length minus that of the size before; `None` for the first size.
    pub step_mm: Option<f64>,
    /// `None` where it runs across no cloth.
    pub draped_mm: Option<f64>,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LevelGap {
    pub level: String,
    /// Below 0 where cloth lies inside the body; `None` where no direction has cloth.
    pub least_gap_mm: Option<f64>,
    /// Mean over the directions with cloth.
    pub mean_gap_mm: Option<f64>,
    pub greatest_gap_mm: Option<f64>,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DrawnOpening {
    /// Name of the measurement along the opening.
    pub opening: String,
    /// Mean displacement along the opening; below 0 away from the garment.
    pub drawn_mm: f64,
    pub drawn_most_mm: f64,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SizeWorn {
    pub size: String,
    pub job: JobId,
    pub gaps: Vec<LevelGap>,
    /// Heights of hem and waist edge, lean of the side seams.
    pub balance: Vec<Balance>,
    /// Empty for Hybrid-GS.
    pub pressure: Vec<RegionPressure>,
    /// Longest first.
    pub folds: Vec<FoldLine>,
    pub points: Vec<WornPoint>,
    /// Empty unless the body moved with the garment on.
    pub drawn: Vec<DrawnOpening>,
}

impl SizeWorn {
    pub fn balance_of(&self, quantity: &str) -> Option<f64> {
        self.balance.iter().find(|known| known.quantity == quantity).map(|known| known.value)
    }

    /// Height of the hem in front minus its height behind, mm, with a description.
    pub fn hem_tilt(&self) -> Option<(f64, &'static str)> {
        let off = self.balance_of("hem_front_over_back")?;
        let words = match off {
            off if off.abs() < LEVEL_MM => "level",
            off if off > 0.0 => "higher in front",
            _ => "lower in front",
        };
        Some((off, words))
    }

    pub fn hem_words(&self) -> Option<String> {
        let ((off, words), front) = (self.hem_tilt()?, self.balance_of("hem_front")?);
        let tilt =
            if off.abs() < LEVEL_MM { words.to_owned() } else { format!("{:.0} mm {words} than behind", off.abs()) };
        Some(format!("{tilt}, {front:.0} mm above the floor in front"))
    }
}

impl FoldLine {
    pub fn words(&self) -> String {
        let way = match self.from_vertical_deg {
            a if a < 25.0 => "upright",
            a if a > 65.0 => "across",
            _ => "slanting",
        };
        let sides = [
            "in front",
            "at the right front",
            "at the right",
            "at the right back",
            "behind",
            "at the left back",
            "at the left",
            "at the left front",
        ];
        let side = ((self.side_deg / 45.0).round() as usize) % sides.len();
        format!("{way} {}", sides[side])
    }
}

/// Fit of a garment on a subject, by ease and on drapes.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct GarmentWorn {
    pub card: FitCard,
    /// FEM-GS, or Hybrid-GS where only that has drapes; `None` without drapes.
    pub simulator: Option<Simulator>,
    /// Sizes that have a drape, in order.
    pub sizes: Vec<SizeWorn>,
}

/// Fit cards of a study, with measurements of the drapes. `garment` and `subject` select one of each.
pub fn worn(store: &Store, study: &str, garment: Option<&str>, subject: Option<&str>) -> Result<Vec<GarmentWorn>> {
    let cards = fit_cards(store, study, garment, subject)?.into_iter();
    cards.map(|card| garment_worn(store, study, card)).collect()
}

fn garment_worn(store: &Store, study: &str, card: FitCard) -> Result<GarmentWorn> {
    for simulator in [Simulator::Fem, Simulator::Hybrid] {
        let drapes = drapes(store, study, &card, simulator)?.into_iter();
        let sizes = drapes.map(|(size, job)| size_worn(store, size, job)).collect::<Result<Vec<_>>>()?;
        if !sizes.is_empty() {
            return Ok(GarmentWorn { card, simulator: Some(simulator), sizes });
        }
    }
    Ok(GarmentWorn { card, simulator: None, sizes: Vec::new() })
}

pub fn drapes(store: &Store, study: &str, card: &FitCard, simulator: Simulator) -> Result<Vec<(String, JobId)>> {
    let mut found = Vec::new();
    for size in &card.sizes {
        let job = drape_of(store, study, card, &size.size, simulator)?;
        found.extend(job.map(|job| (size.size.clone(), job)));
    }
    Ok(found)
}

/// Current result of the first repeat.
fn drape_of(store: &Store, study: &str, card: &FitCard, size: &str, simulator: Simulator) -> Result<Option<JobId>> {
    let sql =
        "SELECT job_id FROM v_metrics WHERE study = ? AND garment = ? AND subject = ? AND size = ? AND simulator = ?
        ORDER BY repeat LIMIT 1";
    let mut statement = store.reader.prepare_cached(sql)?;
    let mut rows = statement.query((study, &card.garment, &card.subject, size, simulator.as_str()))?;
    Ok(rows.next()?.map(|row| row.get(0)).transpose()?.map(JobId))
}

fn size_worn(store: &Store, size: String, job: JobId) -> Result<SizeWorn> {
    let gaps = "SELECT level, least_gap_mm, mean_gap_mm, greatest_gap_mm FROM v_section_level WHERE job_id = ? ORDER BY height_mm DESC";
    let balance = "SELECT quantity, value, unit FROM balance WHERE job_id = ? ORDER BY quantity";
    let pressure = "SELECT region, area_cm2, mean_kpa, most_kpa, most_mmhg FROM v_pressure WHERE job_id = ? ORDER BY most_kpa DESC";
    let folds =
        "SELECT kind, length_mm, from_vertical_deg, height_mm, side_deg FROM fold WHERE job_id = ? ORDER BY number";
    let points = "SELECT point, flat_mm, step_mm, draped_mm FROM v_pom WHERE job_id = ? ORDER BY position";
    let drawn = "SELECT opening, mean_mm, most_mm FROM drawn WHERE job_id = ? ORDER BY opening";
    Ok(SizeWorn {
        size,
        job,
        gaps: rows(store, gaps, job, |row| {
            Ok(LevelGap {
                level: row.get(0)?,
                least_gap_mm: row.get(1)?,
                mean_gap_mm: row.get(2)?,
                greatest_gap_mm: row.get(3)?,
            })
        })?,
        balance: rows(store, balance, job, |row| {
            Ok(Balance { quantity: row.get(0)?, value: row.get(1)?, unit: row.get(2)? })
        })?,
        pressure: rows(store, pressure, job, |row| {
            Ok(RegionPressure {
                region: row.get(0)?,
                area_cm2: row.get(1)?,
                mean_kpa: row.get(2)?,
                most_kpa: row.get(3)?,
                most_mmhg: row.get(4)?,
            })
        })?,
        folds: rows(store, folds, job, |row| {
            Ok(FoldLine {
                kind: row.get(0)?,
                length_mm: row.get(1)?,
                from_vertical_deg: row.get(2)?,
                height_mm: row.get(3)?,
                side_deg: row.get(4)?,
            })
        })?,
        points: rows(store, points, job, |row| {
            Ok(WornPoint { point: row.get(0)?, flat_mm: row.get(1)?, step_mm: row.get(2)?, draped_mm: row.get(3)? })
        })?,
        drawn: rows(store, drawn, job, |row| {
            Ok(DrawnOpening { opening: row.get(0)?, drawn_mm: row.get(1)?, drawn_most_mm: row.get(2)? })
        })?,
    })
}

fn rows<T>(
    store: &Store,
    sql: &str,
    job: JobId,
    read: impl FnMut(&rusqlite::Row<'_>) -> rusqlite::Result<T>,
) -> Result<Vec<T>> {
    let mut statement = store.reader.prepare_cached(sql)?;
    let rows = statement.query_map([job.0], read)?;
    Ok(rows.collect::<rusqlite::Result<_>>()?)
}
