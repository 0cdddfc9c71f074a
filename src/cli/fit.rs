//! `toile fit`: the size to wear, and the ease of all sizes.

use super::answers::NO_EASE;
use super::args::Fit;
use super::context::Context;
use super::{End, Outcome, output};
use fit::target::band_words;
use results::{FitCard, LevelSits, Sits, SizeSits, fit_card};
use store::{Table, Value};

pub fn fit(context: &Context, arguments: &Fit) -> Outcome {
    let (store, study) = context.eased(&arguments.study)?;
    let cards = fit_card::fit_cards(&store, &study, arguments.garment.as_deref(), arguments.subject.as_deref())?;
    if context.json {
        output::json(&cards)?;
        let is_known = !cards.is_empty() && !cards.iter().any(FitCard::is_unknown);
        return Ok(if is_known { End::Done } else { End::CheckFailed });
    }
    for (number, card) in cards.iter().enumerate() {
        let gap = if number == 0 { "" } else { "\n" };
        let intended = card.intended.as_deref().map_or(String::new(), |fit| format!(" ({fit} fit)"));
        output::text(&format!("{gap}{} on {}{intended}: {}\n", card.garment, card.subject, card.verdict()))?;
        if !card.is_unknown() {
            context.print(&table(card))?;
        }
    }
    if cards.iter().any(|card| card.beside().iter().flat_map(|size| &size.levels).any(|level| level.ease_mm < 0.0)) {
        output::text("! smaller than the body\n")?;
    }
    let told: Vec<String> =
        cards.iter().flat_map(|card| card.beside().iter().flat_map(|size| uncovered(card, size))).collect();
    if !told.is_empty() {
        output::text(&format!("~ not covered all round by the drape, and so not judged: {}\n", told.join("; ")))?;
    }
    if cards.iter().any(FitCard::is_unknown) || cards.is_empty() {
        context.say(NO_EASE);
        return Ok(End::CheckFailed);
    }
    Ok(End::Done)
}

/// A row for each level and a column for each size: ease in millimetres, with its verdict.
fn table(card: &FitCard) -> Table {
    let sizes = card.beside();
    let mut columns = vec!["level".to_owned(), "body_mm".to_owned(), "target_mm".to_owned()];
    columns.extend(sizes.iter().map(|size| {
        let mark = size.mark().map_or(String::new(), |mark| format!(" ({mark})"));
        format!("{} ease_mm{mark}", size.size)
    }));
    let row = |level: &str| {
        let level_of = |size: &SizeSits| size.levels.iter().find(|sits| sits.level == level).cloned();
        let all: Vec<_> = sizes.iter().map(level_of).collect();
        let known = all.iter().flatten().next();
        let target = known.and_then(|sits| sits.target_mm).map_or(Value::Null, |band| Value::Text(band_words(band)));
        let body = known.map_or(Value::Null, |sits| Value::Integer(sits.body_girth_mm.round() as i64));
        let mut row = vec![Value::Text(level.replace('_', " ")), body, target];
        row.extend(all.iter().map(|sits| sits.as_ref().map_or(Value::Null, |sits| Value::Text(short(sits)))));
        row
    };
    Table { columns, rows: card.levels().into_iter().map(row).collect() }
}

fn uncovered(card: &FitCard, size: &SizeSits) -> Vec<String> {
    let is_bare = |level: &&LevelSits| level.covered_deg.is_some();
    let words = |level: &LevelSits| {
        let (name, told) = (level.level.replace('_', " "), level.words());
        format!("{name} of {} {} on {} ({told})", card.garment, size.size, card.subject)
    };
    size.levels.iter().filter(is_bare).map(words).collect()
}

/// Ease in few letters. `!` marks a garment smaller than the body, `~` a level that the drape does not cover all round.
fn short(level: &LevelSits) -> String {
    let mark = if level.ease_mm < 0.0 { "!" } else { "" };
    let by_mm = level.departure_mm();
    let words = match level.sits() {
        Some(Sits::Tight) => format!("tight {by_mm:.0}"),
        Some(Sits::Loose) => format!("loose {by_mm:.0}"),
        Some(Sits::AsMeant) => "as meant".to_owned(),
        None if level.covered_deg.is_some() => "~".to_owned(),
        None => String::new(),
    };
    format!("{:+.0}{mark} {words}", level.ease_mm).trim_end().to_owned()
}
