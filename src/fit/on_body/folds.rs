//! Folds and drag lines: lines along which cloth stands off the skin.
//!
//! A ridge is cloth that is off the skin and bent outwards more sharply than round the narrowest limb. The curvature at
//! a vertex is the mean of the curvatures of the adjacent triangles, from the normals of their corners [Rusinkiewicz
//! 2004]. Adjacent ridge vertices with similar directions form one fold.

use geom::{TriMesh, V3};
use nalgebra::{Matrix2, Matrix3, Vector3};

/// Radius of curvature below which cloth counts as folded, m: that of the narrowest limb that cloth lies on, the wrist.
const SHARP_M: f64 = 0.026;
/// Distance from the skin from which cloth counts as off it, m: well above that at which contact holds cloth.
const OFF_M: f64 = 0.005;
/// Least length of a fold, m: a few mesh edges.
const SHORTEST_M: f64 = 0.05;
/// Cosine of the greatest angle between the directions of neighbours in one fold: 30 degrees.
const TOGETHER: f64 = 0.866;
/// Tension along a fold from which the fold is a drag line, N/m: the weight of a metre of heavy cloth.
const DRAGGED_N_M: f64 = 5.0;

#[derive(Clone, Copy, Debug)]
pub struct Worn<'a> {
    /// Sewn cloth, counter-clockwise seen from outside.
    pub cloth: &'a TriMesh,
    pub gap_m: &'a [f64],
    /// Greater principal tension.
    pub tension_n_m: &'a [f64],
}

#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Fold {
    /// True for a drag line, whose cloth is under tension. False for a fold that hangs free.
    pub is_drag: bool,
    /// Extent of the vertices along their principal axis, m.
    pub length_m: f64,
    /// Angle of that axis from the vertical, radians, 0 to pi / 2.
    pub from_vertical_rad: f64,
    pub middle: V3,
    /// Radius of the mean curvature of the vertices, m.
    pub radius_m: f64,
    pub tension_n_m: f64,
}

/// Folds of a garment, the longest first.
pub fn folds(worn: &Worn<'_>) -> Vec<Fold> {
    let crests = crests(worn.cloth);
    let is_crest = |v: usize| crests[v].curvature * SHARP_M >= 1.0 && worn.gap_m[v] >= OFF_M;
    let mut sets = Sets((0..crests.len()).collect());
    for triangle in &worn.cloth.triangles {
        for (a, b) in [(0, 1), (1, 2), (2, 0)].map(|(a, b)| (triangle[a], triangle[b])) {
            if is_crest(a) && is_crest(b) && crests[a].along.dot(&crests[b].along).abs() >= TOGETHER {
                sets.join(a, b);
            }
        }
    }
    let mut members: Vec<(usize, usize)> =
        (0..crests.len()).filter(|v| is_crest(*v)).map(|v| (sets.root(v), v)).collect();
    members.sort_unstable();
    let groups = members.chunk_by(|vertex, next| vertex.0 == next.0);
    let mut found: Vec<Fold> = groups.filter_map(|group| fold(worn, &crests, group)).collect();
    found.sort_by(|a, b| b.length_m.total_cmp(&a.length_m));
    found
}

/// Fold of some vertices. `None` if they extend less than [`SHORTEST_M`].
fn fold(worn: &Worn<'_>, crests: &[Crest], group: &[(usize, usize)]) -> Option<Fold> {
    let count = group.len() as f64;
    let mean = |value: &dyn Fn(usize) -> f64| group.iter().map(|(_, v)| value(*v)).sum::<f64>() / count;
    let position = |v: usize| worn.cloth.positions[v];
    let middle = group.iter().map(|(_, v)| position(*v)).sum::<V3>() / count;
    let spread: Matrix3<f64> =
        group.iter().map(|(_, v)| (position(*v) - middle) * (position(*v) - middle).transpose()).sum();
    let eigen = spread.symmetric_eigen();
    let along: V3 = eigen.eigenvectors.column(eigen.eigenvalues.imax()).into();
    let reach = |way: V3| {
        let ends = group.iter().map(|(_, v)| (position(*v) - middle).dot(&way));
        let (low, high) = ends.fold((f64::MAX, f64::MIN), |(low, high), t| (low.min(t), high.max(t)));
        high - low
    };
    let length_m = reach(along);
    let tension_n_m = mean(&|v| worn.tension_n_m[v]);
    (length_m >= SHORTEST_M).then(|| Fold {
        is_drag: tension_n_m >= DRAGGED_N_M,
        length_m,
        from_vertical_rad: along.z.abs().min(1.0).acos(),
        middle,
        radius_m: 1.0 / mean(&|v| crests[v].curvature),
        tension_n_m,
    })
}

