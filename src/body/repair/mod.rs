//! Repair of a scan: noise is smoothed and holes are closed, so that it can be measured.

pub mod clean;
pub mod feet;
mod manifold;

use crate::BodyError;
use feet::Feet;
use geom::{TriMesh, V3};
use nalgebra::{DMatrix, DVector};

/// Steps of Taubin's low-pass filter, inwards and outwards, and number of passes [Taubin 1995]. The outward step is the
/// greater one, to keep the volume. Judgement.
const SMOOTHING: [f64; 2] = [0.5, -0.53];
const PASSES: usize = 12;

/// Roughness / mean edge length above which a mesh is smoothed. The facets of a smooth mesh alone give less.
const ROUGH: f64 = 0.022;

/// Length of the rim of a hole from which the hole stays open, m: half a body or a missing limb.
const LONGEST_HOLE: f64 = 0.9;

/// Height below which a rim belongs to a sole, and greatest depth of its patch below the rim, m: a sole is flat.
const SOLE_HEIGHT: f64 = 0.03;
const SOLE_DEPTH: f64 = 0.007;

/// Greatest number of times that holes are sought and closed: a closed hole may leave others.
const MENDED: usize = 3;

/// Greatest number of vertices of a patch that is faired. The solve is dense, so larger patches stay flat.
const LARGEST_PATCH: usize = 900;

/// Makes a mesh an orientable manifold, smooths it if it is rough, and closes its holes. Returns the feet it has.
pub(super) fn repair(mesh: &mut TriMesh, notes: &mut Vec<String>) -> Result<Feet, BodyError> {
    let dropped = manifold::make_manifold(mesh);
    if dropped > 0 {
        notes.push(format!("{dropped} doubled, branching or twisted triangles were left out"));
    }
    let rough = roughness(mesh);
    if rough > ROUGH * mean_edge(mesh) {
        smooth(mesh);
        notes.push(format!("smoothed: its surface is rough by {:.2} mm", rough * 1e3));
    }
    let feet = Feet::of(mesh, &rims(mesh));
    notes.extend(feet.note());
    let mut holes = close_holes(mesh);
    for _ in 0..MENDED {
        if mesh.is_closed_manifold() {
            break;
        }
        // A rim that touches itself leaves parts of its hole, and patches that share an edge.
        manifold::make_manifold(mesh);
        *mesh = clean::keep_body(mesh, &mut Vec::new());
        holes += close_holes(mesh);
    }
    if holes > 0 {
        notes.push(format!("{holes} holes closed"));
    }
    let longest = rims(mesh).iter().map(|rim| length(mesh, rim)).fold(0.0, f64::max);
    if longest >= LONGEST_HOLE {
        return Err(BodyError::Open { problem: format!("a hole is {longest:.2} m round (half a body?)") });
    }
    Ok(feet)
}

fn length(mesh: &TriMesh, rim: &[usize]) -> f64 {
    let next = rim.iter().cycle().skip(1);
    rim.iter().zip(next).map(|(&a, &b)| (mesh.positions[b] - mesh.positions[a]).norm()).sum()
}

fn mean_edge(mesh: &TriMesh) -> f64 {
    let edges = mesh.edges();
    edges.iter().map(|&[a, b]| (mesh.positions[a] - mesh.positions[b]).norm()).sum::<f64>() / edges.len().max(1) as f64
}

/// Neighbours of every vertex, sorted.
fn neighbours(mesh: &TriMesh) -> Vec<Vec<usize>> {
    let mut around = vec![Vec::with_capacity(6); mesh.positions.len()];
    for [a, b] in mesh.edges() {
        around[a].push(b);
        around[b].push(a);
    }
    around
}

/// Vector from the value of a vertex to the mean of its neighbours (umbrella operator).
fn to_mean(values: &[V3], around: &[usize], vertex: usize) -> V3 {
    if around.is_empty() {
        return V3::zeros();
    }
    around.iter().map(|&i| values[i]).sum::<V3>() / around.len() as f64 - values[vertex]
}

/// Noise of a scan, m: median of half the normal component of the second umbrella over all vertices.
fn roughness(mesh: &TriMesh) -> f64 {
    let around = neighbours(mesh);
    let normals = mesh.vertex_normals();
    let bends: Vec<V3> = (0..mesh.positions.len())
        .map(|i| normals[i] * to_mean(&mesh.positions, &around[i], i).dot(&normals[i]))
        .collect();
    let mut off: Vec<f64> =
        (0..bends.len()).map(|i| (to_mean(&bends, &around[i], i).dot(&normals[i]) / 2.0).abs()).collect();
    off.sort_by(f64::total_cmp);
    off.get(off.len() / 2).copied().unwrap_or(0.0)
}

/// Taubin's low-pass filter of the vertex positions, which keeps the volume. Rims of holes stay in place.
fn smooth(mesh: &mut TriMesh) {
    let around = neighbours(mesh);
    let mut free = vec![true; mesh.positions.len()];
    for [a, b] in rim_edges(mesh) {
        free[a] = false;
        free[b] = false;
    }
    for step in SMOOTHING.into_iter().cycle().take(2 * PASSES) {
        let moves: Vec<V3> = (0..free.len()).map(|i| to_mean(&mesh.positions, &around[i], i)).collect();
        for i in (0..free.len()).filter(|&i| free[i]) {
            mesh.positions[i] += moves[i] * step;
        }
    }
}

