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

use super::program::{Place, files};

/// Difference of two lengths in the pattern that are one, mm.
const SAME_MM: f64 = 1e-3;
/// Difference of two chi that are one.
const SAME_CHI: f64 = 1e-3;

/// Difference that curves written as cubics make to all lengths together, mm.
const SAME_CURVE_MM: f64 = 0.1;

/// Edge length of meshes of one drawing, mm.
const COARSE_MM: u32 = 60;
/// Edge length where drawings differ, and with them their meshes: on coarser ones Hybrid-GS restores lengths to within
/// 0.6 % only.
const FINE_MM: u32 = 25;

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

    /// From the results of a study, of one of its garments in one size on one of its subjects.
    fn of_study(place: &Place, garment: &str, subject: &str) -> Self {
        let cells = format!("garment = '{garment}' AND subject = '{subject}' AND size LIKE 'M'");
        let rows = place.sql(&format!("SELECT l2d_mm, chi FROM v_chi WHERE stage = 'drape' AND {cells}"));
        let number = |text: &str| text.parse::<f64>().unwrap_or_else(|_| panic!("{text} is no number"));
        let lengths = rows.iter().map(|row| row.split_once(',').expect("two cells"));
        let lengths = lengths.map(|(l2d, chi)| (number(l2d), number(chi))).collect();
        let rows = place.sql(&format!("SELECT level, ease_mm FROM v_ease WHERE {cells}"));
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

/// A way to draw and to call the pieces of a garment, with its name.
type Way = (&'static str, Vec<Piece>);

/// A place with the drafted T-shirt and somebody to wear it.
struct Doors {
    place: Place,
    drafts: Vec<Draft>,
    /// Edge length of the cloth's meshes, mm.
    edge_mm: u32,
}

impl Doors {
    fn new(edge_mm: u32) -> Self {
        let doors = Self { place: Place::new(), drafts: Model::Tshirt.drafts(), edge_mm };
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
        let edge_mm = self.edge_mm;
        let said =
            self.place.toile(&format!("try --body man.toml {garment} --sim hybrid --edge-mm {edge_mm} -o out --json"));
        // A mesh as coarse as this lies in the body here and there, which ends with 3 and is no matter here.
        assert!(matches!(said.code, Some(0 | 3)), "{garment}: {}", said.err);
        Worn::of_try(&said.json())
    }

    /// Writes a study by Hybrid-GS: its subjects, and garments by their names and keys.
    fn write_study(&self, subjects: &str, garments: &[(&str, String)]) {
        let garment = |(name, keys): &(&str, String)| format!("[[garment]]\nname = {name:?}\n{keys}");
        let garments: String = garments.iter().map(garment).collect();
        let head = format!("name = \"mine\"\nedge_length_mm = {}\nsimulators = [\"hybrid\"]\n", self.edge_mm);
        self.place.write("study.toml", head + subjects + &garments);
    }

    /// Runs a study in which the man wears a garment for each way, and compares all with the first.
    #[track_caller]
    fn are_same(&self, ways: &[(&str, String)]) -> Worn {
        self.write_study(&man(), ways);
        self.toile("run . --no-report");
        let mut worn = ways.iter().map(|(way, _)| (way, Worn::of_study(&self.place, way, "man")));
        let (_, wanted) = worn.next().expect("one way");
        worn.for_each(|(way, worn)| worn.is_same(&wanted, way));
        wanted
    }

    /// As `are_same`, of pieces whose seams are proposed.
    #[track_caller]
    fn are_same_pieces(&self, ways: &[Way]) -> Worn {
        let proposed = |(k, (way, pieces)): (usize, &Way)| {
            self.write_pieces(&format!("{k}.dxf"), pieces);
            self.toile(&format!("pattern propose {k}.dxf -o {k}.seams.toml"));
            (*way, garment(&format!("{k}.seams.toml"), "M", &format!("{k}.dxf")))
        };
        self.are_same(&ways.iter().enumerate().map(proposed).collect::<Vec<_>>())
    }
}

/// The man as a subject of a study.
fn man() -> String {
    format!("[[subject]]\nid = \"man\"\n{MAN}")
}

/// Keys of a garment of one size.
fn garment(seams: &str, size: &str, pattern: &str) -> String {
    format!(
        "fabric = \"cotton_shirting_light\"\nseams = \"{seams}\"\n\
         sizes = [{{ name = \"{size}\", pattern = \"{pattern}\" }}]\n"
    )
}

/// Seams of the drafted T-shirt.
const SEAMS: &str = "patterns/tshirt.seams.toml";

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
    let doors = Doors::new(FINE_MM);
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
    let wanted = doors.are_same(&[
        ("a file a size", garment(SEAMS, "M", "patterns/tshirt-m.dxf")),
        ("a nest", garment(SEAMS, "M", "nest.dxf")),
        ("a size in small letters", garment(SEAMS, "m", "nest.dxf")),
        ("a nest written by AAMA", garment(SEAMS, "M", "aama.dxf")),
        ("a nest written by ASTM", garment(SEAMS, "M", "astm.dxf")),
        ("a sample size with its table", garment(SEAMS, "M", "graded.dxf")),
        ("a folder with a piece a file", garment(SEAMS, "M", "folder")),
        ("features", garment(SEAMS, "M", "tee.features.json")),
        ("centimetres", garment(SEAMS, "M", "cm.dxf")),
        ("inches", garment(SEAMS, "M", "inch.dxf")),
        ("a unit that is said", garment(SEAMS, "M", "no-unit.dxf") + "unit = \"mm\"\n"),
    ]);
    assert_eq!(wanted.lengths.len(), 9);
    let tried = doors.tried(&format!("--pattern nest.dxf --size m --seams {SEAMS}"));
    tried.is_same(&wanted, "tried on");
}

#[test]
fn drawings_give_one_garment() {
    let doors = Doors::new(FINE_MM);
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
    let wanted = doors.are_same_pieces(&[
        ("as drafted", medium.clone()),
        ("turned by 90 degrees", turned(90.0)),
        ("turned by 180 degrees", turned(180.0)),
        ("mirrored", moved(&medium, |p| V2::new(-p.x, p.y), true)),
        ("begun at another vertex", from(7)),
        ("drawn the other way round", reversed),
    ]);
    // GarmentCode JSON has no names for its measurements and sews edge to edge: openings and parts of seams are measured.
    doors.toile("pattern convert 0.dxf --seams 0.seams.toml -o tee.json");
    doors.tried("--pattern tee.json").is_same_in_all(&wanted, "GarmentCode");
}

#[test]
fn names_give_one_garment() {
    let doors = Doors::new(COARSE_MM);
    let medium = doors.medium();
    let word = |words: [&'static str; 3]| called(&medium, |k, _| words[k].to_owned());
    let style = |style: &'static str| called(&medium, |_, piece| format!("{style} {}", piece.name));
    let wanted = doors.are_same_pieces(&[
        ("as drafted", medium.clone()),
        ("called by numbers", called(&medium, |k, _| (k + 1).to_string())),
        ("called in German", word(["VORDERTEIL", "RUECKENTEIL", "AERMEL"])),
        ("called in Chinese", word(["前片", "后片", "袖子"])),
        ("called PALAZZO", style("PALAZZO")),
        ("called FROCK", style("FROCK")),
        ("called JEANNE", style("JEANNE")),
        ("called ROCKY", style("ROCKY")),
        ("called SHORTBREAD", style("SHORTBREAD")),
        ("called BUNDLE", style("BUNDLE")),
    ]);
    doors.tried("--pattern 0.dxf").is_same(&wanted, "tried on, where seams are proposed as well");
}

#[test]
fn studies_give_one_garment() {
    let doors = Doors::new(COARSE_MM);
    let all: Vec<Piece> = doors.drafts.iter().flat_map(|draft| draft.pieces.clone()).collect();
    doors.write_pieces("nest.dxf", &all);
    doors.toile(&format!("style add filed --seams {SEAMS} --pattern S=patterns/tshirt-s.dxf M=patterns/tshirt-m.dxf"));
    doors.toile(&format!("style add nested --seams {SEAMS} --pattern nest.dxf"));
    let sizes = |file: &str| {
        let size = |name: &str| {
            let file = file.replace("SIZE", &name.to_lowercase());
            format!("{{ name = \"{name}\", pattern = \"{file}\" }}")
        };
        format!("seams = \"{SEAMS}\"\nsizes = [{}]", ["M", "L"].map(size).join(", "))
    };
    let garment = |keys: String| format!("fabric = \"cotton_shirting_light\"\n{keys}\n");
    let ways = [
        ("files", garment(sizes("patterns/tshirt-SIZE.dxf"))),
        ("nest", garment(sizes("nest.dxf"))),
        ("filed", garment("style = \"filed\"".to_owned())),
        ("nested", garment("style = \"nested\"\nsizes = [\"L\", \"M\"]".to_owned())),
    ];
    // The largest size first, then all in the order of the file.
    doors.write_study(&man(), &ways);
    doors.toile("run . --size L --workers 1 --no-report");
    let wanted = doors.are_same(&ways);
    let hems = doors.place.sql(
        "SELECT count(DISTINCT l2d_mm), count(DISTINCT size) FROM v_chi
        WHERE stage = 'drape' AND measurement_no = 1 AND garment = 'nest'",
    );
    assert_eq!(hems, ["2,2"], "each size has its own hem");

    // Made by one command, and elsewhere.
    doors.toile(
        "subject add adam --sex male --stature-mm 1760 --chest-girth-mm 960 --waist-girth-mm 840 --hip-girth-mm 980",
    );
    doors.write_pieces("own.dxf", &all);
    doors.toile(&format!("study new recipe --pattern own.dxf --seams {SEAMS} --subject adam"));
    let path = doors.place.path("recipe/study.toml");
    let text = std::fs::read_to_string(&path).expect("made");
    let text = text.replace("edge_length_mm = 15", &format!("edge_length_mm = {}", doors.edge_mm));
    std::fs::write(&path, text.replace("[\"fem\", \"hybrid\"]", "[\"hybrid\"]")).expect("writable");
    doors.toile("job handout recipe --size M -o handed");
    let jobs = files(&doors.place.path("handed"));
    assert_eq!(jobs.len(), 1);
    jobs.iter().for_each(|job| doors.toile(&format!("job run handed/{job}")));
    doors.toile("job merge handed");
    let garment = doors.place.one("SELECT DISTINCT garment FROM v_chi WHERE study = 'recipe'");
    Worn::of_study(&doors.place, &garment, "adam").is_same(&wanted, "a study made by one command, run elsewhere");
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
    let doors = Doors::new(FINE_MM);
    let man = Measurements::of(Sex::Male, 1.76).with(Dimension::ChestGirth, 0.96).with(Dimension::HipGirth, 0.98);
    let mesh = body::build(&man).expect("somebody").mesh;
    let scale = |factor: f64| move |p: [f64; 3]| p.map(|c| c * factor);
    let ways = [
        ("metres", obj(&mesh, |p| p)),
        ("millimetres", obj(&mesh, scale(1e3))),
        ("inches", obj(&mesh, scale(1e3 / 25.4))),
        ("y up", obj(&mesh, |[x, y, z]| [x, z, -y])),
        ("turned to its back", obj(&mesh, |[x, y, z]| [-x, -y, z])),
    ];
    let subject = |(way, text): &(&str, String)| {
        doors.place.write(&format!("{way}.obj"), text);
        format!("[[subject]]\nid = {way:?}\nscan = \"{way}.obj\"\nsex = \"male\"\n")
    };
    let subjects: String = ways.iter().map(subject).collect();
    doors.write_study(&subjects, &[("tee", garment(SEAMS, "M", "patterns/tshirt-m.dxf"))]);
    doors.toile("run . --no-report");
    let worn = |way: &str| Worn::of_study(&doors.place, "tee", way);
    ways.iter().for_each(|(way, _)| worn(way).is_same(&worn("metres"), way));
}

#[test]
fn what_differs_gives_another_garment() {
    let doors = Doors::new(COARSE_MM);
    // So much more on either side of the middle of front and back, whose seams keep their lengths.
    let wider = |piece: &Piece| {
        let is_trunk = ["front", "back"].iter().any(|name| piece.name.to_lowercase().contains(name));
        let [least, most] = [f64::min, f64::max].map(|of| piece.outline.iter().map(|p| p.x).reduce(of).expect("drawn"));
        // All of it 40 mm from the middle, so that neck and hem get no corner there.
        let more = |p: V2| if is_trunk { 0.02 * ((p.x - 0.5 * (least + most)) / 0.04).clamp(-1.0, 1.0) } else { 0.0 };
        moved(std::slice::from_ref(piece), |p| V2::new(p.x + more(p), p.y), false).swap_remove(0)
    };
    doors.write_pieces("wider.dxf", &doors.medium().iter().map(wider).collect::<Vec<_>>());
    doors.toile("pattern propose patterns/tshirt-m.dxf -o proposed.seams.toml");
    doors.toile("pattern propose patterns/tshirt-m.dxf --allowance-mm 10 -o within.seams.toml");
    let medium = "patterns/tshirt-m.dxf";
    let on_man = |keys: String| keys + "subjects = [\"man\"]\n";
    let knit = |keys: String| keys.replace("cotton_shirting_light", "interlock_tshirt");
    let garments = [
        ("base", on_man(garment(SEAMS, "M", medium))),
        ("wider", on_man(garment(SEAMS, "M", "wider.dxf"))),
        ("another fabric", on_man(knit(garment(SEAMS, "M", medium)))),
        ("another pose", garment(SEAMS, "M", medium) + "subjects = [\"raised\"]\n"),
        ("another size", on_man(garment(SEAMS, "M", "patterns/tshirt-l.dxf"))),
        ("proposed", on_man(garment("proposed.seams.toml", "M", medium))),
        ("within", on_man(garment("within.seams.toml", "M", medium))),
    ];
    let raised = format!("[[subject]]\nid = \"raised\"\npose = \"arms_30\"\n{MAN}");
    doors.write_study(&(man() + &raised), &garments);
    doors.toile("run . --no-report");
    let worn = |name: &str| Worn::of_study(&doors.place, name, if name == "another pose" { "raised" } else { "man" });
    let base = worn("base");
    for level in ["chest", "hip"] {
        let more = worn("wider").eases[level] - base.eases[level];
        assert!((more - 80.0).abs() < SAME_MM, "{more} mm more at the {level}");
    }
    for way in ["another fabric", "another pose", "another size"] {
        assert_ne!(worn(way).lengths, base.lengths, "{way}");
    }
    let (proposed, within) = (worn("proposed"), worn("within"));
    assert!(proposed.eases["chest"] - within.eases["chest"] > 35.0, "an allowance of 10 mm: {within:?}");
}
