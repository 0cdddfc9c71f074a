//! One garment, size and body by every way in: files, folders, tables, drawings, names, studies, bodies. Ways that are the same
//! give the same lengths and chi, and ways that differ give others.

use std::collections::BTreeMap;

use serde_json::Value;
use toile::body::{self, Dimension, Measurements, Sex, write_obj};
use toile::geom::{TriMesh, V2};
use toile::pattern::draft::Draft;
use toile::pattern::dxf::{Standard, write_pieces};
use toile::pattern::{Notch, Piece};
use toile::spec::patterns::Model;

use super::program::Place;

/// Difference of two lengths in the pattern that are one, mm.
const SAME_MM: f64 = 1e-3;
/// Difference of two chi that are one.
const SAME_CHI: f64 = 1e-3;

/// Difference that curves written as cubics make to all lengths together, mm.
const SAME_CURVE_MM: f64 = 0.1;

/// Edge length of the cloth's meshes, mm: on coarser ones Hybrid-GS restores lengths to within 0.6 % only.
const EDGE_MM: u32 = 25;

/// The man who wears it, in measurements.
const MAN: &str = "sex = \"male\"\nstature_mm = 1760\nchest_girth_mm = 960\nwaist_girth_mm = 840\nhip_girth_mm = 980\n";

/// How a garment came out.
#[derive(Clone, Debug, PartialEq)]
struct Worn {
    /// Lengths in the pattern, mm, each with its chi, by length.
    lengths: Vec<(f64, f64)>,
    /// Ease by level, mm.
    eases: BTreeMap<String, f64>,
}

impl Worn {
    fn number(of: &Value, key: &str) -> f64 {
        of[key].as_f64().unwrap_or_else(|| panic!("no {key} in {of}"))
    }

    /// From what `try --json` says.
    fn of_try(said: &Value) -> Self {
        let rows = |key: &str| said[key].as_array().unwrap_or_else(|| panic!("no {key} in {said}")).clone();
        let draped = rows("chi").into_iter().filter(|row| row["stage"] == "drape");
        let lengths = draped.map(|row| (Self::number(&row, "l2d_mm"), Self::number(&row, "chi"))).collect();
        let ease = |row: &Value| (row["level"].as_str().expect("a level").to_owned(), Self::number(row, "ease_mm"));
        Self::sorted(lengths, rows("ease").iter().map(ease).collect())
    }

    /// From the results of a study.
    fn of_study(place: &Place, garment: &str, size: &str) -> Self {
        let cells = format!("garment = '{garment}' AND size = '{size}' AND simulator = 'hybrid'");
        let rows = place.sql(&format!("SELECT l2d_mm, chi FROM v_chi WHERE stage = 'drape' AND {cells}"));
        let number = |text: &str| text.parse::<f64>().unwrap_or_else(|_| panic!("{text} is no number"));
        let lengths = rows.iter().map(|row| row.split_once(',').expect("two cells"));
        let lengths = lengths.map(|(l2d, chi)| (number(l2d), number(chi))).collect();
        let rows =
            place.sql(&format!("SELECT level, ease_mm FROM v_ease WHERE garment = '{garment}' AND size = '{size}'"));
        let eases = rows.iter().map(|row| row.split_once(',').expect("two cells"));
        Self::sorted(lengths, eases.map(|(level, ease)| (level.to_owned(), number(ease))).collect())
    }

    fn sorted(mut lengths: Vec<(f64, f64)>, eases: BTreeMap<String, f64>) -> Self {
        assert!(!lengths.is_empty() && !eases.is_empty(), "nothing is measured");
        lengths.sort_by(|a, b| a.0.total_cmp(&b.0));
        Self { lengths, eases }
    }

    #[track_caller]
    fn is_same(&self, other: &Self, way: &str) {
        assert_eq!(self.lengths.len(), other.lengths.len(), "{way}: {self:?}\n{other:?}");
        for ((l2d, chi), (wanted, of)) in self.lengths.iter().zip(&other.lengths) {
            assert!((l2d - wanted).abs() < SAME_MM, "{way}: {l2d} mm in the pattern, wanted {wanted}");
            assert!((chi - of).abs() < SAME_CHI, "{way}: chi {chi} of {l2d} mm, wanted {of}");
        }
        assert_eq!(Vec::from_iter(self.eases.keys()), Vec::from_iter(other.eases.keys()), "{way}");
        for (level, ease) in &self.eases {
            assert!(
                (ease - other.eases[level]).abs() < 0.01,
                "{way}: ease {ease} at the {level}, wanted {}",
                other.eases[level]
            );
        }
    }

