//! Data of the three-dimensional viewer of drapes, as JSON for `viewer.js`.

mod pack;

pub use pack::{STEP_MM, Topology, line};

use std::collections::BTreeMap;

use geom::V3;
use geom::units::mm;
use render::Scale;
use serde::Serialize;

/// Makes no network requests.
pub(super) const SCRIPT: &str = include_str!("viewer.js");
pub(super) const STYLE: &str = include_str!("viewer.css");
/// Hidden until the script can draw.
pub(super) const FRAGMENT: &str = include_str!("viewer.html");

/// Number of colours in a scale.
const COLOURS: usize = 13;

#[derive(Clone, Debug, Serialize)]
pub struct Drapes {
    /// Unit vector towards the front of the bodies.
    front: [f64; 3],
    meshes: Vec<PackedMesh>,
    bodies: Vec<PackedBody>,
    drapes: Vec<PackedDrape>,
    scales: BTreeMap<String, PackedScale>,
    levels: BTreeMap<String, Vec<LevelMark>>,
    #[serde(skip)]
    known: Vec<Topology>,
}

#[derive(Clone, Debug, Serialize)]
struct PackedMesh {
    vertices: usize,
    triangles: usize,
    indices: String,
}

#[derive(Clone, Debug, Serialize)]
struct PackedBody {
    subject: String,
    mesh: usize,
    positions: String,
    origin_mm: [f64; 3],
    step_mm: f64,
}

#[derive(Clone, Debug, Serialize)]
struct PackedDrape {
    garment: String,
    size: String,
    subject: String,
    simulator: String,
    /// True for the recommended size.
    wear: bool,
    mesh: usize,
    positions: String,
    origin_mm: [f64; 3],
    step_mm: f64,
    maps: BTreeMap<String, String>,
    lines: Vec<PackedLine>,
}

#[derive(Clone, Debug, Serialize)]
struct PackedLine {
    name: String,
    text: String,
    points: String,
    count: usize,
}

#[derive(Clone, Debug, Serialize)]
struct PackedScale {
    label: String,
    unit: String,
    low: f64,
    high: f64,
    ramp: Vec<String>,
}

#[derive(Clone, Debug, Serialize)]
struct LevelMark {
    name: String,
    height_mm: f64,
}

pub struct Drape<'a> {
    /// Garment, size, subject and simulator.
    pub names: [&'a str; 4],
    /// True for the recommended size.
    pub is_to_wear: bool,
    /// Positions of the sewn vertices, m.
    pub positions: &'a [V3],
    /// Vertices of each triangle, counter-clockwise seen from outside.
    pub triangles: &'a [[usize; 3]],
    /// Name, scale, and values of the vertices.
    pub maps: Vec<(&'static str, Scale, Vec<f64>)>,
    /// Name, text, and points along the line, m.
    pub lines: Vec<(String, String, Vec<V3>)>,
}

impl Default for Drapes {
    fn default() -> Self {
        Self {
            front: [0.0, 1.0, 0.0],
            meshes: Vec::new(),
            bodies: Vec::new(),
            drapes: Vec::new(),
            scales: BTreeMap::new(),
            levels: BTreeMap::new(),
            known: Vec::new(),
        }
    }
}

impl Drapes {
    pub fn is_empty(&self) -> bool {
        self.drapes.is_empty()
    }

    pub fn has_body(&self, subject: &str) -> bool {
        self.bodies.iter().any(|body| body.subject == subject)
    }

    /// Levels are given by name and height above the floor, m. Does nothing if the mesh is too large for a page.
    pub fn add_body(&mut self, subject: &str, positions: &[V3], triangles: &[[usize; 3]], levels: Vec<(String, f64)>) {
        let Some((mesh, topology)) = self.mesh(triangles) else { return };
        let (origin_mm, positions) = topology.places(positions);
        self.bodies.push(PackedBody { subject: subject.to_owned(), mesh, positions, origin_mm, step_mm: STEP_MM });
        let mark = |(name, height_m): (String, f64)| LevelMark { name, height_mm: mm(height_m) };
        self.levels.insert(subject.to_owned(), levels.into_iter().map(mark).collect());
    }

    /// Does nothing if the mesh is too large for a page.
    pub fn add(&mut self, drape: &Drape<'_>) {
        let Some((mesh, topology)) = self.mesh(drape.triangles) else { return };
        let (origin_mm, positions) = topology.places(drape.positions);
        let mut maps = BTreeMap::new();
        for (name, scale, values) in &drape.maps {
            maps.insert((*name).to_owned(), topology.values(values, scale.low, scale.high));
            self.scales.entry((*name).to_owned()).or_insert_with(|| PackedScale::of(scale));
        }
        let packed = |(name, text, points): &(String, String, Vec<V3>)| PackedLine {
            name: name.clone(),
            text: text.clone(),
            points: line(points, origin_mm),
            count: points.len(),
        };
        let [garment, size, subject, simulator] = drape.names.map(str::to_owned);
        let lines = drape.lines.iter().map(packed).collect();
        let wear = drape.is_to_wear;
        let step_mm = STEP_MM;
        self.drapes.push(PackedDrape {
            garment,
            size,
            subject,
            simulator,
            wear,
            mesh,
            positions,
            origin_mm,
            step_mm,
            maps,
            lines,
        });
    }

    /// Index and topology of the mesh with these triangles, which drapes of one size share.
    fn mesh(&mut self, triangles: &[[usize; 3]]) -> Option<(usize, Topology)> {
        let topology = Topology::of(triangles)?;
        let number = self.known.iter().position(|known| *known == topology).unwrap_or_else(|| {
            let (vertices, triangles) = (topology.vertices.len(), topology.count());
            self.meshes.push(PackedMesh { vertices, triangles, indices: topology.packed() });
            self.known.push(topology.clone());
            self.known.len() - 1
        });
        Some((number, topology))
    }

    /// Returns JSON that is safe within a script element of a page.
    pub(super) fn json(&self) -> Result<String, serde_json::Error> {
        Ok(serde_json::to_string(self)?.replace('<', "\\u003c"))
    }
}

impl PackedScale {
    fn of(scale: &Scale) -> Self {
        let ramp = (0..COLOURS).map(|k| scale.map.at(k as f64 / (COLOURS - 1) as f64).hex()).collect();
        Self { label: scale.label.clone(), unit: scale.unit.clone(), low: scale.low, high: scale.high, ramp }
    }
}
