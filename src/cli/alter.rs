//! `toile alter`: what to change of a pattern.

use super::args::Alter;
use super::context::Context;
use super::{End, Outcome, output};
use advice::{Alteration, AlteredLevel, AlteredReading, Wish};
use geom::units::signed_tenths;
use store::{Table, Value, files};

/// Finds or applies a change of a size for a subject, and prints it.
pub fn alter(context: &Context, arguments: &Alter) -> Outcome {
    arguments.output.as_deref().map(|folder| output::folder(folder, &["dxf", "toml", "json", "svg"])).transpose()?;
    let store = context.store()?;
    let study = context.study(&store, &arguments.study)?;
    let wish = Wish {
        garment: arguments.garment.clone(),
        subject: arguments.subject.clone(),
        size: arguments.size.clone(),
        targets: arguments.target.iter().cloned().collect(),
        limit_mm: arguments.limit_mm,
        without: arguments.without.clone(),
        moves_mm: arguments.moves.clone(),
        is_draped: arguments.drape,
        is_nest: arguments.nest,
        standard: arguments.standard.into(),
    };
    if arguments.list {
        let standing = advice::standing(&study, &wish)?;
        match context.json {
            true => output::json(&standing)?,
            false => context.print(&stands(&standing))?,
        }
        return Ok(End::Done);
    }
    let found = advice::alter(&study, &wish)?;
    if let Some(folder) = &arguments.output {
        files::write_files(folder, &found.files)?;
        found.files.iter().for_each(|(name, _)| context.say(format_args!("wrote {}", folder.join(name).display())));
    }
    match context.json {
        true => output::json(&found)?,
        false => print(context, &found)?,
    }
    let is_draped = found.drape.is_some() || !arguments.drape;
    Ok(if found.is_met() && is_draped { End::Done } else { End::CheckFailed })
}

fn print(context: &Context, found: &Alteration) -> Result<(), super::CliError> {
    let Alteration { garment, subject, size, .. } = found;
    output::text(&format!("{garment} {size} for {subject}: "))?;
    match found.moves.as_slice() {
        [] => output::text("nothing to change\n")?,
        _ => {
            output::text("change\n")?;
            context.print(&moves(found))?;
        }
    }
    output::text("ease\n")?;
    context.print(&levels(found))?;
    if !found.readings.is_empty() {
        output::text(&format!("on the drape ({} drapes)\n", found.drapes))?;
        context.print(&readings(found))?;
    }
    if let Some(drape) = &found.drape {
        output::text(&format!("draped again: {}\n", drape.words()))?;
    }
    found.remarks.iter().for_each(|remark| context.say(format_args!("{remark}")));
    Ok(())
}

fn moves(found: &Alteration) -> Table {
    let columns = ["handle", "by_mm", "of", "girth_mm"].map(str::to_owned).to_vec();
    let row = |one: &advice::MovedHandle| {
        let by = |mm: f64| Value::Text(format!("{mm:+.1}"));
        // A girth changes by twice what half of it does.
        let [of, girth] = match one.is_half_girth {
            true => [Value::Text("half girth".to_owned()), by(2.0 * one.amount_mm)],
            false => [Value::Null, Value::Null],
        };
        vec![Value::Text(one.handle.replace('_', " ")), by(one.amount_mm), of, girth]
    };
    Table { columns, rows: found.moves.iter().map(row).collect() }
}

fn levels(found: &Alteration) -> Table {
    let columns = ["level", "target_mm", "before_mm", "promised_mm", "achieved_mm", ""].map(str::to_owned).to_vec();
    let row = |one: &AlteredLevel| {
        let target = one.target_mm.map_or(Value::Null, |[least, most]| Value::Text(format!("{least:.0} to {most:.0}")));
        let ease = |mm: f64| Value::Text(signed_tenths(mm));
        let verdict = match (one.target_mm, one.is_met()) {
            (None, _) => "",
            (_, true) => "met",
            (_, false) => "missed",
        };
        let level = Value::Text(one.level.replace('_', " "));
        vec![
            level,
            target,
            ease(one.before_mm),
            ease(one.promised_mm),
            ease(one.achieved_mm),
            Value::Text(verdict.to_owned()),
        ]
    };
    Table { columns, rows: found.levels.iter().map(row).collect() }
}

fn stands(standing: &[advice::Standing]) -> Table {
    let columns = ["target", "what", "value", "unit"].map(str::to_owned).to_vec();
    let row = |one: &advice::Standing| {
        let what = if one.is_ease { "ease" } else { "drape" };
        let value = if one.unit == "kPa" { format!("{:.2}", one.value) } else { format!("{:.1}", one.value) };
        [one.name.clone(), what.to_owned(), value, one.unit.to_owned()].map(Value::Text).to_vec()
    };
    Table { columns, rows: standing.iter().map(row).collect() }
}

fn readings(found: &Alteration) -> Table {
    let columns = ["reading", "unit", "target", "before", "promised", "achieved", ""].map(str::to_owned).to_vec();
    let row = |one: &AlteredReading| {
        let number =
            |value: f64| Value::Text(if one.unit == "kPa" { format!("{value:.2}") } else { signed_tenths(value) });
        let [least, most] = one.target.map(|bound| (100.0 * bound).round() / 100.0);
        vec![
            Value::Text(one.reading.replace('_', " ")),
            Value::Text(one.unit.to_owned()),
            Value::Text(format!("{least} to {most}")),
            number(one.before),
            number(one.promised),
            number(one.achieved),
            Value::Text(if one.is_met() { "met" } else { "missed" }.to_owned()),
        ]
    };
    Table { columns, rows: found.readings.iter().map(row).collect() }
}
