use std::path::{Path, PathBuf};

use super::{Handle, HandleError, Redrawn};
use crate::draft::Model;
use crate::dxf::{self, Unit};
use crate::piece::Piece;
use crate::pom::Point;
use crate::source::{self, Kind};
use crate::style::{Edge, EdgeRef, StylePiece};
use crate::{Style, garmentcode, propose};
use geom::V2;
use geom::polyline::{Polyline, boundary_distance, self_crossing};
use geom::units::{from_mm, mm};

fn drafted(model: Model, size: usize) -> Style {
    let draft = model.drafts().swap_remove(size);
    Style::read(&draft.pieces, model.seams(), "seams").expect("our own draft")
}

fn styles() -> Vec<(String, Style)> {
    let all = Model::ALL.into_iter().flat_map(|model| (0..model.drafts().len()).map(move |size| (model, size)));
    all.map(|(model, size)| (format!("{} {size}", model.as_str()), drafted(model, size))).collect()
}

fn points_mm(style: &Style) -> Vec<(Point, f64)> {
    style.points_of_measure().iter().map(|measure| (measure.point, mm(measure.length_m))).collect()
}

/// First side of each seam minus the second.
fn gaps_mm(style: &Style) -> Vec<f64> {
    let length = |side: &[EdgeRef]| side.iter().map(|edge| style.edge(*edge).line.length()).sum::<f64>();
    style.seams.iter().map(|seam| mm(length(&seam.a) - length(&seam.b))).collect()
}

fn farthest_m(outline: &[V2], other: &[V2]) -> f64 {
    let off = |from: &[V2], to: &[V2]| from.iter().map(|p| boundary_distance(to, p)).fold(0.0, f64::max);
    off(outline, other).max(off(other, outline))
}

fn styles_apart_mm(style: &Style, other: &Style) -> f64 {
    let pairs = style.pieces.iter().zip(&other.pieces);
    mm(pairs.map(|(piece, other)| farthest_m(&piece.outline(), &other.outline())).fold(0.0, f64::max))
}

/// Greatest turning angle inside each edge that is no corner, degrees, and the number of corners inside it.
fn kinks(piece: &StylePiece) -> Vec<(f64, usize)> {
    const CORNER_DEG: f64 = 20.0;
    let turns =
        |line: &[V2]| line.windows(3).map(|p| (p[1] - p[0]).angle(&(p[2] - p[1])).to_degrees()).collect::<Vec<_>>();
    let parted = |turns: Vec<f64>| {
        let (smooth, corners): (Vec<f64>, Vec<f64>) = turns.into_iter().partition(|turn| *turn < CORNER_DEG);
        (smooth.into_iter().fold(0.0, f64::max), corners.len())
    };
    piece.edges.iter().map(|edge| parted(turns(edge.line.points()))).collect()
}

fn angles_deg(piece: &StylePiece) -> Vec<f64> {
    let n = piece.edges.len();
    let corner = |k: usize| {
        let (before, after) = (piece.edges[(k + n - 1) % n].line.points(), piece.edges[k].line.points());
        (before[before.len() - 1] - before[before.len() - 2]).angle(&(after[1] - after[0])).to_degrees()
    };
    (0..n).map(corner).collect()
}

fn mirrored(outline: &[V2], about: f64) -> Vec<V2> {
    outline.iter().map(|p| V2::new(2.0 * about - p.x, p.y)).collect()
}

/// Checks that seams are paired, outlines have no crossings and new kinks, and the style meshes.
fn sound(what: &str, before: &Style, after: &Style) {
    for (gap, (was, seam)) in gaps_mm(after).iter().zip(gaps_mm(before).iter().zip(&before.seams)) {
        assert!(gap.abs() < was.abs() + 0.3, "{what}: seam {} is {gap} apart, was {was}", seam.name);
    }
    for (was, piece) in before.pieces.iter().zip(&after.pieces) {
        assert!(
            self_crossing(&was.outline()).is_some() || self_crossing(&piece.outline()).is_none(),
            "{what}: {}",
            piece.id
        );
        for ((was_deg, deg), edge) in kinks(was).iter().zip(kinks(piece)).zip(&piece.edges) {
            let is_smooth = deg.0 < 2.0 * was_deg.0 + 2.5 && deg.1 == was_deg.1;
            assert!(is_smooth, "{what}: {} {:?} turns by {deg:?}, was {was_deg:?}", piece.id, edge.name);
        }
        for (was_at, at) in was.notches.iter().zip(&piece.notches) {
            let off = boundary_distance(&piece.outline(), &at.at) - boundary_distance(&was.outline(), &was_at.at);
            assert!(mm(off).abs() < 2.0, "{what}: a notch of {} leaves the outline by {off}", piece.id);
        }
    }
    after.mesh(0.03).unwrap_or_else(|error| panic!("{what}: {error}"));
}

