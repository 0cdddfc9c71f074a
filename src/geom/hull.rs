//! Convex hulls of plane point sets. A taut tape measure follows one.

use super::V2;

/// Andrew's monotone chain. Counter-clockwise, without collinear points. Returns fewer than three distinct points as
/// they are.
pub fn convex_hull(points: &[V2]) -> Vec<V2> {
    let mut sorted = points.to_vec();
    sorted.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    sorted.dedup();
    if sorted.len() < 3 {
        return sorted;
    }
    let mut lower = half_hull(sorted.iter());
    let mut upper = half_hull(sorted.iter().rev());
    lower.pop();
    upper.pop();
    lower.append(&mut upper);
    lower
}

fn half_hull<'a>(points: impl Iterator<Item = &'a V2>) -> Vec<V2> {
    let mut chain: Vec<V2> = Vec::new();
    for &point in points {
        while chain.len() >= 2 {
            let (a, b) = (chain[chain.len() - 2], chain[chain.len() - 1]);
            if (b - a).perp(&(point - a)) > 0.0 {
                break;
            }
            chain.pop();
        }
        chain.push(point);
    }
    chain
}

pub fn perimeter(points: &[V2]) -> f64 {
    let next = points.iter().cycle().skip(1);
    points.iter().zip(next).map(|(a, b)| (b - a).norm()).sum()
}

/// Girth as a taut tape measures it: the perimeter of the convex hull.
pub fn tape_girth(points: &[V2]) -> f64 {
    perimeter(&convex_hull(points))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_dented_square_is_spanned() {
        let corners = [(0.0, 0.0), (1.0, 0.0), (0.5, 0.5), (1.0, 1.0), (0.5, 1.0), (0.0, 1.0)];
        let points: Vec<V2> = corners.iter().map(|&(x, y)| V2::new(x, y)).collect();
        let hull = convex_hull(&points);
        assert_eq!(hull.len(), 4);
        assert!((tape_girth(&points) - 4.0).abs() < 1e-12);
    }

    #[test]
    fn degenerate_sets_do_not_fail() {
        let check = |points: &[V2], girth: f64| assert!((tape_girth(points) - girth).abs() < 1e-12);
        check(&[], 0.0);
        check(&[V2::new(1.0, 1.0)], 0.0);
        check(&[V2::new(0.0, 0.0), V2::new(3.0, 4.0), V2::new(3.0, 4.0)], 10.0);
        check(&[V2::new(0.0, 0.0), V2::new(1.0, 0.0), V2::new(2.0, 0.0)], 4.0);
    }
}
