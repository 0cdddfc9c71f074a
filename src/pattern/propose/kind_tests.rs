//! Pieces that are told by the other pieces of the garment: side panels, tapes, alternatives, collars.

use super::garment_tests::{legs, piece, strip};
use super::*;
use crate::draft::Model;
use crate::pom::Point;
use crate::seams::SeamFile;
use crate::style::Style;
use geom::V2;

#[test]
fn a_piece_that_the_user_dismisses_is_left_out_and_the_rest_is_sewn_as_without_it() {
    let mut short = legs(1000.0);
    short[0].name = "TROUSER FRONT SHORT".to_owned();
    short[0].block = short[0].name.clone();
    let pieces = [&short[..1], &legs(1000.0)].concat();
    let found = propose(&pieces);
    let question = found.questions.iter().find(|question| question.text == "which piece is the leg front?");
    let number = question.expect("there are two").number;
    let none = propose_answered(&pieces, &[(number, 'c')]).expect("a choice");
    let ids = |proposal: &Proposal| proposal.worn.iter().map(|worn| worn.id.clone()).collect::<Vec<_>>();
    assert!(ids(&found).iter().any(|id| id.contains("front")), "{:?}", ids(&found));
    assert!(ids(&none).iter().all(|id| !id.contains("front")), "{:?}", ids(&none));
    assert!(none.questions.iter().any(|question| question.number == number && question.is_answered));
    // Another answer instead takes the piece in again.
    let again = propose_answered(&pieces, &[(number, 'c'), (number, 'b')]).expect("a choice");
    assert_eq!(ids(&again), ids(&found));
}

#[test]
fn tapes_alternatives_and_what_no_armhole_takes_are_not_sewn() {
    let check = |extra: Piece, expect: Result<&str, &str>| {
        let pieces = [legs(1000.0), vec![extra.clone()]].concat();
        let with = propose(&pieces);
        let without = propose(&legs(1000.0));
        assert_eq!(with.seams, without.seams, "{}", extra.name);
        match expect {
            Ok(note) => {
                assert!(with.notes.iter().any(|found| found.contains(note)), "{:?}", with.notes);
                with.to_drape().expect("it drapes");
            }
            Err(asked) => {
                let error = with.to_drape().expect_err("it is to be said what it is").to_string();
                assert!(error.contains(asked) && error.contains("nothing that is draped"), "{error}");
                let number =
                    with.questions.iter().find(|question| question.text.contains(asked)).expect("asked").number;
                propose_answered(&pieces, &[(number, 'a')]).expect("a choice").to_drape().expect("it drapes");
            }
        }
    };
    check(strip("BACK TAPE", 200.0, 10.0), Ok("left out: `BACK TAPE`"));
    check(strip("X7", 226.0, 121.0), Err("piece `X7`: what it looks like goes with a trunk"));
    let spare = Piece { quantity: Some("0".to_owned()), ..strip("X8", 400.0, 300.0) };
    check(spare, Ok("left out: `X8`: their quantity is 0"));
}