/// Directed edges without an opposite edge, sorted.
fn rim_edges(mesh: &TriMesh) -> Vec<[usize; 2]> {
    let mut edges: Vec<[usize; 2]> = mesh.triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]).collect();
    edges.sort_unstable();
    let open = |&[a, b]: &[usize; 2]| edges.binary_search(&[b, a]).is_err();
    edges.iter().filter(|edge| open(edge)).copied().collect()
}

/// Closed rims of holes, in the direction in which a patch is oriented.
fn rims(mesh: &TriMesh) -> Vec<Vec<usize>> {
    let edges = rim_edges(mesh);
    let mut used = vec![false; edges.len()];
    let mut rims = Vec::new();
    for start in 0..edges.len() {
        let mut rim = Vec::new();
        let mut at = start;
        while !used[at] {
            used[at] = true;
            rim.push(edges[at][0]);
            let end = edges[at][1];
            let first = edges.partition_point(|edge| edge[0] < end);
            match (first..edges.len()).take_while(|&i| edges[i][0] == end).find(|&i| !used[i]) {
                Some(next) => at = next,
                None => break,
            }
        }
        let closes = rim.len() >= 3 && edges[at][1] == rim[0];
        if closes {
            rim.reverse();
            rims.push(rim);
        }
    }
    rims
}

/// Closes every hole with a patch that continues the curvature round it. Returns the number of holes.
fn close_holes(mesh: &mut TriMesh) -> usize {
    let holes: Vec<(Vec<usize>, f64)> = rims(mesh)
        .into_iter()
        .map(|rim| {
            let length = length(mesh, &rim);
            (rim, length)
        })
        .filter(|(_, length)| *length < LONGEST_HOLE)
        .collect();
    let mut patches = Vec::new();
    for (rim, length) in &holes {
        patches.push(patch(mesh, rim, *length));
    }
    let around = neighbours(mesh);
    for (fresh, (rim, _)) in patches.into_iter().zip(&holes).filter(|(fresh, _)| fresh.len() <= LARGEST_PATCH) {
        fair(mesh, &around, fresh.clone());
        let heights = || rim.iter().map(|&i| mesh.positions[i].z);
        let (low, high) = (heights().fold(f64::INFINITY, f64::min), heights().fold(0.0, f64::max));
        if high < SOLE_HEIGHT {
            mesh.positions[fresh].iter_mut().for_each(|p| p.z = p.z.max(low - SOLE_DEPTH));
        }
    }
    holes.len()
}

/// Fills a rim with rings that shrink towards its middle. Returns the new vertices.
fn patch(mesh: &mut TriMesh, rim: &[usize], length: f64) -> std::ops::Range<usize> {
    let first = mesh.positions.len();
    let sides = rim.len();
    let middle = rim.iter().map(|&i| mesh.positions[i]).sum::<V3>() / sides as f64;
    let radius = rim.iter().map(|&i| (mesh.positions[i] - middle).norm()).sum::<f64>() / sides as f64;
    let rings = (radius / (length / sides as f64)).round().clamp(1.0, 12.0) as usize;
    let mut outer = rim.to_vec();
    for ring in 1..rings {
        let share = ring as f64 / rings as f64;
        let start = mesh.positions.len();
        mesh.positions.extend(rim.iter().map(|&i| mesh.positions[i].lerp(&middle, share)).collect::<Vec<_>>());
        let inner: Vec<usize> = (start..start + sides).collect();
        for i in 0..sides {
            let j = (i + 1) % sides;
            mesh.triangles.extend([[outer[i], outer[j], inner[j]], [outer[i], inner[j], inner[i]]]);
        }
        outer = inner;
    }
    let tip = mesh.positions.len();
    mesh.positions.push(middle);
    mesh.triangles.extend((0..sides).map(|i| [outer[i], outer[(i + 1) % sides], tip]));
    first..tip + 1
}

/// Makes a patch a thin plate clamped at its rim: the umbrella of the umbrella is zero at each vertex.
fn fair(mesh: &mut TriMesh, around: &[Vec<usize>], fresh: std::ops::Range<usize>) {
    let count = fresh.len();
    let mut matrix = DMatrix::<f64>::zeros(count, count);
    let mut right = [0, 1, 2].map(|_| DVector::<f64>::zeros(count));
    let mut add = |row: usize, vertex: usize, weight: f64, positions: &[V3]| {
        if fresh.contains(&vertex) {
            matrix[(row, vertex - fresh.start)] += weight;
        } else {
            (0..3).for_each(|axis| right[axis][row] -= weight * positions[vertex][axis]);
        }
    };
    for (row, vertex) in fresh.clone().enumerate() {
        let ring = &around[vertex];
        let terms = ring.iter().map(|&i| (i, 1.0 / ring.len() as f64)).chain([(vertex, -1.0)]);
        for (centre, weight) in terms {
            let share = weight / around[centre].len() as f64;
            around[centre].iter().for_each(|&i| add(row, i, share, &mesh.positions));
            add(row, centre, -weight, &mesh.positions);
        }
    }
    let solver = matrix.lu();
    let solved: Option<Vec<DVector<f64>>> = right.iter().map(|side| solver.solve(side)).collect();
    for (row, vertex) in fresh.enumerate() {
        if let Some(axes) = &solved {
            mesh.positions[vertex] = V3::new(axes[0][row], axes[1][row], axes[2][row]);
        }
    }
}
