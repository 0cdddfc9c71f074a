//! Scenes: meshes with materials, painted with scalar fields or textures.

use super::RenderError;
use super::colour::{Rgb, Scale};
use super::floor::Floor;
use super::raster::NOTHING;
use super::texture::Texture;
use geom::{TriMesh, V2, V3};
use nalgebra::Vector3;
use std::collections::BTreeMap;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Colour of the side to which normals point.
    pub front: Rgb,
    pub back: Rgb,
    /// Distance by which the surface is drawn behind its true place, m: skin recedes behind cloth that lies on it.
    pub recede_m: f64,
    /// True if the lines where pieces meet are drawn.
    pub seams: bool,
}

impl Material {
    pub fn form() -> Self {
        Self::body(Rgb(0xd8, 0xd1, 0xc8))
    }

    /// Dress form under a map: a neutral mid grey, darker than cloth whose value is near the middle of its scale.
    pub fn form_under_map() -> Self {
        Self::body(Rgb(0x8e, 0x92, 0x98))
    }

    pub fn skin(colour: Rgb) -> Self {
        Self::body(colour)
    }

    fn body(colour: Rgb) -> Self {
        Self { front: colour, back: Rgb(0x60, 0x58, 0x52), recede_m: 0.005, seams: false }
    }

    /// Cloth of a colour, with a darker and greyer wrong side.
    pub fn cloth(front: Rgb) -> Self {
        let grey = (u16::from(front.0) + u16::from(front.1) + u16::from(front.2)) / 3;
        let dull = |v: u8| ((u16::from(v) * 3 + grey) / 4 * 4 / 5) as u8;
        Self { front, back: Rgb(dull(front.0), dull(front.1), dull(front.2)), recede_m: 0.0, seams: true }
    }

    /// Cloth draped by FEM-GS: green.
    pub fn fem() -> Self {
        Self::cloth(Rgb(0x62, 0xb3, 0x8c))
    }

    /// Garment below the one that is shown: the grey of undyed linen.
    pub fn under() -> Self {
        Self::cloth(Rgb(0xc4, 0xbd, 0xae))
    }

    /// Cloth of Hybrid-GS after pop-up: yellow.
    pub fn popup() -> Self {
        Self::cloth(Rgb(0xea, 0xbe, 0x4c))
    }

    /// Cloth of Hybrid-GS after draping: blue.
    pub fn hybrid() -> Self {
        Self::cloth(Rgb(0x5f, 0x97, 0xd0))
    }
}

/// Values of vertices (interpolated) or of triangles (constant).
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    Vertices(Vec<f64>),
    Triangles(Vec<f64>),
}

#[derive(Clone, Debug)]
pub enum Paint {
    Plain,
    Field(Values, Scale),
    Printed(Print),
}

/// Textures on a layer, which may be cut from several cloths.
#[derive(Clone, Debug)]
pub struct Print {
    pub textures: Vec<Texture>,
    /// Index of the texture of each triangle.
    pub of: Vec<usize>,
    /// Texture coordinates of each vertex, in repeats.
    pub places: Vec<V2>,
}

#[derive(Clone, Debug)]
pub struct Layer<'a> {
    /// Surface, m; paint is on the side to which its normals point.
    pub mesh: &'a TriMesh,
    pub material: Material,
    pub paint: Paint,
}

impl<'a> Layer<'a> {
    pub fn new(mesh: &'a TriMesh, material: Material) -> Self {
        Self { mesh, material, paint: Paint::Plain }
    }

    pub fn painted(self, paint: Paint) -> Self {
        Self { paint, ..self }
    }
}

pub(super) struct Look {
    pub material: Material,
    pub paint: Paint,
    pub first_vertex: usize,
    pub first_triangle: usize,
}

impl Look {
    /// Group of continuous colour: a triangle where values are constant, a cloth where textures are printed.
    pub fn parts(&self, triangle: usize) -> usize {
        let own = triangle - self.first_triangle;
        match &self.paint {
            Paint::Field(Values::Triangles(_), _) => own,
            Paint::Printed(print) => print.of[own],
            Paint::Plain | Paint::Field(Values::Vertices(_), _) => 0,
        }
    }
}

pub(super) struct Edge {
    pub ends: [u32; 2],
    /// The two triangles. The second is [`NOTHING`] at a border, and where more than two meet.
    pub faces: [u32; 2],
}

