//! Whole garments with yokes, bands, cuffs and details: small patterns of straight lines and a few curve points.

use super::*;
use crate::style::Style;
use geom::V2;

/// Takes vertices in mm; their third number is 1 for a corner.
pub(super) fn piece(name: &str, vertices: &[(f64, f64, u8)]) -> Piece {
    let place = |&(x, y, _): &(f64, f64, u8)| V2::new(x, y) * 1e-3;
    Piece {
        block: name.to_owned(),
        name: name.to_owned(),
        outline: vertices.iter().map(place).collect(),
        turn_points: vertices.iter().filter(|vertex| vertex.2 == 1).map(place).collect(),
        ..Piece::default()
    }
}

pub(super) fn strip(name: &str, length: f64, width: f64) -> Piece {
    piece(name, &[(0.0, 0.0, 1), (length, 0.0, 1), (length, width, 1), (0.0, width, 1)])
}

fn shirt() -> Vec<Piece> {
    let front =
        [(0.0, 0.0, 1), (260.0, 0.0, 1), (260.0, 420.0, 1), (215.0, 440.0, 0), (195.0, 500.0, 0), (190.0, 560.0, 0)];
    let front =
        [&front[..], &[(200.0, 640.0, 1), (80.0, 690.0, 1), (70.0, 640.0, 0), (40.0, 615.0, 0), (0.0, 605.0, 1)]];
    let back = [(0.0, 0.0, 1), (260.0, 0.0, 1), (260.0, 420.0, 1), (220.0, 440.0, 0), (200.0, 500.0, 0)];
    let back = [&back[..], &[(200.0, 560.0, 1), (0.0, 560.0, 1)]];
    let yoke = [(0.0, 0.0, 1), (200.0, 0.0, 1), (200.0, 70.0, 1), (80.0, 120.0, 1), (50.0, 80.0, 0), (0.0, 70.0, 1)];
    vec![
        piece("FRONT", &front.concat()),
        piece("BACK", &back.concat()),
        piece("YOKE", &yoke),
        sleeve(1.0),
        strip("CUFF", 330.0, 60.0),
        strip("POCKET", 110.0, 130.0),
        strip("COLLAR", 210.0, 80.0),
    ]
}

/// `wide` is the width over what the armholes require.
fn sleeve(wide: f64) -> Piece {
    let cap = [(380.0, 300.0, 1), (290.0, 340.0, 0), (230.0, 400.0, 0), (180.0, 420.0, 0)];
    let rest = [(130.0, 400.0, 0), (70.0, 340.0, 0), (-20.0, 300.0, 1)];
    let all = [&[(0.0, 0.0, 1), (360.0, 0.0, 1)][..], &cap, &rest].concat();
    let all: Vec<(f64, f64, u8)> = all.into_iter().map(|(x, y, corner)| (wide * x, y, corner)).collect();
    piece("SLEEVE", &all)
}

/// Half front and half back; `back_waist` is the height of the back, mm.
pub(super) fn legs(back_waist: f64) -> Vec<Piece> {
    let crotch = [(85.0, 850.0, 0), (60.0, 790.0, 0), (10.0, 770.0, 1)];
    let front = [&[(60.0, 0.0, 1), (280.0, 0.0, 1), (300.0, 1000.0, 1), (90.0, 1000.0, 1)][..], &crotch].concat();
    let seat = [(90.0, 850.0, 0), (40.0, 790.0, 0), (-40.0, 770.0, 1)];
    let outer = 290.0 + 0.02 * back_waist;
    let back = [(60.0, 0.0, 1), (290.0, 0.0, 1), (outer, back_waist, 1), (100.0, back_waist + 20.0, 1)];
    vec![piece("TROUSER FRONT", &front), piece("TROUSER BACK", &[&back[..], &seat].concat())]
}

fn seam<'p>(proposal: &'p Proposal, name: &str) -> &'p ProposedSeam {
    let all = || proposal.seams.iter().map(|seam| seam.entry.name.as_str()).collect::<Vec<_>>();
    proposal.seams.iter().find(|seam| seam.entry.name == name).unwrap_or_else(|| panic!("no {name} in {:?}", all()))
}

