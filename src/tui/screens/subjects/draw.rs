//! Drawing the subjects.

use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect, Size};
use ratatui::text::{Line, Span};
use ratatui::widgets::{Block, Paragraph};

use crate::overlays::explanation::Selected;
use crate::screens::page::Draw;
use crate::screens::picture_pane::actions::requests;
use crate::screens::picture_pane::draw::{draw_shot, parts};
use crate::screens::state::State;
use crate::screens::subjects::actions::number;
use crate::screens::subjects::state::{SHOWN, SubjectOrder, SubjectsScreen};
use crate::widgets::jump::{self, Target};
use crate::widgets::layout::{WIDE, is_narrow};
use crate::widgets::lists::{listed, no_rows, pane, scrolled};
use crate::widgets::picture::{PictureRequest, Pictured};
use crate::widgets::text::{self, left, place_bar, right, shortened, wrapped};
use results::Figure;
use spec::MEASUREMENTS;
use wardrobe::{SubjectRow, is_doubtful, percentile, percentile_text};

/// Columns of the first measurements in the list: heading and width.
const HEADINGS: [(&str, usize); SHOWN] = [("stature", 8), ("kg", 6), ("chest", 6), ("waist", 6), ("hip", 6)];

/// Columns for the sex with its gaps, and fewest for a name.
const SEX: usize = 3;

const LEAST_NAME: usize = 10;

/// The panes: list, table of the selected subject, picture.
fn panes(area: Rect) -> [Rect; 3] {
    let picture = if area.width >= WIDE { area.width / 2 } else { area.width * 3 / 8 };
    let [left, picture] = Layout::horizontal([Constraint::Fill(1), Constraint::Length(picture)]).areas(area);
    let lines = (3 + MEASUREMENTS.len()) as u16;
    let table = lines.min(left.height.saturating_sub(8));
    let [list, table] = Layout::vertical([Constraint::Fill(1), Constraint::Length(table)]).areas(left);
    [list, table, picture]
}

/// Returns `None` where the picture does not fit.
pub fn picture_pane(area: Rect) -> Option<Rect> {
    (!is_narrow(area)).then(|| panes(area)[2])
}

pub fn table_rows(area: Rect) -> usize {
    usize::from(panes(area)[1].height).saturating_sub(3)
}

impl Draw for SubjectsScreen {
    fn draw(&self, frame: &mut Frame<'_>, area: Rect, state: &State) {
        if is_narrow(area) {
            frame.render_widget(Paragraph::new(self.list(state, area.width, area.height, true)), area);
            return;
        }
        let [list_area, table_area, picture_area] = panes(area);
        let (shown, all) = (self.shown(state).len(), state.data.as_ref().map_or(0, |data| data.subjects.len()));
        let title = if shown == all { format!("{all} subjects") } else { format!("{shown} of {all} subjects") };
        let focused = !state.in_second_pane();
        let block =
            pane(state.theme, title, focused).title_bottom(Line::styled("mm", state.theme.legend()).right_aligned());
        let inner = block.inner(list_area);
        frame.render_widget(
            Paragraph::new(self.list(state, inner.width, inner.height, focused)).block(block),
            list_area,
        );
        let Some(subject) = self.selected(state) else {
            frame.render_widget(Block::bordered().border_style(state.theme.dim()), table_area);
            frame.render_widget(Block::bordered().border_style(state.theme.dim()), picture_area);
            return;
        };
        self.draw_table(frame, table_area, state, subject);
        draw_picture(frame, picture_area, state, subject);
    }

    fn targets(&self, state: &State, area: Rect) -> Vec<Target> {
        let subjects = self.shown(state);
        let at = self.index_in(&subjects);
        if is_narrow(area) {
            return jump::rows(0, area, 1, subjects.len(), at);
        }
        let [list, table, _] = panes(area);
        let mut targets = jump::rows(0, jump::inside(list), 1, subjects.len(), at);
        targets.push(jump::pane(table, 1));
        targets
    }

    fn explained(&self, state: &State) -> Selected {
        let Some(subject) = self.selected(state) else { return Selected::default() };
        let sorted = match self.order.by {
            SubjectOrder::Name => "subject",
            SubjectOrder::Sex => "sex",
            SubjectOrder::Measurement(k) => MEASUREMENTS[k].label,
        };
        let known = MEASUREMENTS.iter().filter(|field| field.get(&subject.measurements).is_some()).count();
        let what = format!("{}: {}, {known} measurements known", subject.name, text::sex(subject));
        let names: Vec<&str> =
            ["asked", "measured", "centile"].into_iter().chain(MEASUREMENTS.iter().map(|field| field.label)).collect();
        Selected::new(what, &[sorted], &names)
    }

    fn pictures(&self, state: &State, area: Rect) -> Vec<PictureRequest> {
        let Some(body) = self.selected(state).map(|row| Pictured::Body(row.id)) else { return vec![] };
        let wanted = requests(state, picture_pane(area).map(|pane| (body, pane)).into_iter().collect());
        // The body is measured even if its picture does not fit.
        if wanted.is_empty() { vec![state.pictures.request(body, Size::ZERO)] } else { wanted }
    }
}