/// Meshes joined into one, with the light that does not depend on the camera.
pub struct Scene {
    pub(super) positions: Vec<Vector3<f32>>,
    pub(super) normals: Vec<Vector3<f32>>,
    pub(super) triangles: Vec<[usize; 3]>,
    pub(super) layer_of: Vec<usize>,
    pub(super) looks: Vec<Look>,
    pub(super) edges: Vec<Edge>,
    /// Vertices at the ends of each segment of the seam lines.
    pub(super) seams: Vec<[usize; 2]>,
    /// Share of the sky that each vertex sees from its front and from its back, 0 to 1.
    pub(super) openness: Vec<[f32; 2]>,
    pub(super) floor: Floor,
    pub(super) centre: Vector3<f32>,
    pub(super) radius: f32,
}

impl Scene {
    /// Joins the layers and computes the light on each vertex from all around (about 0.1 s for a dressed body).
    pub fn new(layers: Vec<Layer<'_>>) -> Result<Self, RenderError> {
        let mut scene = Self {
            positions: Vec::new(),
            normals: Vec::new(),
            triangles: Vec::new(),
            layer_of: Vec::new(),
            looks: Vec::new(),
            edges: Vec::new(),
            seams: Vec::new(),
            openness: Vec::new(),
            floor: Floor::default(),
            centre: Vector3::zeros(),
            radius: 1.0,
        };
        for (index, layer) in layers.into_iter().enumerate() {
            check_mesh(index, layer.mesh)?;
            check_paint(index, &layer.paint, layer.mesh.positions.len(), layer.mesh.triangles.len())?;
            scene.add(layer);
        }
        if let Some(&first) = scene.positions.first() {
            let (low, high) = scene.positions.iter().fold((first, first), |(l, h), p| (l.inf(p), h.sup(p)));
            scene.centre = (low + high) / 2.0;
            scene.radius = ((high - low).norm() / 2.0).max(1e-3);
            scene.bake(low.z);
        }
        Ok(scene)
    }

    /// Gives a layer another appearance. Light, which takes longest, is computed again only if the recess differs.
    pub fn paint(&mut self, layer: usize, material: Material, paint: Paint) -> Result<(), RenderError> {
        let next = self.looks.get(layer + 1).map(|look| [look.first_vertex, look.first_triangle]);
        let [vertices, triangles] = next.unwrap_or([self.positions.len(), self.triangles.len()]);
        let layers = self.looks.len();
        let look = self.looks.get_mut(layer).ok_or(RenderError::NoSuchLayer { layer, layers })?;
        check_paint(layer, &paint, vertices - look.first_vertex, triangles - look.first_triangle)?;
        let moves = look.material.recede_m != material.recede_m;
        (look.material, look.paint) = (material, paint);
        if moves && !self.positions.is_empty() {
            self.bake(self.floor.z);
        }
        Ok(())
    }

    fn add(&mut self, layer: Layer<'_>) {
        let (first_vertex, first_triangle) = (self.positions.len(), self.triangles.len());
        let (twins, edges) = (twins(&layer.mesh.positions), edges(layer.mesh));
        if layer.material.seams {
            let lines = seam_lines(&edges, &twins);
            self.seams.extend(lines.into_iter().map(|edge| edge.map(|v| v + first_vertex)));
        }
        self.edges.extend(edges.into_iter().map(|Edge { ends, faces }| Edge {
            ends: ends.map(|v| v + first_vertex as u32),
            faces: faces.map(|face| if face == NOTHING { NOTHING } else { face + first_triangle as u32 }),
        }));
        self.positions.extend(layer.mesh.positions.iter().map(|p| p.cast::<f32>()));
        self.normals.extend(seamless_normals(layer.mesh, &twins));
        self.triangles.extend(layer.mesh.triangles.iter().map(|t| t.map(|v| v + first_vertex)));
        self.layer_of.resize(self.triangles.len(), self.looks.len());
        self.looks.push(Look { material: layer.material, paint: layer.paint, first_vertex, first_triangle });
    }

    pub(super) fn corners(&self, triangle: usize, projected: &[[f32; 3]]) -> [[f32; 3]; 3] {
        let [a, b, c] = self.triangles[triangle];
        [projected[a], projected[b], projected[c]]
    }

