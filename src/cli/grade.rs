//! `toile grade`: sizes for a population.

use super::args::Grade;
use super::context::Context;
use super::output::tenths;
use super::{CliError, End, Outcome, output, xlsx};
use advice::Grown;
use advice::{GradeWish, Grading, SizeSet, SizeShare};
use fit::target::band_words;
use report::file_part;
use spec::bodies::Sex;
use store::{Table, Value, files};

pub fn grade(context: &Context, arguments: &Grade) -> Outcome {
    let endings = ["dxf", "rul", "toml", "svg", "xlsx"];
    arguments.output.as_deref().map(|folder| output::folder(folder, &endings)).transpose()?;
    let store = context.store()?;
    let study = context.study(&store, &arguments.study)?;
    let wish = GradeWish {
        garment: arguments.garment.clone(),
        sizes: arguments.sizes,
        people: arguments.people,
        held_out: arguments.held_out,
        seed: arguments.seed,
        base: arguments.base.clone(),
        is_even: arguments.even,
        without: arguments.without.clone(),
        draped: arguments.drape,
    };
    if let Some(folder) = &arguments.output {
        files::make_folder(folder)?;
    }
    let found = advice::grade(&study, &wish)?;
    if let Some(folder) = &arguments.output {
        let name = format!("{}.xlsx", file_part(&found.garment));
        let sheets = sheets(&found);
        let sheets: Vec<(&str, &Table)> = sheets.iter().map(|(name, table)| (*name, table)).collect();
        let mut all = found.files.clone();
        all.push((name, xlsx::bytes(&sheets)?));
        context.write_files(folder, &all)?;
    }
    match context.json {
        true => output::json(&found)?,
        false => print(context, &found)?,
    }
    let disagrees = found.drapes.as_ref().is_some_and(|drapes| drapes.agree < drapes.people);
    Ok(if disagrees { End::CheckFailed } else { End::Done })
}

fn sheets(found: &Grading) -> Vec<(&'static str, Table)> {
    vec![
        ("coverage", coverage(found)),
        ("levels", levels(found)),
        ("parts", parts(found)),
        ("growth", growth(found)),
        ("grade", turns(found)),
        ("size chart", chart(found)),
        ("spec sheet", found.sheet.table()),
    ]
}

fn print(context: &Context, found: &Grading) -> Result<(), CliError> {
    let [sought, held_out] = found.people;
    let Grading { garment, base, intended, apart_mm, .. } = found;
    let who = match found.sexes[..] {
        [Sex::Male] => "men",
        [Sex::Female] => "women",
        _ => "women and men",
    };
    output::text(&format!(
        "{garment}, made of {base}, {intended} fit: sought for {sought} {who}, judged on {held_out} others\n"
    ))?;
    for (title, table) in sheets(found) {
        output::text(&format!("{title}\n"))?;
        context.print(&if title == "spec sheet" { without_last(table) } else { table })?;
    }
    let rules = found.rules;
    output::text(&format!("{rules} rules, read again: the same sizes within {apart_mm:.3} mm\n"))?;
    found.refused.iter().for_each(output::note);
    if let Some(drapes) = &found.drapes {
        output::text(&format!("draped again: {} of {} agree\n", drapes.agree, drapes.people))?;
        drapes.against.iter().for_each(output::note);
    }
    Ok(())
}

/// A table without its last column, which is long.
fn without_last(mut table: Table) -> Table {
    table.columns.pop();
    table.rows.iter_mut().for_each(|row| {
        row.pop();
    });
    table
}

fn text(text: impl Into<String>) -> Value {
    Value::Text(text.into())
}

/// Shares of people whom each set and each of its sizes fits.
fn coverage(found: &Grading) -> Table {
    let columns = ["sizes", "size", "sought_percent", "held_out_percent", "within", "worn_percent"];
    let all = |set: &SizeSet| {
        let [sought, out, within] = [set.sought_percent, set.held_out_percent, set.within_percent].map(tenths);
        vec![text(set.set), text("all"), sought, out, within, Value::Null]
    };
    let size = |set: &SizeSet, size: &SizeShare| {
        let [fits, worn] = [size.fits_percent, size.worn_percent].map(tenths);
        vec![text(set.set), text(&size.size), Value::Null, fits, Value::Null, worn]
    };
    let rows = found.sets.iter().flat_map(|set| {
        std::iter::once(all(set)).chain(set.sizes.iter().map(move |share| size(set, share))).collect::<Vec<_>>()
    });
    Table::new(columns, rows)
}

