//! Pictures of results: the stored body and drape, rendered.

use image::RgbaImage;

use super::cache;
use super::error::{Result, StudyError};
use super::inputs::StageKind;
use super::pipeline::{Meshes, Model};
use super::types::JobId;
use super::workspace::Workspace;
use crate::geom::{DistanceField, TriMesh, V2, V3};
use crate::pattern::Garment;
use crate::render::{self, Camera, Frame, Layer, Material, Scale, Scene, Values, View};
use crate::sim::{Drape, Simulator};
use crate::units::mm;

/// What colours the cloth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Map {
    /// The simulator's own colour.
    Plain,
    /// Stretch: the greatest principal stretch of each triangle; 1 is the pattern's own size.
    Stretch,
    /// Gap between cloth and body, mm.
    Gap,
}

impl Map {
    /// All maps.
    pub const ALL: [Self; 3] = [Self::Plain, Self::Stretch, Self::Gap];

    /// Name on screens and in the command line.
    #[must_use]
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Plain => "plain",
            Self::Stretch => "stretch",
            Self::Gap => "gap",
        }
    }
}

/// Stretch at the ends of its colour scale, from 1.
const STRETCH_REACH: f64 = 0.1;
/// Gap at the end of its colour scale, mm.
const GAP_REACH_MM: f64 = 60.0;

/// A result made ready for pictures: lit once, shown from anywhere.
pub(super) struct Stage {
    scene: Scene,
    frame_of: [TriMesh; 2],
}

impl Workspace {
    /// A picture of a result.
    ///
    /// # Errors
    /// [`StudyError::NotFound`] while there is no result; [`StudyError::Artefact`] when it is no longer stored.
    pub fn picture(&self, id: JobId, view: View, width: u32, height: u32, map: Map) -> Result<RgbaImage> {
        let mut kept = self.scene.borrow_mut();
        if !kept.as_ref().is_some_and(|(of, with, _)| (*of, *with) == (id, map)) {
            *kept = Some((id, map, self.stage(id, map)?));
        }
        let Some((_, _, stage)) = kept.as_ref() else {
            return Err(StudyError::NotFound { what: "result of job", name: id.to_string(), known: vec![] });
        };
        let aspect = f64::from(width.max(1)) / f64::from(height.max(1));
        let camera = Camera::new(view, Frame::enclosing(&stage.frame_of, aspect));
        render::render(&stage.scene, &camera, width, height).map_err(StudyError::stage("render"))
    }

    fn stage(&self, id: JobId, map: Map) -> Result<Stage> {
        let job = self.job(id)?;
        let model: Model = self.product(id, StageKind::Body)?;
        let (garment, drape) = self.drape(id)?;
        let cloth = TriMesh { positions: drape.positions, triangles: garment.triangles.clone() };
        let material = match job.simulator {
            Simulator::Fem => Material::fem(),
            Simulator::Hybrid => Material::hybrid(),
        };
        let layer = Layer::new(&cloth, material);
        let layer = match map {
            Map::Plain => layer,
            Map::Stretch => {
                let values = Values::Triangles(stretches(&garment, &cloth.positions));
                layer.with_field(values, Scale::diverging(1.0, STRETCH_REACH, "stretch", ""))
            }
            Map::Gap => {
                let field: DistanceField = self.product(id, StageKind::Field)?;
                let gaps = cloth.positions.iter().map(|p| mm(field.value_and_gradient(p).0)).collect();
                layer.with_field(Values::Vertices(gaps), Scale::sequential(0.0, GAP_REACH_MM, "gap to the body", "mm"))
            }
        };
        let scene = Scene::new(vec![Layer::new(&model.body.mesh, Material::form()), layer]);
        let scene = scene.map_err(StudyError::stage("render"))?;
        Ok(Stage { scene, frame_of: [model.body.mesh, cloth] })
    }

    /// The mesh and the drape of a result.
    ///
    /// # Errors
    /// [`StudyError::NotFound`] while there is no result; [`StudyError::Artefact`] when it is no longer stored.
    pub(super) fn drape(&self, id: JobId) -> Result<(Garment, Drape)> {
        let Meshes(mut meshes) = self.product(id, StageKind::Mesh)?;
        let drape: Drape = self.product(id, StageKind::Drape)?;
        match meshes.pop() {
            Some(garment) if garment.rest.len() == drape.positions.len() => Ok((garment, drape)),
            _ => Err(StudyError::stage("store")(format!("the mesh of job {id} does not fit its drape"))),
        }
    }

    /// A stored product of a job's stage.
    pub(super) fn product<T: cache::Artefact>(&self, id: JobId, stage: StageKind) -> Result<T> {
        let used = self.stages(id)?.into_iter().find(|used| used.stage == stage.as_str());
        let missing = || StudyError::NotFound { what: "result of job", name: id.to_string(), known: vec![] };
        cache::stored(&self.reader, &used.ok_or_else(missing)?.hash)
    }
}

/// Greatest principal stretch of each triangle: the larger singular value of F = Ds Dm^-1 (3x2).
fn stretches(garment: &Garment, positions: &[V3]) -> Vec<f64> {
    let stretch = |[a, b, c]: &[usize; 3]| {
        let (e1, e2): (V2, V2) = (garment.rest[*b] - garment.rest[*a], garment.rest[*c] - garment.rest[*a]);
        let (d1, d2): (V3, V3) = (positions[*b] - positions[*a], positions[*c] - positions[*a]);
        let det = e1.x * e2.y - e1.y * e2.x;
        let (f1, f2) = ((d1 * e2.y - d2 * e1.y) / det, (d2 * e1.x - d1 * e2.x) / det);
        // Eigenvalues of F^T F from its trace and determinant.
        let (p, q, r) = (f1.norm_squared(), f2.norm_squared(), f1.dot(&f2));
        let middle = (p + q) / 2.0;
        (middle + ((p - q).powi(2) / 4.0 + r * r).sqrt()).sqrt()
    };
    garment.triangles.iter().map(stretch).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stretch_is_that_of_the_deformation_and_blind_to_rotation() {
        let rest = vec![V2::new(0.0, 0.0), V2::new(1.0, 0.0), V2::new(0.0, 1.0)];
        let garment = Garment {
            name: String::new(),
            size: String::new(),
            pieces: vec![],
            rest: rest.clone(),
            triangles: vec![[0, 1, 2]],
            seams: vec![],
            measurements: vec![],
            fit_levels: vec![],
            edge_length_m: 1.0,
        };
        let check = |deform: &dyn Fn(V2) -> V3, expected: f64| {
            let positions: Vec<V3> = rest.iter().map(|&p| deform(p)).collect();
            assert!((stretches(&garment, &positions)[0] - expected).abs() < 1e-12);
        };
        check(&|p| V3::new(p.x, p.y, 0.0), 1.0);
        check(&|p| V3::new(0.3, -p.y, p.x), 1.0);
        check(&|p| V3::new(1.2 * p.x, 0.0, 0.9 * p.y), 1.2);
        check(&|p| V3::new(p.x + 0.5 * p.y, p.y, 0.0), (1.125 + (0.125f64 * 0.125 + 0.25).sqrt()).sqrt());
    }
}
