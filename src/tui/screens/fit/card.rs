//! The fit card: a row for each level, a column for each size.

use ratatui::layout::Rect;
use ratatui::style::Style;
use ratatui::text::{Line, Span};

use crate::screens::fit::actions::{card_levels, worn};
use crate::screens::fit::state::{FitScreen, View};
use crate::screens::state::State;
use crate::widgets::jump::{self, Target};
use crate::widgets::lists::first_shown;
use crate::widgets::text::{self, left, right, whole, words, wrapped};
use crate::widgets::theme::Theme;
use results::{FitCard, GarmentWorn, LevelSits, Sits, SizeSits};

pub const LEGEND: &str = " ▼ tight  ▲ loose  ! smaller than the body ";
/// Columns for body and target.
const BODY: usize = 6;
const TARGET: usize = 10;
/// Columns for a size: with words in full, with short words, with only ease and sign.
const LONG: usize = 20;
const SHORT: usize = 18;
const SIGNS: usize = 9;

pub fn title(state: &State) -> String {
    let Some(grid) = state.grid() else { return "fit".to_owned() };
    let at = state.place.subject;
    let subject = grid.subjects.get(at).map_or("", String::as_str);
    let intended = worn(state).and_then(|worn| worn.card.intended.as_deref());
    let intended = intended.map_or(String::new(), |fit| format!(" · {fit} fit"));
    let which = match grid.subjects.len() {
        0 | 1 => String::new(),
        n => format!(" · {} of {n}", at + 1),
    };
    format!("{} on {subject}{which}{intended}", grid.garment)
}

impl FitScreen {
    pub fn card_lines(&self, state: &State, columns: usize, lines: usize, focused: bool) -> Vec<Line<'static>> {
        let Some(worn) = worn(state) else { return vec![Line::raw("reading…")] };
        let card = &worn.card;
        if card.sizes.is_empty() {
            return vec![Line::raw("no ease is known yet: R runs the study, which measures it")];
        }
        let levels = card_levels(state);
        let missing = missing(worn, columns);
        let widths = Columns::new(card, columns);
        let mut told = head(state.theme, card, &widths, columns, lines.saturating_sub(levels.len() + missing.len()));
        let at = self.level_in(state, &levels);
        let room = lines.saturating_sub(told.len() + missing.len());
        let first = first_shown(at.unwrap_or(0), levels.len(), room);
        for (k, level) in levels.iter().enumerate().skip(first).take(room) {
            let selection = (Some(k) == at).then(|| state.theme.selection(focused));
            told.push(row(state.theme, &widths, level, selection.unwrap_or_default()));
        }
        if levels.is_empty() {
            told.push(Line::raw("no level matches the filter"));
        }
        told.extend(missing.into_iter().map(|line| Line::styled(line, state.theme.busy())));
        told
    }

    pub fn card_targets(&self, state: &State, inner: Rect) -> Vec<Target> {
        let Some(worn) = worn(state).filter(|worn| !worn.card.sizes.is_empty()) else { return vec![] };
        let (columns, lines) = (usize::from(inner.width), usize::from(inner.height));
        let levels = card_levels(state);
        let missing = missing(worn, columns).len();
        let widths = Columns::new(&worn.card, columns);
        let head = head(state.theme, &worn.card, &widths, columns, lines.saturating_sub(levels.len() + missing)).len();
        let at = self.level_in(state, &levels);
        let inner = Rect { height: inner.height.saturating_sub(missing as u16), ..inner };
        jump::rows(View::Card as usize, inner, head, levels.len(), at.unwrap_or(0))
    }
}

/// Note on what is not shown without a drape.
fn missing(worn: &GarmentWorn, columns: usize) -> Vec<String> {
    if worn.sizes.is_empty() {
        wrapped("no drape yet: sections and the comparison of sizes need one, R runs the study", columns)
    } else {
        vec![]
    }
}

/// Header of the card, below the verdict and, where they fit, the faults of the neighbouring sizes.
fn head(theme: Theme, card: &FitCard, widths: &Columns<'_>, columns: usize, lines: usize) -> Vec<Line<'static>> {
    let mut told = vec![verdict(theme, card, columns)];
    let others = others(card, columns);
    if told.len() + others.len() < lines {
        told.extend(others.into_iter().map(|line| Line::styled(line, theme.dim())));
    }
    told.push(header(theme, card, widths));
    told
}

/// Line with the size to wear and its worst fault.
fn verdict(theme: Theme, card: &FitCard, columns: usize) -> Line<'static> {
    let (sign, style) =
        card.to_wear().and_then(SizeSits::worst).map_or((" ", Style::new()), |sits| sign(theme, sits.sits()));
    let verdict = text::shortened(&format!("{sign} {}", card.verdict()), columns);
    Line::styled(verdict, style.patch(theme.bold()))
}

/// Lines with the worst faults of the neighbouring sizes.
fn others(card: &FitCard, columns: usize) -> Vec<String> {
    let others = card.beside().iter().filter(|size| size.place.is_some_and(|place| place != 1));
    wrapped(&others.map(|size| format!("not {}: {}", size.size, size.words())).collect::<Vec<_>>().join("; "), columns)
}

/// Columns that fit: as many as possible of the size to wear and its neighbours, then target and body.
struct Columns<'a> {
    level: usize,
    sizes: Vec<&'a SizeSits>,
    size: usize,
    body: bool,
    target: bool,
}

