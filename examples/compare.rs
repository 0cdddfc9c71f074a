//! Three sizes of a T-shirt on one man by both simulators: how they fit, and whose drape to trust.
//!
//! `cargo run --release -p examples --bin compare` prints one line a size.

#![allow(clippy::print_stdout, reason = "an example speaks to whoever runs it")]

use std::error::Error;

use toile::body::Dimension;
use toile::body::{self, Measurements, Sex};
use toile::fit::{self, Cuts};
use toile::geom::DistanceField;
use toile::measure;
use toile::pattern::draft::Model;
use toile::pattern::{Garment, Style};
use toile::sim::{Drape, Silent, fabric, fem, hybrid};

/// Edge length of the finest mesh, m.
const EDGE_M: f64 = 0.025;
/// Spacing of the distance field, m.
const SPACING_M: f64 = 0.005;
/// Chest girth, m.
const CHEST_M: f64 = 0.98;

fn main() -> Result<(), Box<dyn Error>> {
    let measurements = Measurements::of(Sex::Male, 1.76).with(Dimension::ChestGirth, CHEST_M);
    let body = body::build(&measurements)?;
    let field = DistanceField::build(&body.mesh, SPACING_M)?;
    let cotton = &fabric::library()[0];
    let model = Model::Tshirt;

    println!("size  ease at the chest  FEM-GS EI, inside  Hybrid-GS EI, inside  to trust");
    for draft in model.drafts() {
        let style = Style::read(&draft.pieces, model.seams(), "tshirt.seams.toml")?;

        // FEM-GS wants coarser meshes before the last one, Hybrid-GS the last one alone.
        let meshes = fem::level_edges(EDGE_M).into_iter().map(|edge_m| style.mesh(edge_m));
        let meshes = meshes.collect::<Result<Vec<_>, _>>()?;
        let garment = meshes.last().ok_or("no mesh")?;
        let by_fem = fem::simulate(&body, &field, &meshes, cotton, &fem::Params::default(), &mut Silent)?;
        let by_hybrid = hybrid::simulate(&body, &field, &meshes, cotton, &hybrid::Params::default(), &mut Silent)?;

        // The least ease decides the fit class; the thesis's rule names a simulator for it.
        let levels = garment.fit_levels.iter().map(|fit| (fit.level.as_str(), fit.girth_m, true));
        let eases = fit::ease(levels, |level| (level == "chest").then_some(CHEST_M), &Cuts::default());
        let ease = eases.first().ok_or("no chest")?;
        let trusted = ease.class.rule_says();
        println!(
            "{:4}  {:5.1} mm, {:8}  {:17}  {:20}  {}",
            draft.size,
            1e3 * ease.ease_m(),
            ease.class.as_str(),
            told(garment, &by_fem)?,
            told(garment, &by_hybrid)?,
            trusted.as_str()
        );
    }
    Ok(())
}

/// Its error beside the pattern, and how deep it lies in the body.
fn told(garment: &Garment, drape: &Drape) -> Result<String, Box<dyn Error>> {
    let metrics = measure::metrics(&measure::measure(garment, &drape.positions)).ok_or("no measurements")?;
    Ok(format!("{:.4}, {:4.1} mm", metrics.ei, 1e3 * drape.penetration_max_m))
}
