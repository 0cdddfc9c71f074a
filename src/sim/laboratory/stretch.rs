//! Membrane experiments: the patch test, a biaxial sheet, a strip that hangs.

use super::Specimen;
use super::sheets::{hexagonal_sheet, jittered, shaken};
use crate::{Fabric, SimError};
use geom::units::GRAVITY;
use geom::{V2, V3};

/// Sides are held at the places of a homogeneous deformation `gradient` (columns: images of weft and warp). Returns the
/// greatest distance of an inner vertex from that deformation, and the tension across a line normal to the weft and to
/// the warp (N/m of rest width).
pub fn held_sheet(fabric: &Fabric, gradient: [V3; 2]) -> Result<(f64, [f64; 2]), SimError> {
    let edge = 0.02;
    let (columns, rows) = (6, 6);
    let flat = jittered(hexagonal_sheet(columns, rows, edge), 0.2 * edge, |_| false);
    let (width, height) = (columns as f64 * edge, rows as f64 * edge * 0.75_f64.sqrt());
    let is_side = |p: &V2| p.x < 1e-9 || p.y < 1e-9 || p.x > width - 1e-9 || p.y > height - 1e-9;
    let affine = |p: &V2| gradient[0] * p.x + gradient[1] * p.y;
    let sheet = Specimen::new(flat, fabric, affine)?;
    let mut sheet = sheet.hold(is_side);
    let exact = sheet.positions.clone();
    let start = shaken(&sheet.positions, 0.1 * edge, 5);
    for v in (0..start.len()).filter(|v| !sheet.held.contains(v)) {
        sheet.positions[v] = start[v];
    }
    sheet.rest(0.0, 1e-9, 200);
    let off = sheet.positions.iter().zip(&exact).map(|(p, q)| (p - q).norm()).fold(0.0, f64::max);
    let mut forces = vec![V3::zeros(); exact.len()];
    sheet.cloth.membrane.add_forces(&sheet.positions, &mut forces);
    // Virtual work of the reactions at the held sides in a stretch along one axis, corners included.
    let tension = |axis: usize| {
        let direction = gradient[axis].normalize();
        let work: f64 = sheet.garment.rest.iter().zip(&forces).map(|(p, f)| -f.dot(&direction) * p[axis]).sum();
        work / (width * height)
    };
    Ok((off, [tension(0), tension(1)]))
}

/// Elongation of a strip that hangs by its own weight, m, its warp vertical.
pub fn hanging_strip(fabric: &Fabric, length: f64, rows: usize) -> Result<f64, SimError> {
    let edge = length / rows as f64 / 0.75_f64.sqrt();
    let strip = Specimen::new(hexagonal_sheet(4, rows, edge), fabric, |p| V3::new(p.x, 0.0, p.y))?;
    let mut strip = strip.hold(|p| p.y > length - 1e-9);
    strip.rest(1.0, 1e-7, 200);
    let lowest: Vec<f64> =
        strip.garment.rest.iter().zip(&strip.positions).filter(|(r, _)| r.y < 1e-9).map(|(_, p)| -p.z).collect();
    Ok(lowest.iter().sum::<f64>() / lowest.len() as f64)
}

/// Elongation, m: the tension is `w g s` at the height `s`, and the stretch follows from `T = S(E) lambda`, integrated
/// over the length.
pub fn hanging_thread(fabric: &Fabric, length: f64) -> f64 {
    let steps = 2000;
    let piece = length / f64::from(steps);
    let grow = |i: u32| {
        let tension = fabric.density_kg_m2 * GRAVITY * piece * (f64::from(i) + 0.5);
        let pull = |stretch: f64| fabric.warp_law().stress(0.5 * (stretch * stretch - 1.0)) * stretch;
        let (mut low, mut high) = (1.0, 3.0);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if pull(middle) > tension { high = middle } else { low = middle }
        }
        (low - 1.0) * piece
    };
    (0..steps).map(grow).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fabric;
    use crate::testing;

    #[test]
    fn a_patch_deforms_as_its_sides_whatever_its_triangles() {
        let check = |weft: V3, warp: V3| {
            let (off, _) = held_sheet(&testing::fabric(), [weft, warp]).expect("a sound mesh");
            assert!(off < 1e-8, "{off}");
        };
        check(V3::new(1.05, 0.0, 0.0), V3::new(0.0, 1.02, 0.0));
        check(V3::new(1.03, 0.04, 0.0), V3::new(0.1, 1.06, 0.2));
    }

    #[test]
    fn a_biaxial_sheet_pulls_as_its_law_says() {
        let fabric = testing::fabric();
        let (a, b) = (1.08, 1.03);
        let (_, tension) = held_sheet(&fabric, [V3::x() * a, V3::y() * b]).expect("a sound mesh");
        let (ea, eb) = ((a * a - 1.0) / 2.0, (b * b - 1.0) / 2.0);
        let expect = [
            (fabric.membrane_weft_n_m * ea + fabric.membrane_coupling_n_m * eb) * a,
            (fabric.membrane_warp_n_m * eb + fabric.membrane_coupling_n_m * ea) * b,
        ];
        for k in 0..2 {
            assert!((tension[k] / expect[k] - 1.0).abs() < 1e-6, "{} for {}", tension[k], expect[k]);
        }
    }

    #[test]
    fn a_strip_hangs_as_a_thread_and_as_the_book_says() {
        let check = |fabric: &Fabric, length: f64| {
            let strip = Fabric { membrane_coupling_n_m: 0.0, ..fabric.clone() };
            let (growth, expect) =
                (hanging_strip(&strip, length, 40).expect("a sound mesh"), hanging_thread(&strip, length));
            assert!((growth / expect - 1.0).abs() < 0.005, "{}: {growth} for {expect}", fabric.name);
            (growth, expect)
        };
        let fabric = testing::fabric();
        let (_, expect) = check(&fabric, 0.4);
        let small = fabric.density_kg_m2 * GRAVITY * 0.4 * 0.4 / (2.0 * fabric.membrane_warp_n_m);
        assert!((expect / small - 1.0).abs() < 0.005, "{expect} for {small}");
        // Knits that stiffen on the way.
        fabric::library().iter().filter(|f| f.stretched.is_some()).for_each(|knit| {
            check(knit, 1.5);
        });
    }
}