/// Points of measure that a handle changes, each per unit of the handle, and those that change as a consequence.
#[rustfmt::skip]
fn promised(handle: Handle) -> (Vec<(Point, f64)>, &'static [Point]) {
    use Point::*;
    match handle {
        Handle::Chest => (vec![(HalfChest, 1.0)], &[Armhole, HalfBicep]),
        Handle::Waist => (vec![(HalfWaist, 1.0)], &[]),
        Handle::Darts => (vec![(HalfWaist, 1.0)], &[]),
        Handle::CentreBack => (vec![(HalfWaist, 1.0)], &[]),
        Handle::Hip => (vec![(HalfHip, 1.0)], &[]),
        Handle::Hem => (vec![(HalfHem, 1.0)], &[]),
        Handle::Thigh => (vec![(HalfThigh, 1.0)], &[]),
        Handle::Knee => (vec![(HalfKnee, 1.0)], &[]),
        Handle::LegOpening => (vec![(HalfLegOpening, 1.0)], &[]),
        Handle::Fork => (vec![(HalfThigh, 1.0)], &[FrontRise, BackRise]),
        // The fork goes out by half of the wedge.
        Handle::Seat => (vec![(FrontRise, 0.0), (HalfWaist, 0.0)], &[BackRise, HalfThigh]),
        Handle::Abdomen => (vec![(BackRise, 0.0), (HalfWaist, 0.0)], &[FrontRise]),
        // Seat seams and outseams lean a little.
        Handle::Rise => (vec![], &[FrontRise, BackRise, Outseam, HalfWaist]),
        Handle::FrontRise => (vec![(FrontRise, 1.0)], &[]),
        Handle::BackRise => (vec![(BackRise, 1.0)], &[]),
        Handle::LegLength => (vec![(Inseam, 1.0), (Outseam, 1.0)], &[]),
        // The widths are measured half-way up an armhole that sinks, and along a shoulder that rotates.
        Handle::ShoulderSlope => (vec![(Shoulder, 0.0), (Armhole, 0.0)], &[AcrossFront, AcrossBack, AcrossShoulder, HalfChest]),
        Handle::ForwardShoulder => (vec![(Shoulder, 0.0), (Armhole, 0.0)], &[AcrossFront, AcrossBack, AcrossShoulder, SleeveLength]),
        // The widths are measured from armhole to armhole.
        Handle::FrontWidth => (vec![(AcrossFront, 2.0)], &[Armhole, HalfBicep]),
        Handle::BackWidth => (vec![(AcrossBack, 2.0)], &[Armhole, HalfBicep]),
        Handle::UpperBack => (vec![(CentreBackLength, 1.0), (Shoulder, 0.0), (Armhole, 0.0), (Neck, 0.0)], &[BackLength, NeckWidth, BackNeckDrop]),
        Handle::Bust => (vec![(HalfChest, 1.0)], &[FrontLength, CentreFrontLength, HalfHem, Armhole, AcrossFront, HalfBicep]),
        Handle::SwayBack => (vec![(CentreBackLength, 1.0)], &[BackLength]),
        Handle::ShoulderLength => (vec![(Shoulder, 1.0), (Armhole, 0.0)], &[AcrossFront, AcrossBack, AcrossShoulder]),
        Handle::FrontNeckDepth => (vec![(FrontNeckDrop, 1.0), (CentreFrontLength, -1.0)], &[Neck]),
        Handle::BackNeckDepth => (vec![(BackNeckDrop, 1.0), (CentreBackLength, -1.0)], &[Neck]),
        // The high point of the shoulder slides down along it.
        Handle::NeckWidth => (vec![(NeckWidth, 1.0)], &[Shoulder, FrontLength, BackLength, FrontNeckDrop, BackNeckDrop, Neck]),
        Handle::ArmholeDepth => (vec![], &[Armhole, AcrossFront, AcrossBack, HalfBicep, HalfChest]),
        Handle::Bicep => (vec![(HalfBicep, 1.0), (Armhole, 0.0), (SleeveLength, 0.0)], &[]),
        // A short sleeve stays straight from the underarm to its edge.
        Handle::Cuff => (vec![(HalfCuff, 1.0), (SleeveLength, 0.0)], &[HalfBicep]),
        Handle::CapHeight => (vec![(Armhole, 0.0), (SleeveLength, 0.0)], &[HalfBicep]),
        Handle::SleeveLength => (vec![(SleeveLength, 1.0)], &[]),
        Handle::BodyLength | Handle::SkirtLength => {
            (vec![(FrontLength, 1.0), (BackLength, 1.0), (CentreFrontLength, 1.0), (CentreBackLength, 1.0)], &[])
        }
        Handle::FrontLength => (vec![(FrontLength, 1.0), (CentreFrontLength, 1.0)], &[HalfHem]),
        Handle::BackLength => (vec![(BackLength, 1.0), (CentreBackLength, 1.0)], &[HalfHem]),
    }
}

