//! Check of a grading by FEM-GS: some of the people whom a size fits wear it.

use crate::alteration;
use crate::grading::knobs::Band;
use crate::grading::{Crowd, DrapedAgain, Judged, people};
use engine::Outcome;
use fit::target::band_words;
use geom::units::mm;
use spec::{JobSpec, bodies};
use store::Result;

/// Departure of a draped ease from its band that counts as none: it would be written as 0.
const SLACK_M: f64 = 0.5e-3;
/// Deepest penetration into the body that counts as none.
const INSIDE_M: f64 = 1e-3;

/// Drapes the size to wear on a share of the people whom it fits, taken evenly among them.
pub(super) fn agree(spec: &JobSpec, sizes: &Judged<'_>, crowd: Crowd<'_>, share: f64) -> Result<DrapedAgain> {
    let (Judged { styles, names, tally, .. }, Crowd { figures, bands }) = (sizes, crowd);
    let fitted: Vec<usize> = (0..figures.len()).filter(|person| tally.is_fitted(*person)).collect();
    let count = ((fitted.len() as f64 * share).ceil() as usize).min(fitted.len());
    let chosen: Vec<usize> = (0..count).map(|k| fitted[(2 * k + 1) * fitted.len() / (2 * count)]).collect();
    let dressed = |person: &usize| -> Result<Option<String>> {
        let size = tally.wears(*person);
        let body = bodies::build_body(&figures[*person].measurements)?;
        let (outcome, eases) = alteration::outcome(spec, &styles[size], &body)?;
        let against = against(&outcome, &eases, bands);
        Ok((!against.is_empty()).then(|| format!("person {} in {}: {}", person + 1, names[size], against.join(", "))))
    };
    let found = people::of_all(&chosen, dressed).into_iter().collect::<Result<Vec<Option<String>>>>()?;
    let against: Vec<String> = found.into_iter().flatten().collect();
    Ok(DrapedAgain { people: count, agree: count - against.len(), against })
}

/// Objections of a drape: reasons why the size does not fit.
fn against(outcome: &Outcome, eases: &[(String, f64)], bands: &[Band]) -> Vec<String> {
    let mut against = Vec::new();
    if !outcome.converged {
        against.push("not at rest".to_owned());
    }
    if outcome.penetration_max_m > INSIDE_M {
        against.push(format!("{:.1} mm inside the body", mm(outcome.penetration_max_m)));
    }
    for band in bands {
        let Some((_, ease_m)) = eases.iter().find(|(level, _)| *level == band.level) else { continue };
        let [least, most] = band.decides.ends_m;
        if !(least - SLACK_M..=most + SLACK_M).contains(ease_m) {
            let (ease_mm, meant) = (mm(*ease_m), band_words([least, most].map(mm)));
            let level = band.level.replace('_', " ");
            against.push(format!("{level} {ease_mm:+.0} mm, meant {meant}"));
        }
    }
    against
}
