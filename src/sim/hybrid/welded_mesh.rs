//! Phase 2: all seams at once (5.3). The mesher has already given both sides of a seam the same number of vertices
//! (Algorithm 5.3), so that sewing is merging (Algorithm 5.4) and smoothing the free edges (5.3).

use std::collections::BTreeMap;

use crate::sewing;
use geom::V3;
use pattern::Garment;

geom::constants! {
    "hybrid.sewn",
    /// Share of the way to the middle of its neighbours by which a vertex moves each time [T 5.3.3].
    const SMOOTHING: f64 = 0.1;
    /// Smoothing steps [T 5.3.3].
    const TIMES: u32 = 100;
}

/// Garment as one mesh, the vertices of each seam pair welded.
#[derive(Clone, Debug)]
pub struct Sewn {
    pub vertex_of: Vec<usize>,
    /// In the garment's order.
    pub triangles: Vec<[usize; 3]>,
    pub x: Vec<V3>,
    /// Free edges as closed lines of sewn vertices, counter-clockwise about the cloth: hem, neck, sleeve openings.
    pub loops: Vec<Vec<usize>>,
}

impl Sewn {
    /// Merges seam pairs at their mean place, and smooths the free edges.
    pub fn new(garment: &Garment, positions: &[V3]) -> Self {
        let mut sewn = Self::at(garment, positions);
        sewn.smooth(TIMES);
        sewn
    }

    /// Merges without smoothing.
    pub fn at(garment: &Garment, positions: &[V3]) -> Self {
        let vertex_of = sewing::welded(garment);
        let triangles: Vec<[usize; 3]> = garment.triangles.iter().map(|t| t.map(|v| vertex_of[v])).collect();
        let loops = free_edges(&triangles);
        Self { x: sewing::merged(&vertex_of, positions), vertex_of, triangles, loops }
    }

    /// Welds no vertex.
    pub fn pieces(garment: &Garment, positions: &[V3]) -> Self {
        let (vertex_of, triangles) = (sewing::unsewn(garment), garment.triangles.clone());
        Self { vertex_of, triangles, x: positions.to_vec(), loops: Vec::new() }
    }

    pub fn unsewn(&self, x: &[V3]) -> Vec<V3> {
        self.vertex_of.iter().map(|&v| x[v]).collect()
    }

    /// Smooths the free edges (5.3) by explicit Laplacian smoothing.
    pub fn smooth(&mut self, times: u32) {
        for ring in &self.loops {
            let n = ring.len();
            for _ in 0..times {
                let old: Vec<V3> = ring.iter().map(|&v| self.x[v]).collect();
                for (k, &v) in ring.iter().enumerate() {
                    let middle = (old[(k + n - 1) % n] + old[(k + 1) % n]) / 2.0;
                    self.x[v] += (middle - old[k]) * SMOOTHING;
                }
            }
        }
    }
}

/// Closed lines; those that meet in a vertex are left out.
fn free_edges(triangles: &[[usize; 3]]) -> Vec<Vec<usize>> {
    let mut directed: BTreeMap<[usize; 2], ()> = BTreeMap::new();
    for t in triangles {
        for k in 0..3 {
            let (a, b) = (t[k], t[(k + 1) % 3]);
            if directed.remove(&[b, a]).is_none() {
                directed.insert([a, b], ());
            }
        }
    }
    let mut next: BTreeMap<usize, usize> = directed.keys().map(|&[a, b]| (a, b)).collect();
    let mut loops = Vec::new();
    while let Some((start, mut at)) = next.pop_first() {
        let mut ring = vec![start];
        while at != start {
            ring.push(at);
            match next.remove(&at) {
                Some(after) => at = after,
                None => break,
            }
        }
        if at == start {
            loops.push(ring);
        }
    }
    loops
}
