//! `toile section`: cross sections of body and cloth.

use std::path::Path;

use super::args::Section;
use super::context::Context;
use super::{CliError, End, Outcome, output, pictures};
use fit::Simulator;
use results::{CrossSection, CutAt, CutCloth, GarmentWorn, assessment, cross_section};
use store::{JobId, Store, Table, Value};

pub fn section(context: &Context, arguments: &Section) -> Outcome {
    arguments.output.as_deref().map(pictures::chart_format).transpose()?;
    let store = context.store()?;
    let study = context.study_name(&store, &arguments.study)?;
    let at = match (&arguments.level, arguments.at_mm) {
        (Some(level), _) => CutAt::Level(level.clone()),
        (None, Some(height_mm)) => CutAt::HeightMm(height_mm),
        (None, None) => CutAt::Levels,
    };
    let worn = assessment::worn(&store, &study, arguments.garment.as_deref(), arguments.subject.as_deref())?;
    let mut cut: Vec<Drapes<'_>> = Vec::new();
    for worn in &worn {
        let jobs = jobs(&store, &study, worn, arguments)?;
        if !jobs.is_empty() {
            cut.push(Drapes { worn, jobs });
        }
    }
    if cut.is_empty() {
        return Err(CliError::Usage(format!(
            "{study} has no drape of what is asked for; toile run {study} makes them"
        )));
    }
    if let Some(file) = &arguments.output {
        return draw(context, &store, &cut, &at, file);
    }
    let found: Vec<Vec<CrossSection>> =
        cut.iter().map(|drapes| cross_section::sections(&store, &drapes.jobs, &at)).collect::<Result<_, _>>()?;
    if context.json {
        output::json(&found.concat())?;
        return Ok(End::Done);
    }
    for (number, (drapes, sections)) in cut.iter().zip(&found).enumerate() {
        let gap = if number == 0 { "" } else { "\n" };
        let card = &drapes.worn.card;
        output::text(&format!("{gap}{} on {}: gap from skin to cloth\n", card.garment, card.subject))?;
        context.print(&table(sections))?;
    }
    Ok(End::Done)
}

struct Drapes<'a> {
    worn: &'a GarmentWorn,
    jobs: Vec<JobId>,
}

/// Selected jobs in the order of sizes.
fn jobs(store: &Store, study: &str, worn: &GarmentWorn, arguments: &Section) -> Result<Vec<JobId>, CliError> {
    let simulator = arguments.sim.map(Simulator::from).or(worn.simulator);
    let Some(simulator) = simulator else { return Ok(Vec::new()) };
    let is_wanted = |size: &str| arguments.size.is_empty() || arguments.size.iter().any(|wanted| wanted == size);
    let sizes = assessment::drapes(store, study, &worn.card, simulator)?;
    Ok(sizes.into_iter().filter(|(size, _)| is_wanted(size)).map(|(_, job)| job).collect())
}

/// Arguments must select exactly one section.
fn draw(context: &Context, store: &Store, cut: &[Drapes<'_>], at: &CutAt, file: &Path) -> Outcome {
    let mut drawn = Vec::new();
    for Drapes { worn, jobs } in cut {
        let wear = worn.card.to_wear().map(|size| size.size.as_str());
        drawn.extend(cross_section::drawn(store, jobs, at, wear)?);
    }
    let [(_, chart)] = drawn.as_slice() else {
        let asked = format!("{} sections are asked for; a drawing is of one", drawn.len());
        return Err(CliError::Usage(format!("{asked}: name --garment, --subject and --level or --at-mm")));
    };
    pictures::write_chart(context, file, chart)
}

/// A row for each level and size.
fn table(sections: &[CrossSection]) -> Table {
    let columns = ["level", "height_mm", "size", "simulator", "least_mm", "mean_mm", "greatest_mm"];
    let row = |section: &CrossSection, cloth: &CutCloth| {
        let gaps = cloth.gap_mm().map(|gaps| gaps.map(|gap| Value::Real((10.0 * gap).round() / 10.0)));
        let [least, mean, greatest] = gaps.unwrap_or([Value::Null, Value::Null, Value::Null]);
        let level = Value::Text(section.level.replace('_', " "));
        let height = Value::Integer(section.height_mm.round() as i64);
        vec![
            level,
            height,
            Value::Text(cloth.size.clone()),
            Value::Text(cloth.simulator.clone()),
            least,
            mean,
            greatest,
        ]
    };
    let rows = sections.iter().flat_map(|section| section.cloth.iter().map(move |cloth| row(section, cloth)));
    Table::new(columns, rows)
}