/// Drapes without questions. Once it is sewn, no piece meets itself, except where `closed` says so.
fn draped(pieces: &[Piece], closed: &[&str]) -> Proposal {
    let proposal = propose(pieces).to_drape().expect("it can be worn");
    let style = Style::read(pieces, proposal.toml("x").as_bytes(), "x").expect("a style");
    let garment = style.mesh(0.05).expect("a mesh");
    let mut meets: Vec<usize> = (0..garment.rest.len()).collect();
    let root = |meets: &[usize], mut v: usize| {
        while meets[v] != v {
            v = meets[v];
        }
        v
    };
    for [a, b] in garment.seams.iter().flat_map(|seam| &seam.pairs) {
        let (a, b) = (root(&meets, *a), root(&meets, *b));
        meets[a] = b;
    }
    for piece in garment.pieces.iter().filter(|piece| !closed.iter().any(|id| piece.id.starts_with(id))) {
        let mut own: Vec<usize> = piece.vertices.clone().map(|v| root(&meets, v)).collect();
        own.sort_unstable();
        let count = own.len();
        own.dedup();
        assert_eq!(own.len(), count, "{} is sewn to itself", piece.id);
    }
    proposal
}

#[test]
fn a_shirt_with_a_yoke_is_sewn_whole_and_its_details_are_left_out() {
    let proposal = draped(&shirt(), &["sleeve", "cuff"]);
    assert_eq!(
        seam(&proposal, "armhole_right").entry.b,
        ["front_right.armhole", "yoke_back_right.armhole", "back_right.armhole"]
    );
    assert_eq!(
        seam(&proposal, "armhole_left").entry.b,
        ["back_left.armhole", "yoke_back_left.armhole", "front_left.armhole"]
    );
    assert_eq!(seam(&proposal, "shoulder_left").entry.b, ["yoke_back_left.shoulder"]);
    let yoke = seam(&proposal, "yoke_back");
    assert!((yoke.a_mm - 400.0).abs() < 1e-6 && (yoke.b_mm - 400.0).abs() < 1e-6, "{yoke:?}");
    for name in ["yoke_centre_back", "cuff_right", "cuff_left_ends", "side_left", "underarm_right"] {
        seam(&proposal, name);
    }
    let roles: Vec<Role> =
        proposal.worn.iter().filter(|worn| worn.id.contains("yoke")).map(|worn| worn.entry.role).collect();
    assert_eq!(roles, [Role::Back; 2]);
    let left_out = proposal.notes.iter().find(|note| note.starts_with("left out")).expect("it is said");
    assert!(left_out.contains("`POCKET`, `COLLAR`"), "{left_out}");
}

#[test]
fn what_cannot_be_sewn_for_sure_is_left_out_where_the_rest_can_be_worn() {
    let mut pieces = shirt();
    pieces[3] = sleeve(2.5);
    let whole = propose(&pieces);
    assert!(whole.pieces.iter().any(|piece| piece.id.as_deref() == Some("sleeve_right")), "a person may sew it");
    let proposal = draped(&pieces, &[]);
    assert!(
        proposal.worn.iter().all(|worn| !worn.id.contains("sleeve") && !worn.id.contains("cuff")),
        "{:?}",
        proposal.seams
    );
    let said = proposal.notes.join("\n");
    assert!(said.contains("left out: `SLEEVE`") && said.contains("left out: `CUFF`"), "{said}");
    // Nothing else can be spared.
    for (gone, expect) in [("BACK", "side_right"), ("FRONT", "side_right"), ("YOKE", "shoulder_right")] {
        let rest: Vec<Piece> = shirt().into_iter().filter(|piece| piece.name != gone).collect();
        let error = propose(&rest).to_drape().expect_err(gone).to_string();
        assert!(error.contains(expect), "{gone}: {error}");
    }
    // Two garments are not sewn as one.
    let skirt = ["SKIRT FRONT", "SKIRT BACK"].map(|name| strip(name, 420.0, 500.0));
    let error = propose(&[&skirt[..], &legs(1000.0)].concat()).to_drape().expect_err("two garments").to_string();
    assert!(error.contains("no seam joins"), "{error}");
}

