//! A T-shirt on a man, from his measurements to a file that Blender opens.
//!
//! `cargo run --release -p examples --bin dress [FILE.glb]` prints chi of every measurement and writes body and garment to the file.

#![allow(clippy::print_stdout, reason = "an example speaks to whoever runs it")]

use std::error::Error;

use toile::body::Dimension;
use toile::body::{self, Measurements, Sex};
use toile::geom::{DistanceField, TriMesh};
use toile::measure;
use toile::pattern::Style;
use toile::pattern::draft::Model;
use toile::render::Material;
use toile::render::export::{MeshFormat, Part};
use toile::sim::fem::{self, Params};
use toile::sim::{Silent, fabric};

/// Edge length of the finest mesh, m.
const EDGE_M: f64 = 0.02;
/// Spacing of the distance field, m.
const SPACING_M: f64 = 0.005;

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).unwrap_or_else(|| "drape.glb".to_owned());

    // The body. What is not given is estimated.
    let measurements = Measurements::of(Sex::Male, 1.76).with(Dimension::ChestGirth, 0.98);
    let body = body::build(&measurements)?;
    let field = DistanceField::build(&body.mesh, SPACING_M)?;

    // The pattern: the drafted pieces of size M, sewn and measured as the seam file says.
    let model = Model::Tshirt;
    let medium = model.drafts().into_iter().find(|draft| draft.size == "M").ok_or("no size M")?;
    let style = Style::read(&medium.pieces, model.seams(), "tshirt.seams.toml")?;

    // FEM-GS goes through several meshes, coarse to fine; the drape is on the last one.
    let meshes = fem::level_edges(EDGE_M).into_iter().map(|edge_m| style.mesh(edge_m));
    let meshes = meshes.collect::<Result<Vec<_>, _>>()?;
    let garment = meshes.last().ok_or("no mesh")?;
    let cotton = &fabric::library()[0];
    let drape = fem::simulate(&body, &field, &meshes, cotton, &Params::default(), &mut Silent)?;

    // How true it stays to its pattern.
    let chis = measure::measure(garment, &drape.positions);
    for (chi, measurement) in chis.iter().zip(&garment.measurements) {
        println!("{:22} {:7.1} mm  chi {:.3}", measurement.name, 1e3 * chi.l3d_m, chi.chi());
    }
    let metrics = measure::metrics(&chis).ok_or("no measurements")?;
    println!("E {:.4}, SD {:.4}, EI {:.4}", metrics.e_chi, metrics.sd_chi, metrics.ei);

    // Body and garment as meshes.
    let cloth = TriMesh { positions: drape.positions, triangles: garment.triangles.clone() };
    let part = |name, mesh, material: Material| Part {
        name,
        mesh,
        colours: vec![material.front; mesh.positions.len()],
        places: None,
        values: None,
    };
    let parts = [part("body", &body.mesh, Material::form()), part("garment", &cloth, Material::fem())];
    std::fs::write(&path, MeshFormat::Glb.write(&parts))?;
    println!("{path}: written");
    Ok(())
}