    pub(super) fn recede(&self, triangle: usize) -> f32 {
        self.looks[self.layer_of[triangle]].material.recede_m as f32
    }
}

fn check_mesh(layer: usize, mesh: &TriMesh) -> Result<(), RenderError> {
    let vertices = mesh.positions.len();
    if let Some(vertex) = mesh.positions.iter().position(|p| p.iter().any(|c| !c.is_finite())) {
        return Err(RenderError::NotFinite { layer, vertex });
    }
    for (triangle, corners) in mesh.triangles.iter().enumerate() {
        if let Some(&vertex) = corners.iter().find(|&&v| v >= vertices) {
            return Err(RenderError::NoSuchVertex { layer, triangle, vertex, vertices });
        }
    }
    Ok(())
}

fn check_paint(layer: usize, paint: &Paint, vertices: usize, triangles: usize) -> Result<(), RenderError> {
    let (found, needed) = match paint {
        Paint::Plain => return Ok(()),
        Paint::Field(Values::Vertices(values), _) => (values.len(), vertices),
        Paint::Field(Values::Triangles(values), _) => (values.len(), triangles),
        Paint::Printed(print) if print.of.len() != triangles => (print.of.len(), triangles),
        Paint::Printed(print) if print.of.iter().any(|of| *of >= print.textures.len()) => {
            return Err(RenderError::NoSuchTexture { layer, textures: print.textures.len() });
        }
        Paint::Printed(print) => (print.places.len(), vertices),
    };
    if found == needed { Ok(()) } else { Err(RenderError::PaintLength { layer, found, needed }) }
}

/// First of the vertices at the place of each vertex, to 0.01 mm, since the two sides of a sewn seam are one surface.
fn twins(positions: &[V3]) -> Vec<usize> {
    let mut first_at = BTreeMap::new();
    let place = |p: &V3| [p.x, p.y, p.z].map(|c| (c * 1e5).round() as i64);
    positions.iter().enumerate().map(|(i, p)| *first_at.entry(place(p)).or_insert(i)).collect()
}

/// Vertex normals that are continuous across seams. Surfaces that touch back to back keep their own normals.
fn seamless_normals(mesh: &TriMesh, twins: &[usize]) -> Vec<Vector3<f32>> {
    let own = mesh.vertex_normals();
    let mut shared = vec![V3::zeros(); own.len()];
    for (vertex, normal) in own.iter().enumerate() {
        if normal.dot(&own[twins[vertex]]) >= 0.0 {
            shared[twins[vertex]] += normal;
        }
    }
    own.iter()
        .enumerate()
        .map(|(vertex, normal)| {
            let joint = if normal.dot(&own[twins[vertex]]) >= 0.0 { shared[twins[vertex]] } else { *normal };
            joint.try_normalize(0.0).unwrap_or_else(V3::z).cast()
        })
        .collect()
}

/// Distinct edges of a mesh, in the order of their ends.
fn edges(mesh: &TriMesh) -> Vec<Edge> {
    let mut sides: Vec<([u32; 2], u32)> = Vec::with_capacity(3 * mesh.triangles.len());
    for (face, t) in (0..).zip(&mesh.triangles) {
        let ends = |a: usize, b: usize| [a.min(b) as u32, a.max(b) as u32];
        sides.extend([(ends(t[0], t[1]), face), (ends(t[1], t[2]), face), (ends(t[2], t[0]), face)]);
    }
    sides.sort_unstable();
    let edge = |sides: &[([u32; 2], u32)]| Edge {
        ends: sides[0].0,
        faces: if let [first, second] = sides { [first.1, second.1] } else { [sides[0].1, NOTHING] },
    };
    sides.chunk_by(|a, b| a.0 == b.0).map(edge).collect()
}

/// Edges where two borders coincide: seams between pieces.
fn seam_lines(edges: &[Edge], twins: &[usize]) -> Vec<[usize; 2]> {
    let ends = |edge: &Edge| {
        let [a, b] = edge.ends.map(|v| twins[v as usize]);
        [a.min(b), a.max(b)]
    };
    let mut borders: Vec<[usize; 2]> = edges.iter().filter(|edge| edge.faces[1] == NOTHING).map(ends).collect();
    borders.sort_unstable();
    borders.chunk_by(|a, b| a == b).filter(|same| same.len() > 1).map(|same| same[0]).collect()
}
