//! The body of a subject of the catalogue: built once, cached, measured and drawn.

use std::sync::Arc;

use image::{GenericImage, RgbaImage};

use crate::error::ResultsError;
use body::{Dimension, Girths, Mass};
use engine::stages::{self, Model};
use render::{self, Camera, Frame, Layer, Material, Scene, View};
use store::cache::{self, Cache};
use store::{InOrigin, Origin, Result, StageKind, Store, SubjectId};
use wardrobe::catalogue;

const MARGIN_M: f64 = 0.12;

pub struct Figure {
    model: Arc<Model>,
    scene: Scene,
}

pub fn figure(store: &Store, id: SubjectId) -> Result<Figure> {
    let (_, model) = model(store, id)?;
    let scene = Scene::new(vec![Layer::new(&model.body.mesh, Material::form())]);
    let scene = scene.origin(Origin::Render)?;
    Ok(Figure { model, scene })
}

/// Name and body of a subject's revision. The body comes from the cache, or is built and kept there, unless the
/// database is open read-only.
pub(crate) fn model(store: &Store, id: SubjectId) -> Result<(String, Arc<Model>)> {
    let (name, person) = (catalogue::subject_revision(store, id)?.name, catalogue::person(store, id)?);
    let hash = stages::body_inputs(&name, &person).stage_hash(StageKind::Body);
    let make = || Ok(Model { body: person.body()? });
    let model = if store.is_readonly() {
        Arc::new(cache::stored(&store.reader, &hash).or_else(|_| make())?)
    } else {
        Cache::new(store.path().to_owned()).get(StageKind::Body, &hash, make)?.0
    };
    Ok((name, model))
}

impl Figure {
    pub fn girths(&self) -> &Girths {
        &self.model.body.girths
    }

    /// Value on the body for a key of a subject: a tape measurement, or the mass from the volume.
    pub fn reading(girths: &Girths, key: &str) -> Option<f64> {
        if key == Dimension::Weight.key() {
            return Some(Mass::of(girths.volume_l(), None).mass_from_volume_kg);
        }
        girths.written(key)
    }

    /// Draws the body from the front and the side, side by side at one scale, on transparent ground.
    pub fn picture(&self, width: u32, height: u32) -> Result<RgbaImage> {
        let mesh = &self.model.body.mesh;
        let (low, high) = mesh.bounds().ok_or(ResultsError::EmptyBody)?;
        let size = high - low;
        // Widths of the front and the side view, each with a margin; x is to the side, y to the front, z up.
        let across = [size.x + MARGIN_M, size.y + MARGIN_M];
        let all = across[0] + across[1];
        let (width, height) = (width.max(2), height.max(1));
        let height_m = (size.z + MARGIN_M).max(all * f64::from(height) / f64::from(width));
        let frame = Frame { centre: (low + high) / 2.0, height_m };
        let left = ((f64::from(width) * across[0] / all) as u32).clamp(1, width - 1);
        let mut whole = RgbaImage::new(width, height);
        for (view, from, across) in [(View::Front, 0, left), (View::Side, left, width - left)] {
            let picture = render::cutout(&self.scene, &Camera::new(view, frame), across, height);
            whole.copy_from(&picture.origin(Origin::Render)?, from, 0).origin(Origin::Render)?;
        }
        Ok(whole)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use store::sql;
    use wardrobe::Mode;

    #[test]
    fn a_subject_is_built_once_measured_and_drawn() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("toile.sqlite");
        let mut store = catalogue::open(&path, false).expect("a new database");
        let given = [("sex", "f"), ("stature_mm", "1650")].map(|(key, text)| (key.to_owned(), text.to_owned()));
        catalogue::save_subject(&mut store, Mode::Add, "anna", &given).expect("possible");
        let id = catalogue::subjects(&store).expect("readable")[0].id;
        let count = |store: &Store| sql::query(store, "SELECT count(*) FROM artefact").expect("valid").rows;
        let before = count(&store);
        let readonly = catalogue::open(&path, true).expect("there");
        let girths = figure(&readonly, id).expect("built").girths().clone();
        assert_eq!(count(&store), before, "nothing is kept of a read-only store");
        let built = figure(&store, id).expect("built");
        assert_ne!(count(&store), before);
        assert_eq!(*built.girths(), girths);
        assert!((Figure::reading(&girths, "stature_mm").expect("read") - 1650.0).abs() < 5.0);
        let picture = built.picture(120, 160).expect("drawn");
        let is_body = |x: u32, y: u32| picture.get_pixel(x, y)[3] > 0;
        let columns: Vec<u32> = (0..120).filter(|&x| (30..110).any(|y| is_body(x, y))).collect();
        let gaps = columns.windows(2).filter(|pair| pair[1] > pair[0] + 1).count();
        assert!(columns.len() > 30 && gaps >= 1, "front and side stand apart: {columns:?}");
        assert!(figure(&store, SubjectId(999)).is_err());
    }
}
