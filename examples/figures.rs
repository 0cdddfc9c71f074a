//! Figures planted into bodies, and what `alter` proposes for them beside what books on pattern alteration say (docs/alter.md).
//!
//! `cargo run --release -p examples --bin figures [--drape] [PATTERN SEAMS SIZE male|female]` prints a row for each figure: on the
//! drafted T-shirt, trousers and dress, or on the pattern of a file.

#![allow(clippy::print_stdout, reason = "an example speaks to whoever runs it")]

use std::error::Error;
use std::path::{Path, PathBuf};

use toile::advice::{Alteration, Wish, alter};
use toile::engine::run;
use toile::pattern::Handle;
use toile::pattern::draft::Model;
use toile::pattern::dxf::{self, Standard};
use toile::spec::Study;
use toile::wardrobe::catalogue;

type Outcome<T = ()> = Result<T, Box<dyn Error>>;

/// Figures by the garments that books alter for them, with the handle that is their operation and its share of the figure's
/// amount: of a seat seam the wedge is two thirds, the fork the rest.
const FIGURES: [(&str, &str, &[&str], [f64; 2]); 16] = [
    ("legs", "flat_seat", &["seat"], [0.5, 1.0]),
    ("legs", "prominent_seat", &["seat"], [0.5, 1.0]),
    ("legs", "hollow_abdomen", &["abdomen"], [0.5, 1.1]),
    ("legs", "prominent_abdomen", &["abdomen"], [0.5, 1.1]),
    ("legs", "sway_back", &["back_rise"], [1.0, 1.0]),
    ("legs", "long_rise", &["rise"], [1.0, 1.0]),
    ("legs", "short_rise", &["rise"], [1.0, 1.0]),
    ("top", "round_back", &["upper_back"], [1.0, 1.0]),
    ("top", "erect_back", &["upper_back"], [1.0, 1.0]),
    ("top", "sway_back", &["back_length", "sway_back"], [1.0, 1.0]),
    ("top", "sloping_shoulders", &["shoulder_slope"], [1.0, 1.0]),
    ("top", "square_shoulders", &["shoulder_slope"], [1.0, 1.0]),
    ("top", "forward_shoulders", &["forward_shoulder"], [1.0, 1.0]),
    ("top", "prominent_abdomen", &["front_length"], [1.0, 1.0]),
    ("top", "full_bust", &["bust"], [1.0, 1.0]),
    ("top", "small_bust", &["bust"], [1.0, 1.0]),
];
/// Greatest departure of an amount from what was planted, mm.
const WITHIN_MM: f64 = 5.0;

/// A garment with somebody of its size.
struct Worn {
    name: String,
    kind: &'static str,
    pattern: PathBuf,
    seams: PathBuf,
    size: String,
    sex: &'static str,
    measures: &'static str,
}

const MAN: &str = "stature_mm = 1760\nchest_girth_mm = 960\nwaist_girth_mm = 850";
const WOMAN: &str = "stature_mm = 1660\nchest_girth_mm = 890\nwaist_girth_mm = 720\nhip_girth_mm = 960";

fn main() -> Outcome {
    let (flags, rest): (Vec<String>, Vec<String>) = std::env::args().skip(1).partition(|text| text.starts_with("--"));
    let is_draped = flags.iter().any(|flag| flag == "--drape");
    let folder = std::env::temp_dir().join(format!("toile-figures-{}", std::process::id()));
    std::fs::create_dir_all(&folder)?;
    let worn = match rest.as_slice() {
        [pattern, seams, size, sex] => vec![own(pattern, seams, size, sex)?],
        _ => [
            (Model::Tshirt, 1, "top", "male"),
            (Model::Trousers, 1, "legs", "male"),
            (Model::Dress, 0, "top", "female"),
        ]
        .into_iter()
        .map(|(model, size, kind, sex)| drafted(&folder, model, size, kind, sex))
        .collect::<Outcome<_>>()?,
    };
    let [mut asked, mut same, mut near] = [0; 3];
    println!("| garment | figure | planted, mm | book | proposal |\n|---|---|---|---|---|");
    for worn in &worn {
        let women = |figure: &str| figure.ends_with("_bust");
        for (_, figure, book, share) in
            FIGURES.iter().filter(|(kind, figure, ..)| *kind == worn.kind && (worn.sex == "female" || !women(figure)))
        {
            match proposed(worn, figure, is_draped, &folder) {
                Ok((planted_mm, before, found)) => {
                    let own = found.moves.iter().find(|one| book.contains(&one.handle));
                    let [least, most] = share.map(|share| share * planted_mm);
                    let is_near = own.is_some_and(|one| {
                        let (low, high) = (least.min(most) - WITHIN_MM, least.max(most) + WITHIN_MM);
                        (low..=high).contains(&one.amount_mm)
                    });
                    asked += 1;
                    same += usize::from(own.is_some());
                    near += usize::from(is_near);
                    println!(
                        "| {} | {figure} | {planted_mm:+.0} | {} | {} |",
                        worn.name,
                        book.join(" or "),
                        told(before.as_ref(), &found)
                    );
                }
                Err(error) => println!("| {} | {figure} | | {} | {error} |", worn.name, book.join(" or ")),
            }
        }
    }
    println!("\nsame operation {same} of {asked}, amount as planted {near}");
    std::fs::remove_dir_all(folder)?;
    Ok(())
}