#[test]
fn waistbands_go_round_however_they_are_cut() {
    let with = |bands: &[Piece]| [&legs(1000.0)[..], bands].concat();
    // One band all round, from centre front.
    let round = draped(&with(&[strip("WAISTBAND", 880.0, 40.0)]), &["waistband"]);
    let waist = ["leg_front_left.waist", "leg_back_left.waist", "leg_back_right.waist", "leg_front_right.waist"];
    assert_eq!(seam(&round, "waist").entry.b, waist);
    assert!((seam(&round, "waistband").a_mm - 40.0).abs() < 1e-6);
    // A right and a left band, by two pieces or by one cut twice.
    for bands in
        [&[strip("WAISTBAND1", 430.0, 40.0), strip("WAISTBAND2", 460.0, 40.0)][..], &[strip("WAISTBAND", 430.0, 40.0)]]
    {
        let two = draped(&with(bands), &[]);
        assert_eq!(seam(&two, "waist_right").entry.b, [waist[2], waist[3]]);
        assert_eq!(seam(&two, "waist_left").entry.b, [waist[0], waist[1]]);
        assert!(seam(&two, "waistband_front").entry.a[0].starts_with("waistband_right"));
        seam(&two, "waistband_back");
    }
    // A band that fits nothing is left out. Of two that go all round, one is taken.
    let none = draped(&with(&[strip("WAISTBAND", 1500.0, 40.0)]), &[]);
    assert!(none.notes.iter().any(|note| note.contains("left out: `WAISTBAND`")), "{:?}", none.notes);
    let outer =
        draped(&with(&[strip("WAISTBAND OUTER", 1000.0, 40.0), strip("WAISTBAND INNER", 850.0, 40.0)]), &["waistband"]);
    assert!((seam(&outer, "waist").a_mm - 850.0).abs() < 1e-6);
    assert!(
        outer.questions.iter().any(|question| question
            .to_string()
            .contains("b: WAISTBAND INNER; c: none of these: left out (b is taken)")),
        "{:?}",
        outer.questions
    );
}

#[test]
fn a_yoke_on_legs_lies_between_them_and_the_waistband() {
    let yoke = piece("BACK YOKE", &[(0.0, 0.0, 1), (210.0, 0.0, 1), (210.0, 100.0, 1), (5.0, 120.0, 1)]);
    let proposal = draped(&[legs(900.0), vec![yoke, strip("WAISTBAND", 850.0, 40.0)]].concat(), &["waistband"]);
    assert_eq!(seam(&proposal, "outseam_right").entry.b, ["yoke_back_right.side", "leg_back_right.outseam"]);
    assert_eq!(seam(&proposal, "outseam_left").entry.b, ["leg_back_left.outseam", "yoke_back_left.side"]);
    assert_eq!(seam(&proposal, "crotch_back").entry.a, ["yoke_back_right.centre", "leg_back_right.crotch"]);
    let round = ["leg_front_left.waist", "yoke_back_left.waist", "yoke_back_right.waist", "leg_front_right.waist"];
    assert_eq!(seam(&proposal, "waist").entry.b, round);
}

#[test]
fn of_several_pieces_for_one_place_the_one_that_fits_is_taken() {
    let mut pieces = legs(1000.0);
    let mut short = pieces[0].clone();
    short.name = "TROUSER FRONT SHORT".to_owned();
    short.block = short.name.clone();
    short.outline.iter_mut().chain(&mut short.turn_points).for_each(|p| p.y *= 0.9);
    pieces.insert(0, short);
    let proposal = draped(&pieces, &[]);
    let fronts: Vec<&str> =
        proposal.worn.iter().filter(|worn| worn.id.contains("front")).map(|worn| worn.entry.block.as_str()).collect();
    assert_eq!(fronts, ["TROUSER FRONT"; 2]);
    assert!(
        proposal
            .questions
            .iter()
            .any(|question| question.to_string().contains("b: TROUSER FRONT; c: none of these: left out (b is taken)")),
        "{:?}",
        proposal.questions
    );
}

