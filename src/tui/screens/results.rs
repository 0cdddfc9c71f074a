//! Screen 5: one result: its measurements, its numbers, and the picture of its drape.

use ratatui::Frame;
use ratatui::layout::{Alignment, Constraint, Layout, Rect, Size};
use ratatui::text::Line;
use ratatui::widgets::{Paragraph, Wrap};
use ratatui_image::Image;

use super::super::action::Screen;
use super::super::picture::Drawn;
use super::super::state::State;
use super::super::text;
use super::super::theme::glyph;
use super::{WIDE, chi, is_narrow, pane, rows};
use crate::study::Status;

/// The panes: measurements, numbers, picture; those without room are `None`.
struct Panes {
    table: Option<Rect>,
    numbers: Option<Rect>,
    picture: Option<Rect>,
}

fn panes(area: Rect, state: &State) -> Panes {
    if is_narrow(area) {
        let shows_picture = state.enlarged || state.in_second_pane();
        let (table, picture) = if shows_picture { (None, Some(area)) } else { (Some(area), None) };
        return Panes { table, numbers: None, picture };
    }
    if state.enlarged {
        return Panes { table: None, numbers: None, picture: Some(area) };
    }
    let table_width = if area.width >= WIDE { area.width * 9 / 20 } else { area.width * 5 / 8 };
    let [left, picture] = Layout::horizontal([Constraint::Length(table_width), Constraint::Fill(1)]).areas(area);
    let numbers_height = if area.height >= 30 { 12 } else { 9 };
    let [table, numbers] = Layout::vertical([Constraint::Fill(1), Constraint::Length(numbers_height)]).areas(left);
    Panes { table: Some(table), numbers: Some(numbers), picture: Some(picture) }
}

/// Room for the picture on the screen shown, in cells; `None` where no picture is shown.
#[must_use]
pub fn picture_size(state: &State) -> Option<Size> {
    if state.screen != Screen::Results || !state.abilities.pictures {
        return None;
    }
    let [_, body, _] = rows(Rect::from((ratatui::layout::Position::ORIGIN, state.size)));
    let inner = ratatui::widgets::Block::bordered().inner(panes(body, state).picture?);
    (inner.width >= 4 && inner.height >= 3).then(|| inner.as_size())
}

pub(super) fn draw(frame: &mut Frame<'_>, area: Rect, state: &State) {
    let panes = panes(area, state);
    if let Some(area) = panes.table {
        draw_table(frame, area, state);
    }
    if let Some(area) = panes.numbers {
        let block = pane(state.theme, "numbers", false);
        let columns = usize::from(block.inner(area).width);
        let mut lines = chi::numbers(state, columns);
        lines.extend(chi::provenance(state).iter().map(|(name, value)| chi::fact(name, value, columns)));
        frame.render_widget(Paragraph::new(lines).block(block), area);
    }
    if let Some(area) = panes.picture {
        draw_picture(frame, area, state);
    }
}

fn draw_table(frame: &mut Frame<'_>, area: Rect, state: &State) {
    let focused = !state.in_second_pane();
    let title = match state.job() {
        Some(job) => {
            let simulator = text::sim(job.simulator);
            let stage = state.stage().map_or(String::new(), |stage| format!(" · {stage}"));
            format!("{} {} · {} · {simulator}{stage}", job.garment, job.size, job.subject)
        }
        None => "no result".into(),
    };
    let block =
        pane(state.theme, title, focused).title_bottom(Line::styled(chi::LEGEND, state.theme.legend()).right_aligned());
    let inner = block.inner(area);
    if state.chi().is_empty() {
        let paragraph = Paragraph::new(why_empty(state)).wrap(Wrap { trim: true }).block(block);
        frame.render_widget(paragraph, area);
        return;
    }
    let lines = chi::table(state, usize::from(inner.width), usize::from(inner.height), Some(focused));
    frame.render_widget(Paragraph::new(lines).block(block), area);
}

/// Why there is no table.
fn why_empty(state: &State) -> String {
    match state.job() {
        None => "Choose a job on screen 1 or 4 and press Enter.".into(),
        Some(_) if !state.filter().is_empty() => "No measurement matches the filter.".into(),
        Some(job) => {
            format!("{} Job {} has no result yet: it is {}.", glyph(job.status), job.id, text::status(job.status))
        }
    }
}

fn draw_picture(frame: &mut Frame<'_>, area: Rect, state: &State) {
    let focused = state.in_second_pane() || state.enlarged;
    let title = format!("{} · {}", state.view.as_str(), state.map.as_str());
    let hint = if area.width > 44 { " v or h l turn  m colours  Enter size " } else { " v turn  m colours  ↵ size " };
    let block = pane(state.theme, title, focused).title_bottom(Line::styled(hint, state.theme.legend()));
    let inner = block.inner(area);
    frame.render_widget(block, area);
    // While a picture is drawn anew, the one before stays, so that turning does not flicker.
    let drawn = state.picture.as_ref().filter(|(shot, _)| {
        Some(shot.job) == state.focus.job && shot.columns == inner.width && shot.rows == inner.height
    });
    let text = match drawn {
        Some((_, Ok(drawn))) => return draw_cells(frame, inner, drawn, state),
        Some((_, Err(error))) => format!("no picture: {error}"),
        None if !state.abilities.pictures => "pictures are off (--images off)".into(),
        None if state.shot.is_some() => "drawing…".into(),
        None => match state.job().map(|job| job.status) {
            Some(Status::Running) => "the drape is shown when the job is done".into(),
            _ => String::new(),
        },
    };
    frame.render_widget(Paragraph::new(text).wrap(Wrap { trim: true }), inner);
}

/// The picture in the middle of its pane.
fn draw_cells(frame: &mut Frame<'_>, area: Rect, drawn: &Drawn, state: &State) {
    match drawn {
        Drawn::Cells(protocol) => {
            let size = protocol.size();
            let place = centred(area, size);
            frame.render_widget(Image::new(protocol), place);
            state.theme.adapt(frame.buffer_mut(), place);
        }
        Drawn::Letters(rows) => {
            let place = centred(area, Size::new(area.width, rows.len() as u16));
            let lines: Vec<Line<'_>> = rows.iter().map(|row| Line::raw(row.as_str())).collect();
            frame.render_widget(Paragraph::new(lines).alignment(Alignment::Center), place);
        }
    }
}

fn centred(area: Rect, size: Size) -> Rect {
    let x = area.x + area.width.saturating_sub(size.width) / 2;
    let y = area.y + area.height.saturating_sub(size.height) / 2;
    Rect::new(x, y, size.width, size.height).intersection(area)
}
