//! Drawing pictures.

use ratatui::Frame;
use ratatui::layout::{Alignment, Constraint, Layout, Rect, Size};
use ratatui::style::{Color, Style};
use ratatui::text::{Line, Span};
use ratatui::widgets::{Block, Paragraph, Wrap};
use ratatui_image::Image;

use crate::screens::state::State;
use crate::widgets::braille::braille;
use crate::widgets::lists::pane;
use crate::widgets::picture::{Drawn, PictureRequest, Pictured, look_name};
use crate::widgets::text;
use store::Status;

/// Areas of the picture and, where it fits, of the legend's line below. Pictures without a legend keep that line free,
/// so that their size does not change with the map.
pub fn parts(inner: Rect) -> (Rect, Option<Rect>) {
    if inner.height < 8 || inner.width < 24 {
        return (inner, None);
    }
    let [picture, legend] = Layout::vertical([Constraint::Fill(1), Constraint::Length(1)]).areas(inner);
    (picture, Some(legend))
}

/// Draws the pane. `keys` are the keys that change the picture.
pub fn draw_drape(frame: &mut Frame<'_>, area: Rect, state: &State, focused: bool, keys: &'static str) {
    let title = format!("{} · {}", look_name(state.pictures.look), state.pictures.map.as_str());
    let block = pane(state.theme, title, focused).title_bottom(Line::styled(keys, state.theme.legend()));
    let (inner, legend) = parts(block.inner(area));
    frame.render_widget(block, area);
    if state.job().is_some_and(|job| job.status == Status::Running) {
        draw_live(frame, inner, state);
        return;
    }
    if let Some(legend) = legend {
        draw_legend(frame, legend, state);
    }
    // The previous picture stays until the new one is drawn, so that turning does not flicker.
    draw_shot(frame, inner, state, state.focus.job.map(Pictured::Drape), "");
}

/// Draws the garment of the selected running job in its present shape, and the job's progress below.
pub fn draw_live(frame: &mut Frame<'_>, area: Rect, state: &State) {
    let Some(job) = state.job() else { return };
    let [picture, facts] = Layout::vertical([Constraint::Fill(1), Constraint::Length(area.height.min(2))]).areas(area);
    let progress = job.progress.as_ref().map_or_else(Vec::new, |progress| {
        let step = &progress.step;
        let share = format!("{} {:.0}%", progress.phase, 100.0 * progress.fraction);
        vec![Line::raw(share), Line::raw(format!("residual {:.1e}  E {:.4}", step.residual, step.e_chi))]
    });
    frame.render_widget(Paragraph::new(progress).alignment(Alignment::Center), facts);
    match state.running.live.as_ref().filter(|frame| frame.job == job.id) {
        Some(seen) => {
            let (columns, rows) = (usize::from(picture.width), usize::from(picture.height));
            let lines = braille(seen, state.pictures.look, columns, rows, state.theme.busy());
            frame.render_widget(Paragraph::new(lines), picture);
        }
        None => {
            let text = if state.running.watched == Some(job.id) {
                "the garment is being made ready…"
            } else {
                "another process simulates it: its drape is shown when it is done"
            };
            frame.render_widget(Paragraph::new(text).wrap(Wrap { trim: true }), picture);
        }
    }
}

/// Draws a picture, or the reason why there is none.
pub fn draw_shot(frame: &mut Frame<'_>, area: Rect, state: &State, of: Option<Pictured>, otherwise: &str) {
    let fits = |request: &PictureRequest| {
        Some(request.of) == of && request.columns == area.width && request.rows == area.height
    };
    let drawn = state.pictures.drawn.iter().find(|drawn| fits(&drawn.request)).map(|drawn| &drawn.outcome);
    let text = match drawn {
        Some(Ok(drawn)) => return draw_cells(frame, area, drawn, state),
        Some(Err(error)) => format!("no picture: {error}"),
        None if !state.setup.abilities.pictures => "pictures are off (--images off)".into(),
        None if state.pictures.requests.iter().any(|request| Some(request.of) == of) => "drawing…".into(),
        None => otherwise.to_owned(),
    };
    frame.render_widget(Paragraph::new(text).wrap(Wrap { trim: true }), area);
}

/// Draws the legend of the colours: name, least value, colours, greatest value with unit.
pub fn draw_legend(frame: &mut Frame<'_>, area: Rect, state: &State) {
    let Some(scale) = state.pictures.map.scale() else { return };
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

fn draw_cells(frame: &mut Frame<'_>, area: Rect, drawn: &Drawn, state: &State) {
    match drawn {
        Drawn::Pixels(protocol) => frame.render_widget(Image::new(protocol), centred(area, protocol.size())),
        Drawn::Blocks(blocks) => {
            let place = centred(area, blocks.size);
            blocks.render(place, frame.buffer_mut());
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

pub fn cells(pane: Rect) -> Size {
    parts(Block::bordered().inner(pane)).0.as_size()
}
