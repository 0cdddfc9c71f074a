//! New studies from entries of the catalogue: a folder with a `study.toml` to edit, and the patterns beside it.

use std::collections::BTreeSet;
use std::path::PathBuf;

use crate::outfits::NewOutfit;
use crate::{enqueue, run};
use fit::Simulator;
use fit::target::Intended;
use spec::Selection;
use spec::export::{Files, place};
use spec::new_study::{Layered, Outline, Worn, drafted_size};
use spec::patterns::{self, Model};
use store::files::{self, SourceFile};
use store::{Result, SizeKey, Store, StudyError};
use wardrobe::{SizeRow, catalogue};

#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PatternSource {
    Catalogue(SizeKey),
    Drafted(Model),
}

/// A size that a study may wear.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Wearable {
    pub style: String,
    pub size: String,
    pub source: PatternSource,
}

#[derive(Clone, Debug, PartialEq)]
pub struct NewStudy {
    /// Name of the folder too.
    pub name: String,
    /// Folder that holds all studies.
    pub folder: PathBuf,
    /// Subjects of the catalogue.
    pub subjects: Vec<String>,
    /// Sizes of one style are adjacent.
    pub sizes: Vec<Wearable>,
    pub fabric: String,
    pub simulators: Vec<Simulator>,
    /// `None` for the default.
    pub fit: Option<Intended>,
    pub outfits: Vec<NewOutfit>,
}

impl NewStudy {
    /// Styles with their sizes.
    fn chosen(&self) -> Vec<(&str, &str)> {
        self.sizes.iter().map(|wearable| (wearable.style.as_str(), wearable.size.as_str())).collect()
    }
}

/// Sizes of the catalogue, and those of drafted styles whose names the catalogue does not have.
pub fn wearables(sizes: &[SizeRow]) -> Vec<Wearable> {
    let of_catalogue = sizes.iter().map(|row| Wearable {
        style: row.style.clone(),
        size: row.size.clone(),
        source: PatternSource::Catalogue(row.key),
    });
    let is_taken = |model: &Model| sizes.iter().any(|row| row.style == model.as_str());
    let drafted = Model::ALL.into_iter().filter(|model| !is_taken(model)).flat_map(|model| {
        let size = move |(size, _): (&'static str, Vec<f64>)| Wearable {
            style: model.as_str().to_owned(),
            size: size.to_owned(),
            source: PatternSource::Drafted(model),
        };
        model.published_mm().into_iter().map(size)
    });
    of_catalogue.chain(drafted).collect()
}

/// Writes a new study into a folder of its own and queues its jobs without running them. Returns the path of its file.
pub fn create_study(store: &mut Store, new: &NewStudy) -> Result<PathBuf> {
    store.writer()?;
    check(new)?;
    let folder = new.folder.join(&new.name);
    if folder.exists() {
        return Err(StudyError::Exists { what: "study folder", name: folder.display().to_string() });
    }
    let files = files_of(store, new)?;
    files::write_files(&folder, &files)?;
    let path = folder.join("study.toml");
    let study = run::load_study(store, &path)?;
    enqueue::queue(store, &study, &Selection::default())?;
    Ok(path)
}

/// Patterns, seam files, `study.toml`.
fn files_of(store: &Store, new: &NewStudy) -> Result<Vec<(String, Vec<u8>)>> {
    let mut files = Files::new();
    let mut garments = Vec::new();
    for style in styles(new) {
        let mut garment = Worn { style, ..Worn::default() };
        for wearable in new.sizes.iter().filter(|wearable| wearable.style == style) {
            add_size(store, wearable, &mut garment, &mut files)?;
        }
        garments.push(garment);
    }
    let outline = Outline {
        name: Some(&new.name),
        simulators: &new.simulators,
        known: new.subjects.iter().map(String::as_str).collect(),
        measured: vec![],
        scanned: vec![],
        garments,
        fabric: &new.fabric,
        fit: new.fit,
        outfits: new.outfits.iter().map(|outfit| layered(new, outfit)).collect::<Result<_>>()?,
    };
    files.insert("study.toml".to_owned(), outline.text().into_bytes());
    Ok(files.into_iter().collect())
}

fn layered<'a>(new: &'a NewStudy, outfit: &'a NewOutfit) -> Result<Layered<'a>> {
    let refuse = |problem| StudyError::Refused { what: "study", name: new.name.clone(), problems: vec![problem] };
    let sizes = outfit.sizes(&new.chosen()).map_err(refuse)?;
    // Sizes of one name are what the file takes by itself.
    let is_one = |sizes: &&Vec<&str>| sizes.iter().all(|size| *size == sizes[0]);
    let odd = sizes.into_iter().find(|sizes| !is_one(&sizes));
    Ok(Layered { name: &outfit.name, layers: outfit.layers.iter().map(String::as_str).collect(), sizes: odd })
}

