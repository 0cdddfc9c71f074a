//! What a raised arm draws up, beside a computation by hand on the pattern.
//!
//! By hand: the underarm point stays at the trunk, the cuff turns with the arm about the shoulder joint. What the straight
//! way between them exceeds the underarm of the sleeve by is drawn from cuff and trunk.
//!
//! `cargo run --release -p examples --bin reach [EDGE_MM]` prints both for the drafted T-shirt in three sizes and three poses.

#![allow(clippy::print_stdout, reason = "an example speaks to whoever runs it")]

use std::error::Error;

use toile::body::{self, Dimension, Joint, Measurements, Pose, Sex};
use toile::fit;
use toile::geom::{DistanceField, V3};
use toile::pattern::draft::Model;
use toile::pattern::{Garment, Style};
use toile::sim::fem::carry::{self, Motion, Worn};
use toile::sim::fem::{self, Params};
use toile::sim::{Silent, fabric};

/// Spacing of the distance field, m.
const SPACING_M: f64 = 0.005;
/// Pose that the man is dressed in, degrees.
const DRESSED_DEG: f64 = 15.0;

fn main() -> Result<(), Box<dyn Error>> {
    let edge_m = std::env::args().nth(1).map_or(Ok(20.0), |text| text.parse::<f64>())? / 1e3;
    let upright = body::build(&Measurements::of(Sex::Male, 1.76).with(Dimension::ChestGirth, 0.98))?;
    let arms = |deg| Pose { arm_deg: Some(deg), ..Pose::default() };
    let dressed = body::pose(&upright, arms(DRESSED_DEG))?;
    let field = DistanceField::build(&dressed.mesh, SPACING_M)?;
    let cotton = &fabric::library()[0];
    let params = Params::default();
    println!("size  arm  by hand: short  cuff drawn  underarm up  sum  | hem up mean  most  cuff mean, mm");
    for draft in Model::Tshirt.drafts() {
        let style = Style::read(&draft.pieces, Model::Tshirt.seams(), "tshirt.seams.toml")?;
        let meshes =
            fem::level_edges(edge_m).into_iter().map(|edge| style.mesh(edge)).collect::<Result<Vec<_>, _>>()?;
        let garment = meshes.last().ok_or("no mesh")?;
        let drape = fem::simulate(&dressed, &field, &meshes, cotton, &params, &mut Silent)?;
        for deg in [60.0, 75.0, 90.0] {
            let bodies = body::way(&upright, arms(DRESSED_DEG), arms(deg), carry::TURN_DEG)?;
            let motion = Motion { bodies: &bodies, spacing_m: SPACING_M };
            let worn = Worn { garment, fabric: cotton, drape: &drape };
            let carried = carry::carry(motion, worn, &params, &mut Silent)?;
            let (kept, lies) = (carried.kept.as_deref().unwrap_or_default(), &carried.positions[..]);
            let [underarm, cuff] = underarm(garment)?.map(|at| [&drape.positions[..], kept, lies].map(|x| x[at]));
            let joint = dressed.skeleton.at(Joint::ShoulderRight);
            let turned = about(joint, cuff[0], (deg - DRESSED_DEG).to_radians());
            let length_m = garment.measurements.iter().find(|m| m.name == "Sleeve Length").ok_or("no sleeve")?.l2d_m;
            let short = (turned - underarm[0]).norm() - length_m;
            let along = (underarm[0] - cuff[1]).normalize();
            let (drawn, up) = ((cuff[2] - cuff[1]).dot(&along), (underarm[0] - underarm[2]).dot(&along));
            let openings = fit::reach::drawn(garment, kept, lies);
            let hem = openings.iter().find(|one| one.opening.starts_with("Hem")).ok_or("no hem")?;
            let sleeve = openings.iter().find(|one| one.opening.starts_with("Sleeve")).ok_or("no cuff")?;
            let mm = [short, drawn, up, drawn + up, hem.mean_m, hem.most_m, sleeve.mean_m].map(|m| 1e3 * m);
            println!(
                "{:4} {deg:4.0}  {:14.0}  {:10.0}  {:11.0} {:5.0} | {:11.0} {:5.0} {:9.0}",
                draft.size, mm[0], mm[1], mm[2], mm[3], mm[4], mm[5], mm[6]
            );
        }
    }
    Ok(())
}

/// Vertices at both ends of the sleeve's underarm on the wearer's right: at the side seam, and at the cuff.
fn underarm(garment: &Garment) -> Result<[usize; 2], Box<dyn Error>> {
    let sleeve = garment.pieces.iter().find(|piece| piece.id == "sleeve_right").ok_or("no sleeve")?;
    let edge = &sleeve.edges["underarm_front"];
    let opening = &sleeve.edges["opening"];
    let (first, last) = (edge[0], edge[edge.len() - 1]);
    Ok(if opening.contains(&first) { [last, first] } else { [first, last] })
}

/// A point of the right arm, turned outwards about a joint in the frontal plane.
fn about(joint: V3, p: V3, angle: f64) -> V3 {
    let r = p - joint;
    let (sin, cos) = angle.sin_cos();
    joint + V3::new(r.x * cos - r.z * sin, r.y, r.x * sin + r.z * cos)
}
