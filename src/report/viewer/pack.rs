//! Compression of meshes: vertices are numbered in the order in which triangles use them, and their positions are
//! predicted from earlier triangles.
//!
//! `viewer.js` unpacks the data. A change of either file needs one of the other.

use std::collections::{BTreeMap, VecDeque};
use std::io::Write;

use base64::Engine;
use flate2::Compression;
use flate2::write::DeflateEncoder;
use geom::V3;
use geom::units::mm;

/// Quantisation step of positions.
pub const STEP_MM: f64 = 0.25;

/// Triangles in an order in which each is adjacent to an earlier one where possible. Vertices are numbered by their
/// first use.
#[derive(Clone, Debug, PartialEq)]
pub struct Topology {
    /// Vertices have their new numbers.
    triangles: Vec<[usize; 3]>,
    /// Index of each vertex in the original mesh, by its new number.
    pub vertices: Vec<usize>,
}

impl Topology {
    /// `None` for more vertices than 16 bits can number.
    pub fn of(triangles: &[[usize; 3]]) -> Option<Self> {
        let mut beside: BTreeMap<[usize; 2], Vec<usize>> = BTreeMap::new();
        for (t, triangle) in triangles.iter().enumerate() {
            sides(triangle).into_iter().for_each(|side| beside.entry(side).or_default().push(t));
        }
        let mut numbers: BTreeMap<usize, usize> = BTreeMap::new();
        let (mut ordered, mut vertices, mut seen) = (Vec::new(), Vec::new(), vec![false; triangles.len()]);
        for first in 0..triangles.len() {
            let mut waiting = VecDeque::from([first]);
            while let Some(t) = waiting.pop_front() {
                if std::mem::replace(&mut seen[t], true) {
                    continue;
                }
                ordered.push(triangles[t].map(|v| {
                    *numbers.entry(v).or_insert_with(|| {
                        vertices.push(v);
                        vertices.len() - 1
                    })
                }));
                waiting.extend(sides(&triangles[t]).iter().flat_map(|side| &beside[side]).filter(|next| !seen[**next]));
            }
        }
        (vertices.len() <= usize::from(u16::MAX)).then_some(Self { triangles: ordered, vertices })
    }

    /// Number of triangles.
    pub fn count(&self) -> usize {
        self.triangles.len()
    }

    /// Stores each vertex as the next unused number minus its own number.
    pub fn packed(&self) -> String {
        let mut next = 0;
        let mut codes = Vec::new();
        for &vertex in self.triangles.iter().flatten() {
            codes.push((next - vertex) as u16);
            next = next.max(vertex + 1);
        }
        deflated(&planes(&codes))
    }

    /// Packs the positions of the vertices. Returns the lowest corner of their bounding box, mm, and the packed
    /// positions.
    pub fn places(&self, positions: &[V3]) -> ([f64; 3], String) {
        let own: Vec<V3> = self.vertices.iter().map(|v| positions[*v]).collect();
        let grid = Grid::of(&own);
        let steps: Vec<[i32; 3]> = own.iter().map(|p| grid.steps(p)).collect();
        let mut codes: [Vec<u16>; 3] = Default::default();
        for (vertex, predicted) in self.predictions().into_iter().enumerate() {
            let guess = match predicted {
                Prediction::Origin => [0; 3],
                Prediction::Before => steps[vertex - 1],
                Prediction::Across([a, b, o]) => [0, 1, 2].map(|k| steps[a][k] + steps[b][k] - steps[o][k]),
            };
            (0..3).for_each(|k| codes[k].push(zigzag(steps[vertex][k] - guess[k])));
        }
        (grid.origin_mm, deflated(&codes.iter().flat_map(|axis| planes(axis)).collect::<Vec<u8>>()))
    }

    /// One byte each: 0 is `low`, 255 is `high`.
    pub fn values(&self, values: &[f64], low: f64, high: f64) -> String {
        let byte = |v: &usize| (255.0 * (values[*v] - low) / (high - low)).round().clamp(0.0, 255.0) as u8;
        deflated(&self.vertices.iter().map(byte).collect::<Vec<u8>>())
    }

