use std::path::PathBuf;

use super::{Point, PointOfMeasure, Stand};
use crate::draft::Model;
use crate::dxf::Unit;
use crate::source::{self, Kind};
use crate::{Handle, Style, garmentcode, propose};
use geom::V2;
use geom::units::mm;

const STAND: Stand = Stand {
    side_neck_m: 1.50,
    underbust_m: 1.20,
    waist_m: 1.10,
    hip_m: 0.875,
    crotch_m: 0.80,
    knee_m: 0.48,
    forearm_along_m: 0.38,
    wrist_along_m: 0.60,
};

/// Expects lengths in mm.
fn check(what: &str, style: &Style, within_mm: f64, expect: &[(Point, f64)]) {
    let points = style.points_of_measure();
    for (point, expect_mm) in expect {
        let found = points.iter().find(|measure| measure.point == *point).map(|measure| mm(measure.length_m));
        let is_it = found.is_some_and(|found| (found - expect_mm).abs() <= within_mm);
        assert!(is_it, "{what}: {} is {found:?}, by hand {expect_mm}", point.as_str());
    }
}

fn drafted(model: Model, size: usize) -> Style {
    let draft = model.drafts().swap_remove(size);
    Style::read(&draft.pieces, model.seams(), "seams").expect("our own draft")
}

fn piece(block: &str, outline: &[[f64; 2]]) -> crate::Piece {
    let points: Vec<V2> = outline.iter().map(|[u, v]| V2::new(*u, *v)).collect();
    crate::Piece {
        block: block.to_owned(),
        name: block.to_owned(),
        outline: points.clone(),
        turn_points: points,
        ..crate::Piece::default()
    }
}

fn width_mm(outline: &[V2], v: f64) -> f64 {
    let sides = outline.iter().zip(outline.iter().cycle().skip(1));
    let crossed = sides.filter(|(a, b)| (a.y <= v) != (b.y <= v));
    let mut at: Vec<f64> = crossed.map(|(a, b)| a.x + (b.x - a.x) * (v - a.y) / (b.y - a.y)).collect();
    at.sort_by(f64::total_cmp);
    at.chunks(2).map(|pair| mm(pair[1] - pair[0])).sum()
}

#[test]
fn drafted_styles_have_the_lengths_that_they_were_drafted_from() {
    use Point::*;
    for (size, published) in [
        [974.10, 356.53, 550.76, 704.96, 503.71, 560.09, 458.95, 156.67, 119.18],
        [1034.10, 366.53, 560.76, 719.96, 527.34, 569.46, 463.95, 166.01, 130.68],
        [1094.10, 376.53, 570.76, 734.96, 551.55, 578.89, 468.96, 175.44, 142.55],
    ]
    .into_iter()
    .enumerate()
    {
        let [hem, opening, front, back, armhole, neck, _, shoulder, _] = published;
        let style = drafted(Model::Tshirt, size);
        let expect = [
            (HalfChest, hem / 2.0),
            (HalfHem, hem / 2.0),
            (HalfCuff, opening / 2.0),
            (CentreFrontLength, front),
            (CentreBackLength, back),
            // The high points lie 22 mm above the back neck.
            (BackLength, back + 22.0),
            (FrontLength, back + 22.0),
            (BackNeckDrop, 22.0),
            (FrontNeckDrop, back + 22.0 - front),
            (Armhole, armhole),
            (Neck, neck),
            (Shoulder, shoulder),
        ];
        check("T-shirt", &style, 0.1, &expect);
    }
    for (size, [front, back, inseam, outseam, waist, hem]) in [
        [239.00, 357.53, 719.10, 956.48, 981.48, 441.66],
        [239.09, 357.60, 747.49, 984.92, 1001.36, 441.66],
        [252.24, 377.71, 788.12, 1037.83, 1031.43, 461.62],
    ]
    .into_iter()
    .enumerate()
    {
        let expect = [
            (FrontRise, front),
            (BackRise, back),
            (Inseam, inseam),
            (Outseam, outseam),
            (HalfWaist, waist / 2.0),
            (HalfLegOpening, hem / 2.0),
            // Drafted 40 mm wider than the waist, 75 mm above the fork.
            (HalfHip, waist / 2.0 + 20.0),
        ];
        let within_mm = 1.0;
        check("trousers", &drafted(Model::Trousers, size), within_mm, &expect);
    }
    let expect = [
        (HalfHem, 518.2),
        (HalfWaist, 552.12),
        (CentreFrontLength, 722.84),
        (CentreBackLength, 768.79),
        (Armhole, 437.95),
        (Neck, 600.22),
        (Shoulder, 58.41),
        (BackNeckDrop, 45.0),
    ];
    check("dress", &drafted(Model::Dress, 0), 0.1, &expect);
}

