//! Kernels of the membrane that treat four triangles at once, one in each lane of a vector register.

use wide::f32x4;

use super::element::{Element, Foreseen};
use super::law::{Fibre, Orthotropic, Tensor};
use geom::V3;
use linalg::lanes::{Lanes, Number};
use linalg::quad::{self, Block, Quad};
use linalg::simd::{Kernel, Simd, each};

type Vectors<S> = [Lanes<S>; 3];

/// Four triangles of the membrane. The last group is filled up with triangles of no area, on vertex 0 and pair 0.
#[derive(Clone, Copy, Debug, Default)]
pub struct Four {
    vertices: [[u32; 4]; 3],
    /// For the sides (0,1), (1,2), (2,0) twice the index of the pair, plus 1 where the second corner has the smaller
    /// vertex.
    slots: [[u32; 4]; 3],
    areas: [f64; 4],
    /// Gradients of the second and third shape functions in weft and warp, 1/m. That of the first is their negative
    /// sum.
    gradients: [[[f64; 4]; 2]; 2],
    laws: u32,
}

impl Four {
    pub fn new(elements: &[(Element, [u32; 3])], laws: usize) -> Self {
        let mut four = Self { laws: laws as u32, ..Self::default() };
        for (lane, (element, slots)) in elements.iter().enumerate() {
            four.areas[lane] = element.area;
            for k in 0..3 {
                four.vertices[k][lane] = element.vertices()[k] as u32;
                four.slots[k][lane] = slots[k];
            }
            for (kept, gradient) in four.gradients.iter_mut().zip(element.gradients()) {
                (kept[0][lane], kept[1][lane]) = (gradient.x, gradient.y);
            }
        }
        four
    }

    #[inline(always)]
    fn fibres<S: Simd>(&self, simd: S, x: &[V3]) -> [Vectors<S>; 2] {
        let [a, b, c] = each!(corner of 3 => {
            let at = each!(lane of 4 => &x[self.vertices[corner][lane] as usize]);
            each!(c of 3 => Lanes::of(simd, each!(lane of 4 => at[lane][c])))
        });
        let [p, q] = [each!(k of 3 => b[k] - a[k]), each!(k of 3 => c[k] - a[k])];
        let [g, h] = self.lanes_of_gradients(simd);
        // Not a fused multiply-add: it would round differently for the mirrored garment, which has these two corners in
        // the other order.
        each!(axis of 2 => each!(c of 3 => p[c] * g[axis] + q[c] * h[axis]))
    }

    #[inline(always)]
    fn lanes_of_gradients<S: Simd>(&self, simd: S) -> [[Lanes<S>; 2]; 2] {
        each!(corner of 2 => each!(axis of 2 => Lanes::of(simd, self.gradients[corner][axis])))
    }

    #[inline(always)]
    fn law<S: Simd>(&self, simd: S, laws: &[Orthotropic<[f64; 4]>]) -> Orthotropic<Lanes<S>> {
        let Orthotropic { weft, c12, warp, shear } = &laws[self.laws as usize];
        Orthotropic {
            weft: lanes_of_fibre(simd, weft),
            c12: Lanes::of(simd, *c12),
            warp: lanes_of_fibre(simd, warp),
            shear: Lanes::of(simd, *shear),
        }
    }

    #[inline(always)]
    fn lanes_of_areas<S: Simd>(&self, simd: S) -> Lanes<S> {
        Lanes::of(simd, self.areas)
    }

    /// Gradients of the shape functions in weft and warp, 1/m.
    #[inline(always)]
    fn all_gradients<S: Simd>(&self, simd: S) -> [[Lanes<S>; 2]; 3] {
        let [g, h] = self.lanes_of_gradients(simd);
        let zero = g[0].splat(0.0);
        [each!(axis of 2 => zero - g[axis] - h[axis]), g, h]
    }