    /// Compares what all lengths come to, where a format cuts them in parts and draws curves to `SAME_CURVE_MM`.
    fn is_same_in_all(&self, other: &Self, way: &str) {
        let total = |worn: &Self| {
            let l2d: f64 = worn.lengths.iter().map(|(l2d, _)| l2d).sum();
            (l2d, worn.lengths.iter().map(|(l2d, chi)| l2d * chi).sum::<f64>() / l2d)
        };
        let ((l2d, chi), (wanted, of)) = (total(self), total(other));
        assert!((l2d - wanted).abs() < SAME_CURVE_MM, "{way}: {l2d} mm in the pattern, wanted {wanted}");
        assert!((chi - of).abs() < SAME_CHI, "{way}: chi {chi} of {l2d} mm, wanted {of}");
        assert_eq!(Vec::from_iter(self.eases.keys()), Vec::from_iter(other.eases.keys()), "{way}");
        for (level, ease) in &self.eases {
            assert!((ease - other.eases[level]).abs() < SAME_CURVE_MM, "{way}: ease {ease} at the {level}");
        }
    }
}

/// A place with the drafted T-shirt and somebody to wear it.
struct Doors {
    place: Place,
    drafts: Vec<Draft>,
}

impl Doors {
    fn new() -> Self {
        let doors = Self { place: Place::new(), drafts: Model::Tshirt.drafts() };
        doors.place.draft();
        doors.place.write("man.toml", MAN);
        doors
    }

    /// The pieces of size M.
    fn medium(&self) -> Vec<Piece> {
        self.drafts[1].pieces.clone()
    }

    fn write_pieces(&self, name: &str, pieces: &[Piece]) {
        self.place.write(name, write_pieces(pieces, &[], Standard::Aama));
    }

    #[track_caller]
    fn toile(&self, arguments: &str) {
        self.place.toile(arguments).ends_with(0);
    }

    /// The garment of some arguments on the man, by Hybrid-GS.
    #[track_caller]
    fn tried(&self, garment: &str) -> Worn {
        self.tried_on("man.toml", garment)
    }

    #[track_caller]
    fn tried_on(&self, body: &str, garment: &str) -> Worn {
        let said =
            self.place.toile(&format!("try --body {body} {garment} --sim hybrid --edge-mm {EDGE_MM} -o out --json"));
        // A mesh as coarse as this lies in the body here and there, which ends with 3 and is no matter here.
        assert!(matches!(said.code, Some(0 | 3)), "{garment}: {}", said.err);
        Worn::of_try(&said.json())
    }
}

/// A DXF file in another unit: coordinates by a factor, the unit as `$INSUNITS`.
fn in_unit(dxf: &str, factor: f64, code: u32) -> String {
    let lines: Vec<&str> = dxf.lines().collect();
    let mut text = String::new();
    for pair in lines.chunks(2) {
        let [group, value] = [pair[0].trim(), pair[1]];
        let value = match group {
            "10" | "20" | "11" | "21" => format!("{:.7}", value.trim().parse::<f64>().expect("a number") * factor),
            _ => value.replace("Units: METRIC", "Notes: none"),
        };
        text += &format!("{group:>3}\r\n{value}\r\n");
        if pair[1] == "AC1009" {
            text += &format!("  9\r\n$INSUNITS\r\n 70\r\n{code}\r\n");
        }
    }
    text
}

/// Pieces with each point moved; a mirrored outline is walked the other way round.
fn moved(pieces: &[Piece], point: impl Fn(V2) -> V2, is_mirrored: bool) -> Vec<Piece> {
    let all = |points: &[V2]| points.iter().map(|&p| point(p)).collect::<Vec<V2>>();
    let ends = |line: Option<[V2; 2]>| line.map(|line| line.map(&point));
    let moved = |piece: &Piece| {
        let mut outline = all(&piece.outline);
        if is_mirrored {
            outline.reverse();
        }
        Piece {
            outline,
            turn_points: all(&piece.turn_points),
            curve_points: all(&piece.curve_points),
            notches: piece.notches.iter().map(|notch| Notch { at: point(notch.at), ..*notch }).collect(),
            grain: ends(piece.grain),
            mirror_line: ends(piece.mirror_line),
            internal_lines: piece.internal_lines.iter().map(|line| all(line)).collect(),
            sew_line: piece.sew_line.as_ref().map(|line| all(line)),
            ..piece.clone()
        }
    };
    pieces.iter().map(moved).collect()
}

