//! The pattern's size as an energy, lowered by alternating a local and a global step.
//!
//! The rest shape of every triangle is its pattern triangle, up to a rotation: as rigid as possible
//! [Sorkine & Alexa 2007]. The rest length of every control is its pattern length. With the present rotations and
//! directions fixed, the energy is quadratic, and one linear system gives all vertices (projective dynamics,
//! [Bouaziz et al. 2014]). Energies are divided by the membrane stiffness, so that only lengths and areas enter.

use nalgebra::{Matrix2, Matrix3x2};

use super::sparse::Factor;
use geom::{V2, V3};
use pattern::garment::excesses;
use pattern::{Garment, MaterialLine, Measurement};

/// Sewn vertices, gradients of their hat functions in the pattern, rest area.
#[derive(Clone, Copy, Debug)]
struct Triangle {
    vertices: [usize; 3],
    gradients: [V2; 3],
    area_m2: f64,
}

/// Stretch of a controlled measurement between two points of the cloth.
#[derive(Clone, Debug)]
struct Control {
    /// Sewn vertices and weights; their weighted sum is the vector from one point to the other.
    terms: Vec<(usize, f64)>,
    rest_m: f64,
}

/// Stretches of a controlled measurement, one after the other. Their arcs are to have the pattern's length.
#[derive(Clone, Debug)]
struct Run {
    controls: Vec<Control>,
    /// Arc lengths in the pattern.
    rest_m: Vec<f64>,
    /// Arc lengths when the energy was set up.
    first_m: Vec<f64>,
}

geom::constants! {
    "hybrid.elastic",
    /// Weight of a pair of an open seam, over that of a side of a triangle.
    const SEAM_WEIGHT: f64 = 1.0;
}

#[derive(Clone, Copy, Debug)]
pub struct Pull<'a> {
    pub targets: &'a [V3],
    /// Per sewn vertex, over the membrane stiffness, m.
    pub loads: &'a [V3],
    /// Rest shape of triangles and controls: 0 as they were at first, 1 as in the pattern, in between in proportion.
    pub share: f64,
    /// Factor on the lengths of controls, which compensates the error that their finite weight leaves.
    pub control: f64,
    pub closer_m: f64,
}

/// Energy of a sewn garment, ready to be lowered.
pub struct Elastic {
    count: usize,
    triangles: Vec<Triangle>,
    runs: Vec<Run>,
    /// Right stretch tensors when the energy was set up: roots of `F^T F`.
    first_stretch: Vec<Matrix2<f64>>,
    control_weight: f64,
    open: Vec<[usize; 2]>,
    weights: Vec<f64>,
    /// Diagonal of the membrane's matrix: the stiffness with which its neighbours hold each vertex.
    held: Vec<f64>,
    factor: Factor,
}

/// Measurements that keep their pattern length.
#[derive(Clone, Copy)]
pub struct Controls<'a> {
    pub measurements: &'a [&'a Measurement],
    /// Width of the strip of cloth whose weight each has, m.
    pub weight: f64,
}

impl Controls<'_> {
    pub const NONE: Self = Self { measurements: &[], weight: 0.0 };
}

