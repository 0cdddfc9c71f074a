//! Contact experiments: a sheet on an incline, a tube over a cylinder.

use nalgebra::Rotation3;

use super::sheets::hexagonal_sheet;
use super::{garment, settle};
use crate::cloth::Cloth;
use crate::cloth::law::Tensor;
use crate::contact::{BodyContact, ClothContact, ClothContactParams, ContactParams};
use crate::sewing::{unsewn, welded};
use crate::solver::System;
use crate::{Fabric, SimError};
use geom::{DistanceField, TriMesh, V2, V3, shapes};
use pattern::SeamMesh;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Laid {
    pub residual: f64,
    pub moved_m: f64,
}

pub fn on_incline(fabric: &Fabric, friction: f64, angle_rad: f64) -> Result<Laid, SimError> {
    let (edge, columns) = (0.02, 4);
    let sheet = garment(hexagonal_sheet(columns, columns, edge));
    let cloth = Cloth::new(&sheet, fabric, unsewn(&sheet))?;
    let field = incline(angle_rad);
    let contact = ContactParams::default();
    let mut system = System::new(&cloth, BodyContact::new(&field, contact, &cloth.areas), None);
    system.contact.set_friction(std::iter::repeat_n(friction, cloth.len()));
    let (turn, middle) = (Rotation3::from_axis_angle(&V3::x_axis(), angle_rad), 0.5 * columns as f64 * edge);
    let laid = |p: &V2| turn * V3::new(p.x - middle, p.y - middle, 0.9 * contact.offset_m);
    let start: Vec<V3> = sheet.rest.iter().map(laid).collect();
    let mut x = start.clone();
    let residual = settle(&mut system, &mut x, 1e-3, 60);
    let moved_m = x.iter().zip(&start).map(|(p, q)| (p - q).norm()).fold(0.0, f64::max);
    Ok(Laid { residual, moved_m })
}

/// Lays a sheet on a larger one, which is held fast on an incline. The displacement is that of the upper sheet.
pub fn layer_on_incline(fabric: &Fabric, friction: f64, angle_rad: f64) -> Result<Laid, SimError> {
    let (edge, contact, between) = (0.02, ContactParams::default(), ClothContactParams::default());
    let ((mut rest, mut triangles), (upper, others)) = (hexagonal_sheet(8, 8, edge), hexagonal_sheet(4, 4, edge));
    let lower = rest.len();
    triangles.extend(others.iter().map(|t| t.map(|v| v + lower)));
    // Apart in the pattern. Laid on each other, no vertex lies above another.
    rest.extend(upper.iter().map(|p| p + V2::new(0.5, 0.0)));
    let sheets = garment((rest, triangles));
    // The friction on the slope holds the lower sheet at any angle.
    let rough = Fabric { friction_body: 5.0, friction_self: friction, ..fabric.clone() };
    let cloth = Cloth::new(&sheets, &rough, unsewn(&sheets))?;
    let field = incline(angle_rad);
    let mut system = System::new(&cloth, BodyContact::new(&field, contact, &cloth.areas), None);
    system.self_contact = Some(ClothContact::new(between, &cloth.triangles, &cloth.areas));
    system.set_friction();
    let turn = Rotation3::from_axis_angle(&V3::x_axis(), angle_rad);
    let laid = |(v, p): (usize, &V2)| {
        let height = 0.9 * contact.offset_m;
        match v < lower {
            true => turn * V3::new(p.x - 4.0 * edge, p.y - 4.0 * edge, height),
            false => turn * V3::new(p.x - 0.5 - 2.13 * edge, p.y - 2.37 * edge, height + between.thickness_m),
        }
    };
    let mut x: Vec<V3> = sheets.rest.iter().enumerate().map(laid).collect();
    let start = x.clone();
    let residual = settle(&mut system, &mut x, 1e-3, 60);
    let moved_m = x.iter().zip(&start).skip(lower).map(|(p, q)| (p - q).norm()).fold(0.0, f64::max);
    Ok(Laid { residual, moved_m })
}

/// Slab whose upper face is inclined about the x axis.
fn incline(angle_rad: f64) -> DistanceField {
    let (half, depth) = (0.15, 0.1);
    let turn = Rotation3::from_axis_angle(&V3::x_axis(), angle_rad);
    let corner = |i: usize| {
        let sign = |bit: usize| if i & bit == 0 { -half } else { half };
        turn * V3::new(sign(1), sign(2), if i & 4 == 0 { -depth } else { 0.0 })
    };
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    let mesh = TriMesh { positions: (0..8).map(corner).collect(), triangles };
    DistanceField::build(&mesh, 0.01).expect("a closed slab")
}

pub struct Pressed {
    /// Mean pressure away from the ends.
    pub pressure_pa: f64,
    /// Hoop tension over the radius of its girth: the pressure by Laplace's law.
    pub tension_over_radius_pa: f64,
    pub radius_m: f64,
}