#[test]
fn handles_of_drafted_styles_change_what_they_are_about_and_little_else() {
    for (name, style) in styles() {
        let before = points_mm(&style);
        for (handle, amount_mm) in style.handles().into_iter().flat_map(|handle| [(handle, 10.0), (handle, -10.0)]) {
            let what = format!("{name} {} {amount_mm:+}", handle.as_str());
            let moved = style.moved(&[(handle, from_mm(amount_mm))]).unwrap_or_else(|error| panic!("{what}: {error}"));
            sound(&what, &style, &moved);
            let (about, besides) = promised(handle);
            let first = handle.changes().is_none_or(|point| about.contains(&(point, 1.0)));
            assert!(first, "{what}: {:?} is not among {about:?}", handle.changes());
            for ((point, was), (same, is)) in before.iter().zip(points_mm(&moved)) {
                assert_eq!(*point, same, "{what}");
                let change = is - was;
                match about.iter().find(|(about, _)| about == point) {
                    Some((_, of_one)) => {
                        assert!((change - of_one * amount_mm).abs() < 0.2, "{what}: {} by {change}", point.as_str());
                    }
                    None if besides.contains(point) => {}
                    None => assert!(change.abs() < 1.0, "{what}: {} by {change}", point.as_str()),
                }
            }
        }
    }
}

#[test]
fn drafted_styles_have_the_handles_of_their_parts() {
    let check = |model: Model, expect: &[&str]| {
        let found: Vec<&str> = drafted(model, 0).handles().iter().map(|handle| handle.as_str()).collect();
        assert_eq!(found, expect, "{model:?}");
    };
    let trunk =
        ["shoulder_slope", "forward_shoulder", "shoulder_length", "front_width", "back_width", "upper_back", "bust"];
    let neck = ["front_neck_depth", "back_neck_depth", "neck_width", "armhole_depth"];
    let sleeve = ["bicep", "cuff", "cap_height", "sleeve_length"];
    let lengths = ["body_length", "front_length", "back_length"];
    let top = [&["chest", "waist", "hem"][..], &trunk, &neck, &sleeve, &lengths].concat();
    check(Model::Tshirt, &top);
    check(Model::Teetop, &top);
    let girths = ["waist", "centre_back", "hip", "thigh", "knee", "leg_opening", "fork"];
    let legs = ["seat", "abdomen", "rise", "front_rise", "back_rise", "leg_length"];
    check(Model::Trousers, &[&girths[..], &legs].concat());
    // Its skirt ends above the hip.
    check(
        Model::Dress,
        &[&["chest", "waist", "hem"][..], &trunk, &["sway_back"], &neck, &lengths, &["skirt_length"]].concat(),
    );
    for handle in Handle::ALL {
        assert_eq!(Handle::named(handle.as_str()), Some(handle));
        assert!(!handle.definition().is_empty());
    }
}

