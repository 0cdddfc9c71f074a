//! How far a drape's shape depends on its mesh and on its start: drapes on coarser meshes, from two starts each, against their own mesh of
//! 3 mm. Prints a table of `docs/experiments/shape.md`.
//!
//! `cargo run --release -p examples --bin shape tshirt|dress|trousers [FABRIC] [MM ...]`

#![allow(clippy::print_stdout, reason = "an example speaks to whoever runs it")]

use std::error::Error;

use toile::body::{self, Body, Dimension, Measurements, Sex};
use toile::geom::{DistanceField, Surface, V3, triangle};
use toile::measure;
use toile::pattern::draft::Model;
use toile::pattern::garment::Role;
use toile::pattern::{Garment, Style};
use toile::sim::fem::{self, Params};
use toile::sim::{Drape, Fabric, Silent, fabric};

type Outcome<T = ()> = Result<T, Box<dyn Error>>;

/// Edge length of the mesh that others are held against, mm.
const FINE_MM: f64 = 3.0;
/// Points of a piece at which two drapes are compared, about.
const POINTS: usize = 1500;

fn main() -> Outcome {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let scene = arguments.first().ok_or("say tshirt, dress or trousers")?;
    let named = arguments.get(1).filter(|word| word.parse::<f64>().is_err());
    let fabric = of_library(named.map_or("cotton_shirting_light", String::as_str))?;
    let edges = arguments.iter().filter_map(|word| word.parse::<f64>().ok()).collect::<Vec<_>>();
    let edges = if edges.is_empty() { vec![20.0, 15.0, 12.0, 10.0, 7.0, 5.0] } else { edges };
    let (body, style) = worn(scene)?;
    let worn = Worn { surface: Surface::new(&body.mesh)?, field: DistanceField::build(&body.mesh, 0.005)?, body };
    println!(
        "| edges mm | start | from {FINE_MM} mm: mean mm | 95 % | gaps mm: chest | waist | hip | hem | hem height mm | EI | steps | s |"
    );
    println!("| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |");
    let fine = worn.drape(&style, FINE_MM, 0, &fabric)?;
    println!("{}", worn.row(FINE_MM, 0, &fine, None));
    for edge_mm in edges {
        for start in [0, 1] {
            let drape = worn.drape(&style, edge_mm, start, &fabric)?;
            println!("{}", worn.row(edge_mm, start, &drape, Some(&fine)));
        }
    }
    Ok(())
}

fn of_library(name: &str) -> Outcome<Fabric> {
    Ok(fabric::library().into_iter().find(|fabric| fabric.name == name).ok_or("not in the library")?)
}

/// A body of the quickstart's or the thesis's and a garment drafted for it.
fn worn(scene: &str) -> Outcome<(Body, Style)> {
    let (model, size, sex, numbers) = match scene {
        "tshirt" => (Model::Tshirt, "l", Sex::Male, SLIM_MAN),
        "trousers" => (Model::Trousers, "l", Sex::Male, SLIM_MAN),
        "dress" => (Model::Dress, "one", Sex::Female, SLIM_WOMAN),
        _ => return Err("say tshirt, dress or trousers".into()),
    };
    let [stature, weight, chest, waist, hip, neck, shoulder] = numbers;
    let measurements = Measurements::of(sex, stature)
        .with(Dimension::Weight, weight)
        .with(Dimension::ChestGirth, chest)
        .with(Dimension::WaistGirth, waist)
        .with(Dimension::HipGirth, hip)
        .with(Dimension::NeckGirth, neck)
        .with(Dimension::AcrossShoulder, shoulder);
    let drafts = model.drafts();
    let draft = drafts.iter().find(|draft| draft.size.eq_ignore_ascii_case(size)).ok_or("no such size")?;
    Ok((body::build(&measurements)?, Style::read(&draft.pieces, model.seams(), "drafted.seams.toml")?))
}

/// Subject ii of the thesis, m and kg.
const SLIM_MAN: [f64; 7] = [1.690, 53.0, 0.863, 0.782, 0.914, 0.378, 0.429];
/// Subject i of its women.
const SLIM_WOMAN: [f64; 7] = [1.630, 47.0, 0.834, 0.678, 0.928, 0.325, 0.412];

/// What wears the garment.
struct Worn {
    body: Body,
    surface: Surface,
    field: DistanceField,
}

/// A drape with its mesh and the time that it took, s.
struct Made {
    garment: Garment,
    drape: Drape,
    seconds: f64,
}