#[derive(Clone, Copy)]
struct Crest {
    /// Greater principal curvature, 1/m, positive for cloth that bends outwards.
    curvature: f64,
    /// Unit direction of the lesser principal curvature, which runs along a ridge.
    along: V3,
}

/// Principal curvature at each vertex, from the second fundamental forms of the adjacent triangles, weighted by area.
fn crests(cloth: &TriMesh) -> Vec<Crest> {
    let normals = cloth.vertex_normals();
    let mut sums = vec![(Matrix3::zeros(), 0.0); cloth.positions.len()];
    for triangle in &cloth.triangles {
        let corners = triangle.map(|v| cloth.positions[v]);
        let area = 0.5 * (corners[1] - corners[0]).cross(&(corners[2] - corners[0])).norm();
        let Some(shape) = shape(corners, triangle.map(|v| normals[v])) else { continue };
        for v in triangle {
            sums[*v].0 += shape * area;
            sums[*v].1 += area;
        }
    }
    let crest = |((sum, area), normal): ((Matrix3<f64>, f64), &V3)| {
        let flat = Crest { curvature: 0.0, along: V3::zeros() };
        let Some(u) = normal.cross(&V3::x()).try_normalize(0.1).or_else(|| normal.cross(&V3::y()).try_normalize(0.0))
        else {
            return flat;
        };
        let v = normal.cross(&u);
        let shape = sum / f64::max(area, f64::MIN_POSITIVE);
        let in_plane = Matrix2::new(u.dot(&(shape * u)), u.dot(&(shape * v)), v.dot(&(shape * u)), v.dot(&(shape * v)));
        let eigen = (0.5 * (in_plane + in_plane.transpose())).symmetric_eigen();
        let most = eigen.eigenvalues.imax();
        let least = eigen.eigenvectors.column(1 - most);
        Crest { curvature: eigen.eigenvalues[most], along: u * least[0] + v * least[1] }
    };
    sums.into_iter().zip(&normals).map(crest).collect()
}

/// Second fundamental form of a triangle as a 3x3 tensor, by least squares from the change of normals along the edges.
/// `None` for a degenerate triangle.
fn shape(corners: [V3; 3], normals: [V3; 3]) -> Option<Matrix3<f64>> {
    let u = (corners[1] - corners[0]).try_normalize(1e-12)?;
    let v = u.cross(&(corners[2] - corners[0])).try_normalize(1e-12)?.cross(&u);
    let (mut normal_matrix, mut right) = (Matrix3::zeros(), Vector3::zeros());
    for (from, to) in [(0, 1), (1, 2), (2, 0)] {
        let (edge, turn) = (corners[to] - corners[from], normals[to] - normals[from]);
        let (eu, ev) = (edge.dot(&u), edge.dot(&v));
        for (row, value) in [(Vector3::new(eu, ev, 0.0), turn.dot(&u)), (Vector3::new(0.0, eu, ev), turn.dot(&v))] {
            normal_matrix += row * row.transpose();
            right += row * value;
        }
    }
    let form = normal_matrix.try_inverse()? * right;
    Some(u * u.transpose() * form[0] + (u * v.transpose() + v * u.transpose()) * form[1] + v * v.transpose() * form[2])
}

/// Disjoint sets of vertices (union-find).
struct Sets(Vec<usize>);

impl Sets {
    fn root(&mut self, mut v: usize) -> usize {
        while self.0[v] != v {
            self.0[v] = self.0[self.0[v]];
            v = self.0[v];
        }
        v
    }