#[test]
fn corners_go_as_far_as_the_handle_says() {
    // Model, handle, piece, edge, true for its end, and displacement for 10 mm. `None` for a direction in which the
    // point gives way.
    let check = |model: Model, handle: Handle, piece: &str, edge: &str, is_end: bool, expect_mm: [Option<f64>; 2]| {
        let style = drafted(model, 0);
        let moved = style.moved(&[(handle, 0.010)]).expect("it has it");
        let place = |style: &Style| {
            let piece = style.pieces.iter().find(|worn| worn.id == piece).expect("it is drafted");
            let line = &piece.edges.iter().find(|named| named.name.as_deref() == Some(edge)).expect("it is named").line;
            if is_end { line.at(line.length()) } else { line.at(0.0) }
        };
        let by = place(&moved) - place(&style);
        for (found, expect) in [by.x, by.y].into_iter().map(mm).zip(expect_mm) {
            assert!(
                expect.is_none_or(|expect| (found - expect).abs() < 0.05),
                "{handle:?} {piece}.{edge}: {found} for {expect:?}"
            );
        }
    };
    let none = [Some(0.0), Some(0.0)];
    check(Model::Tshirt, Handle::ShoulderSlope, "front", "shoulder_left", false, [None, Some(-10.0)]);
    check(Model::Tshirt, Handle::ShoulderSlope, "back", "shoulder_left", true, [None, Some(-10.0)]);
    check(Model::Tshirt, Handle::ShoulderSlope, "front", "shoulder_left", true, none);
    check(Model::Tshirt, Handle::ArmholeDepth, "front", "side_left", true, [Some(0.0), Some(-10.0)]);
    check(Model::Tshirt, Handle::ArmholeDepth, "sleeve_right", "cap", false, [None, Some(-10.0)]);
    check(Model::Tshirt, Handle::CapHeight, "sleeve_right", "cap", true, [None, Some(-10.0)]);
    check(Model::Tshirt, Handle::Chest, "front", "side_left", true, [Some(5.0), None]);
    check(Model::Tshirt, Handle::Hem, "back", "side_left", true, [Some(-5.0), None]);
    check(Model::Tshirt, Handle::Hem, "back", "side_left", false, none);
    check(Model::Dress, Handle::Waist, "bodice_front", "waist", true, [Some(5.0), None]);
    check(Model::Trousers, Handle::Fork, "leg_back_left", "crotch_lower", false, [Some(10.0), None]);
    check(Model::Trousers, Handle::LegOpening, "leg_front_right", "hem", true, [Some(5.0), None]);
}

#[test]
fn right_and_left_stay_alike_and_square_corners_square() {
    // The underarm seam of a short sleeve and the side of a straight skirt stay straight, and so rotate.
    #[rustfmt::skip]
    let turned = {
        use Handle::*;
        [
            ShoulderSlope, ForwardShoulder, ShoulderLength, FrontWidth, BackWidth, UpperBack, Fork,
            Seat, Abdomen, FrontRise, BackRise, CentreBack, NeckWidth, FrontNeckDepth, BackNeckDepth,
        ]
    };
    for (name, style) in styles() {
        for (handle, amount_mm) in style.handles().into_iter().flat_map(|handle| [(handle, 10.0), (handle, -10.0)]) {
            let what = format!("{name} {} {amount_mm:+}", handle.as_str());
            let moved = style.moved(&[(handle, from_mm(amount_mm))]).unwrap_or_else(|error| panic!("{what}: {error}"));
            for (was, piece) in style.pieces.iter().zip(&moved.pieces) {
                let outline = piece.outline();
                let other = piece.id.strip_suffix("_left").map(|stem| format!("{stem}_right"));
                let twin = other.and_then(|id| moved.pieces.iter().find(|piece| piece.id == id));
                let is_half = piece.id.ends_with("_left") || piece.id.ends_with("_right");
                let image = twin.map(StylePiece::outline).or_else(|| (!is_half).then(|| outline.clone()));
                let apart = image.map_or(0.0, |image: Vec<V2>| farthest_m(&outline, &mirrored(&image, 0.0)));
                assert!(mm(apart) < 0.01, "{what}: {} is {apart} from its image", piece.id);
                let is_short_sleeve = name.starts_with("teetop") && piece.id.starts_with("sleeve");
                let is_straight_skirt = piece.id.starts_with("skirt") && matches!(handle, Handle::Waist | Handle::Hem);
                if is_short_sleeve || is_straight_skirt || turned.contains(&handle) {
                    continue;
                }
                for (k, (was_deg, deg)) in angles_deg(was).iter().zip(angles_deg(piece)).enumerate() {
                    let is_square = (was_deg - 90.0).abs() < 1.0;
                    assert!(
                        !is_square || (deg - was_deg).abs() < 1.5,
                        "{what}: {} corner {k}: {was_deg} to {deg}",
                        piece.id
                    );
                }
            }
        }
    }
}

