use super::corners::{corner_vertices, mirrored};
use super::*;
use crate::draft::{TSHIRT_SEAMS, TshirtSize, tshirt};
use crate::piece::Notch;
use crate::seams::SeamFile;

fn read(seams: &str) -> Result<Style, StyleError> {
    Style::read(&tshirt(TshirtSize::S).pieces, seams.as_bytes(), "a.toml")
}

fn seams() -> &'static str {
    std::str::from_utf8(TSHIRT_SEAMS).expect("it is UTF-8")
}

#[test]
fn mistakes_name_their_place_and_what_exists() {
    let check = |from: &str, to: &str, expect: &[&str]| {
        assert!(seams().contains(from), "`{from}` is in the file");
        let text = read(&seams().replacen(from, to, 1)).expect_err(to).to_string();
        for part in ["a.toml"].iter().chain(expect) {
            assert!(text.contains(part), "`{part}` in: {text}");
        }
    };
    check("block = \"FRONT\"", "block = \"FRUNT\"", &["piece `front`", "block `FRUNT`", "FRONT, BACK, SLEEVE"]);
    check("role = \"front\"", "role = \"lapel\"", &["line", "lapel", "sleeve_right"]);
    check("hem = [0, 1]", "hem = [0, 12]", &["piece `front`", "corner 12", "0 to 8"]);
    check("hem = [0, 1]", "hem = [0, 2]", &["piece `front`", "edge `hem`", "overlaps"]);
    check(
        "a = [\"front.side_right\"]",
        "a = [\"front.sleeve\"]",
        &["seam `side_right`", "front.sleeve", "front.side_left"],
    );
    check("a = [\"front.side_right\"]", "a = [\"frunt.side\"]", &["piece `frunt`", "sleeve_left, sleeve_right"]);
    check("a = [\"front.side_right\"]", "a = []", &["seam `side_right`", "without edges"]);
    check(
        "a = [\"front.side_right\"]",
        "a = [\"front.side_left\"]",
        &["seam `side_left`", "`front.side_left` is sewn twice"],
    );
    check(
        "a = [\"front.side_right\"]",
        "a = [\"front.hem\"]",
        &["seam `side_right`", "487.1 mm", "459.0 mm", "ease_mm = 0"],
    );
    check("\"front.hem.mid\"", "\"front.hem.middle\"", &["measurement 3", "front.hem.middle", "EDGE.mid"]);
    check("\"front.hem.mid\"", "\"back.hem.mid\"", &["measurement 3", "one piece"]);
    check("path = [\"sleeve_right.opening\"]", "path = []", &["measurement 2", "empty path"]);
    check("[fit.chest]", "[fut.chest]", &["line", "unknown field `fut`"]);
    check("name = \"Mens T-shirt\"", "name = ", &["line 4"]);
    let twice = [tshirt(TshirtSize::S).pieces, tshirt(TshirtSize::M).pieces].concat();
    let error = Style::read(&twice, TSHIRT_SEAMS, "a.toml").expect_err("two sizes at once");
    assert!(error.to_string().contains("2 pieces are called `BACK`"), "{error}");
    assert!(matches!(Style::read(&[], b"\xff\xfe", "a.toml"), Err(StyleError::Syntax { .. })));
}

#[test]
fn the_seam_file_survives_a_round_trip() {
    let file: SeamFile = toml::from_str(seams()).expect("it reads");
    let written = toml::to_string(&file).expect("it writes");
    assert_eq!(toml::from_str::<SeamFile>(&written).expect("it reads again"), file);
    assert_eq!(read(&written), read(seams()));
}

#[test]
fn stated_ease_is_accepted_and_no_other() {
    let eased = |ease: &str| {
        seams().replacen("a = [\"front.side_right\"]", &format!("a = [\"front.hem\"]\nease_mm = {ease}"), 1)
    };
    assert!(read(&eased("28.1")).is_ok());
    assert!(read(&eased("20.0")).is_err());
}

