//! `toile alter`: changes of a pattern for a subject.

use super::args::Alter;
use super::context::Context;
use super::{End, Outcome, output};
use advice::{Alteration, AlteredLevel, AlteredReading, Wish};
use fit::target::band_words;
use geom::units::signed_tenths;
use store::{Table, Value};

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
        context.write_files(folder, &found.files)?;
        context.say(match found.keeps_source {
            true => "the pattern is the file that came: nothing but coordinates of what moves has changed",
            false => "the pattern is written as a new file",
        });
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
    for told in found.figures.iter().filter(|told| told.handle.is_none()) {
        let figure = told.figure.replace('_', " ");
        context.say(format_args!("{figure}, {:.0} mm: this pattern has no handle for it", told.amount_mm));
    }
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
    for advice::SignRead { sign, value, unit, cause, handles, .. } in &found.signs {
        let handles = if handles.is_empty() { "no handle of this pattern".to_owned() } else { handles.join(", ") };
        output::text(&format!("sign: {sign}, {value:+.0} {unit}: {cause}, altered by {handles}\n"))?;
    }
    found.remarks.iter().for_each(|remark| context.say(format_args!("{remark}")));
    Ok(())
}

fn moves(found: &Alteration) -> Table {
    let columns = ["handle", "by_mm", "of", "girth_mm", "for", "pieces"];
    let row = |moved: &advice::MovedHandle| {
        let by = |mm: f64| Value::Text(format!("{mm:+.1}"));
        // Half of a girth changes by the amount, and the girth by twice as much.
        let [of, girth] = match moved.is_half_girth {
            true => [Value::Text("half girth".to_owned()), by(2.0 * moved.amount_mm)],
            false => [Value::Null, Value::Null],
        };
        let [serves, pieces] = [&moved.serves, &moved.pieces].map(|all| Value::Text(all.join(", ").replace('_', " ")));
        vec![Value::Text(moved.handle.replace('_', " ")), by(moved.amount_mm), of, girth, serves, pieces]
    };
    Table::new(columns, found.moves.iter().map(row))
}

fn levels(found: &Alteration) -> Table {
    let columns = ["level", "target_mm", "before_mm", "promised_mm", "achieved_mm", ""];
    let row = |altered: &AlteredLevel| {
        let target = altered.target_mm.map_or(Value::Null, |band| Value::Text(band_words(band)));
        let ease = |mm: f64| Value::Text(signed_tenths(mm));
        let verdict = match (altered.target_mm, altered.is_met()) {
            (None, _) => "",
            (_, true) => "met",
            (_, false) => "missed",
        };
        let level = Value::Text(altered.level.replace('_', " "));
        vec![
            level,
            target,
            ease(altered.before_mm),
            ease(altered.promised_mm),
            ease(altered.achieved_mm),
            Value::Text(verdict.to_owned()),
        ]
    };
    Table::new(columns, found.levels.iter().map(row))
}

fn stands(standing: &[advice::Standing]) -> Table {
    let columns = ["target", "what", "value", "unit"];
    let row = |target: &advice::Standing| {
        let what = if target.is_ease { "ease" } else { "drape" };
        let value = if target.unit == "kPa" { format!("{:.2}", target.value) } else { format!("{:.1}", target.value) };
        [target.name.clone(), what.to_owned(), value, target.unit.to_owned()].map(Value::Text).to_vec()
    };
    Table::new(columns, standing.iter().map(row))
}

fn readings(found: &Alteration) -> Table {
    let columns = ["reading", "unit", "target", "before", "promised", "achieved", ""];
    let row = |altered: &AlteredReading| {
        let is_pressure = altered.unit == "kPa";
        let number = |value: f64| Value::Text(if is_pressure { format!("{value:.2}") } else { signed_tenths(value) });
        let [least, most] = altered.target.map(|bound| (100.0 * bound).round() / 100.0);
        vec![
            Value::Text(altered.reading.replace('_', " ")),
            Value::Text(altered.unit.to_owned()),
            Value::Text(format!("{least} to {most}")),
            number(altered.before),
            number(altered.promised),
            number(altered.achieved),
            Value::Text(if altered.is_met() { "met" } else { "missed" }.to_owned()),
        ]
    };
    Table::new(columns, found.readings.iter().map(row))
}
