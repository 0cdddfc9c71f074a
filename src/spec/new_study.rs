//! New study files, for people to read and edit: their comments show further keys.

use std::fmt::Write;
use std::path::Path;

use crate::export::{list, quoted};
use crate::fields::{MEASUREMENTS, sex_name};
use crate::parameters::SIMULATORS;
use crate::patterns::Model;
use body::{Dimension, Measurements, Sex};
use fit::Simulator;
use fit::target::Intended;
use geom::units::from_mm;
use store::files::write_files;
use store::{Result, StudyError};

pub struct Outline<'a> {
    /// `None` for that of the folder.
    pub name: Option<&'a str>,
    pub simulators: &'a [Simulator],
    /// Subjects of the catalogue.
    pub known: Vec<&'a str>,
    pub measured: Vec<(&'a str, Measurements)>,
    /// Subjects with the paths of their scans.
    pub scanned: Vec<(&'a str, String)>,
    pub garments: Vec<Worn<'a>>,
    pub fabric: &'a str,
    /// `None` for the default.
    pub fit: Option<Intended>,
    pub outfits: Vec<Layered<'a>>,
}

pub struct Layered<'a> {
    pub name: &'a str,
    /// Names of the garments, the inner first.
    pub layers: Vec<&'a str>,
    /// One size of each layer; `None` for all that they share.
    pub sizes: Option<Vec<&'a str>>,
}

#[derive(Default)]
pub struct Worn<'a> {
    /// Name of the style, which becomes the name of the garment.
    pub style: &'a str,
    pub seams: Option<String>,
    /// Unit of the patterns, where their files name none.
    pub unit: Option<String>,
    /// `None` for all.
    pub subjects: Option<Vec<String>>,
    /// Sizes with the paths of their patterns.
    pub sizes: Vec<(String, String)>,
}

impl Outline<'_> {
    pub fn text(&self) -> String {
        let subjects = self.known.len() + self.measured.len() + self.scanned.len();
        let wearers = |garment: &Worn<'_>| garment.subjects.as_ref().map_or(subjects, Vec::len);
        let worn: usize = self.garments.iter().map(|garment| garment.sizes.len() * wearers(garment)).sum();
        let simulators: Vec<&str> = self.simulators.iter().map(|simulator| simulator.as_str()).collect();
        let name = self.name.map_or("# name = \"...\"              # default: the folder's name".to_owned(), |name| {
            format!("name = {}", quoted(name))
        });
        let mut text = format!(
            r#"# A study: who wears what, by which simulators. `toile study check` checks it, `toile run` runs it.
# Sizes on subjects, simulators: {worn} x {} = {} simulations.

{name}
simulators = {}
edge_length_mm = 15         # of the finest cloth mesh: 25 is quick, 10 is fine
# repeats = 1
# fit = {{ tight_below_mm = 50, loose_above_mm = 100 }}
# time_limit_s = 600          # also of one garment, as memory_limit_mb, priority and after = ["..."]
"#,
            simulators.len(),
            worn * simulators.len(),
            list(&simulators)
        );
        self.write_subjects(&mut text);
        text += "\n# A style of the catalogue (`toile style ls`) needs no files: style = \"...\", sizes = [\"S\"].\n";
        for garment in &self.garments {
            self.write_garment(&mut text, garment);
        }
        for Layered { name, layers, sizes } in &self.outfits {
            let _ = writeln!(text, "[[outfit]]\nname = {}\nlayers = {}", quoted(name), list(layers));
            match sizes {
                Some(sizes) => drop(writeln!(text, "sizes = {}\n", list(sizes))),
                None => text.push_str(
                    "# sizes = [\"...\"]            # one size of each layer; default: all that they share\n\n",
                ),
            }
        }
        text += "# Everything again in other cloths and on finer meshes; parameters of the simulators too, such as \
                 fem.offset_mu.\n# [[sweep]]\n# fabric = [\"cotton_shirting_light\", \"interlock_tshirt\"]\n\
                 # edge_length_mm = [20, 15]\n";
        text
    }

    // Writing into a `String` does not fail, here and below.
    fn write_subjects(&self, text: &mut String) {
        if !self.known.is_empty() {
            *text += "\n# Of the catalogue (`toile subject ls`), as it is when the study is run.\n";
        }
        for name in &self.known {
            let _ = writeln!(text, "[[subject]]\nid = {0}\nlike = {0}\n", quoted(name));
        }
        for (name, measurements) in &self.measured {
            let sex = sex_name(measurements);
            let _ = writeln!(
                text,
                "# Somebody of whom this is known. A scan will do instead: scan = \"me.ply\", sex = \"{sex}\", \
                 unit = \"mm\".\n[[subject]]\nid = {}\nsex = \"{sex}\"",
                quoted(name)
            );
            for field in MEASUREMENTS.iter() {
                if let Some(value) = field.get(measurements) {
                    let _ = writeln!(text, "{} = {value}", field.key);
                }
            }
        }
        for (name, scan) in &self.scanned {
            let _ = writeln!(text, "\n[[subject]]\nid = {}\nscan = {}", quoted(name), quoted(scan));
        }
    }

    fn write_garment(&self, text: &mut String, garment: &Worn<'_>) {
        let _ = writeln!(text, "[[garment]]\nname = {}", quoted(garment.style));
        if let Some(seams) = &garment.seams {
            let _ = writeln!(text, "seams = {}", quoted(seams));
        }
        let _ =
            writeln!(text, "fabric = {}   # of `toile fabric ls`, or a [[fabric]] of this file", quoted(self.fabric));
        let all = Intended::ALL.map(Intended::as_str).join(", ");
        let (mark, fit) = if self.fit.is_some() { ("", self.fit) } else { ("# ", Some(Intended::default())) };
        let fit = format!("{mark}intended_fit = \"{}\"", fit.unwrap_or_default().as_str());
        let _ = writeln!(text, "{fit:<27} # the ease that is meant: {all}");
        text.push_str("# target_ease_mm = { hip = [40, 120] }   # least and greatest of levels where it is another\n");
        match &garment.subjects {
            Some(names) => {
                let names: Vec<&str> = names.iter().map(String::as_str).collect();
                let _ = writeln!(text, "subjects = {}", list(&names));
            }
            None => text.push_str("# subjects = [\"...\"]         # default: all\n"),
        }
        match &garment.unit {
            Some(unit) => drop(writeln!(text, "unit = {}", quoted(unit))),
            None => text.push_str("# unit = \"mm\"              # only where the DXF files name none\n"),
        }
        text.push_str("sizes = [\n");
        for (size, pattern) in &garment.sizes {
            let _ = writeln!(text, "    {{ name = {}, pattern = {} }},", quoted(size), quoted(pattern));
        }
        text.push_str("]\n\n");
    }
}