#[test]
fn a_panel_between_front_and_back_is_sewn_to_both_and_to_the_sleeve() {
    // A tee of which a strip of 60 mm is cut off beside each side, and worn as a panel of both strips.
    let drafts = Model::Tshirt.drafts();
    let tee = &drafts[1].pieces;
    let narrowed = |piece: &Piece| {
        let half = piece.outline.iter().map(|p| p.x).fold(0.0, f64::max);
        let narrow = |p: &mut V2| p.x -= p.x.signum() * 0.06 * (p.x.abs() / half);
        let mut piece = piece.clone();
        piece.outline.iter_mut().chain(&mut piece.turn_points).chain(&mut piece.curve_points).for_each(narrow);
        piece.notches.clear();
        piece
    };
    let (front, back) = (narrowed(&tee[0]), narrowed(&tee[1]));
    let sides = |piece: &Piece| propose(&[piece.clone(), back.clone()]);
    let side_m = sides(&front).seams.iter().find(|seam| seam.entry.name == "side_right").expect("a side").a_mm * 1e-3;
    let hollow = (0..=12).map(|k| {
        let t = f64::from(k) / 12.0;
        V2::new(0.12 * (1.0 - t), side_m - 0.06 * t * (1.0 - t))
    });
    let outline: Vec<V2> = [V2::new(0.0, 0.0), V2::new(0.12, 0.0)].into_iter().chain(hollow).collect();
    let turn_points = vec![outline[0], outline[1], outline[2], outline[14]];
    let panel = |name: &str| Piece {
        name: name.to_owned(),
        block: name.to_owned(),
        outline: outline.clone(),
        turn_points: turn_points.clone(),
        ..Piece::default()
    };
    let check = |name: &str| {
        let found = propose(&[front.clone(), back.clone(), tee[2].clone(), panel(name)]);
        let names: Vec<&str> = found.seams.iter().map(|seam| seam.entry.name.as_str()).collect();
        for seam in ["side_front_right", "side_back_right", "side_front_left", "side_back_left", "armhole_right"] {
            assert!(names.contains(&seam), "{name}: {names:?}, {:?}", found.questions);
        }
        assert!(!names.contains(&"side_right"), "{name}: {names:?}");
        let armhole = found.seams.iter().find(|seam| seam.entry.name == "armhole_right").expect("found");
        let (first, last) = (&armhole.entry.b[0], &armhole.entry.b[armhole.entry.b.len() - 1]);
        assert_eq!([first.as_str(), last.as_str()], ["side_right.armhole_right", "side_right.armhole_left"]);
        let style = Style::of(
            &[front.clone(), back.clone(), tee[2].clone(), panel(name)],
            &SeamFile { length_tolerance_mm: f64::INFINITY, ..found.seam_file("") },
            "",
        );
        let style = style.expect("a style");
        style.mesh(30e-3).expect("a mesh");
        // The panels are as wide as what was cut off, so the chest is that of the tee.
        let chest_m = |style: &Style| {
            let points = style.points_of_measure();
            points.iter().find(|found| found.point == Point::HalfChest).expect("a chest").length_m
        };
        let plain = Style::read(tee, Model::Tshirt.seams(), "seams").expect("a style");
        assert!((chest_m(&style) - chest_m(&plain)).abs() < 6e-3, "{} {}", chest_m(&style), chest_m(&plain));
    };
    check("SIDE PANEL");
    check("\u{4fa7}\u{7247}");
    check("Seitenteil");
}

#[test]
fn a_collar_goes_with_a_trunk_and_a_dart_with_the_waist() {
    // A front and a back with sleeves cut on: their outlines look like legs.
    let cut_on = |name: &str, neck: f64| {
        let points = [(0.0, 0.0, 1), (260.0, 0.0, 1), (260.0, 420.0, 1), (330.0, 480.0, 0), (600.0, 470.0, 1)];
        let top = [(600.0, 600.0, 1), (80.0, 700.0, 1), (40.0, 690.0 - 0.6 * neck, 0), (0.0, 690.0 - neck, 1)];
        piece(name, &[&points[..], &top].concat())
    };
    let pieces = [cut_on("DELANTERO", 90.0), cut_on("ESPALDA", 20.0), strip("CUELLO", 400.0, 60.0)];
    let classes: Vec<Option<Class>> = propose(&pieces).pieces.iter().map(|piece| piece.class).collect();
    assert!(classes.iter().all(|class| matches!(class, None | Some(Class::Body))), "{classes:?}");
    // Half a skirt that lies on its side, without a grain line: the dart is at its waist.
    let lying = |name: &str| {
        let dart = [(0.0, 220.0, 1), (0.0, 150.0, 1), (90.0, 140.0, 1), (0.0, 130.0, 1), (0.0, 0.0, 1)];
        piece(name, &[&dart[..], &[(700.0, 0.0, 1), (700.0, 260.0, 1), (250.0, 255.0, 0)]].concat())
    };
    let found = propose(&[lying("SKIRT FRONT"), lying("SKIRT BACK")]);
    let side = found.seams.iter().find(|seam| seam.entry.name == "skirt_side_right");
    assert!(side.is_some_and(|seam| seam.a_mm > 650.0), "{:?} {:?}", found.seams, found.questions);
}