    /// Derivative of the Green strain by half of each squared side, 1/m2: `-(g_i g_j^T + g_j g_i^T) / 2` for the side
    /// `ij`.
    #[inline(always)]
    fn side_strains<S: Simd>(&self, simd: S) -> [Tensor<Lanes<S>>; 3] {
        let gradients = self.all_gradients(simd);
        let (zero, half) = (gradients[0][0].splat(0.0), gradients[0][0].splat(0.5));
        each!(k of 3 => {
            let (i, j) = (gradients[k], gradients[(k + 1) % 3]);
            Tensor {
                weft: zero - i[0] * j[0],
                warp: zero - i[1] * j[1],
                shear: (zero - half) * (i[0] * j[1] + i[1] * j[0]),
            }
        })
    }

    #[inline(always)]
    fn sides<S: Simd>(&self, simd: S, values: &[f64]) -> [Lanes<S>; 3] {
        each!(k of 3 => Lanes::of(simd, each!(lane of 4 => values[(self.slots[k][lane] >> 1) as usize])))
    }

    /// Green strain of squared sides that are longer by `excess`, m2.
    #[inline(always)]
    fn strain_of<S: Simd>(&self, simd: S, excess: &[f64]) -> Tensor<Lanes<S>> {
        let (shapes, sides) = (self.side_strains(simd), self.sides(simd, excess));
        let half = sides[0].splat(0.5);
        (shapes[0] * (half * sides[0]) + shapes[2] * (half * sides[2])) + shapes[1] * (half * sides[1])
    }

    /// Adds the tensions conjugate to half of each squared side, `A S : dE`, N/m.
    #[inline(always)]
    fn add_tensions<S: Simd>(&self, simd: S, stress: Tensor<Lanes<S>>, tensions: &mut [f64]) {
        let (shapes, area) = (self.side_strains(simd), self.lanes_of_areas(simd));
        for k in 0..3 {
            let all = (product(&shapes[k], &stress) * area).numbers();
            for lane in 0..4 {
                tensions[(self.slots[k][lane] >> 1) as usize] += all[lane];
            }
        }
    }

    /// Second derivatives of the energy by half of the squared sides, N/m3: of each side with itself, then of (0, 1),
    /// (1, 2), (2, 0).
    #[inline(always)]
    fn push_couplings<S: Simd>(
        &self,
        simd: S,
        law: &Orthotropic<Lanes<S>>,
        strain: Tensor<Lanes<S>>,
        couplings: &mut Vec<[f32; 6]>,
    ) {
        let (shapes, area) = (self.side_strains(simd), self.lanes_of_areas(simd));
        let stresses = each!(k of 3 => law.tangent(strain, shapes[k]) * area);
        let own = each!(k of 3 => product(&shapes[k], &stresses[k]).single());
        // The mean of both orders, so that the result does not depend on which side comes first.
        let half = area.splat(0.5);
        let other = each!(k of 3 => {
            let next = (k + 1) % 3;
            ((product(&shapes[k], &stresses[next]) + product(&shapes[next], &stresses[k])) * half).single()
        });
        for lane in 0..4 {
            couplings.push([own[0][lane], own[1][lane], own[2][lane], other[0][lane], other[1][lane], other[2][lane]]);
        }
    }

    /// Adds the nodal forces `-A F S g_i`, N.
    #[inline(always)]
    fn add_forces<S: Simd>(
        &self,
        simd: S,
        [weft, warp]: &[Vectors<S>; 2],
        stress: Tensor<Lanes<S>>,
        forces: &mut [V3],
    ) {
        // The first Piola-Kirchhoff stress `F S` times the negative area, by columns.
        let area = self.lanes_of_areas(simd);
        let s = stress * (area.splat(0.0) - area);
        let p = each!(c of 3 => weft[c].mul_add(s.weft, warp[c] * s.shear));
        let q = each!(c of 3 => weft[c].mul_add(s.shear, warp[c] * s.warp));
        let gradients = self.lanes_of_gradients(simd);
        let corner_forces = each!(corner of 2 => {
            let [x, y] = gradients[corner];
            each!(c of 3 => p[c].mul_add(x, q[c] * y).numbers())
        });
        for lane in 0..4 {
            let [second, third] = each!(k of 2 => {
                let [x, y, z] = &corner_forces[k];
                V3::new(x[lane], y[lane], z[lane])
            });
            let [a, b, c] = each!(corner of 3 => self.vertices[corner][lane] as usize);
            forces[a] -= second + third;
            forces[b] += second;
            forces[c] += third;
        }
    }