impl Worn {
    fn drape(&self, style: &Style, edge_mm: f64, seed: u64, fabric: &Fabric) -> Outcome<Made> {
        let meshes = fem::level_edges(1e-3 * edge_mm).into_iter().map(|edge| style.mesh(edge));
        let mut meshes = meshes.collect::<Result<Vec<Garment>, _>>()?;
        let params = Params { seed, ..Params::default() };
        let begun = std::time::Instant::now();
        let drape = fem::simulate(&self.body, &self.field, &meshes, fabric, &params, &mut Silent)?;
        Ok(Made { garment: meshes.pop().ok_or("no mesh")?, drape, seconds: begun.elapsed().as_secs_f64() })
    }

    fn row(&self, edge_mm: f64, start: u64, made: &Made, fine: Option<&Made>) -> String {
        let levels = &self.body.levels;
        let gaps = [levels.chest_m, levels.waist_m, levels.hip_m].map(|height| self.gap_m(made, height));
        let (hem_gap, hem_height) = self.hem_m(made);
        let away = fine.map_or(String::from(" | "), |fine| {
            let (mean, most) = distances_m(fine, made);
            format!("{:.1} | {:.0}", 1e3 * mean, 1e3 * most)
        });
        let gaps =
            gaps.into_iter().chain([hem_gap]).map(|gap| format!("{:.1}", 1e3 * gap)).collect::<Vec<_>>().join(" | ");
        let chis = measure::measure(&made.garment, &made.drape.positions);
        let ei = measure::metrics(&chis).map_or(f64::NAN, |metrics| metrics.ei);
        let (steps, seconds) = (made.drape.iterations, made.seconds);
        format!(
            "| {edge_mm} | {start} | {away} | {gaps} | {:.1} | {ei:.4} | {steps} | {seconds:.1} |",
            1e3 * hem_height
        )
    }

    /// Mean distance of the cloth from the body where a level plane cuts it, sleeves left out, m.
    fn gap_m(&self, made: &Made, height_m: f64) -> f64 {
        let (mut sum, mut length) = (0.0, 0.0);
        let is_sleeve = |role| matches!(role, Role::SleeveLeft | Role::SleeveRight);
        for piece in made.garment.pieces.iter().filter(|piece| !is_sleeve(piece.role)) {
            for t in &made.garment.triangles[piece.triangles.clone()] {
                let corners = t.map(|v| made.drape.positions[v]);
                let cut = |k: usize| {
                    let (a, b) = (corners[k], corners[(k + 1) % 3]);
                    let crosses = (a.z - height_m) * (b.z - height_m) < 0.0;
                    crosses.then(|| a + (b - a) * ((height_m - a.z) / (b.z - a.z)))
                };
                if let [Some(a), Some(b)] =
                    [0, 1, 2].map(cut).into_iter().filter(Option::is_some).collect::<Vec<_>>()[..]
                {
                    let (part, middle): (f64, V3) = ((b - a).norm(), (a + b) * 0.5);
                    sum += part * self.surface.signed_distance(&middle);
                    length += part;
                }
            }
        }
        sum / length
    }

    /// Mean distance of the hem from the body, and its height, m.
    fn hem_m(&self, made: &Made) -> (f64, f64) {
        let is_hem = |name: &str| name.to_lowercase().contains("hem") && !name.to_lowercase().contains("sleeve");
        let hems = made.garment.measurements.iter().filter(|m| is_hem(&m.name)).flat_map(|m| &m.runs);
        let points: Vec<V3> = hems.flat_map(|run| &run.points).map(|p| p.at(&made.drape.positions)).collect();
        let mean = |of: &dyn Fn(&V3) -> f64| points.iter().map(of).sum::<f64>() / points.len() as f64;
        (mean(&|p| self.surface.signed_distance(p)), mean(&|p| p.z))
    }
}

/// Distances of points of one drape from the same piece of another, m: their mean, and what 95 in a hundred are less than.
fn distances_m(one: &Made, other: &Made) -> (f64, f64) {
    let mut all = Vec::new();
    for (piece, same) in one.garment.pieces.iter().zip(&other.garment.pieces) {
        let corners = |t: &[usize; 3]| t.map(|v| other.drape.positions[v]);
        let triangles: Vec<[V3; 3]> = other.garment.triangles[same.triangles.clone()].iter().map(corners).collect();
        let step = (piece.vertices.len() / POINTS).max(1);
        for p in piece.vertices.clone().step_by(step).map(|v| one.drape.positions[v]) {
            let distance = |corners: &[V3; 3]| {
                let shares = triangle::nearest(&p, corners);
                (corners.iter().zip(shares).map(|(q, share)| q * share).sum::<V3>() - p).norm()
            };
            all.push(triangles.iter().map(distance).fold(f64::MAX, f64::min));
        }
    }
    all.sort_by(f64::total_cmp);
    (all.iter().sum::<f64>() / all.len() as f64, all[all.len() * 95 / 100])
}
