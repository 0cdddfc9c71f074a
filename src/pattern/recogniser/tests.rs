use super::facts::{Fact, Facts};
use super::network::Garment;
use super::settle::seams;
use super::stretch::{Part, stretches};
use super::symmetry::symmetry;
use crate::trade;
use geom::V2;

/// Corners in mm, counter-clockwise.
fn part(name: &str, corners: &[[f64; 2]]) -> Part {
    Part {
        outline: corners.iter().map(|&corner| V2::from(corner) / 1000.0).collect(),
        corners: (0..corners.len()).collect(),
        notches: Vec::new(),
        said: trade::read(name),
    }
}

/// Half of a skirt: its side on the right.
const HALF: [[f64; 2]; 4] = [[0.0, 0.0], [280.0, 0.0], [220.0, 600.0], [0.0, 600.0]];
const WHOLE: [[f64; 2]; 4] = [[-280.0, 0.0], [280.0, 0.0], [220.0, 600.0], [-220.0, 600.0]];

fn skirt() -> Vec<Part> {
    let half = part("skirt back right", &HALF);
    vec![part("skirt front", &WHOLE), Part { said: trade::read("skirt back left"), ..half.mirrored() }, half]
}

#[test]
fn a_stretch_has_the_geometry_of_its_outline() {
    let arc = |k: u32| {
        let angle = std::f64::consts::FRAC_PI_2 * f64::from(k) / 32.0;
        [100.0 * angle.cos(), 100.0 * angle.sin()]
    };
    let outline: Vec<[f64; 2]> = [[0.0, 0.0]].into_iter().chain((0..=32).map(arc)).collect();
    let sector = Part {
        corners: vec![0, 1, 33],
        notches: vec![V2::new(0.05, 0.001), V2::new(0.002, 0.05), V2::new(0.004, 0.0)],
        ..part("", &outline)
    };
    let found = stretches(&[sector]);
    let lengths: Vec<f64> = found.iter().map(|stretch| (1000.0 * stretch.length).round()).collect();
    assert_eq!(lengths, [100.0, 157.0, 100.0]);
    for (stretch, angles) in found.iter().zip([[90.0, 90.0], [90.0, 90.0], [90.0, 90.0]]) {
        assert!((stretch.start_angle - angles[0]).abs() < 2.0, "{}", stretch.start_angle);
        assert!((stretch.end_angle - angles[1]).abs() < 2.0, "{}", stretch.end_angle);
    }
    assert!(found[0].turn.abs() < 1e-9 && (found[1].turn - 90.0 * 15.0 / 16.0).abs() < 1.0, "{}", found[1].turn);
    let notches: Vec<usize> = found.iter().map(|stretch| stretch.notches.len()).collect();
    assert_eq!(notches, [1, 0, 1], "a mark at a corner belongs to neither side");
}

#[test]
fn mirror_images_and_copies_are_found_however_they_lie() {
    let lopsided = part("", &[[0.0, 0.0], [200.0, 0.0], [150.0, 300.0], [0.0, 250.0]]);
    let turned = |part: &Part| Part {
        outline: part.outline.iter().map(|p| V2::new(-p.y, p.x) + V2::new(0.5, 0.1)).collect(),
        ..part.clone()
    };
    let parts = [lopsided.clone(), turned(&lopsided.mirrored()), turned(&lopsided), part("", &WHOLE)];
    let found = symmetry(&parts, &stretches(&parts));
    assert_eq!(found.kind, [0, 1, 0, 3]);
    assert_eq!(found.copies, [2, 1, 2, 1]);
    assert_eq!(found.twin_part, [Some(1), Some(0), None, None]);
    assert_eq!(found.like[8..12], [0, 1, 2, 3]);
    // Stretch 0 of the drawing is the one before the last of the mirror image.
    assert_eq!(found.twin[0], Some(6));
    assert_eq!(found.own[12..16], [Some(12), Some(15), Some(14), Some(13)]);
}

/// Seams as pairs of part and stretch.
fn sewn(parts: &[Part], facts: &Facts) -> Vec<[(usize, usize); 2]> {
    let garment = Garment::of(parts);
    let place = |k: usize| (garment.stretches[k].part, garment.stretches[k].at);
    let mut found: Vec<_> = seams(&garment, facts).seams.iter().map(|seam| [place(seam.a), place(seam.b)]).collect();
    found.sort_unstable();
    found
}

#[test]
fn halves_are_sewn_at_the_centre_and_to_the_other_face_at_the_sides() {
    // Sides are 603 mm, the centre 600 mm.
    let expect = [[(0, 1), (1, 1)], [(0, 3), (2, 1)], [(1, 3), (2, 3)]];
    assert_eq!(sewn(&skirt(), &Facts::default()), expect);
    assert_eq!(sewn(&skirt(), &Facts::default()), expect, "the same bits");
    let nameless: Vec<Part> = skirt().into_iter().map(|part| Part { said: trade::Named::default(), ..part }).collect();
    assert_eq!(sewn(&nameless, &Facts::default()), expect, "by shape alone");
    let [front, left, right] = <[Part; 3]>::try_from(nameless).expect("three");
    let expect = [[(0, 1), (2, 1)], [(0, 3), (1, 3)], [(1, 1), (2, 3)]];
    assert_eq!(sewn(&[left, right, front], &Facts::default()), expect, "in any order");
}

#[test]
fn what_is_stated_is_kept_and_the_rest_is_weighed_with_it() {
    let parts = skirt();
    let garment = Garment::of(&parts);
    let mut facts = Facts::default();
    facts.free(4);
    let likely = garment.likelihoods(&facts);
    for k in 0..garment.stretches.len() {
        let sum = (0..garment.stretches.len()).map(|other| likely.of(k, other)).sum::<f64>() + likely.free(k);
        assert!((sum - 1.0).abs() < 1e-5, "{sum}");
    }
    assert_eq!((likely.free(4), likely.of(1, 4), likely.of(4, 1)), (1.0, 0.0, 0.0));
    assert_eq!(seams(&garment, &facts).partner(4), None);
    facts.sew(1, 11);
    assert_eq!(seams(&garment, &facts).partner(11), Some(1));
    // A later statement replaces an earlier one, on both sides.
    facts.sew(11, 5);
    assert_eq!((facts.of(1), facts.of(5), facts.of(11)), (None, Some(Fact::Sewn(11)), Some(Fact::Sewn(5))));
}