/// Counts changes of the sense in which a line turns by more than a tenth of a degree for each centimetre over at least
/// two degrees.
fn inflections(line: &Polyline) -> usize {
    const STEP_M: f64 = 0.01;
    const STRAIGHT_DEG: f64 = 0.1;
    const TURN_DEG: f64 = 2.0;
    let steps = (line.length() / STEP_M).ceil().max(2.0) as usize;
    let points: Vec<V2> = (0..=steps).map(|k| line.at(line.length() * k as f64 / steps as f64)).collect();
    let turn = |p: &[V2]| (p[1] - p[0]).perp(&(p[2] - p[1])).atan2((p[1] - p[0]).dot(&(p[2] - p[1]))).to_degrees();
    let mut stretches: Vec<f64> = Vec::new();
    for turn in points.windows(3).map(turn).filter(|turn| turn.abs() > STRAIGHT_DEG) {
        match stretches.last_mut() {
            Some(last) if *last * turn > 0.0 => *last += turn,
            _ => stretches.push(turn),
        }
    }
    stretches.retain(|turn| turn.abs() > TURN_DEG);
    stretches.windows(2).filter(|pair| pair[0] * pair[1] < 0.0).count()
}

fn is_curve(edge: &Edge) -> bool {
    let named = |start: &&str| edge.name.as_deref().is_some_and(|name| name.starts_with(*start));
    ["armhole", "cap", "neck", "crotch"].iter().any(named)
}

