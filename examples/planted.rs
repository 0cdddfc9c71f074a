//! Planted faults: sound drafted patterns are spoilt by a handle, and `alter` is asked to make them drape as the sound ones do
//! (docs/alter.md).
//!
//! `cargo run --release -p examples --bin planted [EDGE_MM] [WORD ...]` prints a line for each fault whose name contains one of the words.

#![allow(clippy::print_stdout, reason = "an example speaks to whoever runs it")]

use std::error::Error;
use std::path::Path;

use toile::advice::Wish;
use toile::engine::run;
use toile::geom::V2;
use toile::geom::polyline::segment_distance;
use toile::pattern::draft::Model;
use toile::pattern::dxf::{self, Standard};
use toile::pattern::handle::Redrawn;
use toile::pattern::{Handle, Style};
use toile::spec::Study;
use toile::wardrobe::catalogue;

type Outcome<T = ()> = Result<T, Box<dyn Error>>;

/// How near ease, mm, and what is read off the drape, in its unit, are to come to those of the sound pattern.
const EASE_WITHIN: f64 = 1.0;
const DRAPE_WITHIN: f64 = 1.0;

/// A style that is spoilt.
struct Fault {
    name: &'static str,
    model: Model,
    size: usize,
    subject: &'static str,
    handles: &'static [(Handle, f64)],
}

const MAN: &str = "sex = \"male\"\nstature_mm = 1760\nchest_girth_mm = 960\nwaist_girth_mm = 850";
const LARGE: &str =
    "sex = \"male\"\nstature_mm = 1790\nchest_girth_mm = 1080\nwaist_girth_mm = 990\nhip_girth_mm = 1050";
const WOMAN: &str =
    "sex = \"female\"\nstature_mm = 1660\nchest_girth_mm = 890\nwaist_girth_mm = 720\nhip_girth_mm = 960";

/// Amounts in mm. Girths by half of them; a shoulder of 150 mm falls by 16 mm at 6 degrees.
const FAULTS: [Fault; 12] = [
    Fault {
        name: "tshirt chest -30 mm",
        model: Model::Tshirt,
        size: 1,
        subject: MAN,
        handles: &[(Handle::Chest, -15.0)],
    },
    Fault {
        name: "tshirt shoulder +6 degrees",
        model: Model::Tshirt,
        size: 1,
        subject: MAN,
        handles: &[(Handle::ShoulderSlope, 16.0)],
    },
    Fault {
        name: "tshirt back 15 mm short",
        model: Model::Tshirt,
        size: 1,
        subject: MAN,
        handles: &[(Handle::BackLength, -15.0)],
    },
    Fault {
        name: "tshirt sleeve narrow by 25 mm",
        model: Model::Tshirt,
        size: 1,
        subject: MAN,
        handles: &[(Handle::Bicep, -12.5)],
    },
    Fault {
        name: "tshirt front neck 15 mm deep",
        model: Model::Tshirt,
        size: 1,
        subject: MAN,
        handles: &[(Handle::FrontNeckDepth, 15.0)],
    },
    Fault {
        name: "trousers rise -20 mm",
        model: Model::Trousers,
        size: 1,
        subject: LARGE,
        handles: &[(Handle::FrontRise, -20.0), (Handle::BackRise, -20.0)],
    },
    Fault {
        name: "trousers back rise -20 mm",
        model: Model::Trousers,
        size: 1,
        subject: LARGE,
        handles: &[(Handle::BackRise, -20.0)],
    },
    Fault {
        name: "trousers hip -30 mm",
        model: Model::Trousers,
        size: 1,
        subject: LARGE,
        handles: &[(Handle::Hip, -15.0)],
    },
    Fault {
        name: "dress chest -30 mm",
        model: Model::Dress,
        size: 0,
        subject: WOMAN,
        handles: &[(Handle::Chest, -15.0)],
    },
    Fault {
        name: "dress shoulder +6 degrees",
        model: Model::Dress,
        size: 0,
        subject: WOMAN,
        handles: &[(Handle::ShoulderSlope, 8.0)],
    },
    Fault {
        name: "dress back 15 mm short",
        model: Model::Dress,
        size: 0,
        subject: WOMAN,
        handles: &[(Handle::BackLength, -15.0)],
    },
    Fault {
        name: "dress skirt 20 mm short",
        model: Model::Dress,
        size: 0,
        subject: WOMAN,
        handles: &[(Handle::SkirtLength, -20.0)],
    },
];

fn main() -> Outcome {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let edge_mm: f64 = arguments.first().map_or(Ok(15.0), |text| text.parse())?;
    let words = arguments.get(1..).unwrap_or_default();
    let folder = std::env::temp_dir().join(format!("toile-planted-{}", std::process::id()));
    for fault in FAULTS.iter().filter(|fault| words.is_empty() || words.iter().any(|word| fault.name.contains(word))) {
        match undone(fault, edge_mm, &folder) {
            Ok(told) => println!("{}: {told}", fault.name),
            Err(error) => println!("{}: {error}", fault.name),
        }
    }
    std::fs::remove_dir_all(folder)?;
    Ok(())
}

