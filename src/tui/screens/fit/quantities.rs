//! Quantities measured on the drapes of a garment: a row for each, with a cell for each size.

use crate::widgets::text::{whole, words};
use results::{FoldLine, SizeWorn};

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Quantity {
    /// Name; lengths are in mm.
    pub name: String,
    /// Value in each size; `None` where it is not measured.
    pub cells: Vec<Option<String>>,
}

/// Quantities that are differences of heights, with the names shown.
const DIFFERENCES: [(&str, &str); 4] = [
    ("hem_front_over_back", "hem, front over back"),
    ("hem_right_over_left", "hem, right over left"),
    ("waist_front_over_back", "waist, front over back"),
    ("waist_right_over_left", "waist, right over left"),
];

/// Quantities that at least one size has: balance, pressure, folds, displaced openings, gaps, points of measure.
pub fn quantities(sizes: &[SizeWorn]) -> Vec<Quantity> {
    let mut rows = Rows { sizes, found: vec![] };
    for (quantity, name) in DIFFERENCES {
        rows.add(name, |size| size.balance_of(quantity).map(signed));
        if quantity == "hem_front_over_back" {
            rows.add("hem, front above floor", |size| size.balance_of("hem_front").map(whole));
        }
    }
    for side in ["right", "left"] {
        let quantity = format!("side_seam_lean_{side}");
        rows.add(&format!("side seam lean, {side}"), |size| size.balance_of(&quantity).map(lean));
    }
    rows.add("greatest pressure, kPa", |size| {
        let most = size.pressure.first()?;
        Some(format!("{:.2} {}", most.most_kpa, words(&most.region)))
    });
    rows.add("drag lines, longest", |size| Some(longest(&size.folds, "drag_line")));
    rows.add("folds, longest", |size| Some(longest(&size.folds, "fold")));
    for opening in names(sizes, |size| size.drawn.iter().map(|drawn| drawn.opening.as_str()).collect()) {
        rows.add(&format!("drawn {opening}"), |size| {
            let drawn = size.drawn.iter().find(|drawn| drawn.opening == opening)?;
            Some(signed(drawn.drawn_mm))
        });
    }
    let mut levels = names(sizes, |size| size.gaps.iter().map(|gap| gap.level.as_str()).collect());
    levels.sort_by_key(|level| *level == "upper_arm");
    for level in levels {
        rows.add(&format!("mean gap, {}", words(level)), |size| {
            size.gaps.iter().find(|gap| gap.level == level)?.mean_gap_mm.map(whole)
        });
    }
    for point in names(sizes, |size| size.points.iter().map(|point| point.point.as_str()).collect()) {
        rows.add(&words(point), |size| {
            let found = size.points.iter().find(|worn| worn.point == point)?;
            let worn = found.draped_mm.map_or(String::new(), |worn| format!(" → {worn:.1}"));
            Some(format!("{:.1}{worn}", found.flat_mm))
        });
    }
    rows.found
}

struct Rows<'a> {
    sizes: &'a [SizeWorn],
    found: Vec<Quantity>,
}

impl Rows<'_> {
    fn add(&mut self, name: &str, cell: impl Fn(&SizeWorn) -> Option<String>) {
        let cells: Vec<Option<String>> = self.sizes.iter().map(cell).collect();
        if cells.iter().any(Option::is_some) {
            self.found.push(Quantity { name: name.to_owned(), cells });
        }
    }
}

fn names(sizes: &[SizeWorn], names_of: fn(&SizeWorn) -> Vec<&str>) -> Vec<&str> {
    let mut found = vec![];
    for name in sizes.iter().flat_map(names_of) {
        if !found.contains(&name) {
            found.push(name);
        }
    }
    found
}

/// Whole number with its sign; 0 has none.
fn signed(value: f64) -> String {
    if value.abs() < 0.5 { "0".to_owned() } else { format!("{value:+.0}").replace('-', "−") }
}

/// Angle of a side seam from the vertical, and the direction in which its lower end lies.
fn lean(deg: f64) -> String {
    match deg {
        deg if deg.abs() < 0.5 => "upright".to_owned(),
        deg if deg > 0.0 => format!("{deg:.0}° to the front"),
        deg => format!("{:.0}° to the back", -deg),
    }
}

/// Number of folds of a kind, with the length of the longest.
fn longest(folds: &[FoldLine], kind: &str) -> String {
    let lengths = || folds.iter().filter(|fold| fold.kind == kind).map(|fold| fold.length_mm);
    let longest = lengths().reduce(f64::max);
    longest.map_or("none".to_owned(), |longest| format!("{}, {longest:.0}", lengths().count()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn signs_and_ways_are_told() {
        assert_eq!([signed(27.2), signed(-4.9), signed(-0.2)], ["+27", "−5", "0"]);
        assert_eq!([lean(4.04), lean(-2.0), lean(0.2)], ["4° to the front", "2° to the back", "upright"]);
    }
}