#[test]
fn a_mirrored_piece_is_the_mirror_image_still_counter_clockwise() {
    let style = read(seams()).expect("it is a style");
    let piece = |id: &str| style.pieces.iter().find(|piece| piece.id == id).expect("it is there");
    let (right, left) = (piece("sleeve_right"), piece("sleeve_left"));
    let area = |piece: &StylePiece| geom::polyline::signed_area(&piece.outline());
    assert!(area(left) > 0.0 && (area(left) - area(right)).abs() < 1e-12);
    let edge = |piece: &'static str, name: &str| {
        let found = style.pieces.iter().find(|p| p.id == piece).expect("it is there");
        found.edges.iter().find(|edge| edge.name.as_deref() == Some(name)).expect("it is there").clone()
    };
    let (cap, mirrored_cap) = (edge("sleeve_right", "cap"), edge("sleeve_left", "cap"));
    assert_eq!(mirrored_cap.line.at(0.0), mirrored(cap.line.at(cap.line.length())));
    assert_eq!(mirrored_cap.corners.len(), 1);
    assert!((mirrored_cap.corners[0] + cap.corners[0] - cap.line.length()).abs() < 1e-12);
}

#[test]
fn corners_come_from_turn_points_or_else_from_the_outline() {
    let square = |turn_points: Vec<V2>| {
        let mut piece = tshirt(TshirtSize::S).pieces.remove(0);
        piece.outline = (0..40)
            .map(|i| {
                let (side, along) = (i / 10, f64::from(i % 10) / 10.0);
                let corners = [V2::new(0.0, 0.0), V2::new(1.0, 0.0), V2::new(1.0, 1.0), V2::new(0.0, 1.0)];
                corners[side as usize].lerp(&corners[(side as usize + 1) % 4], along)
            })
            .collect();
        piece.turn_points = turn_points;
        corner_vertices(&piece)
    };
    let corner = |x: f64, y: f64| V2::new(x, y);
    // Sharp corners that the file does not mark are corners too. Numbering begins with the first marked one.
    assert_eq!(square(vec![corner(1.0, 1.0), corner(0.0, 0.0), corner(0.5, 0.0)]), [20, 30, 0, 5, 10]);
    // Marks off the outline, such as those of a cut line if the sew line is sewn, are ignored.
    assert_eq!(square(vec![corner(2.0, 2.0)]), [0, 10, 20, 30]);
    assert_eq!(square(Vec::new()), [0, 10, 20, 30]);
}

#[test]
fn notches_cut_into_a_marked_outline_are_no_corners() {
    let mut piece = tshirt(TshirtSize::S).pieces.remove(0);
    let point = |x: f64, y: f64| V2::new(x, y);
    let notch = [point(0.495, 0.0), point(0.5, 0.006), point(0.505, 0.0)];
    let square = [point(1.0, 0.0), point(1.0, 1.0), point(0.0, 1.0)];
    piece.outline = [&[point(0.0, 0.0)][..], &notch, &square].concat();
    piece.turn_points = [&[point(0.0, 0.0)][..], &square].concat();
    assert_eq!(corner_vertices(&piece), [0, 4, 5, 6]);
}

#[test]
fn reinforced_edges_reach_the_mesh() {
    let with = |entry: &str| read(&format!("{}\n[[reinforce]]\n{entry}\n", seams()));
    let style =
        with("edges = [\"front.neck_left\", \"front.neck_right\"]\nkind = \"rib\"\nstiffness_n = 20.0").expect("sound");
    let garment = style.mesh(0.03).expect("it meshes");
    assert_eq!(garment.reinforcements.len(), 2);
    let neck = garment.pieces.iter().find(|p| p.id == "front").map(|p| p.edges["neck_left"].clone());
    assert!(garment.reinforcements.iter().any(|r| Some(&r.vertices) == neck.as_ref() && r.length_factor == 1.0));
    assert!(read(seams()).expect("sound").mesh(0.03).expect("it meshes").reinforcements.is_empty());
    let check = |entry: &str, expect: &str| {
        let text = with(entry).expect_err(entry).to_string();
        assert!(text.contains(expect), "`{expect}` in: {text}");
    };
    check("edges = [\"front.neck_left\"]\nkind = \"rib\"\nstiffness_n = -1.0", "reinforce 1");
    check("edges = [\"front.nick\"]\nkind = \"rib\"\nstiffness_n = 20.0", "front.nick");
    check("edges = [\"front.neck_left\"]\nkind = \"lace\"\nstiffness_n = 20.0", "lace");
}

