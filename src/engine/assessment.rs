//! Assessment of a drape on its body: cross sections, balance, folds and pressure, measured and stored.

use rusqlite::{Transaction, params};
use serde::{Deserialize, Serialize};

use crate::stages::Garb;
use body::Body;
use fit::Simulator;
use fit::on_body::{self, DIRECTIONS, Fold, Hang, Section, Sides, Site};
use fit::reach::{self, Drawn};
use geom::units::mm;
use geom::{Surface, V3, hull};
use pattern::style::PathPart;
use pattern::{Garment, MaterialLine, Style};
use sim::Drape;
use sim::sewn::Sewn;
use store::{InOrigin, JobId, Origin, Result};

/// Square centimetres in a square metre.
const CM2: f64 = 1e4;

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Level {
    /// Level of the body, such as `chest`.
    pub level: String,
    /// Height above the floor.
    pub height_m: f64,
    /// Tape girth of trunk or limb.
    pub body_girth_m: f64,
    /// Length of the cloth's outlines.
    pub cloth_length_m: f64,
    /// Area of trunk or limb.
    pub body_area_m2: f64,
    /// Area between skin and cloth.
    pub air_m2: f64,
    /// Gaps between skin and cloth in [`DIRECTIONS`] directions from the front towards the subject's right; `None`
    /// without cloth.
    pub gaps_m: Vec<Option<f64>>,
}

impl Level {
    pub fn of(section: &Section) -> Self {
        Self {
            level: section.site.level.clone(),
            height_m: section.site.height_m(),
            body_girth_m: hull::tape_girth(&section.skin.points),
            cloth_length_m: section.cloth_length_m(),
            body_area_m2: section.body_area_m2(),
            air_m2: section.air_m2(),
            gaps_m: section.gaps(DIRECTIONS).into_iter().map(|angle| angle.gap_m).collect(),
        }
    }
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pressing {
    /// Name of the region, such as `lower_legs`.
    pub region: String,
    /// Area under pressure.
    pub area_m2: f64,
    pub mean_kpa: f64,
    /// Pressure that 1 % of the area exceeds.
    pub most_kpa: f64,
}

#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Assessment {
    /// Levels that the garment covers.
    pub levels: Vec<Level>,
    /// Heights of hem and waist edge, lean of the side seams.
    pub hang: Hang,
    /// Longest first.
    pub folds: Vec<Fold>,
    /// Empty for Hybrid-GS, which does not bring cloth and body into equilibrium.
    pub pressing: Vec<Pressing>,
    /// Displacements of openings, for a drape that was carried into another pose.
    #[serde(default)]
    pub drawn: Vec<Drawn>,
}

impl Assessment {
    pub(crate) fn of(body: &Body, garb: &Garb, drape: &Drape, simulator: Simulator) -> Result<Self> {
        let garment = garb.meshes.finest()?;
        let sewn = Sewn::new(garment, &garb.fabric, &drape.positions).origin(Origin::Measure)?;
        let cut = |site: Site| Section::cut(site, &body.mesh, &sewn.mesh).filter(|section| !section.cloth.is_empty());
        let surface = Surface::new(&body.mesh).origin(Origin::Measure)?;
        let gap_m: Vec<f64> = sewn.mesh.positions.iter().map(|p| surface.signed_distance(p)).collect();
        let tension_n_m = sewn.welded(&sewn.tensions_n_m());
        let worn = on_body::Worn { cloth: &sewn.mesh, gap_m: &gap_m, tension_n_m: &tension_n_m };
        let pressed = match simulator {
            Simulator::Fem => on_body::pressed(body, &sewn.mesh, &sewn.welded_pressures_kpa()),
            Simulator::Hybrid => Vec::new(),
        };
        let pressing = pressed.into_iter().map(|pressed| Pressing {
            region: pressed.region.as_str().to_owned(),
            area_m2: pressed.area_m2,
            mean_kpa: pressed.mean_kpa,
            most_kpa: pressed.most_kpa,
        });
        let drawn = drape.kept.iter().flat_map(|kept| reach::drawn(garment, kept, &drape.positions));
        Ok(Self {
            levels: on_body::sites(body).into_iter().filter_map(cut).map(|section| Level::of(&section)).collect(),
            hang: hang(&garb.style, garment, &drape.positions),
            folds: on_body::folds(&worn),
            pressing: pressing.collect(),
            drawn: drawn.collect(),
        })
    }
}

impl Assessment {
    pub fn most_kpa(&self) -> Option<f64> {
        self.pressing.iter().map(|region| region.most_kpa).reduce(f64::max)
    }

    /// Height in front minus height behind.
    pub fn hem_front_over_back_m(&self) -> Option<f64> {
        self.hang.hem.and_then(|hem| Some(hem.front_m? - hem.back_m?))
    }
}