    /// Adds the off-diagonal blocks `K_ij = sum f_a (m_ab f_b)^T` of a law with the tangent moduli `slopes`, where `f`
    /// are the columns of the deformation gradient. `tension` is the stress of the geometric part, without compression;
    /// without it there is no geometric part.
    #[inline(always)]
    fn add_stiffness<S: Simd>(
        &self,
        simd: S,
        fibres: &[Vectors<S>; 2],
        law: &Orthotropic<Lanes<S>>,
        slopes: [Lanes<S>; 2],
        tension: Option<Tensor<Lanes<S>>>,
        blocks: &mut [Block<f32x4>],
    ) {
        let area = self.lanes_of_areas(simd);
        let (c11, c22) = (slopes[0] * area, slopes[1] * area);
        let (c12, shear) = (area * law.c12, area * law.shear);
        let [g, h] = self.lanes_of_gradients(simd);
        let gradients = [each!(axis of 2 => area.splat(0.0) - g[axis] - h[axis]), g, h];
        let couplings = each!(k of 3 => {
            let (i, j) = (gradients[k], gradients[(k + 1) % 3]);
            let [xx, xy, yx, yy] = [i[0] * j[0], i[0] * j[1], i[1] * j[0], i[1] * j[1]];
            let geometric = match tension {
                Some(t) => xx.mul_add(t.weft, (xy + yx).mul_add(t.shear, yy * t.warp)) * area,
                None => area.splat(0.0),
            };
            [
                c11.mul_add(xx, shear * yy).single(),
                c12.mul_add(xy, shear * yx).single(),
                c12.mul_add(yx, shear * xy).single(),
                c22.mul_add(yy, shear * xx).single(),
                geometric.single(),
            ]
        });
        let fibres = each!(axis of 2 => each!(c of 3 => fibres[axis][c].single()));
        for lane in 0..4 {
            let [weft, warp] = each!(axis of 2 => {
                let fibre = &fibres[axis];
                f32x4::from([fibre[0][lane], fibre[1][lane], fibre[2][lane], 0.0])
            });
            for (coupling, slots) in couplings.iter().zip(&self.slots) {
                let slot = slots[lane];
                let [by_weft, mut across, mut back, by_warp, geometric] = each!(k of 5 => coupling[k][lane]);
                if slot & 1 == 1 {
                    (across, back) = (back, across);
                }
                let of_weft = weft.mul_add_on(f32x4::splat(by_weft), warp * f32x4::splat(across), simd);
                let of_warp = weft.mul_add_on(f32x4::splat(back), warp * f32x4::splat(by_warp), simd);
                let block = &mut blocks[(slot >> 1) as usize];
                let alike = quad::alike(geometric);
                for row in 0..3 {
                    let [along_weft, along_warp] = each!(axis of 2 => f32x4::splat(fibres[axis][row][lane]));
                    let sum = along_warp.mul_add_on(of_warp, block[row] + alike[row], simd);
                    block[row] = along_weft.mul_add_on(of_weft, sum, simd);
                }
            }
        }
    }
}

/// `(F^T F - I) / 2` of the columns of the deformation gradient.
#[inline(always)]
fn green<N: Number>([weft, warp]: &[[N; 3]; 2]) -> Tensor<N> {
    let half = weft[0].splat(0.5);
    let one = weft[0].splat(1.0);
    Tensor { weft: half * (dot(weft, weft) - one), warp: half * (dot(warp, warp) - one), shear: half * dot(weft, warp) }
}

