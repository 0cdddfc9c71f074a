//! Visible surface of each pixel: one sample at its centre, and nine where an outline, a seam or the edge of a layer
//! passes through it.
//!
//! A pixel needs nine samples only where its colour can change. That is at a contour (an edge between a triangle that
//! faces the viewer and one that does not), at a border of a mesh, at a seam line, and where layers meet.

use super::raster::{NOTHING, RIM, cover};
use super::scene::{Edge, Scene};

/// Samples along a side of a supersampled pixel.
const FINE: usize = 3;
pub(super) const SAMPLES: usize = FINE * FINE;
/// Depth behind the visible surface at which a seam line is still drawn, m, since skin and cloth lie on each other.
const SEAM_DEPTH: f32 = 0.006;

/// A supersampled pixel: the visible triangle of each sample, row by row.
#[derive(Clone)]
pub(super) struct Fine {
    depth: [f32; SAMPLES],
    /// Triangle of each sample; `NOTHING` where there is none.
    pub triangle: [u32; SAMPLES],
    pub stitched: [bool; SAMPLES],
}

impl Fine {
    const EMPTY: Self =
        Self { depth: [f32::INFINITY; SAMPLES], triangle: [NOTHING; SAMPLES], stitched: [false; SAMPLES] };
}

pub(super) struct Visible {
    width: usize,
    height: usize,
    /// Depth at the centre of each pixel, m, behind the centre plane; infinite where there is no surface.
    pub depth: Vec<f32>,
    /// Triangle at the centre of each pixel; `NOTHING` where there is none.
    pub triangle: Vec<u32>,
    /// Index of each pixel in `fine`; `NOTHING` for a pixel with one sample.
    place: Vec<u32>,
    fine: Vec<Fine>,
}

pub(super) fn offset(k: usize) -> [f32; 2] {
    let middle = |cell: usize| (cell as f32 + 0.5) / FINE as f32;
    [middle(k % FINE), middle(k / FINE)]
}

impl Visible {
    /// Rasterises the triangles of a scene. `projected` are its vertices in pixels, with their depth, m.
    pub fn new(scene: &Scene, projected: &[[f32; 3]], width: usize, height: usize) -> Self {
        let pixels = width * height;
        let (depth, triangle) = (vec![f32::INFINITY; pixels], vec![NOTHING; pixels]);
        let mut visible = Self { width, height, depth, triangle, place: vec![NOTHING; pixels], fine: Vec::new() };
        let drawn = |index: usize| {
            let (recede, mut corners) = (scene.recede(index), scene.corners(index, projected));
            corners.iter_mut().for_each(|corner| corner[2] += recede);
            corners
        };
        for index in 0..scene.triangles.len() {
            let (depths, triangles) = (&mut visible.depth, &mut visible.triangle);
            cover(drawn(index), width, height, |pixel, depth| {
                if depth < depths[pixel] {
                    depths[pixel] = depth;
                    triangles[pixel] = index as u32;
                }
            });
        }
        visible.mark_layers(scene);
        visible.mark_contours(scene, projected);
        visible.mark_seams(scene, projected);
        for index in 0..scene.triangles.len() {
            visible.refine(index as u32, drawn(index));
        }
        visible.stitch(scene, projected);
        visible
    }

    /// Samples of a pixel; `None` where it is not supersampled.
    pub fn closer(&self, pixel: usize) -> Option<&Fine> {
        self.fine.get(self.place[pixel] as usize)
    }

    fn mark(&mut self, pixel: usize) {
        if self.place[pixel] == NOTHING {
            self.place[pixel] = self.fine.len() as u32;
            self.fine.push(Fine::EMPTY);
        }
    }

    fn pixel(&self, x: f32, y: f32) -> Option<usize> {
        let inside = x >= 0.0 && y >= 0.0 && x < self.width as f32 && y < self.height as f32;
        inside.then(|| y as usize * self.width + x as usize)
    }

    /// Marks pixels whose right or lower neighbour shows another layer, or another group of it (`Look::parts`).
    fn mark_layers(&mut self, scene: &Scene) {
        let differ = |a: u32, b: u32| {
            a != b
                && (a == NOTHING || b == NOTHING || {
                    let (layer, other) = (scene.layer_of[a as usize], scene.layer_of[b as usize]);
                    layer != other || scene.looks[layer].parts(a as usize) != scene.looks[layer].parts(b as usize)
                })
        };
        for pixel in 0..self.triangle.len() {
            let here = self.triangle[pixel];
            let right = (pixel + 1) % self.width != 0 && differ(here, self.triangle[pixel + 1]);
            let below = self.triangle.get(pixel + self.width).is_some_and(|&other| differ(here, other));
            for (turns, next) in [(right, pixel + 1), (below, pixel + self.width)] {
                if turns {
                    self.mark(pixel);
                    self.mark(next);
                }
            }
        }
    }