pub fn hang(style: &Style, garment: &Garment, positions: &[V3]) -> Hang {
    let lines = style.hang_lines();
    let paths: Vec<&[PathPart]> =
        [&lines.hem, &lines.waist].into_iter().chain(&lines.side_seams).map(Vec::as_slice).collect();
    let place = |run: &MaterialLine| -> Vec<V3> { run.points.iter().map(|point| point.at(positions)).collect() };
    let laid = style.laid(garment, &paths).into_iter();
    let mut placed = laid.map(|runs| runs.iter().flatten().map(place).collect::<Vec<_>>());
    let (hem, waist) = (placed.next().unwrap_or_default(), placed.next().unwrap_or_default());
    on_body::hang(&hem, &waist, &placed.flatten().collect::<Vec<_>>())
}

pub(crate) fn write(transaction: &Transaction<'_>, id: JobId, assessment: &Assessment) -> Result<()> {
    let mut section = transaction.prepare_cached("INSERT INTO section VALUES (?, ?, ?, ?, ?, ?, ?)")?;
    let mut gap = transaction.prepare_cached("INSERT INTO section_gap VALUES (?, ?, ?, ?)")?;
    for level in &assessment.levels {
        let [height_mm, girth_mm, cloth_mm] = [level.height_m, level.body_girth_m, level.cloth_length_m].map(mm);
        let [body_cm2, air_cm2] = [level.body_area_m2, level.air_m2].map(|area| area * CM2);
        section.execute(params![id.0, level.level, height_mm, girth_mm, cloth_mm, body_cm2, air_cm2])?;
        for (number, gap_m) in level.gaps_m.iter().enumerate() {
            let angle_deg = number as f64 * 360.0 / DIRECTIONS as f64;
            gap.execute(params![id.0, level.level, angle_deg, gap_m.map(mm)])?;
        }
    }
    let mut balance = transaction.prepare_cached("INSERT INTO balance VALUES (?, ?, ?, ?)")?;
    for Quantity { name, value, unit } in quantities(&assessment.hang) {
        balance.execute(params![id.0, name, value, unit])?;
    }
    let mut drawn = transaction.prepare_cached("INSERT INTO drawn VALUES (?, ?, ?, ?)")?;
    for Drawn { opening, mean_m, most_m } in &assessment.drawn {
        drawn.execute(params![id.0, opening, mm(*mean_m), mm(*most_m)])?;
    }
    let mut statement = transaction.prepare_cached("INSERT INTO fold VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?)")?;
    for (number, fold) in (1_i64..).zip(&assessment.folds) {
        let kind = if fold.is_drag { "drag_line" } else { "fold" };
        let side_deg = fold.middle.x.atan2(fold.middle.y).to_degrees().rem_euclid(360.0);
        let [length_mm, height_mm, radius_mm] = [fold.length_m, fold.middle.z, fold.radius_m].map(mm);
        let (angle_deg, tension_n_m) = (fold.from_vertical_rad.to_degrees(), fold.tension_n_m);
        let row = params![id.0, number, kind, length_mm, angle_deg, height_mm, side_deg, radius_mm, tension_n_m];
        statement.execute(row)?;
    }
    let mut pressure = transaction.prepare_cached("INSERT INTO pressure VALUES (?, ?, ?, ?, ?)")?;
    for Pressing { region, area_m2, mean_kpa, most_kpa } in &assessment.pressing {
        pressure.execute(params![id.0, region, area_m2 * CM2, mean_kpa, most_kpa])?;
    }
    Ok(())
}

pub struct Quantity {
    /// Such as `hem_front`.
    pub name: String,
    pub value: f64,
    /// `mm` or `deg`.
    pub unit: &'static str,
}

/// Heights above the floor, differences of heights, angles.
pub fn quantities(hang: &Hang) -> Vec<Quantity> {
    let height = |name: String, m: f64| Quantity { name, value: mm(m), unit: "mm" };
    let mut found = Vec::new();
    for (edge, sides) in [("hem", hang.hem), ("waist", hang.waist)] {
        let Some(Sides { front_m, back_m, right_m, left_m }) = sides else { continue };
        for (side, height_m) in [("front", front_m), ("back", back_m), ("right", right_m), ("left", left_m)] {
            found.extend(height_m.map(|height_m| height(format!("{edge}_{side}"), height_m)));
        }
        let differences = [("front_over_back", front_m.zip(back_m)), ("right_over_left", right_m.zip(left_m))];
        for (name, pair) in differences {
            found.extend(pair.map(|(higher, lower)| height(format!("{edge}_{name}"), higher - lower)));
        }
    }
    for (side, lean_rad) in ["right", "left"].into_iter().zip(hang.lean_rad) {
        let name = format!("side_seam_lean_{side}");
        found.extend(lean_rad.map(|lean_rad| Quantity { name, value: lean_rad.to_degrees(), unit: "deg" }));
    }
    found
}