#[test]
fn widths_are_those_of_the_outlines() {
    use Point::*;
    for model in [Model::Tshirt, Model::Teetop] {
        for size in 0..model.drafts().len() {
            let style = drafted(model, size);
            let piece = |id: &str| style.pieces.iter().find(|piece| piece.id == id).expect("it is drafted");
            let [front, back, sleeve] = ["front", "back", "sleeve_right"].map(|id| piece(id).outline());
            let edge = |id: &str, name: &str| {
                let piece = piece(id);
                let edge = piece.edges.iter().find(|edge| edge.name.as_deref() == Some(name)).expect("it is named");
                edge.line.points().to_vec()
            };
            // Sides are straight and upright.
            let underarm = edge("front", "side_left").iter().map(|p| p.y).fold(f64::MIN, f64::max);
            let chest = width_mm(&front, underarm - 0.025) + width_mm(&back, underarm - 0.025);
            let armhole = edge("back", "armhole_right");
            let [tip, low] = [f64::MIN, f64::MAX].map(|from| {
                let heights = armhole.iter().map(|p| p.y);
                if from < 0.0 { heights.fold(from, f64::max) } else { heights.fold(from, f64::min) }
            });
            let across_back = width_mm(&back, 0.5 * (tip + low));
            let seam = edge("sleeve_right", "underarm_front");
            let (from, to) = (seam[0], seam[seam.len() - 1]);
            let [upper, lower] = if from.y > to.y { [from, to] } else { [to, from] };
            let below = upper + (lower - upper).normalize() * 0.025;
            let bicep = width_mm(&sleeve, below.y);
            let expect = [(HalfChest, chest / 2.0), (AcrossBack, across_back), (HalfBicep, bicep / 2.0)];
            check(model.as_str(), &style, 0.5, &expect);
        }
    }
}

#[test]
fn a_girth_taken_through_a_dart_leaves_the_dart_out() {
    // A tube of two panels with a dart in the front. The cloth inside the dart is not measured.
    let seams = r#"
        name = "tube"
        piece.front = { block = "F", role = "front", edges = { hem = [0, 1], da = [1, 2], db = [2, 3], hem_2 = [3, 4], side_left = [4, 5], neck = [5, 6], side_right = [6, 0] } }
        piece.back = { block = "B", role = "back", edges = { hem = [0, 1], side_right = [1, 2], neck = [2, 3], side_left = [3, 0] } }
        seam = [
            { name = "left", a = ["front.side_left"], b = ["back.side_left"] },
            { name = "right", a = ["front.side_right"], b = ["back.side_right"] },
            { name = "dart", a = ["front.da"], b = ["front.db"] },
        ]
    "#;
    let front = [[-0.25, 0.0], [-0.02, 0.0], [0.0, 0.3], [0.02, 0.0], [0.25, 0.0], [0.25, 0.4], [-0.25, 0.4]];
    let back = [[-0.2, 0.0], [0.2, 0.0], [0.2, 0.4], [-0.2, 0.4]];
    let style = Style::read(&[piece("F", &front), piece("B", &back)], seams.as_bytes(), "tube").expect("it is sewn");
    let points = style.points_of_measure();
    let flat_mm =
        |point: Point| points.iter().find(|measure| measure.point == point).map(|measure| mm(measure.length_m));
    let chest_mm = flat_mm(Point::HalfChest).expect("it has sides");
    assert!((chest_mm - 450.0).abs() < 1e-6, "above the dart: {chest_mm}");
    assert!((flat_mm(Point::HalfHem).expect("it has a hem") - 430.0).abs() < 1e-6, "without the dart's mouth");
    let mouth_mm = 40.0 * (0.3 - 0.22) / 0.3;
    assert!(
        (flat_mm(Point::HalfWaist).expect("180 mm below") - (450.0 - 0.5 * mouth_mm)).abs() < 1e-6,
        "through the dart"
    );
}

