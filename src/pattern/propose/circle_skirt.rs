//! Pieces of a circle skirt: annular sectors between two concentric arcs.

use super::Class;
use super::Label;
use super::align::{Alignment, Labelled};
use super::shape::Shape;
use super::templates::{TEMPLATES, Template};

/// Least angle of a sector. A flared skirt has a smaller one.
const LEAST_TURN_DEG: f64 = 60.0;
const SIDE_DIFFERENCE: f64 = 0.02;
const STRAIGHT_BOW: f64 = 0.01;
/// Confidence in a sector whose name says skirt.
pub const CONFIDENCE: f64 = 0.9;

/// Reads an outline as an annular sector: the longer arc is its hem, the shorter, hollow arc its waist, and its sides
/// are straight. `None` for another outline.
pub fn read(shape: &Shape) -> Option<Alignment> {
    if shape.len() != 4 || !shape.darts().is_empty() {
        return None;
    }
    // The hem bulges outwards. The other three edges follow counter-clockwise.
    let hem = (0..4).max_by(|&i, &j| shape.length(i).total_cmp(&shape.length(j)))?;
    let [side, waist, other_side] = [1, 2, 3].map(|k| (hem + k) % 4);
    let turn = |edge: usize| {
        // Angle of the arc, by the ratio of length to chord.
        let section = shape.section(edge, 1);
        let arc_over_chord = section.length / section.chord.norm().max(f64::MIN_POSITIVE);
        (section.bow, turn_of(arc_over_chord))
    };
    let ((hem_bow, hem_turn), (waist_bow, waist_turn)) = (turn(hem), turn(waist));
    let sides = [shape.length(side), shape.length(other_side)];
    let is_straight = |edge: usize| shape.section(edge, 1).bow.abs() < STRAIGHT_BOW;
    let is_sector = hem_bow > 0.0
        && waist_bow < 0.0
        && hem_turn.min(waist_turn).to_degrees() > LEAST_TURN_DEG
        && (hem_turn - waist_turn).abs() < 0.15 * hem_turn
        && (sides[0] - sides[1]).abs() < SIDE_DIFFERENCE * sides[0]
        && is_straight(side)
        && is_straight(other_side);
    let template: Template = *TEMPLATES.iter().find(|template| template.class == Class::Skirt && template.is_whole)?;
    let up = shape.section(waist, 1).middle - shape.section(hem, 1).middle;
    let quarter_turns = ((90.0 - up.y.atan2(up.x).to_degrees()) / 90.0).round().rem_euclid(4.0) as usize;
    let part = |label, from, is_right| Labelled { label, from, span: 1, is_right };
    is_sector.then(|| Alignment {
        template,
        is_mirrored: false,
        quarter_turns,
        parts: vec![
            part(Label::Hem, hem, true),
            part(Label::Side, side, true),
            part(Label::Waist, waist, true),
            part(Label::Side, other_side, false),
        ],
        score: CONFIDENCE,
    })
}

/// In radians.
fn turn_of(arc_over_chord: f64) -> f64 {
    // arc / chord = t / sin t for half the angle t, which increases with t.
    let (mut low, mut high) = (0.0, std::f64::consts::PI * 0.999);
    for _ in 0..60 {
        let t = 0.5 * (low + high);
        if t / t.sin().max(f64::MIN_POSITIVE) < arc_over_chord { low = t } else { high = t }
    }
    low + high
}

#[cfg(test)]
mod tests {
    use super::*;
    use geom::V2;

    fn ring(turn_deg: f64, radii: [f64; 2]) -> Shape {
        let arc = |radius: f64, share: f64| {
            let angle = (90.0 - turn_deg * (0.5 - share)).to_radians();
            V2::new(angle.cos(), -angle.sin()) * radius
        };
        // Clockwise angles run counter-clockwise below the centre.
        let hem = (0..=40).map(|k| arc(radii[1], 1.0 - f64::from(k) / 40.0));
        let waist = (0..=40).map(|k| arc(radii[0], f64::from(k) / 40.0));
        Shape::new(hem.chain(waist).collect(), vec![0, 40, 41, 81]).expect("four corners")
    }

    #[test]
    fn rings_are_read_and_flared_skirts_are_not() {
        for turn_deg in [90.0, 180.0, 270.0] {
            let read = read(&ring(turn_deg, [0.2, 0.8])).unwrap_or_else(|| panic!("{turn_deg}"));
            let labels: Vec<(Label, usize)> = read.parts.iter().map(|part| (part.label, part.from)).collect();
            assert_eq!(labels, [(Label::Hem, 0), (Label::Side, 1), (Label::Waist, 2), (Label::Side, 3)]);
            assert_eq!(read.quarter_turns, 0);
        }
        assert!(read(&ring(30.0, [0.4, 1.0])).is_none());
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]| V2::new(x, y)).to_vec();
        assert!(read(&Shape::new(square, vec![0, 1, 2, 3]).expect("four corners")).is_none());
    }

    #[test]
    fn an_arc_is_known_by_its_length() {
        for turn_deg in [10.0_f64, 90.0, 180.0, 300.0] {
            let half = turn_deg.to_radians() / 2.0;
            assert!((turn_of(half / half.sin()).to_degrees() - turn_deg).abs() < 1e-6, "{turn_deg}");
        }
    }
}