/// Pieces called otherwise, block and piece alike.
fn called(pieces: &[Piece], name: impl Fn(usize, &Piece) -> String) -> Vec<Piece> {
    let renamed = |(k, piece): (usize, &Piece)| {
        let name = name(k, piece);
        Piece { block: name.clone(), name, ..piece.clone() }
    };
    pieces.iter().enumerate().map(renamed).collect()
}

#[test]
fn kinds_of_files_give_one_garment() {
    let doors = Doors::new();
    let all: Vec<Piece> = doors.drafts.iter().flat_map(|draft| draft.pieces.clone()).collect();
    doors.write_pieces("nest.dxf", &all);
    doors.toile("pattern convert nest.dxf --standard astm -o astm.dxf");
    doors.toile("pattern convert nest.dxf --standard aama -o aama.dxf");
    doors.toile("pattern convert nest.dxf --with-rul --size S -o sample.dxf");
    doors.toile("pattern convert sample.dxf --rul sample.rul -o graded.dxf");
    doors.toile("pattern features patterns/tshirt-m.dxf -o tee.features.json");
    for (k, piece) in doors.medium().iter().enumerate() {
        doors.write_pieces(&format!("folder/{k}.dxf"), std::slice::from_ref(piece));
    }
    let dxf =
        String::from_utf8(std::fs::read(doors.place.path("patterns/tshirt-m.dxf")).expect("drafted")).expect("ASCII");
    doors.place.write("cm.dxf", in_unit(&dxf, 0.1, 5));
    doors.place.write("inch.dxf", in_unit(&dxf, 1.0 / 25.4, 1));
    doors.place.write("no-unit.dxf", in_unit(&dxf, 1.0, 0));
    let wanted = doors.tried("--pattern patterns/tshirt-m.dxf --seams patterns/tshirt.seams.toml");
    assert_eq!(wanted.lengths.len(), 9);
    for (way, garment) in [
        ("a nest", "--pattern nest.dxf --size M"),
        ("a size in small letters", "--pattern nest.dxf --size m"),
        ("a nest written by AAMA", "--pattern aama.dxf --size M"),
        ("a nest written by ASTM", "--pattern astm.dxf --size M"),
        ("a sample size with its table", "--pattern graded.dxf --size M"),
        ("a folder with a piece a file", "--pattern folder"),
        ("features", "--pattern tee.features.json"),
        ("centimetres", "--pattern cm.dxf"),
        ("inches", "--pattern inch.dxf"),
        ("a unit that is said", "--pattern no-unit.dxf --unit mm"),
    ] {
        let worn = doors.tried(&format!("{garment} --seams patterns/tshirt.seams.toml"));
        worn.is_same(&wanted, way);
    }
}

#[test]
fn drawings_and_names_give_one_garment() {
    let doors = Doors::new();
    let medium = doors.medium();
    let turned = |degrees: f64| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        moved(&medium, |p| V2::new(cos * p.x - sin * p.y + 0.3, sin * p.x + cos * p.y - 0.2), false)
    };
    let from = |start: usize| -> Vec<Piece> {
        let mut pieces = medium.clone();
        for piece in &mut pieces {
            let start = start % piece.outline.len();
            piece.outline.rotate_left(start);
            piece.turn_points.rotate_left(1);
        }
        pieces
    };
    let mut reversed = medium.clone();
    for piece in &mut reversed {
        piece.outline.reverse();
        piece.turn_points.reverse();
    }
    let word = |words: [&'static str; 3]| called(&medium, |k, _| words[k].to_owned());
    let style = |style: &'static str| called(&medium, |_, piece| format!("{style} {}", piece.name));
    doors.write_pieces("as-drafted.dxf", &medium);
    let wanted = doors.tried("--pattern as-drafted.dxf");
    let ways: Vec<(&str, Vec<Piece>)> = vec![
        ("turned by 90 degrees", turned(90.0)),
        ("turned by 180 degrees", turned(180.0)),
        ("mirrored", moved(&medium, |p| V2::new(-p.x, p.y), true)),
        ("begun at another vertex", from(7)),
        ("drawn the other way round", reversed),
        ("called by numbers", called(&medium, |k, _| (k + 1).to_string())),
        ("called in German", word(["VORDERTEIL", "RUECKENTEIL", "AERMEL"])),
        ("called in Chinese", word(["前片", "后片", "袖子"])),
        ("called PALAZZO", style("PALAZZO")),
        ("called FROCK", style("FROCK")),
        ("called JEANNE", style("JEANNE")),
        ("called ROCKY", style("ROCKY")),
        ("called SHORTBREAD", style("SHORTBREAD")),
        ("called BUNDLE", style("BUNDLE")),
    ];
    for (way, pieces) in ways {
        doors.write_pieces("way.dxf", &pieces);
        doors.tried("--pattern way.dxf").is_same(&wanted, way);
    }
    // GarmentCode JSON has no names for its measurements and sews edge to edge: openings and parts of seams are measured.
    doors.toile("pattern propose as-drafted.dxf -o as-drafted.seams.toml");
    doors.toile("pattern convert as-drafted.dxf --seams as-drafted.seams.toml -o tee.json");
    doors.tried("--pattern tee.json").is_same_in_all(&wanted, "GarmentCode");
}