#[test]
fn half_of_a_sleeve_in_two_is_not_taken_for_a_sleeve() {
    let mut pieces = shirt();
    let named = |name: &str| Piece { name: name.to_owned(), block: name.to_owned(), ..sleeve(0.5) };
    pieces.splice(3..4, [named("TOPSLEEVE"), named("UNDERSLEEVE")]);
    let proposal = draped(&pieces, &[]);
    assert!(proposal.worn.iter().all(|worn| !worn.id.contains("sleeve")), "{:?}", proposal.worn);
    let said: String = proposal.questions.iter().map(Question::to_string).collect();
    assert!(said.contains("left out: `TOPSLEEVE`, `UNDERSLEEVE`: a sleeve in two pieces"), "{said}");
}

#[test]
fn a_dart_that_is_widest_inside_is_one_dart() {
    // Open to the hem by a slit, 200 mm up to its waist, 150 mm on to its tip.
    let slit =
        [(100.0, 0.0, 1), (100.0, 60.0, 1), (90.0, 200.0, 1), (101.0, 350.0, 1), (112.0, 200.0, 1), (102.0, 60.0, 1)];
    let front = [
        &[(0.0, 0.0, 1)][..],
        &slit,
        &[(102.0, 0.0, 1), (260.0, 0.0, 1), (260.0, 200.0, 0), (260.0, 420.0, 1), (0.0, 420.0, 1)],
    ];
    let shape = shape::Shape::of(&piece("x", &front.concat())).expect("corners");
    let [dart] = shape.darts() else { panic!("{:?}", shape.darts()) };
    assert_eq!((dart.apex, dart.span), (4, 3));
    assert_eq!((0..shape.len()).filter(|&edge| shape.is_leg(edge)).collect::<Vec<_>>(), [1, 2, 3, 4, 5, 6]);
    assert_eq!((0..shape.len()).filter(|&corner| shape.is_in_dart(corner)).collect::<Vec<_>>(), [2, 3, 4, 5, 6]);
    assert!((shape.sewn_length(0, 8) - 0.258).abs() < 1e-9, "the hem is measured without it");
}

#[test]
fn gores_are_sewn_all_round_and_to_their_band() {
    let gore = |name: &str, quantity: &str| Piece {
        quantity: Some(quantity.to_owned()),
        ..piece(name, &[(0.0, 0.0, 1), (240.0, 0.0, 1), (170.0, 600.0, 1), (70.0, 600.0, 1)])
    };
    // One edge for each gore, as GarmentCode has it.
    let half_band = |name: &str| {
        let lower: Vec<(f64, f64, u8)> = (0..=4).map(|k| (100.0 * f64::from(k), 0.0, 1)).collect();
        piece(name, &[&lower[..], &[(400.0, 40.0, 1), (0.0, 40.0, 1)]].concat())
    };
    let check = |pieces: &[Piece], gores: usize, others: &[&str]| {
        let proposal = propose(pieces);
        let sides = (1..=gores).map(|k| format!("skirt_side_{k}"));
        let mut expected: Vec<String> = sides.chain(others.iter().map(|name| (*name).to_owned())).collect();
        let mut names: Vec<String> = proposal.seams.iter().map(|seam| seam.entry.name.clone()).collect();
        expected.sort_unstable();
        names.sort_unstable();
        assert_eq!(names, expected, "{:?}", proposal.questions);
        assert!(proposal.seams.iter().all(|seam| seam.confidence > 0.6), "{:?}", proposal.seams);
        let text = proposal.to_drape().expect("it is sure").toml("gores");
        let style =
            Style::read(pieces, text.as_bytes(), "gores.toml").unwrap_or_else(|error| panic!("{error}\n{text}"));
        let garment = style.mesh(0.03).expect("a mesh");
        // A closed tube: every gore is sewn to two others.
        let open = garment.pieces.iter().filter(|piece| piece.id.starts_with("skirt")).count();
        assert_eq!(open, gores);
    };
    check(&[gore("GORE", "8"), strip("WAISTBAND", 800.0, 40.0)], 8, &["waist"]);
    check(&[gore("SKIRT GORE", "3,3")], 6, &[]);
    let numbered: Vec<Piece> = (0..8).map(|k| gore(&format!("panel_{k}"), "1")).collect();
    let banded = [numbered, vec![half_band("wb_front"), half_band("wb_back")]].concat();
    check(&banded, 8, &["waist_back_1", "waist_front_1", "waistband_left", "waistband_right"]);
}

