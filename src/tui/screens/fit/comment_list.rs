//! Drawing the comments: a list, and the selected one in full.

use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::style::Style;
use ratatui::text::Line;
use ratatui::widgets::Paragraph;

use crate::screens::fit::actions::wearer;
use crate::screens::fit::comments::{last_round, status};
use crate::screens::fit::state::{Comments, View};
use crate::screens::state::State;
use crate::widgets::jump::{self, Target};
use crate::widgets::lists::{listed, pane};
use crate::widgets::text::{left, right, shortened, wrapped};
use crate::widgets::theme::Theme;
use store::comments::{Comment, Severity, State as Status};

/// Columns for number, severity, place (short and whole), owner and status, and for garment and subject among those of all fittings.
const NUMBER: usize = 3;
const SEVERITY: usize = 9;
const SEEN: [usize; 2] = [15, 24];
const OWNER: usize = 8;
const STATUS: usize = 9;
const FITTING: usize = 16;
/// Least columns of a list with whole places.
const ROOMY: usize = 90;
/// Fewest columns for the words of a comment; what does not fit beside them is left out.
const WORDS: usize = 18;
/// Least rows at which the selected comment stands below the list, and the rows for it.
const TALL: u16 = 12;
const DETAIL: u16 = 9;

impl Comments {
    pub fn draw(&self, frame: &mut Frame<'_>, area: Rect, state: &State, focused: bool) {
        let [list, detail] = panes(area);
        let block = pane(state.theme, self.title(state), focused)
            .title_bottom(Line::styled(self.legend(state), state.theme.legend()).right_aligned());
        let inner = block.inner(list);
        let lines = self.list(state, usize::from(inner.width), usize::from(inner.height), focused);
        frame.render_widget(Paragraph::new(lines).block(block), list);
        if detail.height > 0 {
            self.draw_selected(frame, detail, state);
        }
    }

    pub fn targets(&self, state: &State, area: Rect) -> Vec<Target> {
        let shown = self.shown(state);
        jump::rows(View::Comments as usize, jump::inside(panes(area)[0]), 1, shown.len(), self.index_in(&shown))
    }

    fn title(&self, state: &State) -> String {
        let Some((grid, subject)) = state.grid().zip(wearer(state)) else { return "comments".to_owned() };
        if self.is_whole {
            return format!("comments of all fittings of {}", grid.study);
        }
        let round = last_round(state, &grid.garment, subject).map_or(" · no round yet".to_owned(), |last| {
            let signed = last.signed_by.as_ref().map_or("not signed".to_owned(), |by| format!("signed by {by}"));
            format!(" · round {}, size {}, {signed}", last.round, last.size)
        });
        format!("comments · {} on {subject}{round}", grid.garment)
    }

    /// Numbers of open comments, and of those that an earlier round met, which are not listed.
    fn legend(&self, state: &State) -> String {
        let all = self.in_scope(state);
        let open = all.iter().filter(|one| one.status == Status::Open).count();
        format!(" {open} open of {} through all rounds ", all.len())
    }

    fn list(&self, state: &State, columns: usize, lines: usize, focused: bool) -> Vec<Line<'static>> {
        let shown = self.shown(state);
        let widths = Widths::new(columns, self.is_whole);
        let mut told = vec![Line::styled(shortened(&widths.head(), columns), state.theme.dim())];
        let (at, style) = (self.index_in(&shown), state.theme.selection(focused));
        told.extend(listed(&shown, at, lines.saturating_sub(1), style, |one| {
            Line::styled(shortened(&widths.row(one), columns), style_of(state.theme, one))
        }));
        if shown.is_empty() {
            let text = match (self.in_scope(state).is_empty(), state.filter().is_empty()) {
                (false, false) => "no comment matches the filter",
                (false, true) => "all comments are met: toile comment ls has them",
                (true, _) => "no comment yet: b begins a round, which comments what was measured",
            };
            told.extend(wrapped(text, columns).into_iter().map(Line::raw));
        }
        told
    }

    fn draw_selected(&self, frame: &mut Frame<'_>, area: Rect, state: &State) {
        let one = self.selected(state);
        let title = one
            .map_or("comment".to_owned(), |one| format!("comment {} · {} on {}", one.number, one.garment, one.subject));
        let block = pane(state.theme, title, false);
        let columns = usize::from(block.inner(area).width);
        let lines = one.map_or_else(Vec::new, |one| detail(state.theme, one, columns));
        frame.render_widget(Paragraph::new(lines).block(block), area);
    }
}

