//! `toile chance`: the probability that a garment fits.

use super::args::Chance as Arguments;
use super::context::Context;
use super::{CliError, End, Outcome, output, pictures};
use advice::{Chance, DrapedChance, LevelChance, LikelyDimension, PlantedLevel, Question, Reliability, SizeChance};
use fit::target::band_words;
use store::{Table, Value};

/// Accepted share of true values within the 80 % intervals.
const CALIBRATED: std::ops::RangeInclusive<f64> = 0.77..=0.83;

pub fn chance(context: &Context, arguments: &Arguments) -> Outcome {
    arguments.output.as_deref().map(pictures::chart_format).transpose()?;
    let store = context.store()?;
    let study = context.study(&store, &arguments.study)?;
    let question = Question {
        garment: arguments.garment.clone(),
        subject: arguments.subject.clone(),
        size: arguments.size.clone(),
        draws: arguments.draws as usize,
        seed: arguments.seed,
        error_factor: arguments.error_factor,
        tolerance_mm: arguments.tolerance_mm,
        fem: arguments.fem as usize,
    };
    if let Some(people) = arguments.planted {
        let tally = advice::planted(&study, &question, people as usize, question.error_factor)?;
        if context.json {
            output::json(&tally)?;
        } else {
            output::text(&format!("{} people, of each {} read\n", tally.people, tally.read.join(", ")))?;
            context.print(&held(&tally.levels))?;
            output::text("a size fits\n")?;
            context.print(&came_true(&tally.fits))?;
            output::text("a size is the one to wear\n")?;
            context.print(&came_true(&tally.wear))?;
            let share = percent(tally.held.share);
            output::text(&format!("80 % intervals of levels with a target hold {share} % of the true eases\n"))?;
        }
        return Ok(if CALIBRATED.contains(&tally.held.share) { End::Done } else { End::CheckFailed });
    }
    let found = advice::chance(&study, &question)?;
    if let Some(file) = &arguments.output {
        pictures::write_chart(context, file, &found.chart()?)?;
    }
    match context.json {
        true => output::json(&found)?,
        false => print(context, &found)?,
    }
    Ok(End::Done)
}

fn print(context: &Context, found: &Chance) -> Result<(), CliError> {
    let Chance { garment, subject, intended, told, .. } = found;
    let Some(size) = found.told() else { return Ok(()) };
    let [low, high] = size.fits.interval.map(percent);
    let (fits, wear) = (percent(size.fits.share), percent(size.wear.share));
    output::text(&format!(
        "{garment} on {subject} ({intended} fit): {told} fits with {fits} % (80 % interval {low} to {high}), and is {} with {wear} %\n",
        size.place()
    ))?;
    context.print(&sizes(&found.sizes))?;
    output::text(&format!("{told}\n"))?;
    context.print(&levels(size))?;
    output::text("body\n")?;
    context.print(&body(&found.body))?;
    if let Some(drape) = &found.drape {
        output::text(&draped(drape))?;
        drape.refused.iter().for_each(|reason| context.say(format_args!("left out: {reason}")));
    }
    Ok(())
}

fn percent(share: f64) -> String {
    format!("{:.0}", 100.0 * share)
}

fn table<const N: usize>(columns: [&str; N], rows: impl Iterator<Item = [String; N]>) -> Table {
    Table::new(columns, rows.map(|row| row.map(Value::Text).to_vec()))
}

fn words(level: &str) -> String {
    level.replace('_', " ")
}

fn sizes(sizes: &[SizeChance]) -> Table {
    let row = |size: &SizeChance| {
        let decides = size.decides().map_or(String::new(), |level| {
            let how = if level.tight > level.loose { "tight" } else { "loose" };
            format!("{}, {how}", words(&level.level))
        });
        let [wear, fits, tight, loose] = [size.wear.share, size.fits.share, size.tight, size.loose].map(percent);
        [size.size.clone(), wear, fits, tight, loose, decides]
    };
    table(["size", "wear %", "fits %", "tight %", "loose %", "decides most often"], sizes.iter().map(row))
}

fn levels(size: &SizeChance) -> Table {
    let row = |level: &LevelChance| {
        let target = level.target_mm.map_or(String::new(), band_words);
        let [low, middle, high] = level.ease_mm.map(|mm| format!("{mm:+.0}"));
        let shares = [level.as_meant(), level.tight, level.loose].map(percent);
        let [fits, tight, loose] = if level.target_mm.is_some() { shares } else { Default::default() };
        [words(&level.level), target, middle, format!("{low} to {high}"), fits, tight, loose]
    };
    let columns = ["level", "target_mm", "ease_mm", "80 % interval", "as meant %", "tight %", "loose %"];
    table(columns, size.levels.iter().map(row))
}

fn body(dimensions: &[LikelyDimension]) -> Table {
    let row = |likely: &LikelyDimension| {
        let [read, error] = likely.read?;
        let [low, middle, high] = likely.likely.map(|value| format!("{value:.0}"));
        Some([
            likely.dimension.to_owned(),
            format!("{read:.0}"),
            format!("{error:.1}"),
            middle,
            format!("{low} to {high}"),
        ])
    };
    table(["dimension", "read", "error", "likely", "80 % interval"], dimensions.iter().filter_map(row))
}

fn draped(drape: &DrapedChance) -> String {
    let [low, high] = drape.fits.interval.map(percent);
    let fits = percent(drape.fits.share);
    let hem = drape
        .hem_front_over_back_mm
        .map_or(String::new(), |[low, _, high]| format!(", hem {low:+.0} to {high:+.0} mm in front"));
    let most = drape
        .most_kpa
        .map_or(String::new(), |[low, _, high]| format!(", presses with at most {low:.2} to {high:.2} kPa"));
    format!(
        "draped {}: {} at rest, fits with {fits} % (80 % interval {low} to {high}){hem}{most}\n",
        drape.draws, drape.at_rest
    )
}

fn held(levels: &[PlantedLevel]) -> Table {
    let row = |level: &PlantedLevel| {
        let [low, high] = level.held.interval.map(percent);
        let width = format!("{:.0}", level.width_mm);
        [words(&level.level), level.people.to_string(), percent(level.held.share), format!("{low} to {high}"), width]
    };
    table(["level", "people", "held %", "80 % interval", "width_mm"], levels.iter().map(row))
}

fn came_true(told: &[Reliability]) -> Table {
    let row = |class: &Reliability| {
        let [least, most] = class.told.map(percent);
        let [low, high] = class.came_true.interval.map(percent);
        let (mean, came) = (percent(class.mean), percent(class.came_true.share));
        [format!("{least} to {most}"), class.cases.to_string(), mean, came, format!("{low} to {high}")]
    };
    table(["told %", "cases", "mean %", "came true %", "80 % interval"], told.iter().map(row))
}
