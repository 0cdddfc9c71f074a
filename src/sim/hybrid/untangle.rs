//! Untangling of flipped triangles: vertices are moved within the surface into the kernel of the triangles round them.

use std::collections::BTreeSet;

use geom::V3;

geom::constants! {
    "hybrid.untangle",
    const ROUNDS: usize = 120;
    /// Rounds after which one of Laplacian smoothing follows: a kernel may be empty.
    const SMOOTH_EVERY: usize = 4;
    const CORRECTIONS: usize = 20;
    /// Height of a triangle over its base from which on it counts as not flipped.
    const LEAST_HEIGHT: f64 = 0.1;
    /// Displacement over the violation of a constraint: a little over 1, so that rounding leaves no violation.
    const OVER: f64 = 1.01;
}

/// Turns flipped triangles of a sheet back; returns how many are left.
///
/// `outwards` are normals of the surface on which the vertices lie. Both harmonic maps are bijective, but only the
/// vertices of a piece are mapped. So a triangle may turn over where the surface bends, or where the corner of an
/// outline is wider on the body than in the pattern. Vertices are relaxed towards the half-planes of their kernel
/// [Motzkin & Schoenberg 1954]. Those of a seam move as one, so that no seam opens.
pub fn untangle(triangles: &[[usize; 3]], outwards: &[V3], x: &mut [V3]) -> usize {
    let mut around = vec![Vec::new(); x.len()];
    for (index, t) in triangles.iter().enumerate() {
        t.iter().for_each(|&v| around[v].push(index));
    }
    let sheet = Sheet { triangles, outwards, around };
    for round in 1..=ROUNDS {
        let moving: BTreeSet<usize> = sheet.flipped(x).flatten().copied().collect();
        if moving.is_empty() {
            return 0;
        }
        if round % SMOOTH_EVERY == 0 {
            let wider: BTreeSet<usize> = moving.iter().flat_map(|&v| sheet.neighbours(v)).collect();
            wider.into_iter().for_each(|v| x[v] = sheet.mean(v, x));
        } else {
            moving.into_iter().for_each(|v| x[v] = sheet.in_kernel(v, x));
        }
    }
    sheet.flipped(x).count()
}

/// Half-plane beyond the far side of a triangle, in which its vertex must lie.
struct Side {
    point: V3,
    /// Unit vector into the triangle.
    inwards: V3,
    /// Least height of the vertex over the side, m.
    least: f64,
}

struct Sheet<'a> {
    triangles: &'a [[usize; 3]],
    outwards: &'a [V3],
    around: Vec<Vec<usize>>,
}

impl Sheet<'_> {
    fn flipped<'s>(&'s self, x: &'s [V3]) -> impl Iterator<Item = &'s [usize; 3]> + 's {
        self.triangles.iter().filter(|t| {
            let [a, b, c] = t.map(|v| x[v]);
            let out: V3 = t.iter().map(|&v| self.outwards[v]).sum();
            (b - a).cross(&(c - a)).dot(&out) <= 0.0
        })
    }

    fn neighbours(&self, v: usize) -> impl Iterator<Item = usize> + '_ {
        self.around[v].iter().flat_map(|&t| self.triangles[t])
    }

    fn mean(&self, v: usize, x: &[V3]) -> V3 {
        let count = 3.0 * self.around[v].len() as f64;
        self.neighbours(v).map(|w| x[w]).sum::<V3>() / count
    }

    /// Place near a vertex from which it sees the far side of each of its triangles.
    fn in_kernel(&self, v: usize, x: &[V3]) -> V3 {
        let out = self.outwards[v].try_normalize(0.0).unwrap_or_else(V3::z);
        let sides: Vec<Side> = self.around[v]
            .iter()
            .filter_map(|&t| {
                let t = self.triangles[t];
                let k = t.iter().position(|&w| w == v)?;
                let (a, b) = (x[t[(k + 1) % 3]], x[t[(k + 2) % 3]]);
                let along = (b - a) - out * (b - a).dot(&out);
                let inwards = out.cross(&along).try_normalize(0.0)?;
                Some(Side { point: a, inwards, least: LEAST_HEIGHT * along.norm() })
            })
            .collect();
        let mut p = x[v];
        for _ in 0..CORRECTIONS {
            let lacks = |side: &Side| side.least - (p - side.point).dot(&side.inwards);
            let worst = sides.iter().max_by(|l, r| lacks(l).total_cmp(&lacks(r)));
            let Some((lack, inwards)) = worst.map(|side| (lacks(side), side.inwards)).filter(|(lack, _)| *lack > 0.0)
            else {
                break;
            };
            p += inwards * (OVER * lack);
        }
        p
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laboratory::sheets::sheet;

    #[test]
    fn a_vertex_pulled_across_its_neighbours_goes_back() {
        let (rest, triangles) = sheet(6, 6, 1.0);
        let mut x: Vec<V3> = rest.iter().map(|p| V3::new(p.x, p.y, 0.0)).collect();
        let outwards = vec![V3::z(); x.len()];
        assert_eq!(untangle(&triangles, &outwards, &mut x), 0);
        let inner = 3 * 7 + 3;
        x[inner] += V3::new(1.7, 0.4, 0.0);
        // A corner, which has one triangle only, too.
        x[0] += V3::new(1.6, 1.2, 0.0);
        let before = x.clone();
        assert_eq!(untangle(&triangles, &outwards, &mut x), 0);
        let moved = x.iter().zip(&before).filter(|(a, b)| a != b).count();
        assert!((2..12).contains(&moved), "{moved} vertices moved");
    }
}
