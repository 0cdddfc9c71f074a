//! What may be asked of the catalogue: subjects, styles, sizes, fabrics.

use std::path::PathBuf;

use super::Workspace;
use crate::catalogue::{
    self, FabricRow, Imported, Mode, Part, Removed, Saved, ScanGiven, SizeRow, Strictness, StyleGiven, SubjectRow,
    fabrics, import, known, sizes, style,
};
use crate::error::Result;
use crate::files::SourceFile;
use crate::rows::SizeKey;
use crate::seams::workpiece::Workpiece;
use crate::spec::fields::Given;
use crate::spec::file::Person;
use sim::Fabric;
use sim::fabric::USUAL;

impl Workspace {
    /// The fabrics of the catalogue, by name.
    pub fn fabrics(&self) -> Result<Vec<FabricRow>> {
        fabrics::fabrics(&self.store)
    }

    /// Brings all entries of some files into the catalogue: TOML with the tables of a study file (a study file itself will do), or, for
    /// subjects and fabrics, CSV with the same keys. Where anything is wrong with one, none is taken, or as `strictness` says.
    ///
    /// # Errors
    /// Everything that is wrong with the files, each with its line.
    pub fn import(&mut self, part: Part, files: &[PathBuf], strictness: Strictness) -> Result<Imported> {
        import::import(&mut self.store, part, files, strictness)
    }

    /// A cloth of the catalogue by its name; the usual one where none is given.
    ///
    /// # Errors
    /// When there is none of that name.
    pub fn cloth(&self, name: Option<&str>) -> Result<Fabric> {
        catalogue::stored_fabric(&self.store, name.unwrap_or(USUAL))
    }

    /// The subjects of the catalogue, by name.
    pub fn subjects(&self) -> Result<Vec<SubjectRow>> {
        known::subjects(&self.store)
    }

    /// Saves a subject: given values over those it has, or over none. The body is built to see that it can be.
    ///
    /// # Errors
    /// When a value or the body is impossible, the name is taken (`Add`) or unknown (`Edit`), or the workspace is
    /// read-only.
    pub fn save_subject(&mut self, mode: Mode, name: &str, given: &[Given]) -> Result<Saved> {
        catalogue::save_subject(&mut self.store, mode, name, given)
    }

    /// Saves a subject whose body is a scan; what is known of it is measured there.
    ///
    /// # Errors
    /// When the scan cannot be read or wear garments, the name is taken (`Add`) or unknown (`Edit`), or the workspace is read-only.
    pub fn save_scan(&mut self, mode: Mode, name: &str, given: &ScanGiven) -> Result<Saved> {
        catalogue::save_scan(&mut self.store, mode, name, given)
    }

    /// Saves a fabric: given values over those it has, over those of the fabric `like`, or over none.
    ///
    /// # Errors
    /// As [`Workspace::save_subject`].
    pub fn save_fabric(&mut self, mode: Mode, name: &str, like: Option<&str>, given: &[Given]) -> Result<Saved> {
        catalogue::save_fabric(&mut self.store, mode, name, like, given)
    }

    /// Removes an entry: for good, or, where jobs use it or it is built in, from all lists. A style goes with its sizes.
    ///
    /// # Errors
    /// When there is none of that name, or the workspace is read-only.
    pub fn remove(&mut self, part: Part, name: &str) -> Result<Removed> {
        catalogue::remove(&mut self.store, part, name)
    }

    /// The current sizes of all styles, by style and in the order in which they came.
    pub fn sizes(&self) -> Result<Vec<SizeRow>> {
        sizes::sizes(&self.store)
    }

    /// The pattern and the seam file of a size.
    ///
    /// # Errors
    /// When there are no such revisions.
    pub fn workpiece(&self, key: SizeKey) -> Result<Workpiece> {
        sizes::workpiece(&self.store, key)
    }

    /// Saves a style: its seam file, and its sizes. Every size, given now or earlier, must be sewable by the seams.
    ///
    /// # Errors
    /// When a file cannot be read or sewn, the name is taken (`Add`) or unknown (`Edit`), or the workspace is read-only.
    pub fn save_style(&mut self, mode: Mode, name: &str, given: &StyleGiven) -> Result<Vec<Saved>> {
        style::save_style(&mut self.store, mode, name, given)
    }

    /// Saves other seams of a style that is there. Every size must be sewable by them.
    ///
    /// # Errors
    /// As [`Workspace::save_style`].
    pub fn save_seams(&mut self, name: &str, seams: &SourceFile) -> Result<Vec<Saved>> {
        style::save_seams(&mut self.store, name, seams)
    }

    /// Saves a size, named `STYLE/SIZE`, of a style that is there.
    ///
    /// # Errors
    /// As [`Workspace::save_style`].
    pub fn save_size(&mut self, mode: Mode, name: &str, given: &StyleGiven) -> Result<Saved> {
        style::save_size(&mut self.store, mode, name, given)
    }

    /// A subject of the catalogue, latest revision.
    ///
    /// # Errors
    /// When there is none of that name.
    pub fn subject(&self, name: &str) -> Result<Person> {
        known::subject(&self.store, name)
    }
}