impl<'a> Columns<'a> {
    fn new(card: &'a FitCard, columns: usize) -> Self {
        let longest = |is_short: bool| card.levels().iter().map(|level| text::width(&name(level, is_short))).max();
        let level = |size: usize| longest(size < LONG).unwrap_or(0).max(5);
        let mut sizes: Vec<&SizeSits> = card.beside().iter().collect();
        let left_over = |size: usize, sizes: &[&SizeSits]| columns.checked_sub(level(size) + size * sizes.len());
        let size = [LONG, SHORT].into_iter().find(|size| left_over(*size, &sizes) >= Some(BODY + TARGET - 1));
        let size = size.or_else(|| left_over(SHORT, &sizes).map(|_| SHORT)).unwrap_or(SIGNS);
        while sizes.len() > 1 && left_over(size, &sizes).is_none() {
            // Keeps the size to wear.
            let last = sizes.len() - 1;
            sizes.remove(if sizes[last].place == Some(1) { 0 } else { last });
        }
        let room = left_over(size, &sizes).unwrap_or(0);
        Self { level: level(size), sizes, size, body: room >= BODY, target: room >= BODY + TARGET - 1 }
    }
}

pub fn name(level: &str, is_short: bool) -> String {
    let name = words(level);
    if is_short { name.replace("across ", "") } else { name }
}

fn header(theme: Theme, card: &FitCard, columns: &Columns<'_>) -> Line<'static> {
    let mut start = left("mm", columns.level);
    if columns.body {
        start += &right("body", BODY);
    }
    if columns.target {
        start += &right("target", TARGET - 1);
    }
    let mut spans = vec![Span::styled(start, theme.dim())];
    for size in &columns.sizes {
        let (title, style) = headed(theme, card, &size.size);
        spans.push(Span::raw("  "));
        spans.push(Span::styled(left(&title, columns.size - 2), style));
    }
    Line::from(spans)
}

/// The title of a size's column, in the colour of its line in sections.
pub fn headed(theme: Theme, card: &FitCard, size: &str) -> (String, Style) {
    let style = colour(theme, card, size);
    let mark = card.sizes.iter().find(|other| other.size == size).and_then(SizeSits::mark);
    match mark {
        Some(mark) => (format!("▸{size} {mark}"), style.patch(theme.bold())),
        None => (size.to_owned(), style),
    }
}

pub fn is_to_wear(card: &FitCard, size: &str) -> bool {
    card.to_wear().is_some_and(|wear| wear.size == size)
}

pub fn colour(theme: Theme, card: &FitCard, size: &str) -> Style {
    let number = card.sizes.iter().position(|other| other.size == size).unwrap_or(0);
    Style::new().fg(theme.lettered(number))
}

fn row(theme: Theme, columns: &Columns<'_>, level: &str, selection: Style) -> Line<'static> {
    let of_sizes: Vec<Option<&LevelSits>> =
        columns.sizes.iter().map(|size| size.levels.iter().find(|sits| sits.level == level)).collect();
    let known = of_sizes.iter().flatten().next();
    let mut spans = vec![Span::styled(left(&name(level, columns.size < LONG), columns.level), selection)];
    if columns.body {
        spans.push(Span::raw(right(&known.map_or(String::new(), |sits| whole(sits.body_girth_mm)), BODY)));
    }
    if columns.target {
        let target = target(theme, known.and_then(|sits| sits.target_mm));
        spans.push(Span::styled(right(&target, TARGET - 1), theme.dim()));
    }
    for sits in of_sizes {
        spans.push(match sits {
            Some(sits) => cell(theme, sits, columns.size),
            None => Span::styled(left(" —", columns.size), theme.dim()),
        });
    }
    Line::from(spans)
}

/// Target ease, from where to where; in ASCII with two dots, since one would be a decimal point. Nothing follows them
/// where the garment hangs free.
pub fn target(theme: Theme, target_mm: Option<[f64; 2]>) -> String {
    let to = if theme.ascii { ".." } else { "…" };
    target_mm.map_or("—".to_owned(), |[least, most]| {
        let most = if most.is_finite() { whole(most) } else { String::new() };
        format!("{}{to}{most}", whole(least))
    })
}

fn cell(theme: Theme, sits: &LevelSits, columns: usize) -> Span<'static> {
    let (sign, style) = sign(theme, sits.sits());
    let ease = format!("{:+.0}", sits.ease_mm).replace('-', "−");
    let told = sits.words();
    let told = told.split(" mm").next().unwrap_or_default();
    let told = match columns {
        LONG.. => told.to_owned(),
        SHORT.. => told.replace("by ", "").replace("as designed", "designed"),
        _ => String::new(),
    };
    let mark = if is_undersized(sits) { "!" } else { "" };
    Span::styled(left(format!("{} {sign} {told}{mark}", right(&ease, 5)).trim_end(), columns), style)
}

pub fn sign(theme: Theme, sits: Option<Sits>) -> (&'static str, Style) {
    match sits {
        None => (" ", theme.dim()),
        Some(Sits::Tight) => ("▼", theme.bad()),
        Some(Sits::Loose) => ("▲", theme.warn()),
        Some(Sits::AsMeant) => ("·", theme.good()),
    }
}

/// True if a size is tight at a level and smaller than the body.
fn is_undersized(sits: &LevelSits) -> bool {
    sits.ease_mm < 0.0 && sits.sits() == Some(Sits::Tight)
}