/// Planted amount of a figure, mm, the drape of the pattern as it is, where it is asked for, and the proposal.
fn proposed(
    worn: &Worn,
    figure: &str,
    is_draped: bool,
    folder: &Path,
) -> Outcome<(f64, Option<Alteration>, Alteration)> {
    let study = study_of(worn, figure, folder)?;
    let subject = study.subjects.first().ok_or("no subject")?;
    let planted = subject.person.figures.iter().next().map_or(0.0, |(_, amount_mm)| amount_mm);
    let wish = Wish { is_draped, ..Wish::of("worn", "one", &worn.size) };
    let found = alter(&study, &wish)?;
    let moved = found.moves.first().filter(|_| is_draped).and_then(|moved| Handle::named(moved.handle));
    let unmoved = moved.map(|handle| Wish { moves_mm: vec![(handle, 0.0)], ..wish });
    Ok((planted, unmoved.map(|wish| alter(&study, &wish)).transpose()?, found))
}

/// Signs on a drape, with their readings.
fn signs(found: &Alteration) -> String {
    let told: Vec<String> =
        found.signs.iter().map(|sign| format!("{} {:+.1} {}", sign.sign, sign.value, sign.unit)).collect();
    if told.is_empty() { "none".to_owned() } else { told.join(", ") }
}

fn told(before: Option<&Alteration>, found: &Alteration) -> String {
    let moves: Vec<String> = found
        .moves
        .iter()
        .map(|one| format!("{} {:+.1} ({})", one.handle, one.amount_mm, one.serves.join(", ")))
        .collect();
    let was =
        before.map_or(String::new(), |before| format!("; signs before: {}, after: {}", signs(before), signs(found)));
    let drape = found.drape.as_ref().map_or(String::new(), |drape| format!("; {}{was}", drape.words()));
    format!("{}{drape}", if moves.is_empty() { "nothing".to_owned() } else { moves.join(", ") })
}

/// A garment of a file.
fn own(pattern: &str, seams: &str, size: &str, sex: &str) -> Outcome<Worn> {
    let text = std::fs::read_to_string(seams)?;
    let kind = if text.contains("leg_") { "legs" } else { "top" };
    let [sex, measures] = if sex == "female" { ["female", WOMAN] } else { ["male", MAN] };
    let (pattern, seams) = (std::fs::canonicalize(pattern)?, std::fs::canonicalize(seams)?);
    let name = pattern.file_stem().map_or(String::new(), |stem| stem.to_string_lossy().into_owned());
    Ok(Worn { name, kind, pattern, seams, size: size.to_owned(), sex, measures })
}

/// A drafted garment in a size.
fn drafted(folder: &Path, model: Model, size: usize, kind: &'static str, sex: &'static str) -> Outcome<Worn> {
    let drafts = model.drafts();
    let draft = drafts.get(size).ok_or("no such size")?;
    let texts = [("Style Name".to_owned(), model.as_str().to_owned()), ("Units".to_owned(), "METRIC".to_owned())];
    let [pattern, seams] = ["dxf", "seams.toml"].map(|end| folder.join(format!("{}.{end}", model.as_str())));
    std::fs::write(&pattern, dxf::write_pieces(&draft.pieces, &texts, Standard::Aama))?;
    std::fs::write(&seams, model.seams())?;
    let measures = if sex == "female" { WOMAN } else { MAN };
    Ok(Worn { name: model.as_str().to_owned(), kind, pattern, seams, size: "M".to_owned(), sex, measures })
}

/// A study of a garment on somebody with a figure.
fn study_of(worn: &Worn, figure: &str, folder: &Path) -> Outcome<Study> {
    let text = format!(
        "name = \"figures\"\nsimulators = [\"fem\"]\nedge_length_mm = 20\n\n[[garment]]\nname = \"worn\"\nfabric = \"cotton_shirting_light\"\n\
        seams = {:?}\nsizes = [{{ name = {:?}, pattern = {:?} }}]\n\n[[subject]]\nid = \"one\"\nsex = {:?}\n{}\nfigure = [{figure:?}]\n",
        worn.seams, worn.size, worn.pattern, worn.sex, worn.measures
    );
    std::fs::write(folder.join("study.toml"), text)?;
    let store = catalogue::open(&folder.join("figures.sqlite"), false)?;
    Ok(run::load_study(&store, folder)?)
}
