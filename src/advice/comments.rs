//! Comments of a fitting, made from what was measured: ease outside its target, signs on the drape, drag lines, pressure;
//! each with its likely cause and the handles that mend it.

use crate::alteration::{self, Alteration, Reading, Readings, Wish, alter};
use engine::stages;
use geom::units::signed_tenths;
use results::assessment::{GarmentWorn, SizeWorn};
use results::{LevelSits, Sits};
use spec::Study;
use store::Result;
use store::comments::{Remark, Severity, Side};

/// Departure from which a comment on ease is major: half of a grade step of 60 mm.
const MAJOR_MM: f64 = 30.0;
/// Multiple of the limit of a sign from which it is major.
const MAJOR_SIGN: f64 = 2.0;
/// Pressure that wearers begin to call uncomfortable.
const PRESSES_KPA: f64 = 2.0;

#[derive(Clone, Debug)]
pub struct Fitted {
    /// Size to wear, or the nearest.
    pub size: String,
    pub basis: String,
    /// Comments from the neck down.
    pub found: Vec<Remark>,
    pub untold: Option<String>,
}

/// `None` where no size is known to be worn.
pub fn fitted(study: &Study, worn: &GarmentWorn) -> Result<Option<Fitted>> {
    let card = &worn.card;
    let Some(size) = card.to_wear() else { return Ok(None) };
    let drape = worn.sizes.iter().find(|drape| drape.size == size.size);
    let departs = |level: &&LevelSits| level.sits().is_some_and(|sits| sits != Sits::AsMeant);
    let asked = size
        .levels
        .iter()
        .any(|level| departs(&level))
        .then(|| alter(study, &Wish::of(&card.garment, &card.subject, &size.size)));
    let (proposed, untold) = match asked {
        Some(Ok(proposed)) => (Some(proposed), None),
        Some(Err(error)) => (None, Some(error.to_string())),
        None => (None, None),
    };
    let mut found: Vec<Remark> =
        size.levels.iter().filter(departs).map(|level| on_ease(level, proposed.as_ref())).collect();
    if let Some(drape) = drape {
        found.extend(signs(study, worn, drape)?);
        found.extend(drag_lines(drape));
        let is_to_press = card.intended.as_deref() == Some("compression");
        found.extend(drape.pressure.iter().filter(|_| !is_to_press).filter_map(on_pressure));
    }
    let eases: Vec<String> = size.levels.iter().map(|level| format!("{} {:.1}", level.level, level.ease_mm)).collect();
    let job = drape.map_or(String::new(), |drape| format!("; job {}", drape.job.0));
    let said: Vec<&str> = found.iter().map(|remark| remark.said.as_str()).collect();
    let basis = format!("{}: {}{job}; {}", size.size, eases.join(", "), said.join(", "));
    Ok(Some(Fitted { size: size.size.clone(), basis, found, untold }))
}

fn on_ease(level: &LevelSits, proposed: Option<&Alteration>) -> Remark {
    let is_tight = level.sits() == Some(Sits::Tight);
    let departure_mm = level.departure_mm();
    let severity = match departure_mm {
        _ if level.cannot_close => Severity::Critical,
        mm if mm >= MAJOR_MM => Severity::Major,
        _ => Severity::Minor,
    };
    let name = level.level.replace('_', " ");
    let moves = proposed.into_iter().flat_map(|proposed| &proposed.moves);
    let own = moves.filter(|moved| moved.serves.contains(&level.level));
    let actions: Vec<String> = own
        .map(|moved| {
            let pieces = moved.pieces.join(", ");
            format!(
                "{} {} mm ({}) on {pieces}",
                moved.handle.replace('_', " "),
                signed_tenths(moved.amount_mm),
                moved.does
            )
        })
        .collect();
    Remark {
        side: if level.level == "across_shoulder" { Side::Back } else { Side::Front },
        place: name.clone(),
        said: format!("{name} {}", level.words()),
        severity,
        cause: format!("pattern too {} there for this figure", if is_tight { "narrow" } else { "wide" }),
        action: actions.join("; "),
        quantity: Some(format!("{} {}", level.level, if is_tight { "tight" } else { "loose" })),
    }
}

fn signs(study: &Study, worn: &GarmentWorn, drape: &SizeWorn) -> Result<Vec<Remark>> {
    let unit = |unit: &str| if unit == "deg" { "deg" } else { "mm" };
    let readings: Readings = drape
        .balance
        .iter()
        .map(|balance| (balance.quantity.clone(), Reading { value: balance.value, unit: unit(&balance.unit) }))
        .collect();
    let jobs = spec::jobs_of(study, &worn.card.garment, &worn.card.subject);
    let Some(job) = jobs.iter().find(|job| job.size == drape.size) else { return Ok(Vec::new()) };
    let style = stages::style(job)?;
    let remark = |sign: alteration::SignRead| {
        let place = if sign.reading.starts_with("waist") { "waist" } else { "hem" };
        let handles: Vec<String> = sign.handles.iter().map(|handle| handle.replace('_', " ")).collect();
        Remark {
            side: Side::Side,
            place: if sign.reading.starts_with("side") { "side seam".to_owned() } else { place.to_owned() },
            said: format!("{}, {} {}", sign.sign, signed_tenths(sign.value), sign.unit),
            severity: if sign.value.abs() > MAJOR_SIGN * sign.beyond { Severity::Major } else { Severity::Minor },
            cause: sign.cause.to_owned(),
            action: if handles.is_empty() { String::new() } else { format!("alter by {}", handles.join(" or ")) },
            quantity: Some(sign.sign.to_owned()),
        }
    };
    Ok(alteration::signs(&readings, &style).into_iter().map(remark).collect())
}

/// Drag lines, those of each side together.
fn drag_lines(drape: &SizeWorn) -> Vec<Remark> {
    let side_of = |deg: f64| match deg.rem_euclid(360.0) {
        deg if !(45.0..315.0).contains(&deg) => Side::Front,
        deg if (135.0..225.0).contains(&deg) => Side::Back,
        _ => Side::Side,
    };
    let on = |side: Side| {
        let lines: Vec<_> =
            drape.folds.iter().filter(|fold| fold.kind == "drag_line" && side_of(fold.side_deg) == side).collect();
        let longest = lines.first()?;
        Some(Remark {
            side,
            place: format!("{:.0} cm above the floor", 0.1 * longest.height_mm),
            said: format!("drag lines: {}, the longest {:.0} mm", lines.len(), longest.length_mm),
            severity: Severity::Minor,
            cause: "cloth under tension along the fold: too little of it across, or a length that is short".to_owned(),
            action: String::new(),
            quantity: Some(format!("drag lines {}", side.as_str())),
        })
    };
    Side::ALL.iter().filter_map(|side| on(*side)).collect()
}

fn on_pressure(pressed: &results::assessment::RegionPressure) -> Option<Remark> {
    let region = pressed.region.replace('_', " ");
    (pressed.most_kpa > PRESSES_KPA).then(|| Remark {
        side: Side::Front,
        place: region.clone(),
        said: format!("presses at the {region} with {:.1} kPa", pressed.most_kpa),
        severity: Severity::Major,
        cause: "garment smaller than the body there".to_owned(),
        action: String::new(),
        quantity: Some(format!("pressure {}", pressed.region)),
    })
}