#[test]
fn the_centre_of_halves_goes_on_over_a_whole_skirt_with_a_round_waist() {
    let seams = r#"
        name = "dress"
        piece.front_left = { block = "FL", role = "bodice_front", edges = { waist = [0, 1], side = [1, 2], armhole = [2, 3], shoulder = [3, 4], neck = [4, 5], centre = [5, 0] } }
        piece.front_right = { block = "FL", role = "bodice_front", mirror = true, edges = { waist = [0, 1], side = [1, 2], armhole = [2, 3], shoulder = [3, 4], neck = [4, 5], centre = [5, 0] } }
        piece.back_right = { block = "FL", role = "bodice_back", edges = { waist = [0, 1], side = [1, 2], armhole = [2, 3], shoulder = [3, 4], neck = [4, 5], centre = [5, 0] } }
        piece.back_left = { block = "FL", role = "bodice_back", mirror = true, edges = { waist = [0, 1], side = [1, 2], armhole = [2, 3], shoulder = [3, 4], neck = [4, 5], centre = [5, 0] } }
        piece.skirt_front = { block = "S", role = "skirt_front", edges = { hem = [0, 1], side_right = [1, 2], waist_right = [2, 3], waist_left = [3, 4], side_left = [4, 0] } }
        seam = [
            { name = "cf", a = ["front_left.centre"], b = ["front_right.centre"] },
            { name = "cb", a = ["back_left.centre"], b = ["back_right.centre"] },
            { name = "sl", a = ["front_left.side"], b = ["back_left.side"] },
            { name = "sr", a = ["front_right.side"], b = ["back_right.side"] },
            { name = "hl", a = ["front_left.shoulder"], b = ["back_left.shoulder"] },
            { name = "hr", a = ["front_right.shoulder"], b = ["back_right.shoulder"] },
            { name = "wl", a = ["front_left.waist"], b = ["skirt_front.waist_right"] },
            { name = "wr", a = ["front_right.waist"], b = ["skirt_front.waist_left"] },
        ]
    "#;
    let half = [[0.0, 0.0], [0.2, 0.0], [0.22, 0.2], [0.18, 0.38], [0.08, 0.42], [0.0, 0.34]];
    // The waist falls steeply to its middle, as that of a circle skirt does.
    let (up, out) = (0.2 * 0.8, 0.2 * 0.6);
    let skirt = [[-0.6, 0.0], [0.6, 0.0], [out, 0.5 + up], [0.0, 0.5], [-out, 0.5 + up]];
    let style = Style::read(&[piece("FL", &half), piece("S", &skirt)], seams.as_bytes(), "dress").expect("it is sewn");
    // 340 mm of the bodice, 500 of the skirt; 1 mm beside its middle the waist is a little higher.
    check("dress", &style, 2.0, &[(Point::CentreFrontLength, 840.0), (Point::CentreBackLength, 340.0)]);
}

#[test]
fn a_skirt_of_one_piece_has_a_waist_and_a_hem() {
    let band = r#"
        piece.waistband = { block = "B", role = "waistband", edges = { lower = [0, 1], end_right = [1, 2], top = [2, 3], end_left = [3, 0] } }
        seam = [
            { name = "side", a = ["skirt.side_right"], b = ["skirt.side_left"] },
            { name = "waist", a = ["waistband.lower"], b = ["skirt.waist"], ease_mm = 20.0 },
        ]"#;
    let alone = r#"seam = [{ name = "side", a = ["skirt.side_right"], b = ["skirt.side_left"] }]"#;
    let skirt = piece("S", &[[-0.6, 0.0], [0.6, 0.0], [0.35, 0.5], [-0.35, 0.5]]);
    let pieces = [skirt, piece("B", &[[0.0, 0.0], [0.72, 0.0], [0.72, 0.04], [0.0, 0.04]])];
    let top = r#"
        name = "skirt"
        piece.skirt = { block = "S", role = "other", edges = { hem = [0, 1], side_right = [1, 2], waist = [2, 3], side_left = [3, 0] } }"#;
    // The band holds the skirt, and its open ends are no waist.
    for (rest, waist_mm) in [(band, 360.0), (alone, 350.0)] {
        let style = Style::read(&pieces, format!("{top}\n{rest}").as_bytes(), "skirt").expect("it is sewn");
        check("skirt", &style, 0.1, &[(Point::HalfWaist, waist_mm), (Point::HalfHem, 600.0)]);
        let lengths = style.worn_lengths(&STAND);
        let waist = lengths.iter().find(|length| length.level == "waist").expect("a waist");
        assert!(waist.is_held && (mm(waist.length_m) - 2.0 * waist_mm).abs() < 0.1, "{}", waist.length_m);
    }
}