/// Turned about the origin, as a program may draw it.
fn turned(piece: &Piece, degrees: f64) -> Piece {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let turned = |p: &V2| V2::new(cos * p.x - sin * p.y, sin * p.x + cos * p.y);
    let all = |points: &[V2]| points.iter().map(turned).collect();
    Piece {
        outline: all(&piece.outline),
        turn_points: all(&piece.turn_points),
        notches: piece.notches.iter().map(|notch| Notch { at: turned(&notch.at), ..*notch }).collect(),
        grain: piece.grain.map(|ends| ends.map(|end| turned(&end))),
        ..piece.clone()
    }
}

#[test]
fn pieces_are_set_upright_however_they_lie_in_the_file() {
    let draft = tshirt(TshirtSize::M).pieces;
    let upright = Style::read(&draft, TSHIRT_SEAMS, "a.toml").expect("drafted upright");
    for degrees in [90.0, 180.0, 270.0, 37.0, -20.0] {
        let turned: Vec<Piece> = draft.iter().map(|piece| turned(piece, degrees)).collect();
        let style = Style::read(&turned, TSHIRT_SEAMS, "a.toml").expect("the same pieces");
        for (drawn, found) in upright.pieces.iter().zip(&style.pieces) {
            let outlines = [drawn.outline(), found.outline()];
            let from_first = |outline: &[V2]| outline.iter().map(|p| p - outline[0]).collect::<Vec<_>>();
            let pairs = from_first(&outlines[0]).into_iter().zip(from_first(&outlines[1]));
            let off = pairs.map(|(p, q)| (p - q).norm()).fold(0.0, f64::max);
            assert!(off < 1e-9, "{} turned by {degrees}: {off}", drawn.id);
            assert!(found.grain.dot(&drawn.grain) > 1.0 - 1e-9, "{}", drawn.id);
        }
    }
}

#[test]
fn an_allowance_lies_between_the_cut_line_and_what_is_sewn() {
    let height_mm = |text: &str| {
        let style = read(text).unwrap_or_else(|error| panic!("{error}"));
        let front = style.pieces.iter().find(|piece| piece.id == "front").expect("a front").outline();
        let heights = || front.iter().map(|p| p.y * 1e3);
        heights().fold(f64::MIN, f64::max) - heights().fold(f64::MAX, f64::min)
    };
    let tolerant = seams().replacen("length_tolerance_mm = 0.5", "length_tolerance_mm = 30.0", 1);
    assert_ne!(tolerant, seams());
    let net = height_mm(&tolerant);
    let cut = tolerant.replacen("length_tolerance_mm", "allowance_mm = 5.0\nlength_tolerance_mm", 1);
    let with_hem = cut.replacen("role = \"front\"\n", "role = \"front\"\nallowance_mm = { hem = 20.0 }\n", 1);
    assert_ne!(cut, with_hem);
    // 5 mm above as below, and 15 mm more at the hem.
    assert!((height_mm(&cut) - height_mm(&with_hem) - 15.0).abs() < 0.1, "{}", height_mm(&with_hem));
    assert!((5.0..15.0).contains(&(net - height_mm(&cut))), "{net} {}", height_mm(&cut));
    let refused = |text: &str, expect: &str| {
        let told = read(text).expect_err(expect).to_string();
        assert!(told.contains(expect), "{told}");
    };
    refused(&with_hem.replacen("hem = 20.0", "him = 20.0", 1), "no edge `him`");
    refused(&with_hem.replacen("hem = 20.0", "hem = 200.0", 1), "0 to 100 mm");
}
