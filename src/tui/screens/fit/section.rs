//! A cross section: the body and the cloth of all sizes, seen from above.

use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::style::Style;
use ratatui::text::{Line, Span};
use ratatui::widgets::{Paragraph, Wrap};

use crate::screens::fit::actions::worn;
use crate::screens::fit::card::{colour, is_to_wear};
use crate::screens::fit::state::FitScreen;
use crate::screens::state::State;
use crate::widgets::dots::{Dash, Dots};
use crate::widgets::lists::pane;
use crate::widgets::text::{left, right, whole, words};
use results::{CrossSection, CutCloth, CutLine, FitCard};

const LEGEND: [&str; 2] = [" front up, the subject's right on the right ", " front up, right on the right "];
/// Columns for the key of the lines, and for each of its parts: sample, name, three gaps.
const KEY: u16 = 33;
const SAMPLE: usize = 4;
const NAME: usize = 8;
const GAPS: [(&str, usize); 3] = [("least", 6), ("mean", 5), ("greatest", 9)];
/// Factor on the extent of the lines that leaves a margin.
const MARGIN: f64 = 1.04;
/// Dashes of the lines: of body and size to wear, then of the other sizes.
const WHOLE: Dash = Dash { on: 1, off: 0 };
const DASHES: [Dash; 4] =
    [Dash { on: 1, off: 1 }, Dash { on: 4, off: 2 }, Dash { on: 2, off: 3 }, Dash { on: 7, off: 3 }];
/// Levels of the trunk, where sleeves are cut too.
const TRUNK: [&str; 4] = ["chest", "underbust", "waist", "hip"];
/// Spacing of the dots that fill the body.
const FILL: usize = 4;

impl FitScreen {
    pub fn draw_section(&self, frame: &mut Frame<'_>, area: Rect, state: &State, focused: bool) {
        let section = self.section(state);
        let title = match (section, self.level(state)) {
            (Some(section), _) => format!("{} · {:.0} mm above the floor", words(&section.level), section.height_mm),
            (None, level) => format!("section · {}", words(level.unwrap_or_default())),
        };
        let legend = LEGEND[usize::from(area.width < 50)];
        let block =
            pane(state.theme, title, focused).title_bottom(Line::styled(legend, state.theme.legend()).right_aligned());
        let inner = block.inner(area);
        frame.render_widget(block, area);
        let (Some(section), Some(worn)) = (section, worn(state)) else {
            frame.render_widget(Paragraph::new(self.why_no_section(state)).wrap(Wrap { trim: true }), inner);
            return;
        };
        let key = key(state, section, &worn.card);
        // Beside a wide picture the key does not take any of its height.
        let is_wide = inner.width > 3 * inner.height && inner.width > 2 * KEY;
        let [key_area, picture] = if is_wide {
            Layout::horizontal([Constraint::Length(KEY + 1), Constraint::Fill(1)]).areas(inner)
        } else {
            Layout::vertical([Constraint::Length(key.len() as u16), Constraint::Fill(1)]).areas(inner)
        };
        frame.render_widget(Paragraph::new(key), key_area);
        frame.render_widget(Paragraph::new(outlines(state, section, &worn.card, picture)), picture);
    }
}

fn pen(state: &State, card: &FitCard, size: &str) -> (Dash, Style) {
    let number = card.sizes.iter().position(|other| other.size == size).unwrap_or(0);
    let dash = if is_to_wear(card, size) { WHOLE } else { DASHES[number % DASHES.len()] };
    (dash, colour(state.theme, card, size))
}

/// Lines of the key: size, then least, mean and greatest gap.
fn key(state: &State, section: &CrossSection, card: &FitCard) -> Vec<Line<'static>> {
    let head: String = GAPS.iter().map(|(title, columns)| right(title, *columns)).collect();
    let mut told = vec![Line::styled(left("gap, mm", SAMPLE + 1 + NAME) + &head, state.theme.dim())];
    for cloth in &section.cloth {
        let (dash, style) = pen(state, card, &cloth.size);
        let gaps = cloth.gap_mm().map(|gaps| gaps.map(whole));
        let cells = GAPS
            .iter()
            .enumerate()
            .map(|(k, (_, columns))| right(gaps.as_ref().map_or("—", |gaps| gaps[k].as_str()), *columns));
        let name = if is_to_wear(card, &cloth.size) {
            Span::styled(left(&format!("▸{}", cloth.size), NAME + 1), style.patch(state.theme.bold()))
        } else {
            Span::styled(left(&format!(" {}", cloth.size), NAME + 1), style)
        };
        told.push(Line::from(vec![sample(dash, style), name, Span::raw(cells.collect::<String>())]));
    }
    told.push(Line::from(vec![sample(WHOLE, Style::new()), Span::raw(" body")]));
    told
}

fn sample(dash: Dash, style: Style) -> Span<'static> {
    let mut dots = Dots::new(SAMPLE, 1);
    dots.line(&[[0.0, 2.0], [2.0 * SAMPLE as f64, 2.0]], dash, style);
    let line = dots.lines().pop().unwrap_or_default();
    Span::styled(left(&line.to_string(), SAMPLE), style)
}

