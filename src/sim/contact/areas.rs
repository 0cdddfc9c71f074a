//! Vertex areas for the contact of cloth with itself.

use pattern::Garment;

/// Rest areas of the vertices of a sewn garment for its contact with itself, m2. Where a triangle is lower at a vertex
/// than `least_m`, the area is at most the square of that height.
///
/// A pattern may have edges of a millimetre, where two seams just miss each other. The two ends of such an edge are
/// then nearer than the distance at which layers repel each other, and contacts thicken with these areas. With the
/// areas of the mesh the cloth would push itself apart in its own plane, with forces beyond its weight.
pub fn contact_areas(garment: &Garment, vertex_of: &[usize], areas: &[f64], least_m: f64) -> Vec<f64> {
    let mut areas = areas.to_vec();
    for t in &garment.triangles {
        for k in 0..3 {
            let [p, a, b] = [0, 1, 2].map(|j| garment.rest[t[(k + j) % 3]]);
            let height_m = (b - a).perp(&(p - a)).abs() / (b - a).norm();
            if height_m < least_m {
                let area = &mut areas[vertex_of[t[k]]];
                *area = area.min(height_m * height_m);
            }
        }
    }
    areas
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::{ClothContact, ClothContactParams};
    use crate::laboratory;
    use geom::{V2, V3};

    /// Two rows, with the middle columns `apart_m` apart and the others 0.02 m; and the vertex areas.
    fn strip(apart_m: f64) -> (Garment, Vec<f64>) {
        let columns = [-0.04, -0.02, 0.0, apart_m, 0.02 + apart_m, 0.04 + apart_m];
        let rest: Vec<V2> = [0.0, 0.02].iter().flat_map(|y| columns.map(|x| V2::new(x, *y))).collect();
        let n = columns.len();
        let squares = (0..n - 1).flat_map(|i| [[i, i + 1, i + 1 + n], [i, i + 1 + n, i + n]]);
        let garment = laboratory::garment((rest, squares.collect()));
        let mut areas = vec![0.0; garment.rest.len()];
        for t in &garment.triangles {
            let [a, b, c] = t.map(|v| garment.rest[v]);
            t.iter().for_each(|v| areas[*v] += (b - a).perp(&(c - a)) / 6.0);
        }
        (garment, areas)
    }

    fn greatest_n(garment: &Garment, areas: &[f64]) -> f64 {
        let x: Vec<V3> = garment.rest.iter().map(|p| V3::new(p.x, p.y, 0.0)).collect();
        let mut contact = ClothContact::new(ClothContactParams::default(), &garment.triangles, areas);
        contact.update(&x);
        let mut forces = vec![V3::zeros(); x.len()];
        contact.assemble(&x, &mut forces);
        forces.iter().map(V3::norm).fold(0.0, f64::max)
    }

    #[test]
    fn a_flat_cloth_does_not_push_itself_apart_where_an_edge_is_short() {
        let least_m = 2.0 * ClothContactParams::default().thickness_m;
        let check = |apart_m: f64| {
            let (garment, areas) = strip(apart_m);
            let vertex_of: Vec<usize> = (0..areas.len()).collect();
            let own = contact_areas(&garment, &vertex_of, &areas, least_m);
            assert_eq!(greatest_n(&garment, &own), 0.0, "columns {apart_m} m apart");
            (greatest_n(&garment, &areas), own == areas)
        };
        assert_eq!(check(0.02), (0.0, true), "nothing is short there");
        for apart_m in [1e-3, 5e-4, 1e-4] {
            assert!(check(apart_m).0 > 1e-3, "{apart_m} m: by the mesh's areas it does push");
        }
    }
}
