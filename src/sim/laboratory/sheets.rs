//! Flat meshes for specimens.

use geom::{V2, V3};

/// Vertices, and counter-clockwise triangles.
pub type Flat = (Vec<V2>, Vec<[usize; 3]>);

/// Squares of side `step`, cut along either diagonal alternately.
pub fn sheet(columns: usize, rows: usize, step: f64) -> Flat {
    let vertex = |i: usize, j: usize| j * (columns + 1) + i;
    let rest = (0..=rows).flat_map(|j| (0..=columns).map(move |i| V2::new(i as f64 * step, j as f64 * step))).collect();
    let mut triangles = Vec::new();
    for j in 0..rows {
        for i in 0..columns {
            let [a, b, c, d] = [vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)];
            if (i + j) % 2 == 0 {
                triangles.extend([[a, b, c], [a, c, d]]);
            } else {
                triangles.extend([[a, b, d], [b, c, d]]);
            }
        }
    }
    (rest, triangles)
}

/// Nearly equilateral triangles, as from a mesher: `rows` strips of height `step sqrt(3)/2`, with every other row of
/// vertices shifted by half a step, and both sides straight.
pub fn hexagonal_sheet(columns: usize, rows: usize, step: f64) -> Flat {
    let width = columns as f64 * step;
    let mut rest = Vec::new();
    let mut starts = Vec::new();
    for j in 0..=rows {
        starts.push(rest.len());
        let y = j as f64 * step * 0.75_f64.sqrt();
        if j % 2 == 0 {
            rest.extend((0..=columns).map(|i| V2::new(i as f64 * step, y)));
        } else {
            rest.push(V2::new(0.0, y));
            rest.extend((0..columns).map(|i| V2::new((i as f64 + 0.5) * step, y)));
            rest.push(V2::new(width, y));
        }
    }
    starts.push(rest.len());
    let mut triangles = Vec::new();
    for j in 0..rows {
        let (mut low, mut high) = (starts[j], starts[j + 1]);
        while low + 1 < starts[j + 1] || high + 1 < starts[j + 2] {
            // Advance on the row whose next vertex comes first.
            let next = |v: usize, end: usize| if v + 1 < end { rest[v + 1].x } else { f64::MAX };
            if next(low, starts[j + 1]) <= next(high, starts[j + 2]) {
                triangles.push([low, low + 1, high]);
                low += 1;
            } else {
                triangles.push([low, high + 1, high]);
                high += 1;
            }
        }
    }
    (rest, triangles)
}

/// Rings `radius / rings` wide each, with `6 k` vertices on ring `k`.
pub fn disc(rings: usize, radius: f64) -> Flat {
    let on_ring = |k: usize| 6 * k.max(1);
    let first = |k: usize| if k == 0 { 0 } else { 1 + 3 * k * (k - 1) };
    let mut rest = vec![V2::zeros()];
    for k in 1..=rings {
        let angle = |i: usize| std::f64::consts::TAU * i as f64 / on_ring(k) as f64;
        let r = radius * k as f64 / rings as f64;
        rest.extend((0..on_ring(k)).map(|i| V2::new(angle(i).cos(), angle(i).sin()) * r));
    }
    let mut triangles: Vec<[usize; 3]> = (0..6).map(|i| [0, 1 + i, 1 + (i + 1) % 6]).collect();
    for k in 1..rings {
        let (inner, outer) = (on_ring(k), on_ring(k + 1));
        let (mut i, mut o) = (0, 0);
        while i < inner || o < outer {
            let (a, b) = (first(k) + i % inner, first(k + 1) + o % outer);
            // Advance on the ring whose next vertex comes first. The angles are compared by cross-multiplication, so
            // that ties are exact.
            if o < outer && (i >= inner || (o + 1) * inner <= (i + 1) * outer) {
                triangles.push([a, b, first(k + 1) + (o + 1) % outer]);
                o += 1;
            } else {
                triangles.push([a, b, first(k) + (i + 1) % inner]);
                i += 1;
            }
        }
    }
    (rest, triangles)
}

/// Displaces vertices at random in the plane. Inner ones move by up to `size` along each axis, those on a side only
/// along it, and those that `is_fixed` selects not at all.
pub fn jittered((mut rest, triangles): Flat, size: f64, is_fixed: impl Fn(&V2) -> bool) -> Flat {
    let (low, high) = rest.iter().fold((rest[0], rest[0]), |(low, high), p| (low.inf(p), high.sup(p)));
    let shift = noise(2 * rest.len(), 11);
    for (i, p) in rest.iter_mut().enumerate() {
        let on_side = |k: usize| (p[k] - low[k]).abs() < 1e-9 || (p[k] - high[k]).abs() < 1e-9;
        let sides = [on_side(0), on_side(1)];
        if !is_fixed(p) {
            for k in (0..2).filter(|&k| !sides[k]) {
                p[k] += size * shift[2 * i + k];
            }
        }
    }
    (rest, triangles)
}

/// Reproducible numbers in -1..1 (a linear congruential generator).
pub fn noise(count: usize, seed: u64) -> Vec<f64> {
    let mut state = seed;
    (0..count)
        .map(|_| {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        })
        .collect()
}

pub fn shaken(positions: &[V3], size: f64, seed: u64) -> Vec<V3> {
    let noise = noise(3 * positions.len(), seed);
    positions.iter().enumerate().map(|(i, p)| p + V3::from_row_slice(&noise[3 * i..3 * i + 3]) * size).collect()
}