/// Double contraction `E : S`.
#[inline(always)]
fn product<N: Number>(strain: &Tensor<N>, stress: &Tensor<N>) -> N {
    let twice = strain.shear.splat(2.0) * strain.shear;
    strain.weft.mul_add(stress.weft, strain.warp.mul_add(stress.warp, twice * stress.shear))
}

#[inline(always)]
fn dot<N: Number>(a: &[N; 3], b: &[N; 3]) -> N {
    a[0].mul_add(b[0], a[1].mul_add(b[1], a[2] * b[2]))
}

#[inline(always)]
fn lanes_of_fibre<S: Simd>(simd: S, fibre: &Fibre<[f64; 4]>) -> Fibre<Lanes<S>> {
    Fibre { rest: Lanes::of(simd, fibre.rest), rise: Lanes::of(simd, fibre.rise), until: Lanes::of(simd, fibre.until) }
}

#[inline(always)]
fn lanes_of<S: Simd>(simd: S, tensors: &[Tensor]) -> Tensor<Lanes<S>> {
    let nothing = Tensor::default();
    let all = each!(lane of 4 => match tensors.get(lane) {
        Some(tensor) => tensor,
        None => &nothing,
    });
    Tensor {
        weft: Lanes::of(simd, each!(lane of 4 => all[lane].weft)),
        warp: Lanes::of(simd, each!(lane of 4 => all[lane].warp)),
        shear: Lanes::of(simd, each!(lane of 4 => all[lane].shear)),
    }
}

#[inline(always)]
fn apart<S: Simd>(tensor: Tensor<Lanes<S>>) -> [Tensor; 4] {
    let (weft, warp, shear) = (tensor.weft.numbers(), tensor.warp.numbers(), tensor.shear.numbers());
    each!(lane of 4 => Tensor { weft: weft[lane], warp: warp[lane], shear: shear[lane] })
}

/// Kernel of the elastic energy, J, and of those derivatives that are asked for.
pub struct Assembly<'a> {
    /// Packed laws; the groups refer to them by index.
    pub laws: &'a [Orthotropic<[f64; 4]>],
    pub fours: &'a [Four],
    pub x: &'a [V3],
    /// Squared arcs less squared chords of the sides, m2; empty where sides are chords.
    pub excess: &'a [f64],
    /// N.
    pub forces: Option<&'a mut [V3]>,
    /// Conjugate to half of each squared side, N/m.
    pub tensions: Option<&'a mut [f64]>,
    /// As `tensions`, of the stresses in the geometric part.
    pub pulls: Option<&'a mut [f64]>,
    /// Off-diagonal stiffness, N/m.
    pub blocks: Option<&'a mut [Block<f32x4>]>,
    /// Second derivatives by half of the squared sides, N/m3.
    pub couplings: Option<&'a mut Vec<[f32; 6]>>,
    /// Stress of each triangle in the geometric part of the blocks, N/m; without it that at `x`.
    pub predicted: Option<&'a [Tensor]>,
}

impl Kernel for Assembly<'_> {
    type Output = f64;

    #[inline(always)]
    fn run<S: Simd>(mut self, simd: S) -> f64 {
        let mut energy = Lanes::of(simd, [0.0; 4]);
        for (k, four) in self.fours.iter().enumerate() {
            let fibres = four.fibres(simd, self.x);
            let has_arcs = !self.excess.is_empty();
            let mut strain = green(&fibres);
            if has_arcs {
                strain = strain + four.strain_of(simd, self.excess);
            }
            let law = four.law(simd, self.laws);
            energy = four.lanes_of_areas(simd).mul_add(law.energy(strain), energy);
            let stress = law.stress(strain);
            if let Some(forces) = &mut self.forces {
                four.add_forces(simd, &fibres, stress, forces);
            }
            if let Some(tensions) = &mut self.tensions
                && has_arcs
            {
                four.add_tensions(simd, stress, tensions);
            }
            if let Some(couplings) = &mut self.couplings
                && has_arcs
            {
                four.push_couplings(simd, &law, strain, couplings);
            }
            if let Some(blocks) = &mut self.blocks {
                let stress = match self.predicted {
                    Some(all) => lanes_of(simd, &all[4 * k..]),
                    None => stress,
                };
                let tension = stress.without_compression();
                if let Some(pulls) = &mut self.pulls
                    && has_arcs
                {
                    four.add_tensions(simd, tension, pulls);
                }
                let tension = Some(tension);
                four.add_stiffness(simd, &fibres, &law, law.tangents(strain), tension, blocks);
            }
        }
        energy.numbers().iter().sum()
    }
}

