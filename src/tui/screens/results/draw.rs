//! Drawing a result.

use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::text::Line;
use ratatui::widgets::{Paragraph, Wrap};

use crate::overlays::explanation::Selected;
use crate::screens::measurements::{self, draw as measured};
use crate::screens::page::Draw;
use crate::screens::picture_pane::actions::{drape_in, requests};
use crate::screens::picture_pane::draw::draw_drape;
use crate::screens::results::ResultsScreen;
use crate::screens::state::State;
use crate::widgets::jump::{self, Target};
use crate::widgets::layout::{WIDE, is_narrow};
use crate::widgets::lists::pane;
use crate::widgets::picture::PictureRequest;
use crate::widgets::text;
use crate::widgets::theme::glyph;

impl Draw for ResultsScreen {
    fn draw(&self, frame: &mut Frame<'_>, area: Rect, state: &State) {
        let panes = panes(area, state);
        if let Some(area) = panes.table {
            draw_table(frame, area, state);
        }
        if let Some(area) = panes.numbers {
            let block = pane(state.theme, "numbers", false);
            let columns = usize::from(block.inner(area).width);
            let mut lines = measured::numbers(state, columns);
            lines.extend(measured::provenance(state).iter().map(|(name, value)| measured::fact(name, value, columns)));
            frame.render_widget(Paragraph::new(lines).block(block), area);
        }
        if let Some(area) = panes.picture {
            let focused = state.in_second_pane() || state.pictures.enlarged;
            let keys = if area.width > 44 {
                " v h l turn  + - zoom  m colours  ↵ size "
            } else {
                " v turn  m colours  ↵ size "
            };
            draw_drape(frame, area, state, focused, keys);
        }
    }

    fn targets(&self, state: &State, area: Rect) -> Vec<Target> {
        let panes = panes(area, state);
        let rows = panes.table.map_or(vec![], |table| {
            jump::rows(0, jump::inside(table), 1, measurements::rows(state).len(), state.measurements.row)
        });
        rows.into_iter().chain(panes.picture.map(|picture| jump::pane(picture, 1))).collect()
    }

    fn explained(&self, state: &State) -> Selected {
        measured::explained(state)
    }

    fn pictures(&self, state: &State, area: Rect) -> Vec<PictureRequest> {
        requests(state, drape_in(state, picture_pane(area, state)))
    }
}

/// Panes; `None` where one does not fit.
struct Panes {
    table: Option<Rect>,
    numbers: Option<Rect>,
    picture: Option<Rect>,
}

fn panes(area: Rect, state: &State) -> Panes {
    if is_narrow(area) {
        let shows_picture = state.pictures.enlarged || state.in_second_pane();
        let (table, picture) = if shows_picture { (None, Some(area)) } else { (Some(area), None) };
        return Panes { table, numbers: None, picture };
    }
    if state.pictures.enlarged {
        return Panes { table: None, numbers: None, picture: Some(area) };
    }
    let table_width = if area.width >= WIDE { area.width * 9 / 20 } else { area.width * 5 / 8 };
    let [left, picture] = Layout::horizontal([Constraint::Length(table_width), Constraint::Fill(1)]).areas(area);
    let numbers_height = if area.height >= 30 { 12 } else { 9 };
    let [table, numbers] = Layout::vertical([Constraint::Fill(1), Constraint::Length(numbers_height)]).areas(left);
    Panes { table: Some(table), numbers: Some(numbers), picture: Some(picture) }
}

/// Returns `None` where the picture does not fit.
pub fn picture_pane(area: Rect, state: &State) -> Option<Rect> {
    panes(area, state).picture
}

fn draw_table(frame: &mut Frame<'_>, area: Rect, state: &State) {
    let focused = !state.in_second_pane();
    let title = match state.job() {
        Some(job) => {
            let simulator = text::sim(job.simulator);
            let stage = state
                .detail()
                .and_then(|detail| state.measurements.stage(detail))
                .map_or(String::new(), |stage| format!(" · {stage}"));
            let mark = state.mark_of(Some(job.id));
            format!("{} {} · {} · {simulator}{stage}{mark}", job.garment, job.size, job.subject)
        }
        None => "no result".into(),
    };
    let block = pane(state.theme, title, focused)
        .title_bottom(Line::styled(measured::LEGEND, state.theme.legend()).right_aligned());
    let inner = block.inner(area);
    if measurements::rows(state).is_empty() {
        let paragraph = Paragraph::new(why_empty(state)).wrap(Wrap { trim: true }).block(block);
        frame.render_widget(paragraph, area);
        return;
    }
    let lines = measured::table(state, usize::from(inner.width), usize::from(inner.height), Some(focused));
    frame.render_widget(Paragraph::new(lines).block(block), area);
}

fn why_empty(state: &State) -> String {
    match state.job() {
        None => "Choose a job on screen 1 or 4 and press Enter.".into(),
        Some(_) if !state.filter().is_empty() => "No measurement matches the filter.".into(),
        Some(job) => {
            format!("{} Job {} has no result yet: it is {}.", glyph(job.status), job.id, text::status(job.status))
        }
    }
}