pub const QUICKSTART: &str = "quickstart";

/// Does nothing where a study is in the folder already.
pub fn write_quickstart(folder: &Path) -> Result<()> {
    if folder.join("study.toml").exists() {
        return Ok(());
    }
    let mut files: Vec<(String, Vec<u8>)> =
        Model::Tshirt.files().into_iter().map(|(name, bytes)| (format!("patterns/{name}"), bytes)).collect();
    // Written last, so that a folder with a study.toml has all other files.
    files.push(("study.toml".to_owned(), include_bytes!("../../studies/quickstart/study.toml").to_vec()));
    write_files(folder, &files).map(drop)
}

/// Files of a first study: a `study.toml` to edit, and a drafted style. Its wearers are a subject of the catalogue and
/// one whose measurements are to be filled in.
pub fn new_study(folder: &Path, model: Model, fit: Option<Intended>) -> Result<Vec<(String, Vec<u8>)>> {
    let path = folder.join("study.toml");
    if path.exists() {
        return Err(StudyError::Exists { what: "study", name: path.display().to_string() });
    }
    let is_mens = matches!(model, Model::Tshirt | Model::Trousers);
    let (sex, known) = if is_mens { (Sex::Male, "male-ii") } else { (Sex::Female, "female-ii") };
    let [stature, chest, waist, hip] =
        if is_mens { [1780.0, 980.0, 850.0, 1000.0] } else { [1660.0, 900.0, 720.0, 970.0] };
    let me = Measurements::of(sex, from_mm(stature))
        .with(Dimension::ChestGirth, from_mm(chest))
        .with(Dimension::WaistGirth, from_mm(waist))
        .with(Dimension::HipGirth, from_mm(hip));
    let mut garment = Worn { style: model.as_str(), ..Worn::default() };
    let mut files = Vec::new();
    for (name, bytes) in model.files() {
        let path = format!("patterns/{name}");
        match drafted_size(&name) {
            Some(size) => garment.sizes.push((size, path.clone())),
            None => garment.seams = Some(path.clone()),
        }
        files.push((path, bytes));
    }
    let outline = Outline {
        name: None,
        simulators: &SIMULATORS,
        known: vec![known],
        measured: vec![("me", me)],
        scanned: vec![],
        garments: vec![garment],
        fabric: sim::fabric::USUAL,
        fit,
        outfits: vec![],
    };
    files.insert(0, ("study.toml".to_owned(), outline.text().into_bytes()));
    Ok(files)
}

/// Size of a drafted pattern, by its file's name; `None` for the seam file.
pub fn drafted_size(file: &str) -> Option<String> {
    Some(file.strip_suffix(".dxf")?.rsplit_once('-')?.1.to_uppercase())
}