    fn predictions(&self) -> Vec<Prediction> {
        let mut found = Vec::with_capacity(self.vertices.len());
        let mut opposite: BTreeMap<[usize; 2], usize> = BTreeMap::new();
        for triangle in &self.triangles {
            let new: Vec<usize> = (0..3).filter(|k| triangle[*k] >= found.len()).collect();
            let known = match new.as_slice() {
                [k] => {
                    let [a, b] = [triangle[(k + 1) % 3], triangle[(k + 2) % 3]];
                    opposite.get(&[a.min(b), a.max(b)]).map(|o| Prediction::Across([a, b, *o]))
                }
                _ => None,
            };
            for _ in &new {
                let before = if found.is_empty() { Prediction::Origin } else { Prediction::Before };
                found.push(known.unwrap_or(before));
            }
            for k in 0..3 {
                let [a, b] = [triangle[(k + 1) % 3], triangle[(k + 2) % 3]];
                opposite.insert([a.min(b), a.max(b)], triangle[k]);
            }
        }
        found
    }
}

/// Predictor of the position of a vertex.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Prediction {
    Origin,
    /// The vertex numbered before.
    Before,
    /// Parallelogram: sum of the ends of an edge of an earlier triangle, less that triangle's third vertex.
    Across([usize; 3]),
}

/// Packs points along a line as steps from each to the next, on the grid of some vertices.
pub fn line(points: &[V3], origin_mm: [f64; 3]) -> String {
    let grid = Grid { origin_mm };
    let mut before = [0; 3];
    let mut codes: [Vec<u16>; 3] = Default::default();
    for point in points {
        let at = grid.steps(point);
        (0..3).for_each(|k| codes[k].push(zigzag(at[k] - before[k])));
        before = at;
    }
    deflated(&codes.iter().flat_map(|axis| planes(axis)).collect::<Vec<u8>>())
}

struct Grid {
    origin_mm: [f64; 3],
}

impl Grid {
    /// Grid with its origin at the lowest corner of some points, rounded down to whole millimetres.
    fn of(points: &[V3]) -> Self {
        let low = points.iter().copied().reduce(|low, p| low.inf(&p)).unwrap_or_default();
        Self { origin_mm: [low.x, low.y, low.z].map(|at| mm(at).floor()) }
    }

    fn steps(&self, point: &V3) -> [i32; 3] {
        [0, 1, 2].map(|k| ((mm(point[k]) - self.origin_mm[k]) / STEP_MM).round() as i32)
    }
}

/// Smaller number first.
fn sides(triangle: &[usize; 3]) -> [[usize; 2]; 3] {
    [0, 1, 2].map(|k| {
        let [a, b] = [triangle[k], triangle[(k + 1) % 3]];
        [a.min(b), a.max(b)]
    })
}

/// Zigzag code: 0, -1, 1, -2 ... become 0, 1, 2, 3 ... Clamps steps that 16 bits cannot hold.
fn zigzag(step: i32) -> u16 {
    let step = step.clamp(i32::from(i16::MIN), i32::from(i16::MAX));
    ((step << 1) ^ (step >> 31)) as u16
}

/// Byte planes: the low bytes of all numbers, then their high bytes.
fn planes(codes: &[u16]) -> Vec<u8> {
    let bytes = |place: usize| codes.iter().map(move |code| code.to_le_bytes()[place]);
    bytes(0).chain(bytes(1)).collect()
}