#[test]
fn paths_have_the_lengths_that_are_told_and_lie_on_the_mesh() {
    for model in [Model::Tshirt, Model::Trousers, Model::Teetop, Model::Dress] {
        let style = drafted(model, 0);
        let garment = style.mesh(0.02).expect("it meshes");
        let points: Vec<PointOfMeasure> = style.points_of_measure();
        let paths: Vec<_> = points.iter().map(|measure| measure.path.as_slice()).collect();
        for (measure, runs) in points.iter().zip(style.laid(&garment, &paths)) {
            if measure.path.is_empty() {
                continue;
            }
            let runs =
                runs.unwrap_or_else(|| panic!("{}: {} leaves the cloth", model.as_str(), measure.point.as_str()));
            let flat: Vec<geom::V3> = garment.rest.iter().map(|p| p.push(0.0)).collect();
            let length_m: f64 = runs.iter().map(|run| run.length_m(&garment.rest, &flat)).sum();
            assert!((length_m - style.path_length_m(&measure.path)).abs() < 1e-9, "{}", measure.point.as_str());
        }
    }
}

#[test]
fn worn_lengths_follow_the_levels_of_the_body() {
    let stand = STAND;
    let check = |style: &Style, expect_mm: &[(&str, f64)]| {
        let found = style.worn_lengths(&stand);
        for (level, expect) in expect_mm {
            let mm = found.iter().find(|worn| worn.level == *level).map(|worn| mm(worn.length_m));
            assert!(mm.is_some_and(|mm| (mm - expect).abs() < 1.5), "{level}: {mm:?} instead of {expect}");
        }
    };
    let tshirt = drafted(Model::Tshirt, 1);
    check(&tshirt, &[("chest", 1034.1), ("waist", 1034.1), ("hip", 1034.1), ("neck", 569.5)]);
    assert!(!tshirt.worn_lengths(&stand).iter().any(|worn| matches!(worn.level, "wrist" | "forearm" | "thigh")));
    // A sleeve in one piece goes round the arm once.
    let long = tshirt.moved(&[(Handle::SleeveLength, 0.3)]).expect("a longer sleeve");
    let girth =
        |level: &str| long.worn_lengths(&stand).iter().find(|worn| worn.level == level).map(|worn| worn.length_m);
    let (upper_arm, forearm) = (girth("upper_arm").expect("sleeves"), girth("forearm").expect("long ones"));
    assert!((0.7 * upper_arm..upper_arm).contains(&forearm), "{forearm} of {upper_arm}");
    // Its hem ends above a hip that is 80 mm lower.
    let low = Stand { hip_m: 0.70, ..stand };
    assert!(!tshirt.worn_lengths(&low).iter().any(|worn| worn.level == "hip"));
    check(&drafted(Model::Trousers, 1), &[("waist", 1001.4), ("hip", 1041.4)]);
    let waist = drafted(Model::Trousers, 1).worn_lengths(&stand).swap_remove(0);
    assert!(waist.height_m.is_some_and(|m| (0.9..1.1).contains(&m)), "{waist:?}");
    check(&drafted(Model::Dress, 0), &[("chest", 968.4)]);
    // A level that leaves trousers at their top edge, which is higher behind than in front, goes round all or nothing.
    let trousers = drafted(Model::Trousers, 1);
    for step in 0..60 {
        let near_top = Stand { underbust_m: 0.90 + 0.005 * f64::from(step), ..stand };
        let round = trousers.worn_lengths(&near_top).into_iter().find(|worn| worn.level == "underbust");
        assert!(round.is_none_or(|round| round.length_m > 0.95), "{}", near_top.underbust_m);
    }
}