#[test]
fn studies_give_one_garment() {
    let doors = Doors::new();
    let all: Vec<Piece> = doors.drafts.iter().flat_map(|draft| draft.pieces.clone()).collect();
    doors.write_pieces("nest.dxf", &all);
    let seams = "patterns/tshirt.seams.toml";
    let wanted = doors.tried(&format!("--pattern patterns/tshirt-m.dxf --seams {seams}"));
    doors.toile(&format!("style add filed --seams {seams} --pattern S=patterns/tshirt-s.dxf M=patterns/tshirt-m.dxf"));
    doors.toile(&format!("style add nested --seams {seams} --pattern nest.dxf"));
    let sizes = |file: &str| {
        let size = |name: &str| {
            let file = file.replace("SIZE", &name.to_lowercase());
            format!("{{ name = \"{name}\", pattern = \"{file}\" }}")
        };
        ["S", "M", "L"].map(size).join(", ")
    };
    let garment = |name: &str, what: String| {
        format!("[[garment]]\nname = \"{name}\"\nfabric = \"cotton_shirting_light\"\n{what}\n")
    };
    let study = [
        format!("edge_length_mm = {EDGE_MM}\nsimulators = [\"hybrid\"]\n[[subject]]\nid = \"man\"\n{MAN}"),
        garment("files", format!("seams = \"{seams}\"\nsizes = [{}]", sizes("patterns/tshirt-SIZE.dxf"))),
        garment("nest", format!("seams = \"{seams}\"\nsizes = [{}]", sizes("nest.dxf"))),
        garment("filed", "style = \"filed\"".to_owned()),
        garment("nested", "style = \"nested\"".to_owned()),
    ];
    doors.place.write("mine/study.toml", study.join("\n"));
    for file in ["nest.dxf", seams, "patterns/tshirt-s.dxf", "patterns/tshirt-m.dxf", "patterns/tshirt-l.dxf"] {
        let bytes = std::fs::read(doors.place.path(file)).expect("written");
        doors.place.write(&format!("mine/{file}"), bytes);
    }
    // The largest size first, then all in the order of the file.
    doors.toile("run mine --size L --workers 1");
    doors.toile("run mine");
    for garment in ["files", "nest", "filed", "nested"] {
        Worn::of_study(&doors.place, garment, "M").is_same(&wanted, garment);
    }
    let hems = doors.place.sql(
        "SELECT count(DISTINCT l2d_mm), count(DISTINCT size) FROM v_chi
        WHERE stage = 'drape' AND measurement_no = 1 AND garment = 'nest'",
    );
    assert_eq!(hems, ["3,3"], "each size has its own hem");

    // Made by one command, and elsewhere.
    doors.toile(
        "subject add adam --sex male --stature-mm 1760 --chest-girth-mm 960 --waist-girth-mm 840 --hip-girth-mm 980",
    );
    doors.write_pieces("own.dxf", &all);
    doors.toile(&format!("study new recipe --pattern own.dxf --seams {seams} --subject adam"));
    let path = doors.place.path("recipe/study.toml");
    let text = std::fs::read_to_string(&path).expect("made");
    let text = text.replace("edge_length_mm = 15", &format!("edge_length_mm = {EDGE_MM}"));
    std::fs::write(&path, text.replace("[\"fem\", \"hybrid\"]", "[\"hybrid\"]")).expect("writable");
    doors.toile("job handout recipe -o handed");
    let jobs = std::fs::read_dir(doors.place.path("handed")).expect("handed out");
    let mut jobs: Vec<String> =
        jobs.map(|job| job.expect("readable").file_name().to_string_lossy().into_owned()).collect();
    jobs.sort();
    assert_eq!(jobs.len(), 3);
    for job in jobs {
        doors.toile(&format!("job run handed/{job}"));
    }
    doors.toile("job merge handed");
    let garment = doors.place.one("SELECT DISTINCT garment FROM v_chi WHERE study = 'recipe'");
    Worn::of_study(&doors.place, &garment, "M").is_same(&wanted, "a study made by one command, run elsewhere");
}