/// Kernel of the first-order forces (N) of the compressive part of stresses along a displacement.
pub struct Compression<'a> {
    pub fours: &'a [Four],
    /// N/m.
    pub stresses: &'a [Tensor],
    pub d: &'a [V3],
    /// Share of the compressive forces that is added, 0 to 1.
    pub share: f64,
    /// N.
    pub forces: &'a mut [V3],
}

impl Kernel for Compression<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        for (k, four) in self.fours.iter().enumerate() {
            let stress = lanes_of(simd, &self.stresses[4 * k..]);
            let compression = stress - stress.without_compression();
            let share = compression.weft.splat(self.share);
            four.add_forces(simd, &four.fibres(simd, self.d), compression * share, self.forces);
        }
    }
}

/// Kernel of the second-order correction of a displacement from `x`: forces (N) of the stresses at the end in excess of
/// the predicted ones, the predicted stresses, and the material stiffness at the end.
pub struct Correction<'a> {
    pub laws: &'a [Orthotropic<[f64; 4]>],
    pub fours: &'a [Four],
    pub x: &'a [V3],
    pub d: &'a [V3],
    /// Squared arcs less squared chords, m2: before the displacement, their first-order change, and at its end. Empty
    /// where sides are chords.
    pub excess: [&'a [f64]; 3],
    /// N.
    pub forces: &'a mut [V3],
    /// Conjugate to half of each squared side, N/m.
    pub tensions: &'a mut [f64],
    /// Off-diagonal stiffness, N/m.
    pub blocks: &'a mut [Block<f32x4>],
    /// Second derivatives by half of the squared sides, N/m3.
    pub couplings: &'a mut Vec<[f32; 6]>,
    /// Receives the predicted stress of each triangle, and some more where a group is not full.
    pub foreseen: &'a mut Vec<Foreseen>,
}

impl Kernel for Correction<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        for four in self.fours {
            let (fibres, moved) = (four.fibres(simd, self.x), four.fibres(simd, self.d));
            let [weft, warp] = &fibres;
            let has_arcs = !self.excess[0].is_empty();
            let mut strain = green(&fibres);
            let half = strain.weft.splat(0.5);
            let mut change = Tensor {
                weft: dot(weft, &moved[0]),
                warp: dot(warp, &moved[1]),
                shear: half * (dot(weft, &moved[1]) + dot(warp, &moved[0])),
            };
            if has_arcs {
                strain = strain + four.strain_of(simd, self.excess[0]);
                change = change + four.strain_of(simd, self.excess[1]);
            }
            let law = four.law(simd, self.laws);
            let (stress, change) = (law.stress(strain), law.tangent(strain, change));
            let end = each!(axis of 2 => each!(c of 3 => fibres[axis][c] + moved[axis][c]));
            let mut strain = green(&end);
            if has_arcs {
                strain = strain + four.strain_of(simd, self.excess[2]);
            }
            let excess = law.stress(strain) - (stress + change);
            four.add_forces(simd, &end, excess, self.forces);
            if has_arcs {
                four.add_tensions(simd, excess, self.tensions);
                four.push_couplings(simd, &law, strain, self.couplings);
            }
            four.add_stiffness(simd, &end, &law, law.tangents(strain), None, self.blocks);
            let (stress, change) = (apart(stress), apart(change));
            self.foreseen.extend_from_slice(&each!(k of 4 => Foreseen { stress: stress[k], change: change[k] }));
        }
    }
}