fn shared(file: &str) -> Option<PathBuf> {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../shared/patterns").join(file);
    path.exists().then_some(path)
}

/// Style of a file of another program, sewn as proposed if it holds no seams.
fn foreign(path: &PathBuf, size: Option<&str>) -> Style {
    let bytes = std::fs::read(path).expect("readable");
    let name = path.display().to_string();
    if source::kind(&bytes) == Kind::GarmentCode {
        return garmentcode::read(&bytes, &name).expect("a specification").style();
    }
    let unit = name.contains("valentina").then_some(Unit::Mm);
    let pieces = source::read(&bytes, &name, unit).expect("a pattern").to_sew(size).expect("a size");
    let proposal = propose::propose(&pieces);
    Style::read(&pieces, proposal.toml("foreign").as_bytes(), "foreign").expect("it holds")
}

/// Lengths computed by hand: sums of the lengths of edges, and distances of vertices, of the outlines in the files.
#[rustfmt::skip]
#[test]
fn foreign_patterns_have_the_lengths_of_their_outlines() {
    use Point::*;
    let mut missing = 0;
    let mut on = |file: &str, size: Option<&str>, expect: &[(Point, f64)]| match shared(file) {
        Some(path) => check(file, &foreign(&path, size), 1.0, expect),
        None => missing += 1,
    };
    let gc = |name: &str| format!("garmentcode/{name}_specification.json");
    let fs = |name: &str| format!("freesewing/{name}.dxf");
    on(&gc("tshirt_mean_female"), None, &[
        (HalfChest, 511.4), (HalfHem, 511.4), (FrontLength, 483.2), (BackLength, 482.7), (CentreFrontLength, 329.9),
        (CentreBackLength, 429.1), (NeckWidth, 203.6), (FrontNeckDrop, 153.3), (BackNeckDrop, 53.6), (Shoulder, 66.1),
        (Armhole, 456.8), (Neck, 674.6), (HalfCuff, 210.5), (SleeveLength, 211.0),
    ]);
    on(&gc("tshirt_mean_all"), None, &[
        (HalfChest, 524.2), (CentreFrontLength, 343.1), (CentreBackLength, 442.7), (NeckWidth, 216.0), (Shoulder, 69.0),
        (Armhole, 459.6), (Neck, 700.6), (HalfCuff, 210.6),
    ]);
    on(&gc("longsleeve_shirt_mean_all"), None, &[
        (HalfChest, 524.2), (HalfHem, 524.2), (CentreFrontLength, 343.1), (HalfCuff, 147.4), (SleeveLength, 516.9),
    ]);
    on(&gc("fitted_shirt_sleeves_mean_male"), None, &[
        (HalfHem, 446.9), (HalfCuff, 203.0), (Shoulder, 70.8), (Armhole, 446.6), (Neck, 648.0),
        (CentreFrontLength, 324.0), (CentreBackLength, 332.0),
    ]);
    on(&gc("fitted_bodice_darts_mean_female"), None, &[
        (HalfHem, 403.3), (Armhole, 437.9), (Shoulder, 64.4), (Neck, 585.2), (CentreFrontLength, 310.4), (CentreBackLength, 313.6),
    ]);
    on(&gc("dress_sheath_mean_female"), None, &[
        (HalfWaist, 403.3), (HalfHem, 520.5), (Armhole, 437.9), (CentreFrontLength, 310.4 + 45.3 + 720.0),
    ]);
    on(&gc("pencil_skirt_mean_female"), None, &[(HalfWaist, 401.7), (HalfHem, 520.5), (CentreFrontLength, 720.0)]);
    on(&gc("pants_mean_all"), None, &[
        (HalfWaist, 421.7), (Inseam, 680.0), (HalfLegOpening, 309.4), (FrontRise, 394.3), (BackRise, 429.1), (Outseam, 1050.3),
    ]);
    on(&gc("pants_mean_female"), None, &[
        (HalfWaist, 401.7), (Inseam, 662.3), (HalfLegOpening, 311.7), (FrontRise, 375.3), (BackRise, 410.9), (Outseam, 1014.0),
    ]);
    on(&fs("teagan_cisFemaleAdult36_aama"), None, &[
        (FrontLength, 611.3), (CentreFrontLength, 518.5), (CentreBackLength, 582.5), (NeckWidth, 234.3), (FrontNeckDrop, 92.8),
        (BackNeckDrop, 28.8), (HalfHem, 562.3), (HalfCuff, 172.3), (AcrossShoulder, 431.0), (Shoulder, 100.9),
    ]);
    on(&fs("titan_cisFemaleAdult36_aama"), None, &[(HalfWaist, 417.1), (HalfLegOpening, 254.0)]);
    on(&fs("bella_cisFemaleAdult36_aama-net"), None, &[
        (CentreFrontLength, 346.6), (CentreBackLength, 388.5), (Neck, 362.4), (HalfHem, 415.1), (HalfCuff, 102.0),
        (NeckWidth, 141.8), (AcrossShoulder, 428.8),
    ]);
    on(&fs("brian_cisMaleAdult40_aama"), None, &[
        (HalfChest, 605.4), (CentreFrontLength, 555.5), (CentreBackLength, 600.0), (Neck, 420.8), (HalfCuff, 108.0),
        (Armhole, 591.2), (AcrossShoulder, 465.0), (Shoulder, 148.8),
    ]);
    on(&fs("paco_cisFemaleAdult36_aama"), None, &[
        (HalfWaist, 523.0), (HalfLegOpening, 168.0), (FrontRise, 290.3), (BackRise, 288.0), (Inseam, 735.2),
    ]);
    on("valentina/pantsM1_52-176.v1.1.1.astm-r12.dxf", None, &[
        (HalfWaist, 570.2), (HalfLegOpening, 242.0), (Outseam, 1205.7), (FrontRise, 374.8), (BackRise, 479.1), (Inseam, 848.2),
    ]);
    on("freesewing/teagan_nest_aama-inch.dxf", Some("28"), &[
        (FrontLength, 521.5), (CentreFrontLength, 442.7), (CentreBackLength, 499.1), (NeckWidth, 191.8), (Shoulder, 89.9),
        (AcrossShoulder, 367.0), (HalfHem, 437.2), (HalfCuff, 132.8),
    ]);
    on("freesewing/teagan_nest_aama-inch.dxf", Some("44"), &[
        (FrontLength, 702.2), (CentreFrontLength, 595.3), (CentreBackLength, 667.0), (NeckWidth, 276.5), (Shoulder, 111.6),
        (AcrossShoulder, 494.0), (HalfHem, 687.4), (HalfCuff, 210.7),
    ]);
    on("freesewing/titan_nest_astm-mm.dxf", Some("28"), &[(HalfWaist, 344.8), (HalfLegOpening, 219.0)]);
    on("freesewing/titan_nest_astm-mm.dxf", Some("44"), &[(HalfWaist, 494.4), (HalfLegOpening, 288.0)]);
    if missing > 0 {
        eprintln!("skipped {missing} patterns of ../shared that are not there");
    }
}

#[test]
fn drafted_styles_have_their_hem_and_both_side_seams() {
    let check = |model: Model, side_seams: usize, has_waist: bool| {
        let style = drafted(model, 0);
        let lines = style.hang_lines();
        assert!(!lines.hem.is_empty(), "{model:?}");
        assert_eq!(lines.waist.is_empty(), !has_waist, "{model:?}");
        let lengths: Vec<f64> = lines.side_seams.iter().map(|seam| style.path_length_m(seam)).collect();
        assert_eq!(lengths.len(), side_seams, "{model:?}: {lengths:?}");
        // Right and left are alike.
        let pairs =
            lengths.iter().filter(|length| lengths.iter().filter(|other| (*length - *other).abs() < 1e-6).count() == 2);
        assert_eq!(pairs.count(), side_seams, "{model:?}: {lengths:?}");
    };
    check(Model::Tshirt, 2, false);
    check(Model::Trousers, 2, true);
    check(Model::Dress, 4, false);
}