#[test]
fn curves_get_no_new_inflection() {
    let mut found = Vec::new();
    for (name, style) in styles() {
        for handle in style.handles() {
            for amount_mm in [-1.0, 1.0].map(|by: f64| by * handle.most_mm().min(10.0)) {
                let Ok(moved) = style.moved(&[(handle, from_mm(amount_mm))]) else { continue };
                for (was, is) in style.pieces.iter().zip(&moved.pieces) {
                    for (was, edge) in was.edges.iter().zip(&is.edges) {
                        let [before, after] = [&was.line, &edge.line].map(inflections);
                        if after > before && is_curve(was) {
                            found.push(format!(
                                "{name} {} {amount_mm:+}: {} {:?} {before} to {after}",
                                handle.as_str(),
                                is.id,
                                edge.name
                            ));
                        }
                    }
                }
            }
        }
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
fn nothing_is_nothing_and_back_is_back() {
    let check = |model: Model, handle: Handle, within_mm: f64| {
        let style = drafted(model, 0);
        assert_eq!(style.moved(&[(handle, 0.0)]), Ok(style.clone()), "{handle:?}");
        for amount_m in [0.010, -0.010] {
            let back = style.moved(&[(handle, amount_m), (handle, -amount_m)]).expect("it has it");
            let apart = styles_apart_mm(&back, &style);
            assert!(apart < within_mm, "{} {} {amount_m:+}: {apart} mm", model.as_str(), handle.as_str());
        }
    };
    for model in Model::ALL {
        for handle in drafted(model, 0).handles() {
            use Handle::*;
            let is_linear = match handle {
                BodyLength | SkirtLength | SleeveLength | LegLength | LegOpening => true,
                Hem | Waist => model != Model::Dress,
                _ => false,
            };
            // The kind of a section, by which its ends carry it along, may be another after the first change.
            let is_between = matches!(
                handle,
                ShoulderLength | FrontWidth | BackWidth | UpperBack | NeckWidth | FrontNeckDepth | BackNeckDepth
            );
            check(
                model,
                handle,
                if is_linear {
                    0.01
                } else if is_between {
                    5.0
                } else {
                    1.2
                },
            );
        }
    }
}

#[test]
fn styles_change_smoothly_with_the_amount() {
    for (model, style) in Model::ALL.map(|model| (model, drafted(model, 0))) {
        for handle in style.handles() {
            let outline_at = |amount_mm: f64| {
                let moved = style.moved(&[(handle, from_mm(amount_mm))]).expect("it has it");
                moved.pieces.iter().flat_map(StylePiece::outline).collect::<Vec<V2>>()
            };
            let [low, middle, high] = [0.5, 1.0, 1.5].map(outline_at);
            assert!(low.len() == middle.len() && middle.len() == high.len(), "{model:?} {handle:?}");
            for k in 0..low.len() {
                let bend_mm = mm((low[k] - middle[k] * 2.0 + high[k]).norm());
                assert!(bend_mm < 0.03, "{model:?} {handle:?}: vertex {k} bends by {bend_mm}");
            }
        }
    }
}

#[test]
fn what_cannot_be_done_is_refused_with_its_reason() {
    let style = drafted(Model::Tshirt, 0);
    let told =
        |style: &Style, handle: Handle, amount_m: f64| style.moved(&[(handle, amount_m)]).expect_err("it is refused");
    let absent = told(&style, Handle::LegLength, 0.01);
    assert!(
        matches!(absent, HandleError::Absent { .. }) && absent.to_string().contains("chest, waist, hem"),
        "{absent}"
    );
    for amount_m in [0.5, f64::NAN] {
        let much = told(&style, Handle::Waist, amount_m).to_string();
        assert!(much.contains("accepted: -300 to 300 mm"), "{much}");
    }
    let crossed = told(&style, Handle::Cuff, -0.2);
    assert!(matches!(crossed, HandleError::Crossing { .. }), "{crossed}");
    // The armhole is sewn to a piece that is no sleeve: it cannot follow.
    let text = std::str::from_utf8(Model::Tshirt.seams())
        .expect("text")
        .replace("role = \"sleeve_left\"", "role = \"skirt_back\"");
    let pieces = Model::Tshirt.drafts().swap_remove(0).pieces;
    let odd = Style::read(&pieces, text.as_bytes(), "odd").expect("it is sewn");
    let apart = told(&odd, Handle::ArmholeDepth, 0.01).to_string();
    assert!(
        apart.contains("seam `armhole_left` of sleeve_left.cap and back.armhole_left + front.armhole_left"),
        "{apart}"
    );
}

#[test]
fn redrawn_pieces_make_the_changed_style_by_the_same_seam_file() {
    let check = |model: Model, handles: &[(Handle, f64)]| {
        let draft = model.drafts().swap_remove(0);
        let pieces = Redrawn::of(&draft.pieces, model.seams(), "seams", handles).expect("it has them").pieces();
        let bytes = dxf::write_pieces(&pieces, &[], dxf::Standard::Aama);
        let read = source::read(&bytes, "changed.dxf", None).expect("our own file").to_sew(None).expect("one size");
        let back = Style::read(&read, model.seams(), "seams").expect("the seams hold");
        let moved = drafted(model, 0).moved(handles).expect("it has them");
        let apart = styles_apart_mm(&back, &moved);
        assert!(apart < 0.05, "{model:?}: {apart} mm");
        for ((point, is), (_, expect)) in points_mm(&back).into_iter().zip(points_mm(&moved)) {
            assert!((is - expect).abs() < 0.1, "{model:?}: {} is {is} instead of {expect}", point.as_str());
        }
        for (piece, was) in pieces.iter().zip(&draft.pieces) {
            let direction = |piece: &Piece| piece.grain.map(|[from, to]| (to - from).normalize());
            assert!(
                direction(piece).zip(direction(was)).is_some_and(|(is, was)| (is - was).norm() < 1e-9),
                "{}",
                piece.name
            );
        }
    };
    use Handle::*;
    check(Model::Tshirt, &[(Chest, 0.008), (ArmholeDepth, 0.005), (FrontNeckDepth, -0.004), (SleeveLength, 0.02)]);
    check(Model::Trousers, &[(Waist, -0.008), (BackRise, 0.006), (Knee, 0.01), (LegLength, 0.01)]);
    check(Model::Teetop, &[(ShoulderSlope, 0.006), (Bicep, 0.01), (FrontLength, 0.01)]);
    check(Model::Dress, &[(Waist, -0.01), (NeckWidth, 0.01), (SkirtLength, 0.03)]);
}

/// Corners stand in the file as shares of their piece, which a handle changes.
#[test]
fn a_seam_file_that_tells_where_corners_lie_tells_where_they_have_gone() {
    let draft = Model::Tshirt.drafts().swap_remove(0);
    let seams = propose::propose(&draft.pieces).toml("tee");
    assert!(seams.contains("corners_at"), "{seams}");
    let style = Style::read(&draft.pieces, seams.as_bytes(), "tee").expect("it is sewn");
    for handles in [[(Handle::Chest, 0.025), (Handle::BodyLength, -0.1)], [(Handle::Hem, 0.06), (Handle::Bicep, -0.02)]]
    {
        let changed = Redrawn::of(&draft.pieces, seams.as_bytes(), "tee", &handles).expect("it has them");
        let pieces = changed.pieces();
        let reseamed = changed.seams(&pieces, seams.as_bytes(), "tee").expect("its own seams");
        let back = Style::read(&pieces, &reseamed, "tee").expect("its seam file holds");
        let moved = style.moved(&handles).expect("it has them");
        assert!(styles_apart_mm(&back, &moved) < 0.05, "{handles:?}");
        assert!(reseamed != seams.as_bytes(), "{handles:?}");
    }
}

#[test]
fn a_mesh_goes_along_with_its_style() {
    let style = drafted(Model::Tshirt, 1);
    let mesh = style.mesh(0.04).expect("it meshes");
    let area = |garment: &crate::Garment| -> f64 {
        let corners = |t: &[usize; 3]| t.map(|v| garment.rest[v]);
        garment.triangles.iter().map(corners).map(|[a, b, c]| 0.5 * (b - a).perp(&(c - a))).sum()
    };
    for (handle, amount_m) in [(Handle::Hem, 0.01), (Handle::CapHeight, -0.008), (Handle::BodyLength, 0.02)] {
        let along = style.moved_mesh(&mesh, handle, amount_m).expect("it has it");
        let anew = style.moved(&[(handle, amount_m)]).expect("it has it").mesh(0.04).expect("it meshes");
        // Chords on either side of a curve differ by a little.
        assert!((area(&along) - area(&anew)).abs() < 1e-3 * area(&anew), "{handle:?}");
        for (is, expect) in along.measurements.iter().zip(&anew.measurements) {
            assert!((is.l2d_m - expect.l2d_m).abs() < 1e-3, "{handle:?} {}: {} {}", is.name, is.l2d_m, expect.l2d_m);
        }
        let flat: Vec<geom::V3> = along.rest.iter().map(|p| p.push(0.0)).collect();
        for measured in &along.measurements {
            let off_m = measured.length_m(&along.rest, &flat) - measured.l2d_m;
            assert!(off_m.abs() < 1e-9, "{handle:?} {}", measured.name);
        }
    }
}

#[test]
fn what_lies_inside_goes_along() {
    let mut draft = Model::Tshirt.drafts().swap_remove(0);
    let front = draft.pieces.iter_mut().find(|piece| piece.block == "FRONT").expect("it is drafted");
    front.drill_holes = vec![V2::new(0.0, 0.05), V2::new(0.1, 0.2)];
    front.internal_lines = vec![vec![V2::new(-0.1, 0.05), V2::new(0.1, 0.05)]];
    let pieces = Redrawn::of(&draft.pieces, Model::Tshirt.seams(), "seams", &[(Handle::BodyLength, 0.02)])
        .expect("it has it")
        .pieces();
    let moved = pieces.iter().find(|piece| piece.block == "FRONT").expect("it is there");
    let by: Vec<V2> =
        moved.drill_holes.iter().zip([V2::new(0.0, 0.05), V2::new(0.1, 0.2)]).map(|(p, was)| p - was).collect();
    // Points near the hem move with it, those half-way up by less.
    assert!((by[0].y + 0.02).abs() < 0.004 && by[0].x.abs() < 1e-9, "{by:?}");
    assert!((-0.017..-0.005).contains(&by[1].y), "{by:?}");
    let line = &moved.internal_lines[0];
    assert!(line.len() >= 2 && line.iter().all(|p| p.y < 0.05), "{line:?}");
}

fn shared(file: &str) -> Option<PathBuf> {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../shared/patterns").join(file);
    path.exists().then_some(path)
}

/// File of another program, sewn as proposed if it holds no seams.
fn foreign(path: &Path) -> Style {
    let bytes = std::fs::read(path).expect("readable");
    let name = path.display().to_string();
    if source::kind(&bytes) == Kind::GarmentCode {
        return garmentcode::read(&bytes, &name).expect("a specification").style();
    }
    let unit = name.contains("valentina").then_some(Unit::Mm);
    let pieces = source::read(&bytes, &name, unit).expect("a pattern").to_sew(None).expect("a size");
    Style::read(&pieces, propose::propose(&pieces).toml("foreign").as_bytes(), "foreign").expect("it holds")
}

#[test]
fn foreign_patterns_change_by_their_handles() {
    // File, least number of handles, and the handles that are refused.
    let check = |file: &str, handles: usize, refused: &[Handle]| {
        let Some(path) = shared(file) else { return eprintln!("skipped: {file} is not there") };
        let style = foreign(&path);
        assert!(style.handles().len() >= handles, "{file}: {}", style.handles().len());
        for (handle, amount_mm) in style.handles().into_iter().flat_map(|handle| [(handle, 5.0), (handle, -5.0)]) {
            let what = format!("{file} {} {amount_mm:+}", handle.as_str());
            match style.moved(&[(handle, from_mm(amount_mm))]) {
                Ok(moved) => {
                    assert!(!refused.contains(&handle), "{what} is not refused");
                    sound(&what, &style, &moved);
                    // A straight way down a dart may end beside it, and a seam may have a bag in it.
                    let is_odd = (file.contains("bella") && handle == Handle::BodyLength)
                        || (file.contains("paco") && handle == Handle::LegLength);
                    let (before, after) = (points_mm(&style), points_mm(&moved));
                    for (point, of_one) in promised(handle).0.into_iter().filter(|_| !is_odd) {
                        let length_mm = |points: &[(Point, f64)]| {
                            points.iter().find(|measure| measure.0 == point).map(|measure| measure.1)
                        };
                        let change =
                            length_mm(&after).zip(length_mm(&before)).map(|(is, was)| is - was - of_one * amount_mm);
                        assert!(
                            change.is_none_or(|off| off.abs() < 0.2),
                            "{what}: {} is off by {change:?}",
                            point.as_str()
                        );
                    }
                }
                // A figure that the pieces cannot follow is refused with its seam.
                Err(error) => assert!(refused.contains(&handle) || handle.is_for_figure(), "{what}: {error}"),
            }
        }
    };
    let gc = |name: &str| format!("garmentcode/{name}_specification.json");
    check(&gc("tshirt_mean_female"), 16, &[]);
    check(&gc("tshirt_mean_all"), 16, &[]);
    check(&gc("longsleeve_shirt_mean_all"), 16, &[]);
    check(&gc("fitted_shirt_sleeves_mean_male"), 15, &[]);
    check(&gc("fitted_bodice_darts_mean_female"), 11, &[]);
    check(&gc("dress_sheath_mean_female"), 14, &[]);
    check(&gc("pencil_skirt_mean_female"), 4, &[]);
    check(&gc("pants_mean_all"), 9, &[]);
    check(&gc("pants_mean_female"), 9, &[]);
    check("freesewing/teagan_cisFemaleAdult36_aama.dxf", 16, &[]);
    check("freesewing/titan_cisFemaleAdult36_aama.dxf", 9, &[]);
    check("freesewing/bella_cisFemaleAdult36_aama-net.dxf", 15, &[]);
    check("freesewing/brian_cisMaleAdult40_aama.dxf", 16, &[]);
    check("freesewing/paco_cisFemaleAdult36_aama.dxf", 9, &[]);
    check("freesewing/sandy_cisFemaleAdult36_aama.dxf", 0, &[]);
    check("valentina/pantsM1_52-176.v1.1.1.astm-r12.dxf", 9, &[]);
}

#[test]
fn handles_of_half_a_girth_are_those_whose_words_say_so() {
    for handle in Handle::ALL {
        let says = handle.definition().starts_with("half of");
        assert_eq!(handle.is_half_girth(), says, "{}", handle.as_str());
        let is_half = |point: Point| point.as_str().starts_with("half_");
        assert!(handle.changes().is_none_or(|point| is_half(point) == says), "{}", handle.as_str());
    }
}
