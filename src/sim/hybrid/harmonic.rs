//! Discrete harmonic maps of a disc onto a convex domain (5.2.3). They are bijective, because all weights are positive
//! and the boundary of the domain is strictly convex [Floater 2003].

use std::collections::BTreeMap;

use super::sparse::Factor;
use geom::{V2, V3};

/// Maps a triangulated disc into the plane. Boundary vertices lie where `fixed` says (Dirichlet condition), every other
/// one at the weighted mean of its neighbours, `sum_j w_ij (u_i - u_j) = 0`.
///
/// Weights are those of the cotangent Laplacian, `w_ij = (cot a + cot b) / 2`. One that is not positive is replaced by
/// the mean of the edge's two mean value weights, which is positive. `None` if a vertex is connected to no boundary, or
/// if two vertices coincide.
pub fn map(positions: &[V3], triangles: &[[usize; 3]], fixed: &BTreeMap<usize, V2>) -> Option<Vec<V2>> {
    let mut row = vec![usize::MAX; positions.len()];
    let free: Vec<usize> = (0..positions.len()).filter(|v| !fixed.contains_key(v)).collect();
    for (i, &v) in free.iter().enumerate() {
        row[v] = i;
    }
    let n = free.len();
    let mut entries = Vec::new();
    let mut rhs = vec![0.0; 2 * n];
    for ([a, b], weight) in weights(positions, triangles) {
        for (v, w) in [(a, b), (b, a)] {
            let i = row[v];
            if i == usize::MAX {
                continue;
            }
            entries.push((i, i, weight));
            match fixed.get(&w) {
                Some(u) => {
                    rhs[i] += weight * u.x;
                    rhs[n + i] += weight * u.y;
                }
                None => entries.push((i, row[w], -weight)),
            }
        }
    }
    if n > 0 {
        Factor::new(n, &entries)?.solve(&mut rhs);
    }
    let place = |v: usize| match fixed.get(&v) {
        Some(u) => *u,
        None => V2::new(rhs[row[v]], rhs[n + row[v]]),
    };
    let mapped: Vec<V2> = (0..positions.len()).map(place).collect();
    mapped.iter().all(|u| u.iter().all(|c| c.is_finite())).then_some(mapped)
}

fn weights(positions: &[V3], triangles: &[[usize; 3]]) -> BTreeMap<[usize; 2], f64> {
    // Cotangent sum and mean value sum of each edge.
    let mut sums: BTreeMap<[usize; 2], [f64; 2]> = BTreeMap::new();
    for t in triangles {
        for k in 0..3 {
            let [i, j, o] = [t[k], t[(k + 1) % 3], t[(k + 2) % 3]];
            let (u, v) = (positions[i] - positions[o], positions[j] - positions[o]);
            let cot = u.dot(&v) / u.cross(&v).norm();
            let along = positions[j] - positions[i];
            let half = |p: V3, q: V3| 0.5 * p.angle(&q);
            // Without the factor 1 / length a mean value weight has no unit, like a cotangent.
            let mean_value = 0.25 * (half(along, -u).tan() + half(-along, -v).tan());
            let sum = sums.entry([i.min(j), i.max(j)]).or_default();
            sum[0] += 0.5 * cot;
            sum[1] += mean_value;
        }
    }
    sums.into_iter().map(|(edge, [cot, mean_value])| (edge, if cot > 0.0 { cot } else { mean_value })).collect()
}

pub fn flips(mapped: &[V2], triangles: &[[usize; 3]]) -> usize {
    let area = |t: &&[usize; 3]| (mapped[t[1]] - mapped[t[0]]).perp(&(mapped[t[2]] - mapped[t[0]]));
    triangles.iter().filter(|t| area(t) <= 0.0).count()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laboratory::sheets::sheet;

    fn lifted(rest: &[V2]) -> Vec<V3> {
        rest.iter().map(|p| V3::new(p.x, p.y, 0.0)).collect()
    }

    #[test]
    fn a_square_is_mapped_onto_itself_exactly() {
        let (rest, triangles) = sheet(8, 8, 0.125);
        let on_edge = |p: &V2| [0.0, 1.0].contains(&p.x) || [0.0, 1.0].contains(&p.y);
        let fixed = rest.iter().enumerate().filter(|(_, p)| on_edge(p)).map(|(v, p)| (v, *p)).collect();
        let mapped = map(&lifted(&rest), &triangles, &fixed).expect("a disc");
        for (found, expected) in mapped.iter().zip(&rest) {
            assert!((found - expected).norm() < 1e-12, "{found:?}, not {expected:?}");
        }
    }

    fn concave() -> (Vec<V2>, Vec<[usize; 3]>, Vec<usize>) {
        let (rest, triangles) = sheet(12, 12, 1.0);
        let kept: Vec<[usize; 3]> = triangles
            .into_iter()
            .filter(|t| {
                let middle = t.iter().map(|&v| rest[v]).sum::<V2>() / 3.0;
                middle.x < 6.0 || middle.y < 6.0
            })
            .collect();
        let used: Vec<usize> = (0..rest.len()).filter(|v| kept.iter().any(|t| t.contains(v))).collect();
        let number = |v: usize| used.binary_search(&v).expect("used");
        let points: Vec<V2> = used.iter().map(|&v| rest[v]).collect();
        let corners = [[0, 0], [12, 0], [12, 6], [6, 6], [6, 12], [0, 12], [0, 0]];
        let mut boundary = Vec::new();
        for ends in corners.windows(2) {
            let [from, to] = [ends[0], ends[1]];
            let length = i32::abs(to[0] - from[0] + to[1] - from[1]);
            for k in 0..length {
                let step = |axis: usize| from[axis] + (to[axis] - from[axis]) * k / length;
                boundary.push(number((step(1) * 13 + step(0)) as usize));
            }
        }
        (points, kept.iter().map(|t| t.map(number)).collect(), boundary)
    }

    #[test]
    fn a_concave_outline_is_mapped_onto_a_disc_without_a_flip() {
        let (rest, triangles, boundary) = concave();
        let on_circle = |k: usize| {
            let (sin, cos) = (k as f64 / boundary.len() as f64 * std::f64::consts::TAU).sin_cos();
            V2::new(cos, sin)
        };
        let fixed = boundary.iter().enumerate().map(|(k, &v)| (v, on_circle(k))).collect();
        let mapped = map(&lifted(&rest), &triangles, &fixed).expect("a disc");
        assert_eq!(flips(&mapped, &triangles), 0);
        assert!(mapped.iter().all(|u| u.norm() <= 1.0 + 1e-12));
        let mirrored: Vec<V2> = mapped.iter().map(|u| V2::new(-u.x, u.y)).collect();
        assert_eq!(flips(&mirrored, &triangles), triangles.len(), "a flip is seen");
    }
}