    /// Merges two sets. The root of a set is its least vertex, whatever the order of merging.
    fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        self.0[a.max(b)] = a.min(b);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const EDGE_M: f64 = 0.01;

    /// A sheet in front of the body, 0.6 m square, displaced to the front by `height`.
    fn sheet(height: impl Fn(f64, f64) -> f64) -> TriMesh {
        let side = 61;
        let coordinates = |k: usize| (EDGE_M * (k % side) as f64 - 0.3, EDGE_M * (k / side) as f64);
        let positions = (0..side * side).map(coordinates).map(|(x, z)| V3::new(-x, height(x, z), z)).collect();
        let quad = |k: usize| [[k, k + 1, k + side + 1], [k, k + side + 1, k + side]];
        let triangles = (0..side * (side - 1)).filter(|k| k % side + 1 < side).flat_map(quad).collect();
        TriMesh { positions, triangles }
    }

    fn found(cloth: &TriMesh, gap_m: f64, tension_n_m: f64) -> Vec<Fold> {
        let count = cloth.positions.len();
        folds(&Worn { cloth, gap_m: &vec![gap_m; count], tension_n_m: &vec![tension_n_m; count] })
    }

    /// A ridge with a radius at its crest, along a line at an angle from the vertical, 0.3 m long.
    fn ridge(radius: f64, angle: f64) -> impl Fn(f64, f64) -> f64 {
        move |x, z| {
            let (sin, cos) = angle.sin_cos();
            let (across, along) = (x * cos - (z - 0.3) * sin, x * sin + (z - 0.3) * cos);
            let width = 0.02_f64;
            let end = 1.0 / (1.0 + ((along.abs() - 0.15) / 0.004).exp());
            end * width * width / radius * (-0.5 * (across / width).powi(2)).exp()
        }
    }

    #[test]
    fn a_ridge_has_its_length_its_direction_and_its_radius() {
        let check = |radius: f64, angle_deg: f64| {
            let found = found(&sheet(ridge(radius, angle_deg.to_radians())), 0.02, 1.0);
            assert_eq!(found.len(), 1, "{found:#?}");
            let Fold { length_m, from_vertical_rad, radius_m, is_drag, middle, .. } = found[0];
            assert!((length_m - 0.3).abs() < 0.05, "{length_m}");
            assert!((from_vertical_rad.to_degrees() - angle_deg).abs() < 4.0, "{}", from_vertical_rad.to_degrees());
            assert!(radius_m > radius * 0.8 && radius_m < SHARP_M, "{radius_m}");
            assert!(!is_drag && (middle.z - 0.3).abs() < 0.01, "{middle:?}");
        };
        check(0.012, 0.0);
        check(0.012, 90.0);
        check(0.015, 45.0);
    }

    #[test]
    fn what_lies_on_the_skin_bends_gently_or_is_hollow_is_no_fold() {
        assert!(found(&sheet(ridge(0.012, 0.0)), 0.002, 0.0).is_empty(), "on the skin");
        assert!(found(&sheet(ridge(0.06, 0.0)), 0.02, 0.0).is_empty(), "gently bent");
        assert!(found(&sheet(|_, _| 0.0), 0.02, 0.0).is_empty(), "flat");
    }

    #[test]
    fn a_fold_under_tension_is_a_drag_line() {
        assert!(found(&sheet(ridge(0.012, 0.5)), 0.02, 20.0)[0].is_drag);
    }

    #[test]
    fn a_cylinder_bends_by_its_radius_along_its_axis() {
        let radius = 0.08;
        let cloth = sheet(|x, _| (radius * radius - x * x).max(0.0).sqrt());
        for (crest, p) in crests(&cloth).iter().zip(&cloth.positions) {
            if p.x.abs() < 0.04 && (0.05..0.55).contains(&p.z) {
                assert!((crest.curvature * radius - 1.0).abs() < 0.02, "{}", crest.curvature);
                assert!(crest.along.z.abs() > 0.999, "{:?}", crest.along);
            }
        }
    }
}
