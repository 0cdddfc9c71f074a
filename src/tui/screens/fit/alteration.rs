//! Drawing the alteration of a size: handles, ease before and after, drape, and remarks.

use ratatui::layout::Rect;
use ratatui::style::Style;
use ratatui::text::{Line, Span};

use crate::screens::fit::actions::{passes, worn};
use crate::screens::fit::card::{name, sign, target};
use crate::screens::fit::state::{Alter, Draping};
use crate::screens::state::State;
use crate::widgets::text::{self, left, right, words, wrapped};
use crate::widgets::theme::Theme;
use advice::{Alteration, AlteredLevel, MovedHandle};
use results::Sits;

/// Columns for an amount, a target, and an ease with its sign.
const AMOUNT: usize = 8;
const TARGET: usize = 9;
const EASE: usize = 8;
const SIGN: usize = 3;
/// Least columns at which promised ease and words beside signs are shown.
const ROOMY: usize = 62;

impl Alter {
    pub fn title(&self) -> String {
        match &self.asked {
            Some(asked) => format!("what to change · {} {} for {}", asked.garment, asked.size, asked.subject),
            None => "what to change".to_owned(),
        }
    }

    /// Mark with the numbers of lines hidden above and below.
    pub fn hidden_mark(&self, hidden: usize) -> Option<String> {
        let down = self.down.min(hidden);
        let mark = match (down, hidden - down) {
            (0, 0) => return None,
            (0, below) => format!(" ↓ {below} more lines: j "),
            (above, 0) => format!(" ↑ {above} more lines: k "),
            (above, below) => format!(" ↑ {above} ↓ {below} more lines: j k "),
        };
        Some(mark)
    }

    pub fn hidden(&self, state: &State, pane: Rect) -> usize {
        let (columns, rows) = inner(pane);
        self.lines(state, columns, rows).len().saturating_sub(rows)
    }

    /// All lines. Where they fit into `rows`, blank lines part them, and the effects of handles are given in full.
    pub fn lines(&self, state: &State, columns: usize, rows: usize) -> Vec<Line<'static>> {
        let theme = state.theme;
        let told = |text: &str, style: Style| -> Vec<Line<'static>> {
            wrapped(text, columns).into_iter().map(|line| Line::styled(line, style)).collect()
        };
        let found = match (&self.asked, &self.answer) {
            (None, _) => return vec![Line::raw("reading…")],
            (Some(asked), None) => {
                return told(&format!("finding what to change of {} for {}…", asked.size, asked.subject), theme.busy());
            }
            (_, Some(Err(error))) => return told(&format!("no change is found: {error}"), theme.bad()),
            (_, Some(Ok(found))) => found,
        };
        let drape = match (&found.drape, &self.draping) {
            (_, Draping::GoesOn) => {
                told(&format!("draping the changed pattern by FEM-GS: {}", self.how_long(state)), theme.busy())
            }
            (_, Draping::Failed(error)) => told(&format!("not draped: {error}"), theme.bad()),
            (Some(drape), Draping::No) => told(
                &format!("draped again: {}", drape.words()),
                if drape.converged { Style::new() } else { theme.warn() },
            ),
            (None, Draping::No) => vec![],
        };
        // The limit is a flag of the command; no key here changes it.
        let in_words =
            |remark: &String| remark.replace("--limit-mm allows", "in a shell, toile alter --limit-mm allows");
        let remarks: Vec<Line<'static>> =
            found.remarks.iter().flat_map(|remark| hanging(&in_words(remark), columns)).collect();
        let told = |is_whole: bool, gap: &[Line<'static>]| {
            let (moves, levels) = (moves(theme, found, columns, is_whole), levels(state, found, columns));
            let mut parts = vec![verdict(theme, found, columns), moves, levels, drape.clone(), remarks.clone()];
            parts.retain(|part| !part.is_empty());
            parts.join(gap)
        };
        let roomy = [true, false].map(|is_whole| told(is_whole, &[Line::raw("")]));
        roomy.into_iter().find(|lines| lines.len() <= rows).unwrap_or_else(|| told(false, &[]))
    }
}

/// Columns and rows within the border of a pane.
pub fn inner(pane: Rect) -> (usize, usize) {
    (usize::from(pane.width.saturating_sub(2)), usize::from(pane.height.saturating_sub(2)))
}

/// Lines of a remark, indented from the second on.
fn hanging(remark: &str, columns: usize) -> Vec<Line<'static>> {
    let lines = wrapped(remark, columns.saturating_sub(2)).into_iter().enumerate();
    lines.map(|(k, line)| Line::raw(format!("{}{line}", if k == 0 { "• " } else { "  " }))).collect()
}

