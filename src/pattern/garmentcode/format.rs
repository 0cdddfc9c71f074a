//! Data model of the JSON of a GarmentCode specification, as `pygarment` writes it.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Document {
    pub pattern: Pattern,
    /// Of the program that made the file. Ignored.
    #[serde(default)]
    pub parameters: Map<String, Value>,
    #[serde(default)]
    pub parameter_order: Vec<String>,
    pub properties: Properties,
}

#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Pattern {
    pub panels: BTreeMap<String, Panel>,
    /// Two sides each, and the flag `right_wrong` if both run in the same direction.
    pub stitches: Vec<Vec<StitchItem>>,
    #[serde(default)]
    pub panel_order: Vec<String>,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Panel {
    /// In file units.
    pub translation: [f64; 3],
    /// Intrinsic Euler angles `XYZ`, degrees.
    pub rotation: [f64; 3],
    /// In the plane of the panel, file units, `y` up.
    pub vertices: Vec<[f64; 2]>,
    /// In loop order.
    pub edges: Vec<PanelEdge>,
    /// `body`, `arm`, `leg` or empty.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub label: String,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PanelEdge {
    /// Vertices of start and end.
    pub endpoints: [usize; 2],
    /// `None` for a straight edge.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub curvature: Option<Curvature>,
    /// Ignored.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub label: Option<String>,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Curvature {
    /// Control point of a quadratic curve in older notation.
    Old([f64; 2]),
    Typed(Curve),
}

/// Control points are coordinates along the edge and to its left, divided by its length.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "type", content = "params", rename_all = "lowercase")]
pub enum Curve {
    Quadratic([[f64; 2]; 1]),
    Cubic([[f64; 2]; 2]),
    /// Radius in file units, 1 for the longer arc (else 0), 1 for a left turn (else 0).
    Circle(f64, u8, u8),
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum StitchItem {
    Side { panel: String, edge: usize },
    Flag(String),
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Properties {
    /// Only `relative` is accepted.
    pub curvature_coords: String,
    pub units_in_meter: f64,
    /// Ignored.
    #[serde(default)]
    pub normalize_panel_translation: bool,
    #[serde(default)]
    pub normalized_edge_loops: bool,
}
