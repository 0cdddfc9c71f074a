//! Triangulation of an outline into near-equilateral triangles.
//!
//! The points of a hexagonal grid inside the outline and the vertices on the outline are triangulated by constrained
//! Delaunay triangulation (spade). Then each inner point moves to the area-weighted mean of the centroids of its
//! triangles, and all points are triangulated again, for a few rounds. The outline never gets a new vertex, so seam
//! partners stay matched.

use spade::handles::FixedFaceHandle;
use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation as _};

use geom::V2;
use geom::polyline::{boundary_distance, contains, self_crossing, signed_area};
use geom::triangle::sorted;

const SMOOTHING_ROUNDS: usize = 12;
/// Least distance of the grid points from the outline, in edge lengths.
const SEED_CLEARANCE: f64 = 0.62;
/// Least distance of smoothed points from the outline, in edge lengths.
const MOVED_CLEARANCE: f64 = 0.4;
/// Greatest relative difference between the area of the triangles and that of the outline.
const AREA_TOLERANCE: f64 = 1e-9;

#[derive(Clone, Debug, PartialEq)]
pub struct Triangulation {
    /// Points, m: those of the outline first, in its order.
    pub points: Vec<V2>,
    /// Indices of points, counter-clockwise.
    pub triangles: Vec<[usize; 3]>,
}

/// Triangulates a counter-clockwise polygon with edges of length about `h`.
pub fn triangulate(outline: &[V2], h: f64) -> Result<Triangulation, String> {
    if let Some(place) = self_crossing(outline) {
        return Err(format!("its sampled outline crosses itself at ({:.1}, {:.1}) mm", place.x * 1e3, place.y * 1e3));
    }
    let area = signed_area(outline);
    let mut points = outline.to_vec();
    points.extend(hexagonal_seed(outline, h));
    let mut triangles = delaunay(&points, outline.len())?;
    for _ in 0..SMOOTHING_ROUNDS {
        let moved = smoothed(&points, &triangles, outline, h);
        triangles = delaunay(&moved, outline.len())?;
        points = moved;
    }
    let covered: f64 = triangles.iter().map(|t| signed_area(&t.map(|v| points[v]))).sum();
    if (covered - area).abs() > AREA_TOLERANCE * area {
        return Err(format!("its triangles cover {covered:.6} m2 of {area:.6} m2"));
    }
    // Vertices are numbered row by row. Triangles in the order of their greatest vertex are read in the order of
    // memory.
    triangles.sort_unstable_by_key(|triangle| {
        let [first, second, last] = sorted(*triangle);
        [last, second, first]
    });
    Ok(Triangulation { points, triangles })
}

/// Hexagonal grid well inside a polygon, in rows along `u` from its lowest point.
fn hexagonal_seed(outline: &[V2], h: f64) -> Vec<V2> {
    let first = outline[0];
    let (low, high) = outline.iter().fold((first, first), |(low, high), p| (low.inf(p), high.sup(p)));
    let row_height = h * 0.75_f64.sqrt();
    // The grid is symmetric about the middle, so that a symmetric piece gets a symmetric grid.
    let middle = 0.5 * (low.x + high.x);
    let half_count = ((high.x - middle) / h).ceil() as i64 + 1;
    let rows = ((high.y - low.y) / row_height).ceil() as i64;
    let mut seeds = Vec::new();
    for row in 1..=rows {
        let shift = if row % 2 == 0 { 0.0 } else { 0.5 };
        for column in -half_count..=half_count {
            let point = V2::new(middle + h * (column as f64 + shift), low.y + row_height * row as f64);
            if contains(outline, &point) && boundary_distance(outline, &point) > SEED_CLEARANCE * h {
                seeds.push(point);
            }
        }
    }
    seeds
}

/// Moves inner points to the area-weighted mean of the centroids of their triangles.
fn smoothed(points: &[V2], triangles: &[[usize; 3]], outline: &[V2], h: f64) -> Vec<V2> {
    let mut sums = vec![(V2::zeros(), 0.0); points.len()];
    for &triangle in triangles {
        let corners = triangle.map(|vertex| points[vertex]);
        let area = signed_area(&corners);
        let centroid = (corners[0] + corners[1] + corners[2]) / 3.0;
        for vertex in triangle {
            sums[vertex].0 += centroid * area;
            sums[vertex].1 += area;
        }
    }
    let is_free = |vertex: usize, goal: &V2| {
        vertex >= outline.len() && contains(outline, goal) && boundary_distance(outline, goal) > MOVED_CLEARANCE * h
    };
    let moved = |(vertex, point): (usize, &V2)| {
        let (sum, area) = sums[vertex];
        let goal = sum / area;
        if area > 0.0 && is_free(vertex, &goal) { goal } else { *point }
    };
    points.iter().enumerate().map(moved).collect()
}

/// Constrained Delaunay triangles inside the closed polygon of the first `outline_len` points.
fn delaunay(points: &[V2], outline_len: usize) -> Result<Vec<[usize; 3]>, String> {
    let vertices: Vec<Point2<f64>> = points.iter().map(|p| Point2::new(p.x, p.y)).collect();
    let sides: Vec<[usize; 2]> = (0..outline_len).map(|i| [i, (i + 1) % outline_len]).collect();
    let mut conflicts = 0;
    let cdt =
        ConstrainedDelaunayTriangulation::<Point2<f64>>::try_bulk_load_cdt(vertices, sides.clone(), |_| conflicts += 1)
            .map_err(|error| format!("it cannot be triangulated: {error:?}"))?;
    if conflicts > 0 || cdt.num_vertices() != points.len() {
        return Err("two of its sampled sides cross or two vertices coincide".to_owned());
    }
    // A flood fill of faces from the left of each side of the outline, without crossing a side, finds the faces inside.
    let handles: Vec<_> = cdt.fixed_vertices().collect();
    let mut is_inside = vec![false; cdt.num_all_faces()];
    let mut front: Vec<FixedFaceHandle<spade::handles::PossiblyOuterTag>> = Vec::new();
    for [from, to] in sides {
        let side = cdt
            .get_edge_from_neighbors(handles[from], handles[to])
            .ok_or("a sampled side is missing from its triangles")?;
        front.push(side.face().fix());
    }
    while let Some(face) = front.pop() {
        let Some(inner) = cdt.face(face).as_inner() else { return Err("its triangles leak out".to_owned()) };
        if std::mem::replace(&mut is_inside[face.index()], true) {
            continue;
        }
        let across = inner.adjacent_edges().into_iter().filter(|edge| !edge.is_constraint_edge());
        front.extend(across.map(|edge| edge.rev().face().fix()));
    }
    let inside = cdt.inner_faces().filter(|face| is_inside[face.index()]);
    Ok(inside.map(|face| face.vertices().map(|vertex| vertex.index())).collect())
}

/// Least angle of a triangle, radians.
pub fn min_angle(corners: [V2; 3]) -> f64 {
    let angle = |k: usize| (corners[(k + 1) % 3] - corners[k]).angle(&(corners[(k + 2) % 3] - corners[k]));
    angle(0).min(angle(1)).min(angle(2))
}