fn mirrored(name: &str, vertices: &[(f64, f64, u8)]) -> Piece {
    let turned: Vec<(f64, f64, u8)> = vertices.iter().rev().map(|&(x, y, corner)| (-x, y, corner)).collect();
    piece(name, &turned)
}

#[test]
fn a_raglan_sleeve_is_sewn_to_front_and_back_up_to_the_neck() {
    let trunk = |name: &str, top: f64, neck: f64| {
        let right = [(260.0, 0.0, 1), (260.0, 420.0, 1), (215.0, 440.0, 0), (80.0, top, 1)];
        let left: Vec<(f64, f64, u8)> = right.iter().rev().map(|&(x, y, corner)| (-x, y, corner)).collect();
        piece(name, &[&right[..], &[(0.0, neck, 0)], &left].concat())
    };
    // The front up to 640 mm, the back up to 690; the left side of the sleeve is the longer one.
    let sleeve = [(160.0, 0.0, 1), (200.0, 300.0, 1), (155.0, 320.0, 0), (30.0, 525.0, 1), (-30.0, 570.0, 1)];
    let sleeve = [&sleeve[..], &[(-155.0, 320.0, 0), (-200.0, 300.0, 1), (-160.0, 0.0, 1)]].concat();
    let check = |sleeve: Piece| {
        let proposal = draped(&[trunk("FRONT", 640.0, 560.0), trunk("BACK", 690.0, 670.0), sleeve], &["sleeve"]);
        for hand in ["right", "left"] {
            for face in ["front", "back"] {
                let seam = seam(&proposal, &format!("raglan_{face}_{hand}"));
                assert_eq!(seam.entry.b, [format!("{face}.armhole_{hand}")]);
                assert!((seam.ratio() - 1.0).abs() < 0.03, "{seam:?}");
            }
        }
        assert!(!proposal.seams.iter().any(|seam| seam.entry.name.contains("shoulder")));
    };
    // As drawn, the shorter side, which is the front's, is on the right: a right sleeve. Its mirror image is a left
    // one.
    check(piece("RAGLAN SLEEVE", &sleeve));
    check(mirrored("SLEEVE", &sleeve));
}

#[test]
fn a_cowl_that_rises_in_the_middle_is_a_neck_all_along() {
    let trunk = |name: &str, half: &[(f64, f64, u8)], neck: (f64, f64, u8)| {
        let left: Vec<(f64, f64, u8)> = half.iter().rev().map(|&(x, y, corner)| (-x, y, corner)).collect();
        piece(name, &[half, &[neck], &left].concat())
    };
    let low = [(250.0, 0.0, 1), (205.0, 130.0, 1), (255.0, 310.0, 1), (238.0, 335.0, 0)];
    let front = [&low[..], &[(260.0, 430.0, 0), (295.0, 525.0, 1), (250.0, 553.0, 1)]].concat();
    let back = [&low[..], &[(225.0, 430.0, 0), (215.0, 520.0, 1), (165.0, 538.0, 1)]].concat();
    let pieces = [trunk("FRONT", &front, (0.0, 620.0, 1)), trunk("BACK", &back, (0.0, 520.0, 1))];
    let proposal = draped(&pieces, &["side", "shoulder"]);
    let shoulders = ["shoulder_right", "shoulder_left"].map(|name| seam(&proposal, name).a_mm);
    assert!((shoulders[0] - shoulders[1]).abs() < 1e-6 && shoulders[0] < 60.0, "{shoulders:?}");
    let front = &proposal.worn.iter().find(|worn| worn.id == "front").expect("a front").entry;
    assert_eq!(front.edges.keys().filter(|edge| edge.starts_with("neck")).count(), 1, "{:?}", front.edges);
}

