//! Depth-buffer unsharp masking [Luft 2006]: what lies behind its surroundings darkens, what stands out lightens, so
//! that folds and overlaps read even in flat light.

/// Light gain of each pixel, around 1. `depth` in metres, infinite where there is nothing; `per_m` pixels a metre.
pub(super) fn relief(depth: &[f32], width: usize, per_m: f32) -> Vec<f32> {
    let mut gain = vec![1.0_f32; depth.len()];
    // (radius of the surroundings, depth that counts as much, strength), metres.
    for (radius_m, full_m, strength) in [(0.008, 0.004, 0.24), (0.030, 0.018, 0.32)] {
        let radius = ((radius_m * per_m).round() as usize).clamp(2, width / 2 + 2);
        let surroundings = mean_around(depth, width, radius);
        for ((g, &d), &mean) in gain.iter_mut().zip(depth).zip(&surroundings) {
            if d.is_finite() {
                let stands_out = ((mean - d) / full_m).clamp(-1.0, 1.0);
                *g *= 1.0 + strength * if stands_out < 0.0 { stands_out } else { 0.5 * stands_out };
            }
        }
    }
    gain
}

/// Mean of the finite values in a square around each pixel.
fn mean_around(values: &[f32], width: usize, radius: usize) -> Vec<f32> {
    let height = values.len() / width.max(1);
    // (sum, count) of rows, then of columns.
    let pairs: Vec<[f32; 2]> = values.iter().map(|&v| if v.is_finite() { [v, 1.0] } else { [0.0, 0.0] }).collect();
    let mut rows = vec![[0.0; 2]; values.len()];
    for y in 0..height {
        sliding(width, radius, |x| pairs[y * width + x], |x, sum| rows[y * width + x] = sum);
    }
    let mut square = vec![[0.0; 2]; values.len()];
    for y in 0..height {
        let (low, high) = (y.saturating_sub(radius), (y + radius).min(height - 1));
        if y == 0 {
            for row in low..=high {
                add_row(&mut square, 0, &rows[row * width..][..width], 1.0);
            }
        } else {
            square.copy_within((y - 1) * width..y * width, y * width);
            if y + radius < height {
                add_row(&mut square, y * width, &rows[high * width..][..width], 1.0);
            }
            if y > radius {
                add_row(&mut square, y * width, &rows[(low - 1) * width..][..width], -1.0);
            }
        }
    }
    square.iter().map(|&[sum, count]| if count > 0.5 { sum / count } else { 0.0 }).collect()
}

fn add_row(to: &mut [[f32; 2]], start: usize, row: &[[f32; 2]], sign: f32) {
    for (t, r) in to[start..start + row.len()].iter_mut().zip(row) {
        t[0] += sign * r[0];
        t[1] += sign * r[1];
    }
}

/// Sums over the `2 radius + 1` places around each of `n`.
fn sliding(n: usize, radius: usize, at: impl Fn(usize) -> [f32; 2], mut put: impl FnMut(usize, [f32; 2])) {
    let mut sum = [0.0_f32; 2];
    let change = |sum: &mut [f32; 2], i: usize, sign: f32| {
        let v = at(i);
        sum[0] += sign * v[0];
        sum[1] += sign * v[1];
    };
    for i in 0..radius.min(n) {
        change(&mut sum, i, 1.0);
    }
    for i in 0..n {
        if i + radius < n {
            change(&mut sum, i + radius, 1.0);
        }
        put(i, sum);
        if i >= radius {
            change(&mut sum, i - radius, -1.0);
        }
    }
}