/// Adds only files that are not there yet.
fn add_size<'a>(store: &Store, wearable: &'a Wearable, garment: &mut Worn<'a>, files: &mut Files) -> Result<()> {
    let mut add = |source: &SourceFile| place(files, "patterns", source);
    match wearable.source {
        PatternSource::Catalogue(key) => {
            let piece = catalogue::workpiece(store, key)?;
            garment.sizes.push((wearable.size.clone(), add(&piece.pattern)));
            garment.unit = piece.unit.map(|unit| unit.as_str().to_owned()).or(garment.unit.take());
            garment.seams = piece.seams.as_ref().map(add).or(garment.seams.take());
        }
        PatternSource::Drafted(model) => {
            for (name, bytes) in patterns::drafted(model) {
                let size = drafted_size(&name);
                let source = SourceFile { name, bytes: bytes.into() };
                match size {
                    Some(size) if size == wearable.size => garment.sizes.push((size, add(&source))),
                    Some(_) => {}
                    None => garment.seams = Some(add(&source)),
                }
            }
        }
    }
    Ok(())
}

fn check(new: &NewStudy) -> Result<()> {
    let is_plain = |c: char| c.is_alphanumeric() || "-_. ".contains(c);
    let is_name = !new.name.trim().is_empty() && !new.name.starts_with('.') && new.name.chars().all(is_plain);
    let wrong = [
        (!is_name, "a name of letters, digits, `-`, `_` and spaces is needed: it names a folder"),
        (new.subjects.is_empty(), "no subject is chosen"),
        (new.sizes.is_empty(), "no size of a style is chosen"),
        (new.simulators.is_empty(), "no simulator is chosen"),
    ];
    let mut problems: Vec<String> = wrong.iter().filter(|(is, _)| *is).map(|(_, why)| (*why).to_owned()).collect();
    problems.extend(new.outfits.iter().filter_map(|outfit| outfit.sizes(&new.chosen()).err()));
    if problems.is_empty() {
        return Ok(());
    }
    Err(StudyError::Refused { what: "study", name: new.name.clone(), problems })
}