#[test]
fn a_piece_on_the_fold_is_half_unless_it_was_unfolded() {
    let on_fold = |piece: Piece, is_unfolded: bool| {
        let mut piece = piece;
        piece.texts.push((String::new(), "Cut 1 on fold".to_owned()));
        piece.beside.fold = is_unfolded.then_some([V2::zeros(), V2::y()]);
        piece
    };
    let tee = &Model::Tshirt.drafts()[1].pieces;
    let unfolded: Vec<Piece> = tee.iter().map(|piece| on_fold(piece.clone(), true)).collect();
    assert_eq!(propose(&unfolded).seams, propose(tee).seams);
    // A flared half skirt, with a straight centre and a slanting side.
    let half = |name: &str| {
        let points = [(0.0, 0.0, 1), (420.0, 20.0, 1), (210.0, 700.0, 1), (100.0, 690.0, 0), (0.0, 685.0, 1)];
        on_fold(piece(name, &points), false)
    };
    let found = propose(&[half("SKIRT FRONT"), half("SKIRT BACK")]);
    let names: Vec<&str> = found.seams.iter().map(|seam| seam.entry.name.as_str()).collect();
    assert!(names.contains(&"skirt_centre_front") && names.contains(&"skirt_side_left"), "{names:?}");
}

#[test]
fn a_collar_is_sewn_to_the_neckline_where_the_user_says_so() {
    let tee = &Model::Tshirt.drafts()[1].pieces;
    let plain = propose(tee);
    let style = Style::read(tee, Model::Tshirt.seams(), "seams").expect("a style");
    let neck = style.measurements.iter().find(|measured| measured.name == "Neck Opening").expect("a neckline");
    let neck_mm = neck.l2d_m * 1e3;
    let check = |collar: Piece, is_asked: bool| {
        let pieces = [&tee[..], &[collar]].concat();
        let found = propose(&pieces);
        assert_eq!(found.seams, plain.seams, "left out unless the user says otherwise");
        let question = found.questions.iter().find(|question| question.text.contains("sewn on?"));
        assert_eq!(question.is_some(), is_asked, "{:?}", found.questions);
        let question = question?;
        let sewn = propose_answered(&pieces, &[(question.number, 'b')]).expect("an answer");
        let seam = sewn.seams.iter().find(|seam| seam.entry.name == "collar").expect("a seam");
        assert_eq!(seam.entry.b, ["front.neck_left", "back.neck", "front.neck_right"]);
        assert!((seam.b_mm - neck_mm).abs() < 0.1, "{} {neck_mm}", seam.b_mm);
        assert!(sewn.notes.iter().all(|note| !note.contains("COLLAR")), "{:?}", sewn.notes);
        let style = Style::of(&pieces, &sewn.to_drape().expect("sure").seam_file("a"), "a").expect("a style");
        let mesh = style.mesh(30e-3).expect("a mesh");
        assert!(mesh.pieces.iter().any(|piece| piece.id.starts_with("collar")));
        if question.choices.len() > 2 {
            let ring = propose_answered(&pieces, &[(question.number, 'c')]).expect("an answer");
            let ends = ring.seams.iter().find(|seam| seam.entry.name == "collar_ends").expect("a seam");
            assert!((ends.ratio() - 1.0).abs() < 1e-9 && ring.seams.len() == sewn.seams.len() + 1);
            let style = Style::of(&pieces, &ring.to_drape().expect("sure").seam_file("a"), "a").expect("a style");
            style.mesh(30e-3).expect("a mesh");
        }
        Some(sewn)
    };
    check(strip("COLLAR", neck_mm, 60.0), true);
    // A neckband that is stretched by a tenth is draped once it is confirmed.
    check(strip("NECK BAND", 0.91 * neck_mm, 30.0), true);
    // Half a stand, whose front end slants, drawn for either side of the wearer.
    let half = 0.5 * neck_mm;
    let drawn = [(0.0, 0.0, 1), (half, 10.0, 1), (half - 12.0, 45.0, 1), (0.0, 40.0, 1)];
    let other = [(0.0, 10.0, 1), (half, 0.0, 1), (half, 40.0, 1), (12.0, 45.0, 1)];
    for points in [&drawn, &other] {
        let stand = check(piece("COLLAR STAND", points), true).expect("a proposal");
        let back = stand.seams.iter().find(|seam| seam.entry.name == "collar_back").expect("a seam at the back");
        assert_eq!(back.entry.a, ["collar_left.centre"]);
        assert_eq!(back.a_mm.round(), 40.0, "the square end lies at centre back");
        let neck = stand.seams.iter().find(|seam| seam.entry.name == "collar").expect("a seam");
        assert_eq!(neck.entry.a, ["collar_left.lower", "collar_right.lower"]);
    }
    check(strip("COLLAR STAND", 60.0, 1.05 * neck_mm), true);
    // A rib that is folded in half, a hood.
    check(strip("COLLAR RIB", 0.8 * neck_mm, 40.0), false);
    check(strip("HOOD", 300.0, 350.0), false);
}