impl SubjectsScreen {
    /// List with its header; the name takes what the numbers leave.
    fn list(&self, state: &State, width: u16, height: u16, focused: bool) -> Vec<Line<'static>> {
        let subjects = self.shown(state);
        let width = usize::from(width);
        let (name, shown) = columns(width);
        let at = self.index_in(&subjects);
        let mut lines = vec![self.header(state, name, shown)];
        let room = usize::from(height).saturating_sub(1);
        lines.extend(listed(&subjects, at, room, state.theme.selection(focused), |row| {
            Line::raw(shortened(&list_line(row, self.marks.has(&row.name), name, shown), width))
        }));
        if subjects.is_empty() {
            lines.push(no_rows(state.filter(), "no subject matches the filter", "no subjects yet: a adds one"));
        }
        lines
    }

    fn header(&self, state: &State, name: usize, shown: usize) -> Line<'static> {
        let order = self.order;
        let mut text = left(&order.titled("subject", SubjectOrder::Name), name);
        text += &format!(" {}", left(&order.titled("s", SubjectOrder::Sex), 2));
        for (k, (title, columns)) in HEADINGS.iter().take(shown).enumerate() {
            text += &right(&order.titled(title, SubjectOrder::Measurement(k)), *columns);
        }
        Line::styled(text, state.theme.dim())
    }

    fn draw_table(&self, frame: &mut Frame<'_>, area: Rect, state: &State, subject: &SubjectRow) {
        let scan = subject.scan.as_ref().map_or(String::new(), |file| format!(" · scan {file}"));
        let title = format!("{} · {} · revision {}{scan}", subject.name, text::sex(subject), subject.revision);
        let block = pane(state.theme, title, state.in_second_pane());
        let inner = block.inner(area);
        let lines = self.table(state, subject, usize::from(inner.width));
        let lines = scrolled(lines, state.nav.table_down, inner);
        frame.render_widget(Paragraph::new(lines).block(block), area);
    }

    /// Given and measured values, with percentiles for the sex; then other measurements of the body.
    fn table(&self, state: &State, subject: &SubjectRow, columns: usize) -> Vec<Line<'static>> {
        let measured = self.measured.get(&subject.id);
        let girths = measured.and_then(|measured| measured.as_ref().ok());
        let wait = if measured.is_none() { "…" } else { "—" };
        let bar = columns.saturating_sub(17 + 9 + 10 + 8).min(20);
        let head = format!("{}{}{}  {}", left("mm, kg", 17), right("asked", 9), right("measured", 10), "centile");
        let mut lines = vec![Line::styled(shortened(&head, columns), state.theme.dim())];
        if let Some(Err(error)) = measured {
            let wrapped = wrapped(error, columns);
            lines.extend(wrapped.into_iter().map(|line| Line::styled(line, state.theme.bad())));
        }
        for field in MEASUREMENTS.iter() {
            let asked = field.get(&subject.measurements);
            let read = girths.and_then(|girths| Figure::reading(girths, field.key));
            let stands = asked.or(read).and_then(|value| percentile(subject.measurements.sex, field.key, value));
            let read = read.map_or(wait.to_owned(), |value| format!("{value:.1}"));
            let asked = asked.map_or("—".to_owned(), |value| format!("{}", (value * 10.0).round() / 10.0));
            let text = format!("{}{}{}  ", left(field.label, 17), right(&asked, 9), right(&read, 10));
            let rare = stands.is_some_and(is_doubtful);
            let words = stands.map_or(String::new(), |percent| {
                format!("{}{}", left(&percentile_text(percent), 4), if rare { "!" } else { " " })
            });
            let words = format!("{words} {}", stands.map_or(String::new(), |percent| place_bar(percent, bar)));
            let style = if rare { state.theme.warn() } else { state.theme.dim() };
            lines.push(Line::from(vec![Span::raw(text), Span::styled(words, style)]));
        }
        lines
    }
}

/// Columns for the name, and number of measurements that fit beside it.
pub fn columns(width: usize) -> (usize, usize) {
    let numbers = |shown: usize| HEADINGS.iter().take(shown).map(|(_, columns)| columns).sum::<usize>();
    let fits = |shown: &usize| LEAST_NAME + SEX + numbers(*shown) <= width;
    let shown = (0..=SHOWN).rev().find(fits).unwrap_or(0);
    (width.saturating_sub(SEX + numbers(shown)).clamp(LEAST_NAME, 24), shown)
}

fn list_line(row: &SubjectRow, is_marked: bool, name: usize, shown: usize) -> String {
    let mark = if is_marked { "•" } else { " " };
    let mut text = format!("{}{mark}{} ", left(&row.name, name), &text::sex(row)[..1]);
    for (field, (_, columns)) in MEASUREMENTS.iter().zip(HEADINGS).take(shown) {
        text += &right(&number(field.get(&row.measurements), field.key), columns);
    }
    text
}

fn draw_picture(frame: &mut Frame<'_>, area: Rect, state: &State, subject: &SubjectRow) {
    let block = pane(state.theme, format!("{} · front and side", subject.name), false);
    let (inner, _) = parts(block.inner(area));
    frame.render_widget(block, area);
    draw_shot(frame, inner, state, Some(Pictured::Body(subject.id)), "");
}
