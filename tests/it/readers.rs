//! The program's own readers of study files and seam files, for the tests of what the documents say of these.

use std::path::PathBuf;

use toile::body::{Measurements, Sex, write_obj};
use toile::engine::run;
use toile::pattern::seams::SeamFile;
use toile::spec::patterns::Model;
use toile::spec::{JobSpec, Selection, bodies};
use toile::store::{Store, StudyError};
use toile::wardrobe::catalogue;

/// A fresh database beside the drafted T-shirt.
pub struct Readers {
    folder: tempfile::TempDir,
    store: Store,
}

impl Readers {
    pub fn new() -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        std::fs::create_dir(folder.path().join("patterns")).expect("writable");
        for (name, bytes) in Model::Tshirt.files() {
            std::fs::write(folder.path().join("patterns").join(name), bytes).expect("writable");
        }
        let store = catalogue::open(&folder.path().join("toile.sqlite"), false).expect("a fresh database");
        Self { folder, store }
    }

    fn study_file(&self) -> PathBuf {
        self.folder.path().join("study.toml")
    }

    /// Writes a file beside the study, or below it.
    pub fn write(&self, name: &str, bytes: impl AsRef<[u8]>) {
        std::fs::write(self.folder.path().join(name), bytes).expect("writable");
    }

    /// The bytes of such a file.
    pub fn read(&self, name: &str) -> Vec<u8> {
        std::fs::read(self.folder.path().join(name)).expect("readable")
    }

    /// Writes the surface of somebody of a stature, m, as OBJ.
    pub fn write_scan(&self, name: &str, stature_m: f64) {
        let body = bodies::build_body(&Measurements::of(Sex::Male, stature_m)).expect("it can be built");
        self.write(name, write_obj(&body.mesh));
    }

    /// The jobs of the text of a study file.
    pub fn plan(&mut self, text: &str) -> Vec<JobSpec> {
        self.write("study.toml", text);
        let study = run::load_study(&self.store, &self.study_file()).unwrap_or_else(|error| panic!("{error}\n{text}"));
        let planned = run::plan(&mut self.store, &study, &Selection::default()).expect("planned");
        planned.into_iter().map(|job| job.cell.job(&study)).collect()
    }

    /// What is wrong with the text of a study file.
    pub fn study(&self, text: &str) -> Vec<String> {
        std::fs::write(self.study_file(), text).expect("writable");
        match run::load_study(&self.store, &self.study_file()) {
            Ok(_) => Vec::new(),
            Err(StudyError::File(problems)) => problems.into_iter().map(|problem| problem.message).collect(),
            Err(error) => panic!("{error}"),
        }
    }
}

/// What is wrong with the text of a seam file: the first problem.
pub fn seam_file(text: &str) -> Option<String> {
    SeamFile::parse(text.as_bytes(), "seams.toml").err().map(|error| error.to_string())
}
