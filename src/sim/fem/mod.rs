//! FEM-GS (chapter 4): preposition, sewing and draping by physics alone.

pub mod params;
pub mod preposition;
mod run;
mod start;

pub use params::{Params, level_edges};

use crate::body::Body;
use crate::geom::{DistanceField, V3};
use crate::pattern::Garment;
use crate::sim::cloth::Cloth;
use crate::sim::contact::{BodyContact, ClothContact, Skin};
use crate::sim::levels::prolong;
use crate::sim::quality;
use crate::sim::sewing::{self, Springs};
use crate::sim::solver::System;
use crate::sim::{Drape, Fabric, Monitor, SimError, Stage};

use run::{Phase, Run};

/// Deepest point of a drape that is good, m.
const DEEPEST_M: f64 = 3e-4;
/// Times at most that a drape is taken up again, because it is not at rest yet or to hold out points inside the body.
const HOLDING_ROUNDS: usize = 5;

/// Dresses a body in a garment.
///
/// `garments` are meshes of the same garment, coarse to fine; the drape is on the last. The coarsest is placed, sewn and
/// roughly draped, each finer one starts from the one before. All settle without friction first, so that the drape
/// does not depend on how the seams were closed; only then does friction hold it. What slides off without is settled again
/// with friction throughout.
///
/// # Errors
/// When the garment cannot be placed, is degenerate, diverges, slides off the body even so, or the monitor cancels. Not converging is no error.
pub fn simulate(
    body: &Body,
    field: &DistanceField,
    garments: &[Garment],
    fabric: &Fabric,
    params: &Params,
    monitor: &mut dyn Monitor,
) -> Result<Drape, SimError> {
    let (Some(coarsest), Some(finest)) = (garments.first(), garments.last()) else {
        return Err(SimError::NoMesh);
    };
    let mut run = Run::new(params, monitor, garments.len() - 1);
    let sewn = sew(body, field, coarsest, fabric, params, &mut run)?;
    run.keep_up(&sewn);
    let skin = Skin::new(&body.mesh).ok();
    let around = Around { skin: skin.as_ref(), field };
    let mut from_sewn = |grip| refine(around, garments, fabric, &sewn, &mut run, grip);
    let last = match from_sewn(Grip::AtTheEnd) {
        // Nothing but friction may hold it up.
        Err(SimError::SlidOff { .. }) => from_sewn(Grip::Throughout)?,
        other => other?,
    };
    Ok(Drape {
        stage: Stage::Drape,
        converged: last.residual <= params.tolerance,
        iterations: run.iterations(),
        residual: last.residual,
        penetration_max_m: quality::penetration_m(body, finest, &last.positions),
        seam_gap_max_m: quality::seam_gap_m(finest, &last.positions),
        self_crossings: quality::self_crossings(&last.sewn, &last.triangles),
        welded_vertices: last.sewn.len(),
        positions: last.positions,
        history: run.into_history(),
        earlier: Vec::new(),
    })
}

/// From when on friction holds a garment.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Grip {
    /// Once it has come to rest without: then the drape does not depend on how the seams were closed.
    AtTheEnd,
    /// From the sewing on: for what would slide off the body without.
    Throughout,
}

/// Settles a sewn garment on the coarsest mesh, and on each finer one from the one before.
fn refine(
    around: Around,
    garments: &[Garment],
    fabric: &Fabric,
    sewn: &[V3],
    run: &mut Run,
    grip: Grip,
) -> Result<Settled, SimError> {
    let mut last: Option<(&Garment, Settled)> = None;
    for (level, garment) in garments.iter().enumerate() {
        let cloth = Cloth::new(garment, fabric, sewing::welded(garment))?;
        let x = match &last {
            None => cloth.weld(sewn),
            Some((coarser, drape)) => prolong(coarser, &drape.positions, garment, &cloth, fabric),
        };
        last = Some((garment, settle(around, garment, &cloth, x, fabric, run, level, grip)?));
    }
    last.map(|(_, settled)| settled).ok_or(SimError::NoMesh)
}

/// Places a garment and draws its seams together; returns garment positions with all seams (nearly) closed.
fn sew(
    body: &Body,
    field: &DistanceField,
    garment: &Garment,
    fabric: &Fabric,
    params: &Params,
    run: &mut Run,
) -> Result<Vec<V3>, SimError> {
    let mut x = preposition::place(body, garment, params)?;
    let force = start::perturb(params.seed, &mut x);
    let cloth = Cloth::new(garment, fabric, sewing::unsewn(garment))?;
    let contact = BodyContact::new(field, params.contact, &cloth.areas).with_points_between(&cloth.triangles);
    let springs = Springs::new(garment, params.seam_stiffness_n_m, force * params.seam_cap_n);
    let sewn = springs.pairs.clone();
    let mut system = System::new(&cloth, contact, Some(springs));
    let apart = ClothContact::new(params.self_contact, &cloth.triangles, &cloth.areas);
    system.self_contact = Some(apart.but_near(sewn.into_iter()));
    run.sew(garment, &mut system, &mut x)?;
    Ok(x)
}

