//! Measures the distortion of a draped garment, triangle by triangle.

use nalgebra::Matrix2;

use super::{Distortion, SHARE};
use crate::SimError;
use crate::cloth::element::Element;
use geom::{V2, V3};
use pattern::{Garment, Spot};

impl Distortion {
    pub fn of(garment: &Garment, positions: &[V3]) -> Result<Self, SimError> {
        let mut found = Vec::with_capacity(garment.triangles.len());
        for (index, piece) in garment.pieces.iter().enumerate() {
            for t in piece.triangles.clone() {
                let corners = garment.triangles[t];
                let rest = corners.map(|v| garment.rest[v]);
                let element = Element::new(corners, rest, piece.grain)
                    .ok_or_else(|| SimError::Degenerate { piece: piece.id.clone(), at: rest[0] })?;
                let middle = rest.iter().sum::<V2>() / 3.0;
                found.push(Patch { stretch: stretch(&element, positions), area: element.area, piece: index, middle });
            }
        }
        found.sort_by(|a, b| b.stretch.total_cmp(&a.stretch));
        let wanted = SHARE * found.iter().map(|patch| patch.area).sum::<f64>();
        let mut sums = vec![(0.0, V2::zeros()); garment.pieces.len()];
        let (mut taken, mut least) = (0.0, 0.0);
        for patch in &found {
            let sum = &mut sums[patch.piece];
            *sum = (sum.0 + patch.area, sum.1 + patch.middle * patch.area);
            (taken, least) = (taken + patch.area, patch.stretch);
            if taken >= wanted {
                break;
            }
        }
        let most = (0..sums.len()).rev().max_by(|&a, &b| sums[a].0.total_cmp(&sums[b].0));
        let most = most.filter(|&piece| sums[piece].0 > 0.0).ok_or(SimError::NoMesh)?;
        let most_of_it = Spot { piece: garment.pieces[most].id.clone(), at: sums[most].1 / sums[most].0 };
        Ok(Self { stretch: least, most_of_it })
    }
}

struct Patch {
    stretch: f64,
    area: f64,
    piece: usize,
    middle: V2,
}

/// Root of the greater eigenvalue of the right Cauchy-Green tensor `C = F^T F`, less 1.
fn stretch(element: &Element, positions: &[V3]) -> f64 {
    let f = element.deformation_gradient(positions);
    let c: Matrix2<f64> = f.transpose() * f;
    let mean = 0.5 * (c[(0, 0)] + c[(1, 1)]);
    (mean + (0.5 * (c[(0, 0)] - c[(1, 1)])).hypot(c[(0, 1)])).sqrt() - 1.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laboratory::{self, sheets::sheet};

    #[test]
    fn one_part_in_a_hundred_decides_and_says_where() {
        // 20 x 20 squares of 1 cm; a square is 0.25 % of the cloth.
        let garment = laboratory::garment(sheet(20, 20, 0.01));
        let pulled = |from: f64, by: f64| -> Distortion {
            let stretched = |p: &V2| V3::new(p.x, p.y + by * (p.y - from).max(0.0), 0.0);
            let positions: Vec<V3> = garment.rest.iter().map(stretched).collect();
            Distortion::of(&garment, &positions).expect("a sound mesh")
        };
        let check = |from: f64, by: f64| {
            let found = pulled(from, by);
            assert!((found.stretch - by).abs() < 1e-9, "{found:?}, expected {by}");
        };
        check(0.0, 0.0);
        check(0.0, 0.2);
        // The uppermost row alone is 5 % of the cloth.
        check(0.19, 0.3);
        assert!(pulled(0.19, 0.3).most_of_it.at.y > 0.19);
        // Sheared by half, the longer diagonal of the right angle: root of 1 + g^2/2 + g root(1 + g^2/4).
        let sheared: Vec<V3> = garment.rest.iter().map(|p| V3::new(p.x + 0.5 * p.y, p.y, 0.0)).collect();
        let found = Distortion::of(&garment, &sheared).expect("a sound mesh").stretch;
        assert!((found - ((1.125 + 0.5 * 1.0625_f64.sqrt()).sqrt() - 1.0)).abs() < 1e-9, "{found}");
        // Three triangles of 800, however far they are drawn, are too little to matter.
        let mut corner: Vec<V3> = garment.rest.iter().map(|p| V3::new(p.x, p.y, 0.0)).collect();
        corner[0].x -= 0.05;
        assert!(Distortion::of(&garment, &corner).expect("a sound mesh").stretch < 1e-9);
        let says = pulled(0.19, 0.3).to_string();
        assert!(says.contains("1 % of the cloth is stretched by more than 30.0 %"), "{says}");
    }
}
