use std::path::{Path, PathBuf};

use super::*;
use crate::draft::{TSHIRT_SEAMS, TshirtSize, tshirt};
use crate::dxf::{self, Unit};
use crate::seams::SeamFile;
use crate::style::{EdgeRef, Style};
use geom::V2;

fn shared(file: &str) -> Option<PathBuf> {
    let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/patterns")).join(file);
    if !path.exists() {
        eprintln!("skipped: {} is not here", path.display());
        return None;
    }
    Some(path)
}

fn pieces(file: &str, size: Option<&str>) -> Option<Vec<Piece>> {
    let bytes = std::fs::read(shared(file)?).expect("the file is there");
    let unit = file.starts_with("valentina").then_some(Unit::Mm);
    Some(dxf::read(&bytes, file, unit).expect("it reads").to_sew(size).expect("it is whole"))
}

fn style(pieces: &[Piece], proposal: &Proposal) -> Style {
    let text = proposal.toml("proposed");
    Style::read(pieces, text.as_bytes(), "proposed.toml").unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn proposed(file: &str, size: Option<&str>) -> Option<(Proposal, Style)> {
    let pieces = pieces(file, size)?;
    let proposal = propose(&pieces);
    let style = style(&pieces, &proposal);
    let garment = style.mesh(15e-3).unwrap_or_else(|error| panic!("{file}: {error}"));
    assert_eq!(garment.seams.len(), proposal.seams.len(), "{file}");
    Some((proposal, style))
}

/// `seams` are without darts, in order.
fn check(file: &str, seams: &[&str], darts: usize) {
    let Some((proposal, _)) = proposed(file, None) else { return };
    let names: Vec<&str> = proposal.seams.iter().map(|seam| seam.entry.name.as_str()).collect();
    let mut plain: Vec<&str> = names.iter().copied().filter(|name| !name.contains("dart")).collect();
    plain.sort_unstable();
    assert_eq!(plain, seams, "{file}");
    assert_eq!(names.len() - plain.len(), darts, "{file}");
}

const TOP: [&str; 8] = [
    "armhole_left",
    "armhole_right",
    "shoulder_left",
    "shoulder_right",
    "side_left",
    "side_right",
    "underarm_left",
    "underarm_right",
];
const TROUSERS: [&str; 6] =
    ["crotch_back", "crotch_front", "inseam_left", "inseam_right", "outseam_left", "outseam_right"];

#[test]
fn freesewing_garments_are_sewn() {
    let with = |more: &[&'static str]| {
        let mut all = [&TOP[..], more].concat();
        all.sort_unstable();
        all
    };
    check("freesewing/teagan_cisFemaleAdult36_aama.dxf", &TOP, 0);
    check("freesewing/teagan_cisFemaleAdult36_c3d.dxf", &TOP, 0);
    check("freesewing/brian_cisMaleAdult40_aama.dxf", &TOP, 0);
    check("freesewing/titan_cisFemaleAdult36_aama.dxf", &TROUSERS, 0);
    check("freesewing/bella_cisFemaleAdult36_aama-net.dxf", &with(&["centre_back"]), 6);
    check("freesewing/sandy_cisFemaleAdult36_aama.dxf", &["skirt_side", "waist"], 0);
    check("valentina/TShirt_test.v1.1.1.aama-r12.dxf", &with(&["centre_back", "centre_front"]), 0);
    let mut trousers = [&TROUSERS[..], &["waist_left", "waist_right", "waistband_back", "waistband_front"]].concat();
    trousers.sort_unstable();
    check("valentina/Trousers.v1.1.1.aama-r12.dxf", &trousers, 6);
    check(
        "valentina/MaleShirt.v1.1.1.aama-r12.dxf",
        &with(&["centre_back", "centre_front", "yoke_back", "yoke_centre_back"]),
        2,
    );
    check("valentina/jacketM1_52-176.size50.v1.1.1.astm-r12.cp1251.dxf", &with(&["centre_back", "centre_front"]), 0);
    check("valentina/pantsM1_52-176.v1.1.1.astm-r12.dxf", &TROUSERS, 0);
}

#[test]
fn what_looks_like_a_leg_and_has_darts_elsewhere_is_none() {
    let Some((proposal, _)) = proposed("valentina/Basic_block_women-2016.v1.1.1.aama-r12.dxf", None) else { return };
    let piece_of = |name: &str| proposal.pieces.iter().find(|piece| piece.name == name).expect("it is there");
    let doubted = piece_of("BACKPANEL1");
    assert_eq!(doubted.class, Some(Class::Body), "{doubted:?}");
    // The file draws two blocks, with and without darts: one of each is worn.
    let offers = |question: &Question| question.choices.iter().any(|choice| choice == "BACKPANEL1");
    assert!(proposal.questions.iter().any(offers), "{:?}", proposal.questions);
}

#[test]
fn roles_are_those_that_the_simulators_place() {
    let check = |file: &str, expect: &[Role]| {
        let Some((_, style)) = proposed(file, None) else { return };
        let mut roles: Vec<Role> = style.pieces.iter().map(|piece| piece.role).collect();
        roles.sort();
        roles.dedup();
        assert_eq!(roles, expect, "{file}");
    };
    use Role::{Back, BodiceBack, BodiceFront, Front, SkirtBack, SkirtFront, SleeveLeft, SleeveRight, Waistband};
    let legs = [Role::LegFrontRight, Role::LegFrontLeft, Role::LegBackRight, Role::LegBackLeft];
    check("freesewing/titan_cisFemaleAdult36_aama.dxf", &legs);
    check("freesewing/teagan_cisFemaleAdult36_aama.dxf", &[Front, Back, SleeveRight, SleeveLeft]);
    check("garmentcode/dress_sheath_mean_female.dxf", &[BodiceFront, BodiceBack, SkirtFront, SkirtBack, Waistband]);
    check("garmentcode/pants_mean_female.dxf", &[&legs[..], &[Waistband]].concat());
}

#[test]
fn every_size_of_the_nests_is_sewn_and_meshed() {
    for (file, seams) in [("freesewing/teagan_nest_aama-inch.dxf", 8), ("freesewing/titan_nest_astm-mm.dxf", 6)] {
        for size in ["28", "32", "34", "36", "38", "40", "42", "44"] {
            let Some((proposal, style)) = proposed(file, Some(size)) else { return };
            assert_eq!((proposal.seams.len(), style.size.as_str()), (seams, size), "{file}");
        }
    }
}

/// Seams as the areas of their pieces, mm2, and the lengths of both sides, mm, independent of all names.
fn sewn(style: &Style) -> Vec<[i64; 4]> {
    let area = |edge: EdgeRef| (geom::polyline::signed_area(&style.pieces[edge.piece].outline()).abs() * 1e6).round();
    let side = |chain: &[EdgeRef]| {
        let length: f64 = chain.iter().map(|&edge| style.edge(edge).line.length() * 1e3).sum();
        [chain.iter().map(|&edge| area(edge)).sum::<f64>() as i64, length.round() as i64]
    };
    let mut all: Vec<[i64; 4]> = Vec::new();
    for seam in &style.seams {
        let mut sides = [side(&seam.a), side(&seam.b)];
        sides.sort_unstable();
        all.push([sides[0][0], sides[0][1], sides[1][0], sides[1][1]]);
    }
    all.sort_unstable();
    all
}

#[test]
fn our_own_tshirt_is_sewn_as_its_seam_file_says() {
    let pieces = tshirt(TshirtSize::M).pieces;
    let truth = Style::read(&pieces, TSHIRT_SEAMS, "tshirt.seams.toml").expect("it is a style");
    assert_eq!(sewn(&style(&pieces, &propose(&pieces))), sewn(&truth));
}

#[test]
fn our_own_styles_are_sewn_by_shape_alone() {
    for model in crate::draft::Model::ALL {
        for draft in model.drafts() {
            let truth = Style::read(&draft.pieces, model.seams(), "seams").expect("it is a style");
            let mut pieces = draft.pieces;
            for (number, piece) in pieces.iter_mut().enumerate() {
                (piece.name, piece.block) = ((number + 1).to_string(), (number + 1).to_string());
                piece.texts.clear();
            }
            let proposal = propose(&pieces);
            let found = style(&pieces, &proposal);
            let said = || format!("{model:?} {}: {:?}", draft.size, proposal.questions);
            // The seam file of the trousers splits the outseam at the hip. The same length is sewn there, with as
            // little ease.
            assert_eq!(total_mm(&found), total_mm(&truth), "{}", said());
            if model != crate::draft::Model::Trousers {
                assert_eq!(sewn(&found), sewn(&truth), "{}", said());
            }
        }
    }
}

/// Total length of all seams, and total ease.
fn total_mm(style: &Style) -> [i64; 2] {
    let length = |chain: &[EdgeRef]| chain.iter().map(|&edge| style.edge(edge).line.length() * 1e3).sum::<f64>();
    let sides: Vec<[f64; 2]> = style.seams.iter().map(|seam| [length(&seam.a), length(&seam.b)]).collect();
    let sum = |of: fn(&[f64; 2]) -> f64| sides.iter().map(of).sum::<f64>().round() as i64;
    [sum(|[a, b]| a + b), sum(|[a, b]| (a - b).abs())]
}

#[test]
fn a_proposal_is_the_file_it_writes() {
    let pieces = tshirt(TshirtSize::M).pieces;
    let proposal = propose(&pieces);
    let read: SeamFile = toml::from_str(&proposal.toml("a \"name\"")).expect("it reads");
    assert_eq!(read, proposal.seam_file("a \"name\""));
    assert!(proposal.seams.iter().all(|seam| (0.0..=1.0).contains(&seam.confidence)));
}

#[test]
fn what_is_unsure_is_asked_for() {
    let mut pieces = tshirt(TshirtSize::M).pieces;
    for piece in &mut pieces {
        piece.name = "?????".to_owned();
        piece.turn_points.clear();
        piece.outline =
            (0..40).map(|k| f64::from(k) / 20.0 * std::f64::consts::PI).map(|a| V2::new(a.cos(), a.sin())).collect();
    }
    let proposal = propose(&pieces);
    assert!(proposal.seams.is_empty());
    assert_eq!(proposal.questions.len(), pieces.len());
}

#[test]
fn corners_by_curvature_are_corners_that_the_file_marks() {
    let (mut marked, mut curved, mut agree) = (0, 0, 0);
    for file in [
        "freesewing/teagan_cisFemaleAdult36_aama.dxf",
        "freesewing/titan_cisFemaleAdult36_aama.dxf",
        "freesewing/bella_cisFemaleAdult36_aama-net.dxf",
        "garmentcode/dress_sheath_mean_female.dxf",
        "garmentcode/fitted_shirt_sleeves_mean_male.dxf",
        "garmentcode/pants_mean_all.dxf",
    ] {
        let Some(pieces) = pieces(file, None) else { return };
        for piece in pieces {
            let by_marks = crate::style::corners::corner_vertices(&piece);
            let unmarked = Piece { turn_points: Vec::new(), ..piece };
            let by_curvature = crate::style::corners::corner_vertices(&unmarked);
            marked += by_marks.len();
            curved += by_curvature.len();
            agree += by_curvature.iter().filter(|corner| by_marks.contains(corner)).count();
        }
    }
    eprintln!("{marked} corners marked, {curved} found by curvature, of which {agree} are marked");
    assert!(agree * 100 >= 98 * curved, "{agree} of {curved}");
    assert!(agree * 100 >= 75 * marked, "{agree} of {marked}");
}

/// Panel and edge number, twice, of a GarmentCode file.
type Stitch = [(String, usize); 2];

const SYMMETRIC_M: f64 = 1e-3;

fn is_symmetric(outline: &[V2]) -> bool {
    let (low, high) = outline.iter().fold((f64::MAX, f64::MIN), |(low, high), p| (low.min(p.x), high.max(p.x)));
    let closed = |p: &V2| geom::polyline::boundary_distance(outline, p);
    outline.iter().all(|p| closed(&V2::new(low + high - p.x, p.y)) < SYMMETRIC_M)
}

/// Number of stitches of a GarmentCode file that the proposal for the DXF file beside it finds. The file may not tell
/// the left side of its whole, symmetric backs. Sewing them turned over makes the same garment, so the better of both
/// readings counts.
fn score(garment: &str) -> Option<(usize, usize)> {
    let [plain, turned] = [false, true].map(|is_turned| score_read(garment, is_turned));
    Some(plain?.max(turned?))
}

fn score_read(garment: &str, is_turned: bool) -> Option<(usize, usize)> {
    let file = format!("garmentcode/{garment}.dxf");
    let drawn = pieces(&file, None)?;
    let (proposal, style) = proposed(&file, None)?;
    let text =
        std::fs::read_to_string(shared(&format!("garmentcode/{garment}_specification.json"))?).expect("it reads");
    let pattern: serde_json::Value = serde_json::from_str(&text).expect("it is JSON");
    let pattern = &pattern["pattern"];
    let ends = |panel: &str, edge: usize| -> [V2; 2] {
        let panel_json = &pattern["panels"][panel];
        let point = |v: &serde_json::Value| V2::new(v[0].as_f64().expect("u"), v[1].as_f64().expect("v")) * 0.01;
        let vertices: Vec<V2> = panel_json["vertices"].as_array().expect("a list").iter().map(point).collect();
        let piece = drawn.iter().find(|piece| piece.name == panel).expect("a panel is a piece");
        // The DXF file moves every panel: both hold the same corners.
        let low = |points: &[V2]| points.iter().fold(V2::repeat(f64::MAX), |low, p| low.inf(p));
        let move_by = low(&piece.turn_points) - low(&vertices);
        [0, 1].map(|k| {
            let index = panel_json["edges"][edge]["endpoints"][k].as_u64().expect("an index") as usize;
            vertices[index] + move_by
        })
    };
    let stitches: Vec<Stitch> = pattern["stitches"]
        .as_array()
        .expect("a list")
        .iter()
        .map(|stitch| {
            [0, 1].map(|k| {
                let side = &stitch[k];
                (side["panel"].as_str().expect("a name").to_owned(), side["edge"].as_u64().expect("a number") as usize)
            })
        })
        .collect();
    // Backs that may be turned over, because their mirror image coincides with them.
    let turned_over = |piece: usize, p: V2| {
        let outline = style.pieces[piece].outline();
        if !is_turned || !style.pieces[piece].id.contains("back") || !is_symmetric(&outline) {
            return p;
        }
        let (low, high) = outline.iter().fold((f64::MAX, f64::MIN), |(low, high), p| (low.min(p.x), high.max(p.x)));
        V2::new(low + high - p.x, p.y)
    };
    // Shares of the side of a seam that the edge of a panel takes, in the direction of sewing.
    let place = |chain: &[EdgeRef], is_forwards: bool, (panel, edge): &(String, usize)| {
        let total: f64 = chain.iter().map(|&edge| style.edge(edge).line.length()).sum();
        let mut before = 0.0;
        for &part in chain {
            let line = &style.edge(part).line;
            let entry = &proposal.worn.iter().find(|worn| worn.id == style.pieces[part.piece].id)?.entry;
            if entry.block == *panel {
                let arcs = ends(panel, *edge).map(|p| {
                    let p = if entry.mirror { V2::new(-p.x, p.y) } else { p };
                    let p = turned_over(part.piece, p);
                    line.points().iter().position(|q| (q - p).norm() < 0.6e-3).map(|i| line.arcs()[i])
                });
                if let [Some(from), Some(to)] = arcs {
                    let along = |arc: f64| before + if is_forwards { arc } else { line.length() - arc };
                    return Some([along(from).min(along(to)) / total, along(from).max(along(to)) / total]);
                }
            }
            before += line.length();
        }
        None
    };
    let is_found = |stitch: &Stitch| {
        style.seams.iter().any(|seam| {
            [(0, 1), (1, 0)].iter().any(|&(first, second)| {
                let (Some(a), Some(b)) = (place(&seam.a, true, &stitch[first]), place(&seam.b, false, &stitch[second]))
                else {
                    return false;
                };
                (a[0] - b[0]).abs() < 0.08 && (a[1] - b[1]).abs() < 0.08
            })
        })
    };
    let found = stitches.iter().filter(|stitch| is_found(stitch)).count();
    for stitch in stitches.iter().filter(|stitch| !is_found(stitch)) {
        eprintln!("{garment}: not found: {stitch:?}");
    }
    Some((stitches.len(), found))
}

#[test]
fn the_stitches_of_garmentcode_are_proposed() {
    for (garment, expect) in [
        ("tshirt_mean_all", (16, 16)),
        ("tshirt_mean_female", (16, 16)),
        ("longsleeve_shirt_mean_all", (16, 16)),
        ("fitted_shirt_sleeves_mean_male", (32, 32)),
        ("fitted_bodice_darts_mean_female", (16, 16)),
        ("dress_sheath_mean_female", (46, 46)),
        ("pants_mean_all", (24, 24)),
        ("pants_mean_female", (28, 28)),
        ("pencil_skirt_mean_female", (20, 20)),
    ] {
        let Some(found) = score(garment) else { return };
        eprintln!("{garment}: {} true stitches, {} found", found.0, found.1);
        assert_eq!(found, expect, "{garment}");
    }
}

#[test]
fn proposals_call_girths_what_closes() {
    let check = |file: &str| {
        let Some(path) = shared(file) else { return };
        let bytes = std::fs::read(&path).expect("the file is there");
        let unit = (!file.starts_with("freesewing") && !file.starts_with("garmentcode")).then_some(Unit::Mm);
        let Ok(drawn) = dxf::read(&bytes, file, unit) else { return };
        let size = drawn.sizes().first().map(|size| (*size).to_owned());
        let Ok(pieces) = drawn.to_sew(size.as_deref()) else { return };
        let proposal = propose(&pieces);
        let Ok(style) = Style::read(&pieces, proposal.toml("x").as_bytes(), "x") else { return };
        let Ok(garment) = style.mesh(20e-3) else { return };
        let found = crate::check::of_garment(&style, &garment);
        let loops: Vec<_> = found.iter().filter(|finding| finding.kind == crate::check::FindingKind::Loop).collect();
        assert!(loops.is_empty(), "{file}: {loops:?}");
    };
    for folder in ["freesewing", "garmentcode", "valentina", "jblockcreator"] {
        let Some(path) = shared(folder) else { continue };
        let mut files: Vec<PathBuf> =
            std::fs::read_dir(path).expect("a folder").map(|entry| entry.expect("readable").path()).collect();
        files.sort();
        for file in files.iter().filter(|file| file.extension().is_some_and(|end| end == "dxf")) {
            let name = file.file_name().unwrap_or_default().to_string_lossy();
            check(&format!("{folder}/{name}"));
        }
    }
}