/// Stretches a tube over a cylinder 20 cm high. Its warp is along the axis, and its rest girth is a share of that of
/// the cylinder.
pub fn pressed_tube(fabric: &Fabric, radius_m: f64, share: f64, edge_m: f64) -> Result<Pressed, SimError> {
    let girth_m = share * std::f64::consts::TAU * radius_m;
    let columns = (girth_m / edge_m).round() as usize;
    let edge = girth_m / columns as f64;
    let rows = (0.1 / edge / 0.75_f64.sqrt()).round() as usize;
    let mut tube = garment(hexagonal_sheet(columns, rows, edge));
    let end = |x: f64| -> Vec<usize> { (0..tube.rest.len()).filter(|v| (tube.rest[*v].x - x).abs() < 1e-9).collect() };
    let pairs = end(0.0).into_iter().zip(end(girth_m)).map(|(a, b)| [a, b]).collect();
    tube.seams = vec![SeamMesh { name: "side".into(), pairs }];
    let cloth = Cloth::new(&tube, fabric, welded(&tube))?;
    let height_m = rows as f64 * edge * 0.75_f64.sqrt();
    let start_m = radius_m + 2e-3;
    let around = |p: &V2| {
        let (sin, cos) = (std::f64::consts::TAU * p.x / girth_m).sin_cos();
        V3::new(start_m * cos, start_m * sin, p.y - 0.5 * height_m)
    };
    let mut x = cloth.weld(&tube.rest.iter().map(around).collect::<Vec<_>>());
    let profile = [(0.0, -0.1), (radius_m, -0.1), (radius_m, 0.0), (radius_m, 0.1), (0.0, 0.1)];
    let field = DistanceField::build(&shapes::revolve(&profile, 192), 4e-3).expect("a closed cylinder");
    let mut system = System::new(&cloth, BodyContact::new(&field, ContactParams::default(), &cloth.areas), None);
    system.weights.fill(0.0);
    settle(&mut system, &mut x, 1e-3, 200);
    let forces = system.assemble(&x, None).contact_forces;
    // The middle third of the tube, since free ends contract less along the girth than a strip would.
    let middle: Vec<usize> = (0..x.len()).filter(|v| x[*v].z.abs() < height_m / 6.0).collect();
    let mean = |value: &dyn Fn(usize) -> f64| middle.iter().map(|v| value(*v)).sum::<f64>() / middle.len() as f64;
    let radius = mean(&|v| x[v].xy().norm());
    let strains = cloth.membrane.strains(&x);
    let is_middle = |t: &[usize; 3]| t.iter().all(|v| x[*v].z.abs() < height_m / 6.0);
    let (mut along, mut count) = (0.0, 0.0);
    for (strain, _) in strains.iter().zip(&cloth.triangles).filter(|(_, t)| is_middle(t)) {
        (along, count) = (along + strain[(1, 1)], count + 1.0);
    }
    let along = along / f64::max(count, 1.0);
    // The strain at the girth of the tube, and at the length that it has contracted to along its axis.
    let girth = std::f64::consts::TAU * radius / girth_m;
    let strain = Tensor { weft: 0.5 * (girth * girth - 1.0), warp: along, shear: 0.0 };
    let tension = cloth.membrane.laws()[0].stress(strain).weft * girth / (1.0 + 2.0 * along).sqrt();
    let grown = girth * (1.0 + 2.0 * along).sqrt();
    let pressing = mean(&|v| forces[v].xy().dot(&x[v].xy().normalize())) / (mean(&|v| cloth.areas[v]) * grown);
    Ok(Pressed { pressure_pa: pressing, tension_over_radius_pa: tension / radius, radius_m: radius })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::fabric;

    #[test]
    fn friction_holds_to_a_degree_below_its_angle_and_lets_go_a_degree_above() {
        let laid =
            |degrees: f64| on_incline(&fabric(), 0.3, 0.3_f64.atan() + degrees.to_radians()).expect("a sound mesh");
        let Laid { residual, moved_m } = laid(-1.0);
        assert!(residual <= 1e-3 && moved_m < 1e-3, "below: residual {residual}, moved {moved_m}");
        // A degree above, 0.018 of the weight is unbalanced: the solver may creep, but must not report equilibrium.
        let residual = laid(1.0).residual;
        assert!(residual > 1e-2, "above: residual {residual}");
    }

    #[test]
    fn layers_hold_each_other_to_a_degree_below_coulombs_angle_and_slip_a_degree_above() {
        let check = |friction: f64| {
            let laid = |degrees: f64| {
                layer_on_incline(&fabric(), friction, friction.atan() + degrees.to_radians()).expect("a sound mesh")
            };
            // It slides a little until it is pressed on, and then holds.
            let residual = laid(-1.0).residual;
            assert!(residual <= 1e-3, "{friction}, below: residual {residual}");
            // A degree above, 0.018 of the weight of the upper sheet is unbalanced, at a quarter of the vertices: the
            // solver may creep, but must not report equilibrium.
            let residual = laid(1.0).residual;
            assert!(residual > 5e-3, "{friction}, above: residual {residual}");
        };
        check(0.2);
        check(0.3);
        check(0.5);
    }

    #[test]
    fn a_tube_presses_with_its_tension_over_its_radius() {
        let check = |radius_m: f64, share: f64, edge_m: f64| {
            let found = pressed_tube(&fabric(), radius_m, share, edge_m).expect("a sound mesh");
            let off = found.pressure_pa / found.tension_over_radius_pa - 1.0;
            assert!(off.abs() < 0.01, "{radius_m} {share} {edge_m}: {off}");
        };
        check(0.1, 0.9, 0.015);
        check(0.05, 0.8, 0.015);
        check(0.15, 0.97, 0.015);
    }
}
