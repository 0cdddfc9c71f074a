//! Drapes in the page of a fit report, which its reader can turn.

use crate::assessment::GarmentWorn;
use crate::fit_card::FitCard;
use crate::picture::{self, Dressed, Map};
use crate::reporting::runs::{side_by_side, threads};
use crate::reporting::{Part, Tell, quoted};
use engine::stages::Model;
use fit::on_body::sites;
use geom::{TriMesh, V3};
use pattern::pom::{Point, PointOfMeasure};
use pattern::style::PathPart;
use pattern::{Garment, MaterialLine, Style};
use render::Scale;
use report::viewer::{Drape, Drapes};
use store::{JobId, JobRow, Result, StageKind, Store, sql};
use wardrobe::catalogue;

/// Maps among which a reader may choose.
const MAPS: [Map; 4] = [Map::Stretch, Map::Tension, Map::Pressure, Map::Gap];

/// All drapes of a study, marked where they are in the size to wear.
pub(super) fn drapes(store: &Store, jobs: &[JobRow], worn: &[GarmentWorn], tell: Tell<'_>) -> Result<Drapes> {
    let mut all = Drapes::default();
    let jobs: Vec<&JobRow> = jobs.iter().filter(|job| job.status.has_result() && job.repeat == 1).collect();
    for (chunk, some) in jobs.chunks(threads()).enumerate() {
        tell(Part { name: "drapes to turn", step: [chunk * threads() + 1, jobs.len()] });
        let read = some.iter().map(|job| picture::dressed(store, job.id)).collect::<Result<Vec<Dressed>>>()?;
        for ((&job, dressed), shape) in some.iter().zip(&read).zip(side_by_side(&read, shape)) {
            let Shape { mesh, maps } = shape?;
            if !all.has_body(&job.subject) {
                add_body(store, job, &mut all)?;
            }
            let mut cards = worn.iter().map(|worn| &worn.card);
            let own = cards.find(|card| card.garment == job.garment && card.subject == job.subject);
            all.add(&Drape {
                names: [&job.garment, &job.size, &job.subject, job.simulator.as_str()],
                is_to_wear: own.and_then(FitCard::to_wear).is_some_and(|size| size.size == job.size),
                positions: &mesh.positions,
                triangles: &mesh.triangles,
                maps,
                lines: lines(store, job.id, &dressed.garment, &dressed.cloth.positions)?,
            });
        }
    }
    Ok(all)
}

fn add_body(store: &Store, job: &JobRow, all: &mut Drapes) -> Result<()> {
    let Model { body } = picture::product(store, job.id, StageKind::Body)?;
    let level = sites(&body).into_iter().filter(|site| site.is_level());
    let level = level.map(|site| (site.level.clone(), site.height_m()));
    all.add_body(&job.subject, &body.mesh.positions, &body.mesh.triangles, level.collect());
    Ok(())
}

struct Shape {
    mesh: TriMesh,
    maps: Vec<(&'static str, Scale, Vec<f64>)>,
}

fn shape(dressed: &Dressed) -> Result<Shape> {
    let sewn = dressed.sewn()?;
    let mut maps = Vec::new();
    for map in MAPS {
        let values = dressed.values(map)?;
        if let Some(scale) = map.scale().filter(|_| values.iter().all(|value| value.is_finite())) {
            maps.push((map.as_str(), scale, sewn.welded(&values)));
        }
    }
    Ok(Shape { mesh: sewn.mesh, maps })
}

/// Points of measure that lie on the cloth, with their lengths from `v_pom`.
fn lines(store: &Store, id: JobId, garment: &Garment, positions: &[V3]) -> Result<Vec<(String, String, Vec<V3>)>> {
    let style: Style = catalogue::style_of(store, id)?;
    let points = style.points_of_measure();
    let paths: Vec<&[PathPart]> = points.iter().map(|found| found.path.as_slice()).collect();
    let mut found = Vec::new();
    for (PointOfMeasure { point, .. }, runs) in points.iter().zip(style.laid(garment, &paths)) {
        let Some(runs) = runs.filter(|runs| !runs.is_empty()) else { continue };
        let name = point.as_str().replace('_', " ");
        found.extend(words(store, id, *point)?.map(|words| (name, words, along(&runs, positions))));
    }
    Ok(found)
}

fn words(store: &Store, id: JobId, point: Point) -> Result<Option<String>> {
    let point = quoted(point.as_str());
    let sql = format!(
        "SELECT printf('%.0f mm flat, %.0f mm worn', flat_mm, draped_mm) FROM pom
        WHERE job_id = {id} AND point = {point} AND draped_mm IS NOT NULL"
    );
    Ok(sql::query(store, &sql)?.rows.first().map(|row| row[0].to_string()))
}

/// Points along a path over several pieces; runs in the opposite direction are reversed.
fn along(runs: &[MaterialLine], positions: &[V3]) -> Vec<V3> {
    let mut line: Vec<V3> = Vec::new();
    for run in runs {
        let mut own: Vec<V3> = run.points.iter().map(|point| point.at(positions)).collect();
        let gap_m = |end: Option<&V3>| line.last().zip(end).map_or(0.0, |(last, end)| (last - end).norm());
        if gap_m(own.last()) < gap_m(own.first()) {
            own.reverse();
        }
        line.append(&mut own);
    }
    line
}
