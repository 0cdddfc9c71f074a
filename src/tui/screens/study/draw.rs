//! Drawing the grid and the numbers of the selected cell.

use std::ops::Range;

use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Position, Rect, Size};
use ratatui::style::{Modifier, Style};
use ratatui::text::{Line, Span};
use ratatui::widgets::Paragraph;

use crate::messages::snapshot::Place;
use crate::overlays::explanation::Selected;
use crate::screens::measurements::{self, draw as measured};
use crate::screens::page::Draw;
use crate::screens::picture_pane::actions::{drape_in, requests};
use crate::screens::picture_pane::draw::draw_drape;
use crate::screens::state::State;
use crate::screens::study::StudyScreen;
use crate::screens::study::actions::{self, cell_text, ease_text, is_match, places};
use crate::widgets::jump::{self, Goal, Target};
use crate::widgets::layout::{WIDE, is_narrow};
use crate::widgets::lists::{first_shown, pane};
use crate::widgets::picture::PictureRequest;
use crate::widgets::text::{self, left, wrapped};
use store::Grid;

/// Least lines for a picture below the grid.
const LEAST_PICTURE: u16 = 14;
const FIT_LEGEND: &str = "T tight  J just  L loose  ~ borderline  ! undersized";

impl Draw for StudyScreen {
    fn draw(&self, frame: &mut Frame<'_>, area: Rect, state: &State) {
        let Some(grid) = state.grid() else {
            let text = " this study has no sizes or subjects yet: R runs it, which queues its jobs";
            frame.render_widget(Paragraph::new(text), area);
            return;
        };
        if is_narrow(area) {
            draw_list(frame, area, state, grid);
            return;
        }
        let panes = Panes::new(area, grid);
        draw_grid(frame, panes.grid, state, grid);
        draw_detail(frame, panes.detail, state, grid);
        if let Some(area) = panes.picture {
            draw_drape(frame, area, state, false, "");
        }
    }

    fn targets(&self, state: &State, area: Rect) -> Vec<Target> {
        let Some(grid) = state.grid() else { return vec![] };
        let places = places(state);
        let cell = |place: &Place| places.iter().position(|other| other == place).unwrap_or(0);
        if is_narrow(area) {
            let selected = cell(&state.place);
            let first = first_shown(selected, places.len(), usize::from(area.height));
            let rows = jump::rows(0, area, 0, places.len(), selected).into_iter().enumerate();
            return rows.map(|(k, row)| Target { goal: Goal::Item(first + k), ..row }).collect();
        }
        let panes = Panes::new(area, grid);
        let inner = jump::inside(panes.grid);
        let Shown { subjects, lines } = Shown::of(inner, state, grid);
        let of_size = grid.simulators.len() + 1;
        let cells = lines.clone().filter(|line| line % of_size + 1 < of_size).flat_map(|line| {
            let y = inner.y + 1 + (line - lines.start) as u16;
            subjects.clone().map(move |subject| (line, subject, y))
        });
        let target = |(line, subject, y): (usize, usize, u16)| {
            let x = inner.x + (label_width(grid) + (subject - subjects.start) * cell_width(grid)) as u16;
            let place = Place { size: line / of_size, simulator: line % of_size, subject };
            Target {
                at: Position::new(x, y),
                size: Size::new(cell_width(grid) as u16, 1),
                goal: Goal::Item(cell(&place)),
            }
        };
        let other = if state.in_second_pane() { jump::pane(panes.grid, 0) } else { jump::pane(panes.detail, 1) };
        cells.map(target).chain([other]).collect()
    }

    fn explained(&self, state: &State) -> Selected {
        if state.in_second_pane() { measured::explained(state) } else { actions::explained(state) }
    }

    fn pictures(&self, state: &State, area: Rect) -> Vec<PictureRequest> {
        requests(state, drape_in(state, picture_pane(area, state)))
    }
}

/// The panes. The picture is there only if the grid leaves room.
struct Panes {
    grid: Rect,
    detail: Rect,
    picture: Option<Rect>,
}

impl Panes {
    fn new(area: Rect, grid: &Grid) -> Self {
        let height = (3 + grid.sizes.len() * (grid.simulators.len() + 1)) as u16;
        if area.width < WIDE {
            let height = height.min((area.height * 3 / 5).max(8));
            let [grid, detail] = Layout::vertical([Constraint::Length(height), Constraint::Fill(1)]).areas(area);
            return Self { grid, detail, picture: None };
        }
        let width = (label_width(grid) + grid.subjects.len() * cell_width(grid) + 3) as u16;
        let [left, detail] =
            Layout::horizontal([Constraint::Length(width.clamp(60, area.width - 60)), Constraint::Fill(1)]).areas(area);
        if left.height < height + LEAST_PICTURE {
            return Self { grid: left, detail, picture: None };
        }
        let [grid, picture] = Layout::vertical([Constraint::Length(height), Constraint::Fill(1)]).areas(left);
        Self { grid, detail, picture: Some(picture) }
    }
}