impl Elastic {
    /// Sets up a garment whose vertices are sewn together as `vertex_of` says. `bending` are pairs of sewn vertices
    /// with their entry of the bending matrix over the membrane stiffness. `open` are pairs of seams that are still
    /// open, `weights` those of the vertices' targets.
    ///
    /// `None` if a triangle of the pattern has no area, or if no weight holds the garment.
    pub fn new(
        garment: &Garment,
        vertex_of: &[usize],
        x: &[V3],
        controls: Controls,
        bending: &[([usize; 2], f64)],
        open: Vec<[usize; 2]>,
        weights: Vec<f64>,
    ) -> Option<Self> {
        let triangles = garment
            .triangles
            .iter()
            .map(|t| Triangle::new(t.map(|v| vertex_of[v]), t.map(|v| garment.rest[v])))
            .collect::<Option<Vec<_>>>()?;
        let Controls { measurements, weight: control_weight } = controls;
        let runs: Vec<Run> =
            measurements.iter().flat_map(|m| &m.runs).map(|run| Run::of(garment, vertex_of, run, x)).collect();
        let mut entries = Vec::new();
        let mut add = |i: usize, j: usize, value: f64| {
            if i >= j {
                entries.push((i, j, value));
            }
        };
        let mut held = vec![0.0; x.len()];
        for t in &triangles {
            for (&i, g) in t.vertices.iter().zip(&t.gradients) {
                held[i] += t.area_m2 * g.norm_squared();
            }
            for (&i, gi) in t.vertices.iter().zip(&t.gradients) {
                for (&j, gj) in t.vertices.iter().zip(&t.gradients) {
                    add(i, j, t.area_m2 * gi.dot(gj));
                }
            }
        }
        for control in runs.iter().flat_map(|run| &run.controls) {
            let weight = control_weight / control.rest_m;
            for &(i, a) in &control.terms {
                for &(j, b) in &control.terms {
                    add(i, j, weight * a * b);
                }
            }
        }
        let drawn = open.iter().map(|pair| (*pair, -SEAM_WEIGHT));
        for ([i, j], value) in bending.iter().copied().chain(drawn) {
            add(i.max(j), i.min(j), value);
            add(i, i, -value);
            add(j, j, -value);
        }
        let first_stretch = triangles.iter().map(|t| t.polar(x).1).collect();
        entries.extend(weights.iter().enumerate().map(|(v, w)| (v, v, *w)));
        let factor = Factor::new(x.len(), &entries)?;
        Some(Self { count: x.len(), triangles, runs, first_stretch, control_weight, open, weights, held, factor })
    }

    /// Does nothing if the weights do not hold the garment.
    pub fn set_weights(&mut self, weights: Vec<f64>) {
        let added: Vec<f64> = weights.iter().zip(&self.weights).map(|(new, old)| new - old).collect();
        if self.factor.add_to_diagonal(&added) {
            self.weights = weights;
        }
    }

    /// Stiffness of the membrane at each sewn vertex, in the unit of the targets' weights.
    pub fn held(&self) -> &[f64] {
        &self.held
    }

    /// Greatest principal stretch less 1 at each vertex: the mean over its triangles, weighted by their areas.
    pub fn stretches(&self, x: &[V3]) -> Vec<f64> {
        let (mut sums, mut areas) = (vec![0.0; x.len()], vec![0.0; x.len()]);
        for triangle in &self.triangles {
            let root = triangle.polar(x).1;
            let half = 0.5 * root.trace();
            let greatest = half + (half * half - root.determinant()).max(0.0).sqrt();
            for v in triangle.vertices {
                sums[v] += triangle.area_m2 * (greatest - 1.0);
                areas[v] += triangle.area_m2;
            }
        }
        sums.iter().zip(&areas).map(|(sum, area)| sum / area.max(f64::MIN_POSITIVE)).collect()
    }

    pub fn open(&self) -> &[[usize; 2]] {
        &self.open
    }

    /// Local step (rotations and directions), then global step (positions).
    pub fn step(&mut self, x: &[V3], pull: &Pull) -> Vec<V3> {
        let mut rhs = vec![V3::zeros(); self.count];
        for (t, first) in self.triangles.iter().zip(&self.first_stretch) {
            let wanted = first * (1.0 - pull.share) + Matrix2::identity() * pull.share;
            let turn = t.polar(x).0 * wanted * t.area_m2;
            for (&v, g) in t.vertices.iter().zip(&t.gradients) {
                rhs[v] += turn * g;
            }
        }
        for Chord { control, way, length_m } in self.runs.iter().flat_map(|run| run.chords(x, pull)) {
            let wanted = way * (length_m / way.norm().max(1e-9) * self.control_weight / control.rest_m);
            for &(v, weight) in &control.terms {
                rhs[v] += wanted * weight;
            }
        }
        for &[a, b] in &self.open {
            let way = x[b] - x[a];
            let wanted = way * (SEAM_WEIGHT * (1.0 - pull.closer_m / way.norm().max(1e-9)).max(0.0));
            rhs[a] -= wanted;
            rhs[b] += wanted;
        }
        for v in 0..self.count {
            rhs[v] += pull.targets[v] * self.weights[v] + pull.loads[v];
        }
        let mut columns = vec![0.0; 3 * self.count];
        for (v, r) in rhs.iter().enumerate() {
            for k in 0..3 {
                columns[k * self.count + v] = r[k];
            }
        }
        self.factor.solve(&mut columns);
        (0..self.count).map(|v| V3::new(columns[v], columns[self.count + v], columns[2 * self.count + v])).collect()
    }
}

