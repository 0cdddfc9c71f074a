//! The garment of a running simulation in braille dots: one dot for each vertex, in the view on drapes.

use ratatui::style::Style;
use ratatui::text::Line;

use crate::widgets::dots::Dots;
use results::Look;
use store::LiveFrame;

/// Step in which the height of the view changes, so that the picture does not tremble.
const STEP_M: f64 = 0.1;
/// Factor on the extent of the garment that leaves a margin.
const MARGIN: f64 = 1.05;

pub fn braille(frame: &LiveFrame, look: Look, columns: usize, rows: usize, style: Style) -> Vec<Line<'static>> {
    let (sin, cos) = f64::from(look.azimuth_deg).to_radians().sin_cos();
    let seen: Vec<[f64; 2]> = frame.positions.iter().map(|p| [p.y * sin - p.x * cos, p.z]).collect();
    let bounds = |k: usize| {
        let low = seen.iter().map(|p| p[k]).fold(f64::INFINITY, f64::min);
        let high = seen.iter().map(|p| p[k]).fold(f64::NEG_INFINITY, f64::max);
        ((low / STEP_M).floor() * STEP_M, (high / STEP_M).ceil() * STEP_M)
    };
    let mut dots = Dots::new(columns, rows);
    let [width, height] = dots.size().map(|size| size as f64);
    let (across, up) = (bounds(0), bounds(1));
    let per_m = (width / (across.1 - across.0)).min(height / (up.1 - up.0)) / MARGIN;
    if !(per_m > 0.0 && per_m.is_finite()) {
        return vec![];
    }
    let dot = |value: f64, (low, high): (f64, f64), dots: f64| (value - (low + high) / 2.0) * per_m + dots / 2.0;
    for p in &seen {
        dots.draw([dot(p[0], across, width), dot(-p[1], (-up.1, -up.0), height)], style);
    }
    dots.lines()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::widgets::picture::FRONT;
    use geom::V3;
    use store::JobId;

    #[test]
    fn the_subjects_right_is_at_the_pictures_left() {
        let points = [[0.3, 0.0, 1.4], [-0.3, 0.0, 1.4], [0.3, 0.0, 1.0], [0.0, 0.2, 1.0]];
        let frame = LiveFrame { job: JobId(1), positions: points.map(|p| V3::new(p[0], p[1], p[2])).to_vec() };
        let seen = |look: Look| -> Vec<String> {
            braille(&frame, look, 20, 10, Style::new()).iter().map(Line::to_string).collect()
        };
        let lines = seen(FRONT);
        assert_eq!(lines.len(), 10);
        let shown = |rows: std::ops::Range<usize>, columns: std::ops::Range<usize>| {
            lines[rows]
                .iter()
                .flat_map(|line| line.chars().skip(columns.start).take(columns.len()))
                .filter(|c| *c != ' ')
                .count()
        };
        assert_eq!((shown(0..5, 0..10), shown(0..5, 10..20)), (1, 1), "{lines:#?}");
        assert_eq!((shown(5..10, 0..10), shown(5..10, 12..20)), (1, 0), "{lines:#?}");
        assert_ne!(seen(Look { azimuth_deg: 90, ..FRONT }), lines);
        assert!(braille(&LiveFrame { positions: vec![], ..frame.clone() }, FRONT, 20, 10, Style::new()).is_empty());
    }
}