    fn mark_contours(&mut self, scene: &Scene, projected: &[[f32; 3]]) {
        let faces_us = |triangle: usize| {
            let [a, b, c] = scene.corners(triangle, projected);
            (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) > 0.0
        };
        let faces: Vec<bool> = (0..scene.triangles.len()).map(faces_us).collect();
        let is_contour = |edge: &&Edge| {
            let [first, second] = edge.faces.map(|face| face as usize);
            edge.faces[1] == NOTHING || faces[first] != faces[second]
        };
        for edge in scene.edges.iter().filter(is_contour) {
            let recede = scene.recede(edge.faces[0] as usize);
            walk(edge.ends.map(|v| projected[v as usize]), 2.0, |[x, y, depth]| {
                if let Some(pixel) = self.pixel(x, y)
                    && self.place[pixel] == NOTHING
                    && depth + recede <= self.farthest_around(pixel)
                {
                    self.mark(pixel);
                }
            });
        }
    }

    fn farthest_around(&self, pixel: usize) -> f32 {
        let (x, y) = (pixel % self.width, pixel / self.width);
        let rows = y.saturating_sub(1)..(y + 2).min(self.height);
        let columns = x.saturating_sub(1)..(x + 2).min(self.width);
        rows.flat_map(|row| &self.depth[row * self.width..][columns.clone()]).fold(f32::NEG_INFINITY, |a, &b| a.max(b))
    }

    /// Calls `visit(self, pixel, sample, depth)` along every seam line, which is drawn two samples wide.
    fn along_seams(
        &mut self,
        scene: &Scene,
        projected: &[[f32; 3]],
        mut visit: impl FnMut(&mut Self, usize, usize, f32),
    ) {
        let sample = 1.0 / FINE as f32;
        for seam in &scene.seams {
            walk(seam.map(|v| projected[v]), FINE as f32, |[x, y, depth]| {
                for (dx, dy) in [(-0.5, -0.5), (0.5, -0.5), (-0.5, 0.5), (0.5, 0.5)] {
                    let (x, y) = (x + dx * sample, y + dy * sample);
                    if let Some(pixel) = self.pixel(x, y) {
                        let cell = |t: f32| ((t.fract() * FINE as f32) as usize).min(FINE - 1);
                        visit(self, pixel, cell(y) * FINE + cell(x), depth);
                    }
                }
            });
        }
    }

    fn mark_seams(&mut self, scene: &Scene, projected: &[[f32; 3]]) {
        self.along_seams(scene, projected, |visible, pixel, _, depth| {
            if depth < visible.farthest_around(pixel) + SEAM_DEPTH {
                visible.mark(pixel);
            }
        });
    }

    fn stitch(&mut self, scene: &Scene, projected: &[[f32; 3]]) {
        self.along_seams(scene, projected, |visible, pixel, sample, depth| {
            if let Some(fine) = visible.fine.get_mut(visible.place[pixel] as usize) {
                fine.stitched[sample] |= depth < fine.depth[sample] + SEAM_DEPTH;
            }
        });
    }

    fn refine(&mut self, triangle: u32, [a, b, c]: [[f32; 3]; 3]) {
        let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        if area == 0.0 {
            return;
        }
        let range = |axis: usize, limit: usize| {
            let (low, high) = (a[axis].min(b[axis]).min(c[axis]), a[axis].max(b[axis]).max(c[axis]));
            low.max(0.0) as usize..(high.max(-1.0) + 1.0).min(limit as f32) as usize
        };
        let columns = range(0, self.width);
        for y in range(1, self.height) {
            for x in columns.clone() {
                let Some(fine) = self.fine.get_mut(self.place[y * self.width + x] as usize) else { continue };
                for k in 0..SAMPLES {
                    let [dx, dy] = offset(k);
                    let (dx, dy) = (x as f32 + dx - a[0], y as f32 + dy - a[1]);
                    let wb = (dx * (c[1] - a[1]) - dy * (c[0] - a[0])) / area;
                    let wc = (dy * (b[0] - a[0]) - dx * (b[1] - a[1])) / area;
                    let depth = a[2] + wb * (b[2] - a[2]) + wc * (c[2] - a[2]);
                    if wb >= -RIM && wc >= -RIM && wb + wc <= 1.0 + RIM && depth < fine.depth[k] {
                        (fine.depth[k], fine.triangle[k]) = (depth, triangle);
                    }
                }
            }
        }
    }
}

/// Calls `visit` at points along a line, at least `per_pixel` times to a pixel.
fn walk([a, b]: [[f32; 3]; 2], per_pixel: f32, mut visit: impl FnMut([f32; 3])) {
    let steps = (per_pixel * (b[0] - a[0]).abs().max((b[1] - a[1]).abs())).ceil().clamp(1.0, 8192.0);
    for step in 0..=steps as usize {
        let t = step as f32 / steps;
        let between = |k: usize| a[k] + t * (b[k] - a[k]);
        visit([between(0), between(1), between(2)]);
    }
}