fn levels(found: &Grading) -> Table {
    let columns =
        ["level", "target_mm", "own within_percent", "new within_percent", "own fails_percent", "new fails_percent"];
    let rows = found.levels.iter().map(|level| {
        let shares = level.within_percent.into_iter().chain(level.fails_percent).map(tenths);
        [text(level.level.replace('_', " ")), text(band_words(level.target_mm))].into_iter().chain(shares).collect()
    });
    Table::new(columns, rows)
}

fn parts(found: &Grading) -> Table {
    let (level, parts) = &found.parts;
    let girth = format!("{level}_mm");
    let rows = parts.iter().map(|part| {
        let [from, to] = part.from_to_mm;
        let [own, new] = part.fits_percent.map(tenths);
        vec![text(format!("{from:.0} to {to:.0}")), own, new]
    });
    Table::new([girth.as_str(), "own fits_percent", "new fits_percent"], rows)
}

/// Sizes of the new set.
fn new(found: &Grading) -> &[SizeShare] {
    found.sets.last().map_or(&[], |set| &set.sizes)
}

fn growth(found: &Grading) -> Table {
    let step = |row: &Grown, group: usize| row.steps_mm.get(group).map_or(Value::Null, |step| tenths(*step));
    let row = |row: &Grown| {
        let own =
            [text(row.handle.replace('_', " ")), text(row.with.replace('_', " ")), tenths(row.of_40_mm), step(row, 0)];
        own.into_iter().chain(found.split.is_some().then(|| step(row, 1))).collect()
    };
    let from = found.split.as_ref().map(|split| format!("step_mm from {split}"));
    let columns = ["length", "with", "of_40_mm", "step_mm"].into_iter().map(str::to_owned).chain(from);
    Table { columns: columns.collect(), rows: found.growth.iter().map(row).collect() }
}

/// Amounts of the handles in each size, relative to the base, mm.
fn turns(found: &Grading) -> Table {
    let columns = std::iter::once("handle".to_owned()).chain(new(found).iter().map(|size| format!("{}_mm", size.size)));
    let row = |handle: &&'static str| {
        let amount = |size: &SizeShare| {
            let turn = size.turns.iter().find(|turn| turn.handle == *handle);
            tenths(turn.map_or(0.0, |turn| turn.amount_mm))
        };
        std::iter::once(text(handle.replace('_', " "))).chain(new(found).iter().map(amount)).collect()
    };
    let named =
        |handle: &&'static str| new(found).iter().any(|size| size.turns.iter().any(|turn| turn.handle == *handle));
    let handles = pattern::Handle::ALL.map(pattern::Handle::as_str);
    Table { columns: columns.collect(), rows: handles.iter().filter(|handle| named(handle)).map(row).collect() }
}

/// Dimensions of the people who wear each size.
fn chart(found: &Grading) -> Table {
    let sizes = new(found);
    let columns = std::iter::once("dimension".to_owned()).chain(sizes.iter().map(|size| size.size.clone()));
    let known = sizes.iter().find(|size| !size.wearers.is_empty()).map_or(&[][..], |size| &size.wearers);
    let row = |dimension: &'static str| {
        let range_of = |size: &SizeShare| {
            let range = size.wearers.iter().find(|range| range.dimension == dimension);
            range.map_or(Value::Null, |range| {
                let [low, middle, high] = range.values;
                text(format!("{low:.0} to {high:.0}, middle {middle:.0}"))
            })
        };
        std::iter::once(text(dimension)).chain(sizes.iter().map(range_of)).collect()
    };
    Table { columns: columns.collect(), rows: known.iter().map(|range| row(range.dimension)).collect() }
}
