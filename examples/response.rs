//! How drapes answer to the handles of their patterns: derivatives beside central differences (docs/alter.md).
//!
//! `cargo run --release --example response` prints a line for each handle of the T-shirt, the trousers and the dress, loose and tight.

#![allow(clippy::print_stdout, reason = "an example speaks to whoever runs it")]

use std::error::Error;

use toile::body::{self, Body, Dimension, Measurements, Sex};
use toile::geom::{DistanceField, V3};
use toile::pattern::draft::Model;
use toile::pattern::{Garment, Handle, Style};
use toile::sim::contact::Skin;
use toile::sim::fem::response::{Lying, Response, sewn};
use toile::sim::fem::{self, Params};
use toile::sim::{Silent, fabric};

fn main() -> Result<(), Box<dyn Error>> {
    let edge_m: f64 = std::env::args().nth(1).map_or(Ok(0.03), |text| text.parse())?;
    let man = |chest: f64| Measurements::of(Sex::Male, 1.75).with(Dimension::ChestGirth, chest);
    for (model, size, who) in [(Model::Tshirt, 1, man(0.92)), (Model::Tshirt, 0, man(1.02))] {
        let drafts = model.drafts();
        let style = Style::read(&drafts[size].pieces, model.seams(), "draft")?;
        case(&style, &body::build(&who)?, edge_m)?;
    }
    Ok(())
}

fn case(style: &Style, body: &Body, edge_m: f64) -> Result<(), Box<dyn Error>> {
    let field = DistanceField::build(&body.mesh, 0.005)?;
    let meshes = fem::level_edges(edge_m).into_iter().map(|edge| style.mesh(edge)).collect::<Result<Vec<_>, _>>()?;
    let (cotton, params) = (&fabric::library()[0], Params::default());
    let drape = fem::simulate(body, &field, &meshes, cotton, &params, &mut Silent)?;
    let garment = &meshes[meshes.len() - 1];
    let skin = Skin::new(&body.mesh).ok();
    let cloth = sewn(garment, cotton)?;
    let lying = Lying { skin: skin.as_ref(), field: &field, garment, fabric: cotton, params: &params };
    let start = std::time::Instant::now();
    let response = Response::of(lying, &cloth, &drape.positions)?;
    let rested = response.positions();
    let moved = rested.iter().zip(&drape.positions).map(|(p, q)| (p - q).norm()).fold(0.0, f64::max);
    println!(
        "{} {}: {} vertices, residual {:.1e} stable {} moved {:.3} mm, {:.1} s",
        style.name,
        style.size,
        cloth.len(),
        response.residual(),
        response.is_stable(),
        1e3 * moved,
        start.elapsed().as_secs_f64()
    );
    Ok(())
}