impl Triangle {
    fn new(vertices: [usize; 3], rest: [V2; 3]) -> Option<Self> {
        let edges = Matrix2::from_columns(&[rest[1] - rest[0], rest[2] - rest[0]]);
        let inverse = edges.try_inverse()?;
        let [g1, g2] = [0, 1].map(|k| inverse.row(k).transpose());
        Some(Self { vertices, gradients: [-(g1 + g2), g1, g2], area_m2: 0.5 * edges.determinant().abs() })
    }

    /// Polar decomposition of the deformation gradient `F = R S`: the nearest rotation `R = F (F^T F)^(-1/2)` and the
    /// right stretch tensor `S`, in closed form.
    fn polar(&self, x: &[V3]) -> (Matrix3x2<f64>, Matrix2<f64>) {
        let f: Matrix3x2<f64> = (0..3).map(|k| x[self.vertices[k]] * self.gradients[k].transpose()).sum();
        let c = f.transpose() * f;
        let s = c.determinant().max(1e-12).sqrt();
        let t = (c.trace() + 2.0 * s).sqrt();
        // The root of C is (C + s I) / t.
        let root = (c + Matrix2::identity() * s) / t;
        (root.try_inverse().map_or(f, |inverse| f * inverse), root)
    }
}

impl Run {
    fn of(garment: &Garment, vertex_of: &[usize], run: &MaterialLine, x: &[V3]) -> Self {
        let flat: Vec<V3> = run.points.iter().map(|p| p.at_rest(&garment.rest).push(0.0)).collect();
        let (mut controls, mut ways) = (Vec::new(), Vec::new());
        for (ends, flat) in run.points.windows(2).zip(flat.windows(2)) {
            let way = flat[1] - flat[0];
            let mut terms: std::collections::BTreeMap<usize, f64> = std::collections::BTreeMap::new();
            for (point, sign) in [(&ends[0], -1.0), (&ends[1], 1.0)] {
                for k in 0..3 {
                    *terms.entry(vertex_of[point.vertices[k]]).or_default() += sign * point.weights[k];
                }
            }
            if way.norm() > 1e-6 {
                let terms = terms.into_iter().filter(|(_, w)| *w != 0.0).collect();
                controls.push(Control { terms, rest_m: way.norm() });
                ways.push(way);
            }
        }
        let run = Self { controls, rest_m: Vec::new(), first_m: Vec::new() };
        let arcs = |ways: &[V3]| -> Vec<f64> {
            ways.iter().zip(run.excesses(ways)).map(|(way, excess)| (way.norm_squared() + excess).sqrt()).collect()
        };
        Self { rest_m: arcs(&ways), first_m: arcs(&run.ways(x)), ..run }
    }

    /// Chords of the stretches, with the lengths that give their arcs the wanted length.
    fn chords<'a>(&'a self, x: &[V3], pull: &Pull) -> impl Iterator<Item = Chord<'a>> {
        let ways = self.ways(x);
        let excesses = self.excesses(&ways);
        let lengths = self.first_m.iter().zip(&self.rest_m).map(|(first, rest)| first + (rest - first) * pull.share);
        // A chord is no shorter than half of its arc.
        let chord_m = |(length, excess): (f64, f64)| (length * length - excess).max(0.25 * length * length).sqrt();
        let chords: Vec<f64> = lengths.map(|length| pull.control * length).zip(excesses).map(chord_m).collect();
        let chord = |((control, way), length_m)| Chord { control, way, length_m };
        self.controls.iter().zip(ways).zip(chords).map(chord)
    }

    fn ways(&self, x: &[V3]) -> Vec<V3> {
        self.controls.iter().map(|control| control.way(x)).collect()
    }

    /// Squared arc less squared chord of each way, m2.
    fn excesses(&self, ways: &[V3]) -> Vec<f64> {
        excesses(ways, &self.controls.iter().map(|control| control.rest_m).collect::<Vec<_>>())
    }
}

struct Chord<'a> {
    control: &'a Control,
    way: V3,
    length_m: f64,
}

impl Control {
    fn way(&self, x: &[V3]) -> V3 {
        self.terms.iter().map(|&(v, weight)| x[v] * weight).sum()
    }
}