/// Returns `None` where the picture does not fit.
pub fn picture_pane(area: Rect, state: &State) -> Option<Rect> {
    state.grid().filter(|_| !is_narrow(area)).and_then(|grid| Panes::new(area, grid).picture)
}

fn draw_grid(frame: &mut Frame<'_>, area: Rect, state: &State, grid: &Grid) {
    let block = pane(state.theme, title(state, grid), !state.in_second_pane())
        .title_bottom(Line::styled(FIT_LEGEND, state.theme.legend()).right_aligned());
    let Shown { subjects, lines } = Shown::of(block.inner(area), state, grid);
    let of_size = grid.simulators.len() + 1;
    let mut told = vec![header(state, grid, subjects.clone())];
    told.extend(lines.map(|line| match (line / of_size, line % of_size) {
        (size, simulator) if simulator + 1 < of_size => row(state, grid, subjects.clone(), size, simulator),
        (size, _) => fit_row(state, grid, subjects.clone(), size),
    }));
    frame.render_widget(Paragraph::new(told).block(block), area);
}

/// Part of the grid that fits. Each size has a line for each simulator and one for the ease.
struct Shown {
    subjects: Range<usize>,
    lines: Range<usize>,
}

impl Shown {
    fn of(inner: Rect, state: &State, grid: &Grid) -> Self {
        let place = state.place;
        let shown = (usize::from(inner.width).saturating_sub(label_width(grid)) / cell_width(grid)).max(1);
        let first = first_shown(place.subject, grid.subjects.len(), shown);
        let of_size = grid.simulators.len() + 1;
        let all = grid.sizes.len() * of_size;
        let height = usize::from(inner.height).saturating_sub(1);
        let from = first_shown(place.size * of_size + place.simulator, all, height);
        Self { subjects: first..(first + shown).min(grid.subjects.len()), lines: from..(from + height).min(all) }
    }
}

fn title(state: &State, grid: &Grid) -> String {
    let garments = state.study().map_or(&[][..], |study| &study.garments);
    let at = garments.iter().position(|name| *name == grid.garment).unwrap_or(0);
    match garments.len() {
        0 | 1 => format!("{} · {}", grid.study, grid.garment),
        n => format!("{} · {} · garment {} of {n}, ] next", grid.study, grid.garment, at + 1),
    }
}

fn size_width(grid: &Grid) -> usize {
    grid.sizes.iter().map(|size| text::width(size)).max().unwrap_or(0).clamp(4, 12)
}

/// Columns for size and simulator.
fn label_width(grid: &Grid) -> usize {
    size_width(grid) + 5
}

fn cell_width(grid: &Grid) -> usize {
    grid.subjects.iter().map(|subject| text::width(subject) + 2).max().unwrap_or(0).clamp(10, 16)
}

fn header(state: &State, grid: &Grid, subjects: Range<usize>) -> Line<'static> {
    let more = if subjects.start > 0 { "◂" } else { " " };
    let mut spans = vec![Span::styled(left("EI", label_width(grid) - 1) + more, state.theme.dim())];
    let last = subjects.end;
    for subject in subjects {
        let style = if subject == state.place.subject { state.theme.bold() } else { state.theme.dim() };
        spans.push(Span::styled(left(&grid.subjects[subject], cell_width(grid)), style));
    }
    if last < grid.subjects.len() {
        spans.push(Span::styled("▸", state.theme.dim()));
    }
    Line::from(spans)
}

fn row(state: &State, grid: &Grid, subjects: Range<usize>, size: usize, simulator: usize) -> Line<'static> {
    let name = if simulator == 0 { grid.sizes[size].as_str() } else { "" };
    let is_selected = (size, simulator) == (state.place.size, state.place.simulator);
    let label = format!("{} {} ", left(name, size_width(grid)), text::sim(grid.simulators[simulator]));
    let mut spans = vec![Span::styled(label, if is_selected { state.theme.bold() } else { Style::new() })];
    for subject in subjects {
        let place = Place { size, simulator, subject };
        let cell = &grid.cells[size][subject][simulator];
        let mut style = cell.status.map_or(state.theme.dim(), |status| state.theme.result(status, cell.is_inside));
        if !is_match(state, place) {
            style = style.add_modifier(Modifier::DIM);
        }
        if place == state.place {
            style = style.patch(state.theme.selection(!state.in_second_pane()));
        }
        let width = cell_width(grid);
        let text = format!("{}{}", cell_text(cell), state.mark_of(cell.job));
        spans.push(Span::styled(left(&text, width - 1), style));
        spans.push(Span::raw(" "));
    }
    Line::from(spans)
}

