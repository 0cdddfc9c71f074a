//! The pane with the picture of a drape.

use ratatui::Frame;
use ratatui::layout::{Alignment, Constraint, Layout, Position, Rect, Size};
use ratatui::style::{Color, Style};
use ratatui::text::{Line, Span};
use ratatui::widgets::{Block, Paragraph, Wrap};
use ratatui_image::Image;

use super::super::action::Screen;
use super::super::picture::{Drawn, Sitter};
use super::super::state::State;
use super::super::text;
use super::{pane, results, rows, study, subjects};
use crate::study::Status;

/// Room for the picture on the screen shown, in cells; `None` where no picture is shown.
#[must_use]
pub fn picture_size(state: &State) -> Option<Size> {
    if !state.abilities.pictures {
        return None;
    }
    let [_, body, _] = rows(Rect::from((Position::ORIGIN, state.size)));
    let pane = match state.screen {
        Screen::Study => study::picture_pane(body, state),
        Screen::Results => results::picture_pane(body, state),
        Screen::Subjects => subjects::picture_pane(body),
        Screen::Styles | Screen::Jobs => None,
    };
    let (picture, _) = parts(Block::bordered().inner(pane?));
    (picture.width >= 4 && picture.height >= 3).then(|| picture.as_size())
}

/// Picture and, where there is room, the line below it that says what its colours mean. The line is there for pictures
/// without a legend too, so that they keep their size when the colours change.
pub(super) fn parts(inner: Rect) -> (Rect, Option<Rect>) {
    if inner.height < 8 || inner.width < 24 {
        return (inner, None);
    }
    let [picture, legend] = Layout::vertical([Constraint::Fill(1), Constraint::Length(1)]).areas(inner);
    (picture, Some(legend))
}

/// Draws the pane; `keys` are those that change the picture there.
pub(super) fn draw(frame: &mut Frame<'_>, area: Rect, state: &State, focused: bool, keys: &'static str) {
    let title = format!("{} · {}", state.view.as_str(), state.map.as_str());
    let block = pane(state.theme, title, focused).title_bottom(Line::styled(keys, state.theme.legend()));
    let (inner, legend) = parts(block.inner(area));
    frame.render_widget(block, area);
    if let Some(legend) = legend {
        draw_legend(frame, legend, state);
    }
    // While a picture is drawn anew, the one before stays, so that turning does not flicker.
    let otherwise = match state.job().map(|job| job.status) {
        Some(Status::Running) => "the drape is shown when the job is done",
        _ => "",
    };
    draw_shot(frame, inner, state, state.focus.job.map(Sitter::Drape), otherwise);
}

/// Draws the picture of a sitter, or why there is none.
pub(super) fn draw_shot(frame: &mut Frame<'_>, area: Rect, state: &State, of: Option<Sitter>, otherwise: &str) {
    let drawn = state
        .picture
        .as_ref()
        .filter(|(shot, _)| Some(shot.of) == of && shot.columns == area.width && shot.rows == area.height);
    let text = match drawn {
        Some((_, Ok(drawn))) => return draw_cells(frame, area, drawn, state),
        Some((_, Err(error))) => format!("no picture: {error}"),
        None if !state.abilities.pictures => "pictures are off (--images off)".into(),
        None if state.shot.is_some() => "drawing…".into(),
        None => otherwise.to_owned(),
    };
    frame.render_widget(Paragraph::new(text).wrap(Wrap { trim: true }), area);
}

/// What the colours mean: name, least value, the run of colours, greatest value with its unit.
fn draw_legend(frame: &mut Frame<'_>, area: Rect, state: &State) {
    let Some(scale) = state.map.scale() else { return };
    let before = format!("{} {} ", scale.label, text::whole(scale.low));
    let after = format!(" {} {}", text::whole(scale.high), scale.unit);
    let room = usize::from(area.width).saturating_sub(text::width(&before) + text::width(&after));
    let cells = if state.theme.has_colours() { room.min(48) } else { 0 };
    let cell = |k: usize| {
        let colour = scale.map.at((k as f64 + 0.5) / cells as f64);
        Span::styled("█", Style::new().fg(Color::Rgb(colour.0, colour.1, colour.2)))
    };
    let mut line = vec![Span::raw(before)];
    line.extend(if cells == 0 { vec![Span::raw("to")] } else { (0..cells).map(cell).collect() });
    line.push(Span::raw(after));
    frame.render_widget(Paragraph::new(Line::from(line)).alignment(Alignment::Center), area);
    state.theme.adapt(frame.buffer_mut(), area);
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
