//! The floor under the subject, with its shadow.

use nalgebra::Vector3;

/// Cells along a side of the floor.
const CELLS: usize = 96;

/// Light on the floor under the subject, on a square grid. Lengths in metres.
#[derive(Default)]
pub(super) struct Floor {
    pub z: f32,
    /// Corner of the grid.
    low: [f32; 2],
    cell: f32,
    /// Share of the sky that each cell sees, row by row.
    pub openness: Vec<f32>,
}

impl Floor {
    pub fn new(z: f32, centre: Vector3<f32>, radius: f32) -> Self {
        let cell = 2.0 * radius / CELLS as f32;
        Self { z, low: [centre.x - radius, centre.y - radius], cell, openness: vec![0.0; CELLS * CELLS] }
    }

    pub fn soften(&mut self) {
        for _ in 0..8 {
            let before = self.openness.clone();
            for j in 1..CELLS - 1 {
                for i in 1..CELLS - 1 {
                    let row = |j: usize| before[j * CELLS + i - 1] + before[j * CELLS + i] + before[j * CELLS + i + 1];
                    self.openness[j * CELLS + i] = (row(j - 1) + row(j) + row(j + 1)) / 9.0;
                }
            }
        }
        let from_centre = |k: usize| (2.0 * k as f32 + 1.0) / CELLS as f32 - 1.0;
        for (k, open) in self.openness.iter_mut().enumerate() {
            let r = from_centre(k % CELLS).hypot(from_centre(k / CELLS));
            let fade = ((1.0 - r) / 0.6).clamp(0.0, 1.0);
            *open = 1.0 - (1.0 - *open) * fade * fade * (3.0 - 2.0 * fade);
        }
    }

    /// Centres of the cells.
    pub fn points(&self) -> Vec<Vector3<f32>> {
        let centre = |i: usize, axis: usize| self.low[axis] + (i as f32 + 0.5) * self.cell;
        (0..CELLS * CELLS).map(|k| Vector3::new(centre(k % CELLS, 0), centre(k / CELLS, 1), self.z)).collect()
    }

    /// Share of the sky that a point of the floor sees, interpolated between cells; 1 beyond the grid.
    pub fn openness(&self, x: f32, y: f32) -> f32 {
        if self.openness.is_empty() {
            return 1.0;
        }
        let place = [(x - self.low[0]) / self.cell - 0.5, (y - self.low[1]) / self.cell - 0.5];
        if place.iter().any(|&p| p < 0.0 || p >= (CELLS - 1) as f32) {
            return 1.0;
        }
        let (i, j) = (place[0] as usize, place[1] as usize);
        let (f, g) = (place[0] - i as f32, place[1] - j as f32);
        let cell = |i: usize, j: usize| self.openness[j * CELLS + i];
        let row = |j: usize| (1.0 - f) * cell(i, j) + f * cell(i + 1, j);
        (1.0 - g) * row(j) + g * row(j + 1)
    }
}