#[test]
fn without_its_sleeves_a_raglan_cannot_be_worn() {
    let half =
        [(0.0, 0.0, 1), (260.0, 0.0, 1), (260.0, 420.0, 1), (215.0, 440.0, 0), (80.0, 640.0, 1), (0.0, 560.0, 1)];
    let sleeve = [(160.0, 0.0, 1), (200.0, 600.0, 1), (155.0, 620.0, 0), (30.0, 1125.0, 1), (-30.0, 1125.0, 1)];
    let sleeve = [&sleeve[..], &[(-155.0, 620.0, 0), (-200.0, 600.0, 1), (-160.0, 0.0, 1)]].concat();
    let pieces = [piece("FRONT", &half), piece("BACK", &half), piece("SLEEVE", &sleeve)];
    let reason = propose(&pieces).to_drape().expect_err("sleeves twice as high as the trunk").reason;
    assert!(reason.contains("raglan_front_right"), "{reason}");
}

/// Half a front cut by a princess seam from the shoulder or the armhole, its middle first, and a half back.
fn princess(from_shoulder: bool) -> [Piece; 3] {
    let neck = [(80.0, 690.0, 1), (70.0, 640.0, 0), (40.0, 615.0, 0), (0.0, 605.0, 1), (0.0, 0.0, 1), (120.0, 0.0, 1)];
    let (middle, side) = if from_shoulder {
        (vec![(130.0, 300.0, 0), (140.0, 665.0, 1)], vec![(190.0, 560.0, 0), (200.0, 640.0, 1), (140.0, 665.0, 1)])
    } else {
        (vec![(130.0, 250.0, 0), (195.0, 500.0, 1), (190.0, 560.0, 0), (200.0, 640.0, 1)], vec![])
    };
    let low = [(120.0, 0.0, 1), (260.0, 0.0, 1), (260.0, 420.0, 1), (215.0, 440.0, 0)];
    let bust = [(195.0, 500.0, u8::from(!from_shoulder))];
    let back = [(0.0, 0.0, 1), (260.0, 0.0, 1), (260.0, 420.0, 1), (215.0, 440.0, 0), (195.0, 500.0, 0)];
    let back_top = [(190.0, 560.0, 0), (200.0, 640.0, 1), (80.0, 690.0, 1), (50.0, 680.0, 0), (0.0, 675.0, 1)];
    [
        piece("FRONT INSIDE", &[&neck[..], &middle].concat()),
        piece("FRONT OUTSIDE", &[&low[..], &bust, &side, &[(103.0, 280.0, 0)]].concat()),
        piece("BACK", &[&back[..], &back_top].concat()),
    ]
}

#[test]
fn princess_seams_are_sewn_from_the_shoulder_or_the_armhole() {
    let check = |from_shoulder: bool, shoulder: &[&str], armhole: &[&str]| {
        let mut pieces = princess(from_shoulder).to_vec();
        pieces.push(sleeve(1.0));
        let proposal = draped(&pieces, &["sleeve"]);
        assert_eq!(seam(&proposal, "princess_front_right").entry.a, ["side_front_right.princess"]);
        assert_eq!(seam(&proposal, "princess_front_left").entry.b, ["front_left.princess"]);
        assert_eq!(seam(&proposal, "side_right").entry.a, ["side_front_right.side"]);
        assert_eq!(seam(&proposal, "shoulder_right").entry.a, shoulder);
        assert_eq!(seam(&proposal, "armhole_right").entry.b, armhole);
        let roles = proposal.worn.iter().filter(|worn| worn.id.contains("front")).map(|worn| worn.entry.role);
        assert!(roles.eq([Role::Front; 4]));
    };
    let [side, middle, back] = ["side_front_right.armhole", "front_right.armhole", "back_right.armhole"];
    check(true, &["front_right.shoulder", "side_front_right.shoulder"], &[side, back]);
    check(false, &["front_right.shoulder"], &[side, middle, back]);
}

#[test]
fn two_whole_fronts_are_no_panels() {
    let [_, _, back] = princess(true);
    let front = &shirt()[0];
    let pockets = Piece { block: "POCKETS".to_owned(), name: "FRONT WITH POCKETS".to_owned(), ..front.clone() };
    let proposal = draped(&[front.clone(), pockets, back], &[]);
    assert!(!proposal.seams.iter().any(|seam| seam.entry.name.contains("princess")));
}

