//! Numbered callouts on a picture: circles in its margins, with lines to what they are about.

use std::fmt::Write;

/// Size of the drawing, which is stretched over the picture.
const SIZE: [f64; 2] = [480.0, 540.0];
const RADIUS: f64 = 17.0;
/// Least distance between the middles of two circles of a margin.
const APART: f64 = 2.0 * RADIUS + 5.0;
/// Distance from the middle of the picture, as a share of its width, within which a place lies on neither side.
const MIDDLE: f64 = 0.05;

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Callout {
    pub number: i64,
    /// Shares of the picture's width from the left and of its height from the top.
    pub at: [f64; 2],
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Placed {
    number: i64,
    at: [f64; 2],
    circle: [f64; 2],
}

/// SVG to lie over a picture; empty without a callout.
pub(super) fn overlay(callouts: &[Callout]) -> String {
    if callouts.is_empty() {
        return String::new();
    }
    let [width, height] = SIZE;
    let numbers: Vec<String> = callouts.iter().map(|callout| callout.number.to_string()).collect();
    let mut svg = format!(
        r#"<svg viewBox="0 0 {width} {height}" preserveAspectRatio="none" role="img" aria-label="Comments {}">"#,
        numbers.join(", ")
    );
    let placed = placed(callouts);
    // Lines first, so that no line crosses a number.
    for Placed { at: [x, y], circle: [from_x, from_y], .. } in &placed {
        for class in ["under", "line"] {
            let _ = write!(svg, r#"<path class="{class}" d="M{from_x:.1} {from_y:.1}L{x:.1} {y:.1}"/>"#);
        }
        let _ = write!(svg, r#"<circle class="dot" cx="{x:.1}" cy="{y:.1}" r="5"/>"#);
    }
    for Placed { number, circle: [x, y], .. } in &placed {
        let _ = write!(
            svg,
            r#"<circle cx="{x:.1}" cy="{y:.1}" r="{RADIUS}"/><text x="{x:.1}" y="{:.1}">{number}</text>"#,
            y + 7.0
        );
    }
    svg += "</svg>";
    svg
}

/// Callouts with their circles in the margins: on the side of their places, and those in the middle where fewer are.
fn placed(callouts: &[Callout]) -> Vec<Placed> {
    let [width, height] = SIZE;
    let mut sides: [Vec<Callout>; 2] = [vec![], vec![]];
    let (middle, aside): (Vec<Callout>, Vec<Callout>) =
        callouts.iter().partition(|callout| (callout.at[0] - 0.5).abs() < MIDDLE);
    for callout in aside {
        sides[usize::from(callout.at[0] > 0.5)].push(callout);
    }
    for callout in middle {
        let fewer = usize::from(sides[1].len() < sides[0].len());
        sides[fewer].push(callout);
    }
    let margin = RADIUS + 4.0;
    let mut placed = Vec::new();
    for (mut side, x) in sides.into_iter().zip([margin, width - margin]) {
        side.sort_by(|a, b| a.at[1].total_cmp(&b.at[1]).then(a.number.cmp(&b.number)));
        let wanted: Vec<f64> = side.iter().map(|callout| callout.at[1] * height).collect();
        let heights = spread(&wanted, margin, height - margin);
        placed.extend(side.iter().zip(heights).map(|(callout, y)| Placed {
            number: callout.number,
            at: [callout.at[0] * width, callout.at[1] * height],
            circle: [x, y],
        }));
    }
    placed
}

/// Heights from `low` to `high` in the order of those that are wanted, [`APART`] from each other where there is room,
/// and evenly where there is none.
fn spread(wanted: &[f64], low: f64, high: f64) -> Vec<f64> {
    let apart = APART.min((high - low) / wanted.len().saturating_sub(1).max(1) as f64);
    let mut heights = wanted.to_vec();
    let mut least = low;
    for height in &mut heights {
        *height = height.max(least);
        least = *height + apart;
    }
    let mut most = high;
    for height in heights.iter_mut().rev() {
        *height = height.min(most);
        most = *height - apart;
    }
    heights
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn circles_keep_apart_and_in_order() {
        let check = |wanted: &[f64], expect: &[f64]| assert_eq!(spread(wanted, 20.0, 520.0), expect);
        check(&[100.0, 300.0], &[100.0, 300.0]);
        check(&[100.0, 100.0], &[100.0, 139.0]);
        check(&[500.0, 510.0, 515.0], &[442.0, 481.0, 520.0]);
        check(&[0.0], &[20.0]);
        let crowd = spread(&[260.0; 21], 20.0, 520.0);
        assert_eq!((crowd[0], crowd[20]), (20.0, 520.0));
        assert!(crowd.windows(2).all(|pair| (pair[1] - pair[0] - 25.0).abs() < 1e-9), "{crowd:?}");
    }

    #[test]
    fn a_circle_stands_beside_its_place() {
        let callout = |number, across| Callout { number, at: [across, 0.5] };
        let found = placed(&[callout(1, 0.2), callout(2, 0.5), callout(3, 0.5), callout(4, 0.9)]);
        let left: Vec<i64> =
            found.iter().filter(|placed| placed.circle[0] < 240.0).map(|placed| placed.number).collect();
        let right: Vec<i64> =
            found.iter().filter(|placed| placed.circle[0] > 240.0).map(|placed| placed.number).collect();
        assert_eq!((left, right), (vec![1, 2], vec![3, 4]));
        let far = |a: &Placed, b: &Placed| (a.circle[0] - b.circle[0]).hypot(a.circle[1] - b.circle[1]);
        assert!(found.iter().enumerate().all(|(k, a)| found[..k].iter().all(|b| far(a, b) >= 2.0 * RADIUS)));
    }

    #[test]
    fn every_number_is_drawn_once() {
        let svg = overlay(&[Callout { number: 3, at: [0.5, 0.25] }, Callout { number: 12, at: [0.5, 0.25] }]);
        assert!(svg.contains(r#"aria-label="Comments 3, 12""#), "{svg}");
        for number in ["3", "12"] {
            assert_eq!(svg.matches(&format!(">{number}</text>")).count(), 1, "{svg}");
        }
        assert_eq!(svg.matches("240.0 135.0").count(), 4, "two lines for each: {svg}");
        assert!(overlay(&[]).is_empty());
    }
}
