//! Constant-strain triangle, the finite element of the membrane.

use nalgebra::{Matrix2, Matrix3x2};

use super::law::Tensor;
use geom::{V2, V3};

/// Constant-strain triangle of the membrane.
#[derive(Clone, Copy, Debug)]
pub struct Element {
    /// Simulated, counter-clockwise.
    vertices: [u32; 3],
    pub(super) law: u32,
    /// Rest area, m2.
    pub area: f64,
    /// Gradients of the second and third shape functions in (weft, warp), 1/m. That of the first is their negative sum.
    gradients: [V2; 2],
}

impl Element {
    /// `grain` is the unit warp direction. `None` where the triangle has no area.
    pub fn new(vertices: [usize; 3], rest: [V2; 3], grain: V2) -> Option<Self> {
        let weft = V2::new(grain.y, -grain.x);
        let local = rest.map(|p| V2::new(p.dot(&weft), p.dot(&grain)));
        let dm = Matrix2::from_columns(&[local[1] - local[0], local[2] - local[0]]);
        let area = 0.5 * dm.determinant();
        let inverse = dm.try_inverse().filter(|_| area > 0.0)?;
        let gradients = [inverse.row(0).transpose(), inverse.row(1).transpose()];
        Some(Self { vertices: vertices.map(|v| v as u32), law: 0, area, gradients })
    }

    /// Returns the triangle with another law. A new triangle has law 0.
    pub fn of_law(self, number: usize) -> Self {
        Self { law: number as u32, ..self }
    }

    pub fn renamed(&self, vertices: [usize; 3]) -> Self {
        Self { vertices: vertices.map(|v| v as u32), ..*self }
    }

    pub fn vertices(&self) -> [usize; 3] {
        self.vertices.map(|v| v as usize)
    }

    #[inline]
    fn fibres(&self, x: &[V3]) -> [V3; 2] {
        let [a, b, c] = self.vertices().map(|v| x[v]);
        let (p, q) = (b - a, c - a);
        let [g, h] = self.gradients;
        [p * g.x + q * h.x, p * g.y + q * h.y]
    }

    /// `F`, its columns along weft and warp.
    pub fn deformation_gradient(&self, x: &[V3]) -> Matrix3x2<f64> {
        Matrix3x2::from_columns(&self.fibres(x))
    }

    pub fn gradients(&self) -> [V2; 2] {
        self.gradients
    }
}

/// Stress of an element and its change along a displacement, N/m.
#[derive(Clone, Copy, Debug)]
pub struct Foreseen {
    pub stress: Tensor,
    /// First order.
    pub change: Tensor,
}

impl Foreseen {
    pub fn after(&self, share: f64) -> Tensor {
        self.stress + self.change * share
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_triangle_without_area_is_refused() {
        let points = [V2::zeros(), V2::new(1.0, 0.0), V2::new(2.0, 0.0)];
        assert!(Element::new([0, 1, 2], points, V2::new(0.0, 1.0)).is_none());
    }
}