#[test]
fn outlines_as_long_as_each_other_along_their_seams_are_what_they_look_like() {
    let front = [(0.0, 0.0, 1), (260.0, 0.0, 1), (260.0, 420.0, 1), (215.0, 440.0, 0), (195.0, 500.0, 0)];
    let front = [&front[..], &[(190.0, 560.0, 0), (200.0, 640.0, 1), (80.0, 690.0, 1)]].concat();
    let front = [&front[..], &[(70.0, 640.0, 0), (40.0, 615.0, 0), (0.0, 605.0, 1)]].concat();
    // The lengths of its side and of its shoulder more than the front's.
    let back = |side: f64, shoulder: f64| {
        let lower = [(0.0, 0.0, 1), (260.0, 0.0, 1), (260.0, 420.0 + side, 1), (222.0, 440.0, 0), (205.0, 500.0, 0)];
        let upper =
            [(200.0, 560.0, 0), (205.0, 640.0, 1), (85.0 - shoulder, 690.0, 1), (55.0, 672.0, 0), (0.0, 665.0, 1)];
        piece("DETAIL", &[&lower[..], &upper].concat())
    };
    let sure = |side: f64, shoulder: f64| {
        let proposal = propose(&[piece("DETAIL", &front), back(side, shoulder)]);
        (seam(&proposal, "side_right").confidence, proposal.to_drape().is_ok())
    };
    let [both, one, none] = [(0.0, 0.0), (0.0, 2.0), (2.0, 2.0)].map(|(side, shoulder)| sure(side, shoulder));
    assert!(both.0 > one.0 + 0.05 && one.0 > none.0 + 0.05, "{both:?}, {one:?}, {none:?}");
    assert!(both.1 && !none.1, "{both:?}, {none:?}");
}

#[test]
fn a_vent_beside_the_side_seam_belongs_to_the_side() {
    // Between side and armhole of the back lies a step of 20 mm that its outline gives to either.
    let mut pieces = shirt();
    let back =
        [(0.0, 0.0, 1), (260.0, 0.0, 1), (260.0, 400.0, 1), (260.0, 420.0, 1), (215.0, 440.0, 0), (195.0, 500.0, 0)];
    let top = [(190.0, 560.0, 0), (200.0, 640.0, 1), (80.0, 690.0, 1), (40.0, 675.0, 0), (0.0, 670.0, 1)];
    pieces.retain(|piece| piece.name != "YOKE");
    pieces[1] = piece("BACK", &[&back[..], &top].concat());
    let proposal = propose(&pieces);
    for name in ["side_right", "side_left"] {
        let side = seam(&proposal, name);
        assert!((side.a_mm - side.b_mm).abs() < 0.1, "{side:?}");
    }
}

#[test]
fn a_front_and_a_back_are_of_one_kind_and_a_sleeve_is_worn_with_a_trunk() {
    let pieces: Vec<Piece> = shirt().into_iter().filter(|piece| piece.name != "YOKE" && piece.name != "CUFF").collect();
    let called = |names: [&str; 3]| {
        let mut pieces = pieces.clone();
        let shaped = [(260.0, 420.0, 1), (215.0, 440.0, 0), (190.0, 560.0, 0), (200.0, 640.0, 1), (80.0, 690.0, 1)];
        let back = [&[(0.0, 0.0, 1), (260.0, 0.0, 1)][..], &shaped, &[(40.0, 675.0, 0), (0.0, 670.0, 1)]].concat();
        pieces[1] = piece("BACK", &back);
        pieces.truncate(3);
        for (piece, name) in pieces.iter_mut().zip(names) {
            (piece.name, piece.block) = (name.to_owned(), name.to_owned());
        }
        propose(&pieces).pieces.iter().filter_map(|piece| piece.id.clone()).collect::<Vec<_>>()
    };
    let expect = ["front_left", "front_right", "back_right", "back_left", "sleeve_right", "sleeve_left"];
    let mut found = called(["AX17FR", "AX17BK", "AX17SL"]);
    found.sort();
    let mut expect: Vec<String> = expect.map(str::to_owned).to_vec();
    expect.sort();
    assert_eq!(found, expect);
}