/// Deflates bytes and encodes them in base 64.
fn deflated(bytes: &[u8]) -> String {
    let mut encoder = DeflateEncoder::new(Vec::new(), Compression::best());
    // Writing to a vector cannot fail.
    let packed = encoder.write_all(bytes).and_then(|()| encoder.finish()).unwrap_or_default();
    base64::engine::general_purpose::STANDARD.encode(packed)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Read;

    fn inflated(text: &str) -> Vec<u8> {
        let packed = base64::engine::general_purpose::STANDARD.decode(text).expect("base 64");
        let mut bytes = Vec::new();
        flate2::read::DeflateDecoder::new(packed.as_slice()).read_to_end(&mut bytes).expect("deflated");
        bytes
    }

    fn codes(bytes: &[u8]) -> Vec<u16> {
        let (low, high) = bytes.split_at(bytes.len() / 2);
        low.iter().zip(high).map(|(low, high)| u16::from_le_bytes([*low, *high])).collect()
    }

    fn unzigzag(code: u16) -> i32 {
        i32::from(code >> 1) ^ -i32::from(code & 1)
    }

    fn sheet() -> (Vec<V3>, Vec<[usize; 3]>) {
        let side = 40;
        let place = |k: usize| {
            let (x, z) = ((k % side) as f64 * 0.015, (k / side) as f64 * 0.015);
            V3::new(x - 0.3, 0.1 * (6.0 * x).sin() + 0.05 * z, 0.9 + z)
        };
        let quad = |k: usize| [[k, k + 1, k + side + 1], [k, k + side + 1, k + side]];
        let triangles = (0..side * (side - 1)).filter(|k| k % side + 1 < side).flat_map(quad).collect();
        ((0..side * side).map(place).collect(), triangles)
    }

    #[test]
    fn what_is_unpacked_is_the_mesh_within_half_a_step() {
        let (positions, triangles) = sheet();
        let topology = Topology::of(&triangles).expect("few vertices");
        let mut next = 0;
        let mut read = Vec::new();
        for code in codes(&inflated(&topology.packed())) {
            let vertex = next - usize::from(code);
            next = next.max(vertex + 1);
            read.push(vertex);
        }
        assert_eq!(read, topology.triangles.iter().flatten().copied().collect::<Vec<_>>());
        let sorted = |all: Vec<[usize; 3]>| {
            let mut all: Vec<[usize; 3]> = all
                .into_iter()
                .map(|t| {
                    let first = (0..3).min_by_key(|k| t[*k]).unwrap_or(0);
                    [t[first], t[(first + 1) % 3], t[(first + 2) % 3]]
                })
                .collect();
            all.sort_unstable();
            all
        };
        let named = topology.triangles.iter().map(|t| t.map(|v| topology.vertices[v])).collect();
        assert_eq!(sorted(named), sorted(triangles), "the same triangles, turned the same way");
        let (origin_mm, text) = topology.places(&positions);
        let bytes = inflated(&text);
        let count = topology.vertices.len();
        let axes: Vec<Vec<u16>> = bytes.chunks(2 * count).map(codes).collect();
        let mut at: Vec<[i32; 3]> = Vec::new();
        for (vertex, predicted) in topology.predictions().into_iter().enumerate() {
            let guess = match predicted {
                Prediction::Origin => [0; 3],
                Prediction::Before => at[vertex - 1],
                Prediction::Across([a, b, o]) => [0, 1, 2].map(|k| at[a][k] + at[b][k] - at[o][k]),
            };
            at.push([0, 1, 2].map(|k| guess[k] + unzigzag(axes[k][vertex])));
            let real = positions[topology.vertices[vertex]];
            for k in 0..3 {
                let off = origin_mm[k] + STEP_MM * f64::from(at[vertex][k]) - mm(real[k]);
                assert!(off.abs() <= 0.5 * STEP_MM + 1e-9, "{vertex}: {off} mm");
            }
        }
        assert!(text.len() < 4 * count, "{} bytes for {count} vertices", text.len());
    }

    #[test]
    fn values_and_lines_are_unpacked_as_they_were() {
        let topology = Topology::of(&[[7, 3, 5]]).expect("few vertices");
        let values: Vec<f64> = (0..8).map(f64::from).collect();
        assert_eq!(inflated(&topology.values(&values, 3.0, 8.0)), [204, 0, 102]);
        let points = [V3::new(0.1, 0.0, 1.0), V3::new(0.1005, -0.002, 1.0)];
        let steps: Vec<i32> =
            inflated(&line(&points, [100.0, 0.0, 0.0])).chunks(4).flat_map(codes).map(unzigzag).collect();
        assert_eq!(steps, [0, 2, 0, -8, 4000, 0]);
    }
}
