//! How drapes answer to the handles of their patterns: derivatives beside central differences (docs/alter.md).
//!
//! `cargo run --release -p examples --bin response [EDGE_MM]` prints a line for each handle of the T-shirt, the trousers and the dress, loose and
//! tight: as friction holds the drape, and as it would slide.

#![allow(clippy::print_stdout, reason = "an example speaks to whoever runs it")]

use std::error::Error;

use toile::body::{self, Body, Dimension, Measurements, Sex};
use toile::geom::{DistanceField, V2, V3};
use toile::pattern::draft::Model;
use toile::pattern::{Garment, Handle, Style};
use toile::sim::contact::Skin;
use toile::sim::fem::response::{Lying, Response, sewn};
use toile::sim::fem::{self, Params};
use toile::sim::{Silent, fabric};

/// By how much a mesh is taken along by a handle, and the step of the differences, m.
const TAKEN_M: f64 = 1e-4;
const STEP_M: f64 = 1e-6;
/// How far derivative and differences may be apart, over the differences.
const AGREES: f64 = 1e-3;

fn main() -> Result<(), Box<dyn Error>> {
    let edge_m = 1e-3 * std::env::args().nth(1).map_or(Ok(30.0), |text| text.parse::<f64>())?;
    let man = |chest_m: f64, waist_m: f64| {
        let of = Measurements::of(Sex::Male, 1.75).with(Dimension::ChestGirth, chest_m);
        of.with(Dimension::WaistGirth, waist_m)
    };
    let woman = |chest_m: f64, waist_m: f64, hip_m: f64| {
        let of = Measurements::of(Sex::Female, 1.66).with(Dimension::ChestGirth, chest_m);
        of.with(Dimension::WaistGirth, waist_m).with(Dimension::HipGirth, hip_m)
    };
    let mut all = [0, 0];
    for (name, model, size, who) in [
        ("T-shirt, loose", Model::Tshirt, 1, man(0.92, 0.80)),
        ("T-shirt, tight", Model::Tshirt, 0, man(1.02, 0.93)),
        ("trousers, loose", Model::Trousers, 1, man(0.98, 0.92)),
        ("trousers, tight", Model::Trousers, 0, man(1.04, 0.97)),
        ("dress, loose", Model::Dress, 0, woman(0.86, 0.68, 0.92)),
        ("dress, tight", Model::Dress, 0, woman(0.95, 0.78, 1.02)),
    ] {
        let drafts = model.drafts();
        let style = Style::read(&drafts[size].pieces, model.seams(), "draft")?;
        let [agree, of] = case(name, &style, &body::build(&who)?, edge_m)?;
        all = [all[0] + agree, all[1] + of];
    }
    println!("{} of {} agree within {AGREES}", all[0], all[1]);
    Ok(())
}

/// Prints how a drape answers to each handle; says how many derivatives agree, and of how many.
fn case(name: &str, style: &Style, body: &Body, edge_m: f64) -> Result<[usize; 2], Box<dyn Error>> {
    let field = DistanceField::build(&body.mesh, 0.005)?;
    let meshes = fem::level_edges(edge_m).into_iter().map(|edge| style.mesh(edge)).collect::<Result<Vec<_>, _>>()?;
    let garment = meshes.last().ok_or("no mesh")?;
    let (cotton, params) = (&fabric::library()[0], Params::default());
    let drape = fem::simulate(body, &field, &meshes, cotton, &params, &mut Silent)?;
    let skin = Skin::new(&body.mesh).ok();
    let cloth = sewn(garment, cotton)?;
    let (mut agree, mut of) = (0, 0);
    for is_held in [true, false] {
        let lying = Lying {
            skin: skin.as_ref(),
            field: &field,
            floor_m: fem::floor_m(body),
            garment,
            fabric: cotton,
            params: &params,
            is_held,
        };
        let response = Response::of(lying, &cloth, &drape.positions)?;
        let how = if is_held { "held by friction" } else { "free to slide" };
        let stable = if response.is_stable() { "stable" } else { "not stable" };
        println!("{name}, {how}: {} vertices, residual {:.0e}, {stable}", cloth.len(), response.residual());
        for handle in style.handles() {
            let Some(off) = compared(&response, style, garment, handle)? else { continue };
            let told = if off < AGREES { "" } else { "  contact changes, or not wholly at rest" };
            println!("  {:18} off by {off:.1e} of the way{told}", handle.as_str());
            (agree, of) = (agree + usize::from(off < AGREES), of + 1);
        }
    }
    Ok([agree, of])
}

/// How far derivative and central differences of all vertices are apart, over the differences; `None` of a handle that cannot move.
fn compared(
    response: &Response,
    style: &Style,
    garment: &Garment,
    handle: Handle,
) -> Result<Option<f64>, Box<dyn Error>> {
    let taken = |by_m: f64| style.moved_mesh(garment, handle, by_m);
    let (Ok(more), Ok(less)) = (taken(TAKEN_M), taken(-TAKEN_M)) else { return Ok(None) };
    let at = |by_m: f64| {
        let way = |v: usize| (more.rest[v] - less.rest[v]) / (2.0 * TAKEN_M);
        garment.with_rest((0..garment.rest.len()).map(|v| garment.rest[v] + way(v) * by_m).collect::<Vec<V2>>())
    };
    let (before, after) = (at(-STEP_M), at(STEP_M));
    let rates = response.rates([&before, &after], 2.0 * STEP_M)?;
    let ((before, _), (after, _)) = (response.again(&before)?, response.again(&after)?);
    let norm = |ways: &mut dyn Iterator<Item = V3>| ways.map(|way| way.norm_squared()).sum::<f64>().sqrt();
    let way = |v: usize| (after[v] - before[v]) / (2.0 * STEP_M);
    let off = norm(&mut (0..rates.len()).map(|v| rates[v] - way(v)));
    Ok(Some(off / norm(&mut (0..rates.len()).map(way))))
}