#[test]
fn an_answer_decides_what_was_asked() {
    let mut pieces = legs(1000.0);
    let mut short = pieces[0].clone();
    short.name = "TROUSER FRONT SHORT".to_owned();
    short.block = short.name.clone();
    short.outline.iter_mut().chain(&mut short.turn_points).for_each(|p| p.y *= 0.99);
    pieces.insert(0, short);
    let front = |given: &[(usize, char)]| {
        let proposal = propose_answered(&pieces, given).expect("it is asked");
        let asked: Vec<(usize, bool)> = proposal.questions.iter().map(|q| (q.number, q.is_answered)).collect();
        let front = proposal.worn.iter().find(|worn| worn.id.contains("front")).expect("a front");
        (front.entry.block.clone(), asked)
    };
    let (stands, asked) = front(&[]);
    assert_eq!((stands.as_str(), asked.as_slice()), ("TROUSER FRONT", &[(1, false)][..]));
    let (taken, asked) = front(&[(1, 'a')]);
    assert_eq!((taken.as_str(), asked.as_slice()), ("TROUSER FRONT SHORT", &[(1, true)][..]));
    for (number, letter, accepted) in [(7, 'a', "a question of 1"), (1, 'z', "b: TROUSER FRONT")] {
        let told = propose_answered(&pieces, &[(number, letter)]).expect_err("nothing of the kind").to_string();
        assert!(told.contains(accepted), "{told}");
    }
}

#[test]
fn what_nothing_tells_is_what_a_person_says() {
    let mut pieces = shirt();
    pieces.push(strip("X", 450.0, 45.0));
    let proposal = propose(&pieces);
    let question = proposal.questions.iter().find(|question| question.text.contains("`X`")).expect("it is asked");
    let band = question.choices.iter().position(|choice| choice == "waistband").expect("it is a choice");
    let answered = propose_answered(&pieces, &[(question.number, Question::letter(band))]).expect("it is asked");
    let class =
        |proposal: &Proposal| proposal.pieces.iter().find(|piece| piece.name == "X").and_then(|piece| piece.class);
    assert_eq!((class(&proposal), class(&answered)), (None, Some(Class::Waistband)));
}

#[test]
fn a_leg_in_one_piece_is_sewn_to_itself_and_to_the_other() {
    let outline = [
        (90.0, 0.0, 1),
        (310.0, 0.0, 1),
        (420.0, 700.0, 1),
        (345.0, 760.0, 0),
        (330.0, 900.0, 1),
        (60.0, 930.0, 1),
        (30.0, 770.0, 0),
        (-60.0, 700.0, 1),
    ];
    let check = |name: &str, mirrored: bool, front: &str| {
        let width = 400.0;
        let turned = |&(x, y, c): &(f64, f64, u8)| if mirrored { (width - x, y, c) } else { (x, y, c) };
        let mut vertices: Vec<(f64, f64, u8)> = outline.iter().map(turned).collect();
        if mirrored {
            vertices.reverse();
        }
        let pieces = [piece(name, &vertices), strip("WAISTBAND", 543.3, 50.0)];
        let proposal = draped(&pieces, &["waistband", "leg"]);
        let edges = |kind: &str| (seam(&proposal, kind).entry.a.clone(), seam(&proposal, kind).entry.b.clone());
        let text = |names: [&str; 2]| names.map(|name| vec![name.to_owned()]);
        assert_eq!(<[_; 2]>::from(edges("inseam_right")), text(["leg_right.inseam_right", "leg_right.inseam_left"]));
        assert_eq!(<[_; 2]>::from(edges("crotch_front")), text(["leg_right.crotch_right", "leg_left.crotch_left"]));
        assert_eq!(<[_; 2]>::from(edges("crotch_back")), text(["leg_right.crotch_left", "leg_left.crotch_right"]));
        assert_eq!(edges("waist").1, ["leg_left.waist", "leg_right.waist"]);
        let is_drawn = |id: &str| proposal.worn.iter().any(|worn| worn.id == id && !worn.entry.mirror);
        assert!(is_drawn(front), "{name}: drawn as the {front}");
    };
    check("LEGGING", false, "leg_right");
    check("LEG", true, "leg_left");
}