/// Styles in order, each once.
fn styles(new: &NewStudy) -> Vec<&str> {
    let mut seen = BTreeSet::new();
    new.sizes.iter().map(|wearable| wearable.style.as_str()).filter(|style| seen.insert(*style)).collect()
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use store::{OutfitRow, read};

    fn new_study(folder: &Path) -> NewStudy {
        let sizes =
            wearables(&[]).into_iter().filter(|wearable| wearable.style == "tshirt" || wearable.style == "dress");
        NewStudy {
            name: "first \"try\"".replace('"', ""),
            folder: folder.to_owned(),
            subjects: vec!["male-ii".to_owned(), "female-i".to_owned()],
            sizes: sizes.collect(),
            fabric: "cotton_shirting_light".to_owned(),
            simulators: vec![Simulator::Fem, Simulator::Hybrid],
            fit: None,
            outfits: vec![],
        }
    }

    #[test]
    fn an_outfit_is_written_and_its_layers_queued() {
        let folder = tempfile::tempdir().expect("a folder");
        let mut store = catalogue::open(&folder.path().join("toile.sqlite"), false).expect("a new database");
        let of = |style: &'static str, size: &'static str| {
            wearables(&[]).into_iter().filter(move |one| one.style == style && one.size == size)
        };
        let sizes: Vec<Wearable> = of("tshirt", "M").chain(of("trousers", "M")).collect();
        assert_eq!(sizes.len(), 2, "both are drafted");
        let outfits = vec!["look=tshirt,trousers".parse().expect("an outfit")];
        let new = NewStudy { sizes, outfits, ..new_study(folder.path()) };
        let path = create_study(&mut store, &new).expect("whole");
        // Two garments by two simulators, and two layers by FEM-GS alone, on two subjects.
        assert_eq!(read::study(&store, &new.name).expect("queued").total(), 2 * (2 * 2 + 2));
        let found = read::outfits(&store).expect("readable");
        let layer = |garment: &str, style: &str| (garment.to_owned(), style.to_owned());
        let layers = vec![layer("look tshirt", "tshirt"), layer("look trousers", "trousers")];
        assert_eq!(found, [OutfitRow { study: new.name.clone(), name: "look".to_owned(), layers }]);
        let text = std::fs::read_to_string(&path).expect("written");
        assert!(text.contains("[[outfit]]\nname = \"look\"\nlayers = [\"tshirt\", \"trousers\"]\n"), "{text}");

        let outfits = vec!["look=tshirt,coat".parse().expect("an outfit")];
        let refused = create_study(&mut store, &NewStudy { name: "other".into(), outfits, ..new });
        let told = refused.expect_err("there is no coat").to_string();
        assert!(told.contains("no size of coat is chosen") && !folder.path().join("other").exists(), "{told}");
    }

    #[test]
    fn a_new_study_is_written_read_and_queued() {
        let folder = tempfile::tempdir().expect("a folder");
        let mut store = catalogue::open(&folder.path().join("toile.sqlite"), false).expect("a new database");
        let new = new_study(&folder.path().join("studies"));
        let path = create_study(&mut store, &new).expect("whole");
        let study = run::load_study(&store, &path).expect("it was checked");
        assert_eq!((study.name.as_str(), study.subjects.len(), study.garments.len()), ("first try", 2, 2));
        let row = read::study(&store, "first try").expect("queued");
        assert_eq!(row.total(), 2 * new.sizes.len() * 2);
        assert!(matches!(create_study(&mut store, &new), Err(StudyError::Exists { .. })), "its folder is there");
        let text = std::fs::read_to_string(&path).expect("written");
        assert!(text.contains("like = \"male-ii\"") && text.contains("pattern = \"patterns/tshirt-s.dxf\""), "{text}");
    }

    #[test]
    fn a_new_study_says_how_its_garments_are_meant_to_sit() {
        let check = |fit: Option<Intended>, line: &str| {
            let folder = tempfile::tempdir().expect("a folder");
            let mut store = catalogue::open(&folder.path().join("toile.sqlite"), false).expect("a new database");
            let path = create_study(&mut store, &NewStudy { fit, ..new_study(folder.path()) }).expect("whole");
            let text = std::fs::read_to_string(&path).expect("written");
            assert_eq!(text.lines().filter(|written| written.starts_with(line)).count(), 2, "{text}");
            assert_eq!(text.matches("\n# target_ease_mm").count(), 2, "{text}");
            let study = run::load_study(&store, &path).expect("good");
            let read = study.garments.iter().map(|garment| garment.target.intended);
            assert!(read.eq([fit.unwrap_or_default(); 2]), "{text}");
        };
        check(None, "# intended_fit = \"regular\"");
        for fit in Intended::ALL {
            check(Some(fit), &format!("intended_fit = \"{}\"", fit.as_str()));
        }
    }

    #[test]
    fn sizes_of_the_catalogue_bring_their_files() {
        let folder = tempfile::tempdir().expect("a folder");
        let mut store = catalogue::open(&folder.path().join("toile.sqlite"), false).expect("a new database");
        let quickstart = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies/quickstart/study.toml");
        catalogue::import(&mut store, wardrobe::Part::Style, &[quickstart], wardrobe::Strictness::AllOrNone)
            .expect("good styles");
        let sizes = wearables(&catalogue::sizes(&store).expect("readable"));
        let is_drafted = |size: &Wearable| matches!(size.source, PatternSource::Drafted(_));
        assert!(!sizes.iter().any(|size| size.style == "tshirt" && is_drafted(size)));
        let sizes = sizes.into_iter().filter(|wearable| wearable.style == "tshirt").collect();
        let new = NewStudy { sizes, ..new_study(folder.path()) };
        let path = create_study(&mut store, &new).expect("whole");
        assert_eq!(run::load_study(&store, &path).expect("good").garments[0].sizes.len(), 3);
    }

    #[test]
    fn a_pattern_that_is_a_folder_of_pieces_comes_as_one() {
        let folder = tempfile::tempdir().expect("a folder");
        let shirt = folder.path().join("shirt");
        let files = patterns::drafted(Model::Tshirt)
            .into_iter()
            .filter(|(name, _)| !name.contains("-m") && !name.contains("-l"));
        files::write_files(&shirt, &files.collect::<Vec<_>>()).expect("writable");
        let mut store = catalogue::open(&folder.path().join("toile.sqlite"), false).expect("a new database");
        let given = wardrobe::StyleGiven {
            seams: Some(shirt.join("tshirt.seams.toml")),
            patterns: vec![(Some("S".to_owned()), shirt)],
            ..Default::default()
        };
        catalogue::save_style(&mut store, wardrobe::Mode::Add, "folded", &given)
            .expect("its only drawing is a whole shirt");
        let sizes = wearables(&catalogue::sizes(&store).expect("readable"));
        let sizes = sizes.into_iter().filter(|wearable| wearable.style == "folded").collect();
        let path = create_study(&mut store, &NewStudy { sizes, ..new_study(folder.path()) }).expect("whole");
        assert!(path.with_file_name("patterns/shirt/tshirt-s.dxf").exists());
        assert_eq!(run::load_study(&store, &path).expect("good").garments[0].sizes[0].name, "S");
    }

    #[test]
    fn what_is_missing_is_told_before_anything_is_written() {
        let folder = tempfile::tempdir().expect("a folder");
        let mut store = catalogue::open(&folder.path().join("toile.sqlite"), false).expect("a new database");
        let empty = NewStudy {
            name: "../x".into(),
            subjects: vec![],
            sizes: vec![],
            simulators: vec![],
            ..new_study(folder.path())
        };
        let said = create_study(&mut store, &empty).expect_err("nothing in it").to_string();
        for expect in ["a name of letters", "no subject", "no size", "no simulator"] {
            assert!(said.contains(expect), "{said}");
        }
        assert!(read::studies(&store).expect("readable").is_empty());
    }
}