/// A settled level.
struct Settled {
    positions: Vec<V3>,
    residual: f64,
    /// Positions and triangles of the sewn vertices.
    sewn: Vec<V3>,
    triangles: Vec<[usize; 3]>,
}

/// The body as contact sees it: exactly, and as a field.
#[derive(Clone, Copy)]
struct Around<'a> {
    /// `None` where the mesh bounds no solid: then only the field holds the cloth.
    skin: Option<&'a Skin<'a>>,
    field: &'a DistanceField,
}

/// Lets a sewn garment come to rest from `x`, without friction and then, on the finest level, with it.
#[allow(clippy::too_many_arguments)]
fn settle(
    around: Around,
    garment: &Garment,
    cloth: &Cloth,
    mut x: Vec<V3>,
    fabric: &Fabric,
    run: &mut Run,
    level: usize,
    grip: Grip,
) -> Result<Settled, SimError> {
    let params = run.params();
    let is_finest = level == run.levels();
    let mut contact = BodyContact::new(around.field, params.contact, &cloth.areas);
    if !is_finest {
        contact = contact.with_points_between(&cloth.triangles);
    }
    let mut system = System::new(cloth, contact, None);
    system.self_contact = Some(ClothContact::new(params.self_contact, &cloth.triangles, &cloth.areas));
    let hold_out = |system: &mut System, x: &[V3], is_at_rest: bool| {
        let deepest = |skin| system.contact.hold_out(skin, &cloth.triangles, x, is_at_rest);
        around.skin.map_or(0.0, deepest)
    };
    if is_finest {
        hold_out(&mut system, &x, false);
    }
    if grip == Grip::Throughout {
        system.contact.set_friction(Some(fabric.friction_body));
    }
    let mut residual = run.drape(garment, &mut system, &mut x, Phase::frictionless(params, level, run.levels()))?;
    if is_finest {
        hold_out(&mut system, &x, residual <= params.coarse_tolerance);
        system.contact.set_friction(Some(fabric.friction_body));
        for _ in 0..HOLDING_ROUNDS {
            residual = run.drape(garment, &mut system, &mut x, Phase::final_drape(params, level))?;
            let is_at_rest = residual <= params.tolerance;
            if hold_out(&mut system, &x, is_at_rest) <= DEEPEST_M && is_at_rest {
                break;
            }
        }
    }
    Ok(Settled { positions: cloth.unweld(&x), residual, sewn: x, triangles: cloth.triangles.clone() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::{self, Measurements, Sex};
    use crate::pattern::Style;
    use crate::pattern::draft::Model;
    use crate::sim::{Progress, fabric};

    struct Silent;

    impl Monitor for Silent {
        fn progress(&mut self, _: &Progress) {}
    }

    /// Trousers of a soft, slippery knit, with more at the end of their seam file.
    fn slippery_trousers(more: &str) -> Result<Drape, SimError> {
        let measurements = Measurements {
            chest_girth_m: Some(0.94),
            waist_girth_m: Some(0.8),
            hip_girth_m: Some(0.95),
            ..Measurements::of(Sex::Male, 1.75)
        };
        let body = body::build(&measurements).expect("a body");
        let field = DistanceField::build(&body.mesh, 0.012).expect("a closed body");
        let seams = Model::Trousers.seams().to_vec();
        let style = Style::read(&Model::Trousers.drafts()[1].pieces, &[&seams, more.as_bytes()].concat(), "seams");
        let garment = style.expect("drafted").mesh(0.05).expect("it meshes");
        let knit = fabric::library().into_iter().find(|f| f.name == "interlock_tshirt").expect("in the library");
        let slippery = Fabric { friction_body: 0.05, ..knit };
        simulate(&body, &field, &[garment], &slippery, &Params::default(), &mut Silent)
    }

    #[test]
    fn what_nothing_holds_up_is_given_up_and_a_waistband_holds_it() {
        let error = slippery_trousers("").err().map(|e| e.to_string()).unwrap_or_default();
        assert!(error.contains("slides off this body: it has come down by 25"), "{error}");
        let waist = r#"
            [[reinforce]]
            edges = ["leg_front_left.waist", "leg_front_right.waist", "leg_back_right.waist", "leg_back_left.waist"]
            kind = "waistband"
            stiffness_n = 200.0
            length_factor = 0.95
        "#;
        let drape = slippery_trousers(waist).map_err(|e| e.to_string());
        assert!(drape.is_ok_and(|drape| drape.converged));
    }
}