/// The panes: list, and the selected comment, whose height is 0 where it does not fit.
fn panes(area: Rect) -> [Rect; 2] {
    let below = if area.height < TALL { 0 } else { DETAIL.min(area.height / 2) };
    Layout::vertical([Constraint::Fill(1), Constraint::Length(below)]).areas(area)
}

struct Widths {
    fitting: usize,
    seen: usize,
    words: usize,
    owner: usize,
}

impl Widths {
    fn new(columns: usize, is_whole: bool) -> Self {
        let fitting = if is_whole { FITTING } else { 0 };
        let mut room = columns.saturating_sub(NUMBER + 1 + SEVERITY + STATUS + fitting);
        let mut taken = |columns: usize| {
            let is_fit = room >= columns + WORDS;
            room -= if is_fit { columns } else { 0 };
            if is_fit { columns } else { 0 }
        };
        let (seen, owner) = (taken(SEEN[usize::from(columns >= ROOMY)]), taken(OWNER));
        Self { fitting, seen, owner, words: room }
    }

    fn line(&self, [fitting, number, severity, seen, words, owner, status]: [&str; 7]) -> String {
        // Each column ends in a space.
        let cell = |text: &str, columns: usize| match columns {
            0 => String::new(),
            columns => left(text, columns - 1) + " ",
        };
        let end = cell(words, self.words) + &cell(owner, self.owner) + &left(status, STATUS);
        cell(fitting, self.fitting)
            + &right(number, NUMBER)
            + " "
            + &cell(severity, SEVERITY)
            + &cell(seen, self.seen)
            + &end
    }

    fn head(&self) -> String {
        self.line(["garment, on", "no", "severity", "seen", "comment", "owner", "status"])
    }

    fn row(&self, one: &Comment) -> String {
        let remark = &one.remark;
        let seen = format!("{}: {}", remark.side.as_str(), remark.place);
        let fitting = format!("{} {}", one.garment, one.subject);
        let number = one.number.to_string();
        self.line([&fitting, &number, remark.severity.as_str(), &seen, &remark.said, &one.owner, &status(one)])
    }
}

/// Style of a comment: that of its severity while it is open.
fn style_of(theme: Theme, one: &Comment) -> Style {
    match (one.status, one.remark.severity) {
        (Status::Met | Status::Closed, _) => theme.dim(),
        (Status::Open, Severity::Critical) => theme.bad(),
        (Status::Open, Severity::Major) => theme.warn(),
        (Status::Open, Severity::Minor) => Style::new(),
    }
}

fn detail(theme: Theme, one: &Comment, columns: usize) -> Vec<Line<'static>> {
    let remark = &one.remark;
    let owner = if one.owner.is_empty() { "nobody's yet".to_owned() } else { format!("for {}", one.owner) };
    let source = match (&remark.quantity, one.is_worded) {
        (None, _) => "a fitter's",
        (Some(_), true) => "measured, worded by a fitter",
        (Some(_), false) => "measured",
    };
    let facts = format!(
        "{}, {}; asked in round {} on size {}, {source}; {owner}",
        remark.severity.as_str(),
        status(one),
        one.round,
        one.size
    );
    let told = |label: &str, text: &str, style: Style| -> Vec<Line<'static>> {
        let text = if text.is_empty() { "not known" } else { text };
        let lines = wrapped(&format!("{label}{text}"), columns).into_iter();
        lines.map(|line| Line::styled(line, style)).collect()
    };
    let seen = format!("{}, {}: ", remark.side.as_str(), remark.place);
    [
        told(&seen, &remark.said, theme.bold()),
        told("", &facts, style_of(theme, one)),
        told("cause: ", &remark.cause, Style::new()),
        told("action: ", &remark.action, Style::new()),
    ]
    .concat()
}