/// What `alter` finds of a fault.
fn undone(fault: &Fault, edge_mm: f64, folder: &Path) -> Outcome<String> {
    let sound = study_of(fault, &[], edge_mm, &folder.join("sound"))?;
    let wish = Wish {
        garment: None,
        subject: None,
        size: "planted".to_owned(),
        targets: std::collections::BTreeMap::new(),
        limit_mm: None,
        without: Vec::new(),
        moves_mm: Vec::new(),
        is_draped: false,
        is_nest: false,
        standard: Standard::Aama,
    };
    let stands = toile::advice::standing(&sound, &wish)?;
    let moves: Vec<(Handle, f64)> = fault.handles.iter().map(|(handle, mm)| (*handle, 1e-3 * mm)).collect();
    let spoilt = study_of(fault, &moves, edge_mm, &folder.join("spoilt"))?;
    // A spoilt garment may not reach a level that the sound one covers.
    let known = toile::advice::standing(&spoilt, &wish)?;
    let is_known =
        |one: &&toile::advice::Standing| one.unit == "mm" && known.iter().any(|other| other.name == one.name);
    let asked = stands.iter().filter(is_known).map(|one| {
        let within = if one.is_ease { EASE_WITHIN } else { DRAPE_WITHIN };
        (one.name.clone(), [one.value - within, one.value + within])
    });
    let found = toile::advice::alter(&spoilt, &Wish { targets: asked.collect(), ..wish })?;
    let moved: Vec<String> = found.moves.iter().map(|one| format!("{} {:+.1}", one.handle, one.amount_mm)).collect();
    let missed = found.readings.iter().filter(|one| !one.is_met()).count();
    let (dxf, seams) = (file(&found.files, ".dxf")?, file(&found.files, ".toml")?);
    let repaired = Style::read(&dxf::read(dxf, "repaired", None)?.pieces, seams, "seams.toml")?;
    let off_mm = 1e3 * apart_m(&style_of(fault)?, &repaired);
    Ok(format!(
        "{} drapes, {} of {} readings off by more than {DRAPE_WITHIN} mm, outlines within {:.1} mm: {}",
        found.drapes,
        missed,
        found.readings.len(),
        off_mm,
        moved.join(", ")
    ))
}

/// The bytes of the file whose name ends so.
fn file<'f>(files: &'f [(String, Vec<u8>)], end: &str) -> Outcome<&'f [u8]> {
    let found = files.iter().find(|(name, _)| name.ends_with(end));
    Ok(found.map(|(_, bytes)| bytes.as_slice()).ok_or("nothing was written")?)
}

/// The sound style of a fault.
fn style_of(fault: &Fault) -> Outcome<Style> {
    let drafts = fault.model.drafts();
    Ok(Style::read(&drafts.get(fault.size).ok_or("no such size")?.pieces, fault.model.seams(), "seams.toml")?)
}

/// Greatest distance of the outline of a piece from that of the other style's, m.
fn apart_m(one: &Style, other: &Style) -> f64 {
    let from = |a: &[V2], b: &[V2]| {
        let off = |p: &V2| {
            let sides = (0..b.len()).map(|k| segment_distance(&b[k], &b[(k + 1) % b.len()], p));
            sides.fold(f64::MAX, f64::min)
        };
        a.iter().map(off).fold(0.0, f64::max)
    };
    let pairs = one.pieces.iter().zip(&other.pieces).map(|(a, b)| (a.outline(), b.outline()));
    pairs.map(|(a, b)| from(&a, &b).max(from(&b, &a))).fold(0.0, f64::max)
}

/// A study of a drafted size, spoilt by handles.
fn study_of(fault: &Fault, moves: &[(Handle, f64)], edge_mm: f64, folder: &Path) -> Outcome<Study> {
    std::fs::create_dir_all(folder)?;
    let drafts = fault.model.drafts();
    let draft = drafts.get(fault.size).ok_or("no such size")?;
    let seams = fault.model.seams();
    let pieces = Redrawn::of(&draft.pieces, seams, "seams.toml", moves)?.pieces();
    Style::read(&pieces, seams, "seams.toml")?;
    let texts = [("Style Name".to_owned(), "planted".to_owned()), ("Units".to_owned(), "METRIC".to_owned())];
    std::fs::write(folder.join("planted.dxf"), dxf::write_pieces(&pieces, &texts, Standard::Aama))?;
    std::fs::write(folder.join("planted.seams.toml"), seams)?;
    let text = format!(
        "name = \"planted\"\nsimulators = [\"fem\"]\nedge_length_mm = {edge_mm}\n\n[[garment]]\nname = \"planted\"\nfabric = \"cotton_shirting_light\"\n\
        seams = \"planted.seams.toml\"\nsizes = [{{ name = \"planted\", pattern = \"planted.dxf\" }}]\n\n[[subject]]\nid = \"one\"\n{}\n",
        fault.subject
    );
    std::fs::write(folder.join("study.toml"), text)?;
    let store = catalogue::open(&folder.join("planted.sqlite"), false)?;
    Ok(run::load_study(&store, folder)?)
}