/// Draws the size to wear last, on top.
fn outlines(state: &State, section: &CrossSection, card: &FitCard, area: Rect) -> Vec<Line<'static>> {
    let mut dots = Dots::new(usize::from(area.width), usize::from(area.height));
    let Some(scale) = Scale::fit(section, dots.size()) else { return vec![] };
    let dim = state.theme.dim();
    let skin = scale.places(&section.skin);
    fill(&mut dots, &skin, dim);
    for other in &section.others {
        dots.line(&scale.places(other), WHOLE, dim);
    }
    dots.line(&skin, WHOLE, Style::new());
    let is_worn = |cloth: &&CutCloth| is_to_wear(card, &cloth.size);
    let (worn, others): (Vec<_>, Vec<_>) = section.cloth.iter().partition(is_worn);
    for cloth in others.into_iter().chain(worn) {
        let (dash, style) = pen(state, card, &cloth.size);
        for line in &cloth.lines {
            dots.line(&scale.places(line), dash, style);
        }
    }
    dots.lines()
}

/// Scale from mm to dots, with trunk or limb and its cloth in the middle.
struct Scale {
    middle_mm: [f64; 2],
    per_mm: f64,
    size: [f64; 2],
}

impl Scale {
    fn fit(section: &CrossSection, size: [usize; 2]) -> Option<Self> {
        let is_trunk = TRUNK.contains(&section.level.as_str());
        let cloth = section.cloth.iter().filter(|_| !is_trunk).flat_map(|cloth| &cloth.lines);
        let points = || cloth.clone().chain([&section.skin]).flat_map(|line| &line.points);
        // Sleeves beside the trunk may be cut off: what counts is the air around the trunk.
        let gaps = section.cloth.iter().filter(|_| is_trunk).filter_map(|cloth| cloth.gap_mm());
        let air_mm = gaps.map(|[_, _, greatest]| greatest).fold(0.0, f64::max);
        let bounds = |k: usize| {
            let reach = |(low, high): (f64, f64), mm: f64| (low.min(mm - air_mm), high.max(mm + air_mm));
            points().map(|point| point[k]).fold((f64::INFINITY, f64::NEG_INFINITY), reach)
        };
        let (across, deep) = (bounds(0), bounds(1));
        let size = size.map(|dots| dots as f64);
        let per_mm = (size[0] / (across.1 - across.0)).min(size[1] / (deep.1 - deep.0)) / MARGIN;
        let middle_mm = [across, deep].map(|(low, high)| (low + high) / 2.0);
        (per_mm > 0.0 && per_mm.is_finite()).then_some(Self { middle_mm, per_mm, size })
    }

    /// Points of a line in dots, with the front up. A closed line ends at its first point.
    fn places(&self, line: &CutLine) -> Vec<[f64; 2]> {
        let first = line.points.first().filter(|_| line.closed);
        let place = |point: &[f64; 2]| {
            let [x, y] = [0, 1].map(|k| (point[k] - self.middle_mm[k]) * self.per_mm);
            [self.size[0] / 2.0 + x, self.size[1] / 2.0 - y]
        };
        line.points.iter().chain(first).map(place).collect()
    }
}

fn fill(dots: &mut Dots, outline: &[[f64; 2]], style: Style) {
    let [width, height] = dots.size();
    for y in (0..height).step_by(FILL) {
        let y = y as f64 + 0.5;
        // Crossings of the row with the outline, from the left: inside is between the first and second, and so on.
        let mut crossed: Vec<f64> = outline
            .windows(2)
            .filter(|ends| (ends[0][1] > y) != (ends[1][1] > y))
            .map(|ends| ends[0][0] + (ends[1][0] - ends[0][0]) * (y - ends[0][1]) / (ends[1][1] - ends[0][1]))
            .collect();
        crossed.sort_by(f64::total_cmp);
        for x in (0..width).step_by(FILL) {
            if crossed.partition_point(|crossing| *crossing < x as f64) % 2 == 1 {
                dots.draw([x as f64, y], style);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_front_is_up_and_the_subjects_right_on_the_right() {
        let line = |points: &[[f64; 2]]| CutLine { points: points.to_vec(), closed: false };
        let section = CrossSection {
            level: "waist".into(),
            height_mm: 1000.0,
            centre: [0.0, 0.0],
            skin: line(&[[-100.0, 0.0], [100.0, 0.0], [0.0, 50.0]]),
            others: vec![],
            cloth: vec![],
        };
        let scale = Scale::fit(&section, [104, 104]).expect("it has a size");
        let [left, right, front] = [0, 1, 2].map(|k| scale.places(&section.skin)[k]);
        assert!(right[0] > left[0] && front[1] < left[1], "{left:?} {right:?} {front:?}");
        assert_eq!((right[0] - left[0]).round(), 100.0, "two millimetres a dot, and a margin");
    }
}