fn fit_row(state: &State, grid: &Grid, subjects: Range<usize>, size: usize) -> Line<'static> {
    let mut line = left("ease mm", label_width(grid));
    for subject in subjects {
        let fit = grid.fits[size][subject];
        let text = fit.map_or("—".to_owned(), |fit| ease_text(&fit));
        line += &left(&text, cell_width(grid));
    }
    Line::styled(line, state.theme.dim())
}

fn draw_detail(frame: &mut Frame<'_>, area: Rect, state: &State, grid: &Grid) {
    let place = state.place;
    let job = state.focus.job.map_or(String::new(), |id| format!(" · job {id}"));
    let simulator = grid.simulators.get(place.simulator).map_or("", |sim| text::sim(*sim));
    let title = format!("{} · {} · {simulator}{job}", grid.sizes[place.size], grid.subjects[place.subject]);
    let block = pane(state.theme, title, state.in_second_pane())
        .title_bottom(Line::styled(measured::LEGEND, state.theme.legend()).right_aligned());
    let inner = block.inner(area);
    frame.render_widget(block, area);
    let facts = measured::provenance(state).iter().map(|(name, value)| format!("{name}: {value}")).collect::<Vec<_>>();
    let mut origin = wrapped(&facts.join(" · "), usize::from(inner.width));
    origin.truncate(if inner.height >= 10 { 2 } else { 1 });
    let [inner, origin_area] =
        Layout::vertical([Constraint::Fill(1), Constraint::Length(origin.len() as u16)]).areas(inner);
    let origin: Vec<Line<'_>> = origin.into_iter().map(|line| Line::styled(line, state.theme.dim())).collect();
    frame.render_widget(Paragraph::new(origin), origin_area);
    let is_tall = inner.height >= 24;
    let layout = if is_tall {
        Layout::vertical([Constraint::Length(7), Constraint::Fill(1)]).spacing(1)
    } else {
        Layout::horizontal([Constraint::Length(if inner.width < 100 { 28 } else { 44 }), Constraint::Fill(1)])
            .spacing(1)
    };
    let [numbers_area, table_area] = layout.areas(inner);
    let mut numbers = measured::numbers(state, usize::from(numbers_area.width));
    if numbers.is_empty() {
        numbers.push(Line::raw("no job yet: R runs the study"));
    }
    frame.render_widget(Paragraph::new(numbers), numbers_area);
    if measurements::rows(state).is_empty() {
        let wait = state.job().map_or("", |_| "no measurements yet");
        frame.render_widget(Paragraph::new(Line::styled(wait, state.theme.dim())), table_area);
        return;
    }
    let selected = state.in_second_pane().then_some(true);
    let (columns, lines) = (usize::from(table_area.width), usize::from(table_area.height));
    frame.render_widget(Paragraph::new(measured::table(state, columns, lines, selected)), table_area);
}

/// Draws the cells as a list, where the grid does not fit.
fn draw_list(frame: &mut Frame<'_>, area: Rect, state: &State, grid: &Grid) {
    let places = places(state);
    let selected = places.iter().position(|place| *place == state.place).unwrap_or(0);
    let first = first_shown(selected, places.len(), usize::from(area.height));
    let line = |place: &Place| {
        let cell = &grid.cells[place.size][place.subject][place.simulator];
        let fit = grid.fits[place.size][place.subject].map_or(String::new(), |fit| ease_text(&fit));
        let style = cell.status.map_or(state.theme.dim(), |status| state.theme.result(status, cell.is_inside));
        let style = if *place == state.place { style.patch(state.theme.selected()) } else { style };
        let simulator = text::sim(grid.simulators[place.simulator]);
        let (size, subject) = (left(&grid.sizes[place.size], 4), left(&grid.subjects[place.subject], 9));
        Line::styled(format!("{size} {subject} {simulator} {} {fit}", left(&cell_text(cell), 9)), style)
    };
    let lines: Vec<Line<'_>> = places.iter().skip(first).take(usize::from(area.height)).map(line).collect();
    frame.render_widget(Paragraph::new(lines), area);
}