/// A surface as OBJ: each point through a function.
fn obj(mesh: &TriMesh, point: impl Fn([f64; 3]) -> [f64; 3]) -> String {
    let line = |line: &str| match line.strip_prefix("v ") {
        Some(numbers) => {
            let numbers: Vec<f64> = numbers.split_whitespace().map(|text| text.parse().expect("a number")).collect();
            let [x, y, z] = point([numbers[0], numbers[1], numbers[2]]);
            format!("v {x:.9} {y:.9} {z:.9}\n")
        }
        None => format!("{line}\n"),
    };
    write_obj(mesh).lines().map(line).collect()
}

#[test]
fn surfaces_of_one_body_wear_one_garment() {
    let doors = Doors::new();
    let man = Measurements::of(Sex::Male, 1.76).with(Dimension::ChestGirth, 0.96).with(Dimension::HipGirth, 0.98);
    let mesh = body::build(&man).expect("somebody").mesh;
    let scale = |factor: f64| move |p: [f64; 3]| p.map(|c| c * factor);
    let garment = "--pattern patterns/tshirt-m.dxf --seams patterns/tshirt.seams.toml --sex m";
    doors.place.write("body.obj", obj(&mesh, |p| p));
    let wanted = doors.tried_on("body.obj", garment);
    for (way, text) in [
        ("millimetres", obj(&mesh, scale(1e3))),
        ("inches", obj(&mesh, scale(1e3 / 25.4))),
        ("y up", obj(&mesh, |[x, y, z]| [x, z, -y])),
        ("turned to its back", obj(&mesh, |[x, y, z]| [-x, -y, z])),
    ] {
        doors.place.write("way.obj", text);
        doors.tried_on("way.obj", garment).is_same(&wanted, way);
    }
}

#[test]
fn what_differs_gives_another_garment() {
    let doors = Doors::new();
    // So much more on either side of the middle of front and back, whose seams keep their lengths.
    let wider = |piece: &Piece| {
        let is_trunk = ["front", "back"].iter().any(|name| piece.name.to_lowercase().contains(name));
        let [least, most] = [f64::min, f64::max].map(|of| piece.outline.iter().map(|p| p.x).reduce(of).expect("drawn"));
        // All of it 40 mm from the middle, so that neck and hem get no corner there.
        let more = |p: V2| if is_trunk { 0.02 * ((p.x - 0.5 * (least + most)) / 0.04).clamp(-1.0, 1.0) } else { 0.0 };
        moved(std::slice::from_ref(piece), |p| V2::new(p.x + more(p), p.y), false).swap_remove(0)
    };
    let seams = "--seams patterns/tshirt.seams.toml";
    doors.write_pieces("wider.dxf", &doors.medium().iter().map(wider).collect::<Vec<_>>());
    let base = doors.tried(&format!("--pattern patterns/tshirt-m.dxf {seams}"));
    let wider = doors.tried(&format!("--pattern wider.dxf {seams}"));
    for level in ["chest", "hip"] {
        let more = wider.eases[level] - base.eases[level];
        assert!((more - 80.0).abs() < SAME_MM, "{more} mm more at the {level}");
    }
    doors.place.write("arms.toml", MAN);
    for (way, garment) in [
        ("another fabric", format!("--pattern patterns/tshirt-m.dxf {seams} --fabric interlock_tshirt")),
        ("another pose", format!("--pattern patterns/tshirt-m.dxf {seams} --pose arms_30")),
        ("another size", format!("--pattern patterns/tshirt-l.dxf {seams}")),
    ] {
        assert_ne!(doors.tried(&garment).lengths, base.lengths, "{way}");
    }
    let proposed = doors.tried("--pattern patterns/tshirt-m.dxf");
    let within = doors.tried("--pattern patterns/tshirt-m.dxf --allowance-mm 10");
    assert!(proposed.eases["chest"] - within.eases["chest"] > 35.0, "an allowance of 10 mm: {within:?}");
}