/// Line with the number of handles that move, and the levels that are missed all the same.
fn verdict(theme: Theme, found: &Alteration, columns: usize) -> Vec<Line<'static>> {
    let missed: Vec<&AlteredLevel> = found.levels.iter().filter(|level| !level.is_met()).collect();
    let has_target = found.levels.iter().any(|level| level.target_mm.is_some());
    let change = match found.moves.len() {
        0 => "nothing to change".to_owned(),
        1 => "change one handle".to_owned(),
        n => format!("change {n} handles"),
    };
    let end = match (has_target, missed.is_empty(), found.moves.is_empty()) {
        (false, ..) => "no level has a target".to_owned(),
        (_, true, true) => "every level is as meant".to_owned(),
        (_, true, false) => "every level is as meant then".to_owned(),
        (_, false, _) => {
            let names = missed.iter().map(|level| words(&level.level)).collect::<Vec<_>>().join(", ");
            format!("what is meant is missed at {names}")
        }
    };
    let sits = missed.first().map_or(has_target.then_some(Sits::AsMeant), |level| level.sits(level.achieved_mm));
    let (sign, style) = sign(theme, sits);
    let lines = wrapped(&format!("{sign} {change}: {end}"), columns);
    lines.into_iter().map(|line| Line::styled(line, style.patch(theme.bold()))).collect()
}

/// Lines of the handles that move: amount and effect, in full or as far as one line holds.
fn moves(theme: Theme, found: &Alteration, columns: usize, is_whole: bool) -> Vec<Line<'static>> {
    if found.moves.is_empty() {
        return vec![];
    }
    let longest = found.moves.iter().map(|moved| text::width(moved.handle)).max().unwrap_or(0).max(6);
    let room = columns.saturating_sub(longest + AMOUNT + 2);
    let head = left("handle", longest) + &right("by mm", AMOUNT);
    let head = if room >= 20 { head + "  plus means" } else { head };
    let mut told = vec![Line::styled(head, theme.dim())];
    for MovedHandle { handle, amount_mm, does, .. } in &found.moves {
        let means = if is_whole && room >= 20 { wrapped(does, room) } else { vec![clause(does, room).to_owned()] };
        for (k, line) in means.into_iter().enumerate() {
            let [handle, by] = if k == 0 { [words(handle), signed(*amount_mm)] } else { Default::default() };
            told.push(Line::from(vec![
                Span::raw(left(&handle, longest)),
                Span::styled(right(&by, AMOUNT) + "  ", theme.bold()),
                Span::styled(line, theme.dim()),
            ]));
        }
    }
    told
}

/// Text or its first clause, whichever fits; empty where neither fits.
fn clause(whole: &str, columns: usize) -> &str {
    let first = whole.split([':', ';']).next().unwrap_or(whole);
    [whole, first].into_iter().find(|text| text::width(text) <= columns).unwrap_or_default()
}

/// Lines with the ease at the levels that pass the filter, from the neck down.
fn levels(state: &State, found: &Alteration, columns: usize) -> Vec<Line<'static>> {
    let (theme, is_roomy) = (state.theme, columns >= ROOMY);
    let order = worn(state).map_or(vec![], |worn| worn.card.levels());
    let shown = found.levels.iter().filter(|altered| passes(state, &words(&altered.level)));
    let mut levels: Vec<&AlteredLevel> = shown.collect();
    levels.sort_by_key(|altered| order.iter().position(|level| *level == altered.level).unwrap_or(order.len()));
    let longest = levels.iter().map(|altered| text::width(&name(&altered.level, !is_roomy))).max().unwrap_or(0).max(8);
    let promised = if is_roomy { right("promised", EASE + SIGN) } else { String::new() };
    let head = left("ease, mm", longest) + &right("target", TARGET) + &right("before", EASE) + &" ".repeat(SIGN);
    let mut told = vec![Line::styled(head + &promised + &right("achieved", EASE + SIGN), theme.dim())];
    for altered in levels {
        let mut spans = vec![
            Span::raw(left(&name(&altered.level, !is_roomy), longest)),
            Span::styled(right(&target(theme, altered.target_mm), TARGET), theme.dim()),
            ease(theme, altered, altered.before_mm, EASE),
        ];
        if is_roomy {
            spans.push(Span::raw(right(&signed(altered.promised_mm), EASE + SIGN)));
        }
        spans.push(ease(theme, altered, altered.achieved_mm, EASE + SIGN));
        if is_roomy && altered.target_mm.is_some() {
            let (_, style) = sign(theme, altered.sits(altered.achieved_mm));
            spans.push(Span::styled(if altered.is_met() { "met" } else { "missed" }, style));
        }
        told.push(Line::from(spans));
    }
    if told.len() == 1 {
        told.push(Line::raw("no level matches the filter"));
    }
    told
}

fn ease(theme: Theme, altered: &AlteredLevel, mm: f64, columns: usize) -> Span<'static> {
    let sits = altered.sits(mm);
    let (sign, style) = sign(theme, sits);
    let mark = if mm < 0.0 && sits == Some(Sits::Tight) { "!" } else { " " };
    Span::styled(format!("{} {sign}{mark}", right(&signed(mm), columns)), style)
}

/// Length with its sign, to 0.1 mm.
fn signed(mm: f64) -> String {
    format!("{mm:+.1}").replace('-', "−")
}
