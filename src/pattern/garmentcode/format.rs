//! The JSON of a GarmentCode specification, as `pygarment` writes it.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

/// The whole file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Document {
    /// Panels and stitches.
    pub pattern: Pattern,
    /// Parameters of the program that made it; not used here.
    #[serde(default)]
    pub parameters: Map<String, Value>,
    /// Names of the parameters in the order of that program.
    #[serde(default)]
    pub parameter_order: Vec<String>,
    /// Units and conventions.
    pub properties: Properties,
}

/// Panels and stitches.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Pattern {
    /// Panels by name.
    pub panels: BTreeMap<String, Panel>,
    /// Stitches: two sides, and `right_wrong` where both run the same way.
    pub stitches: Vec<Vec<StitchItem>>,
    /// Order in which panels are drawn.
    #[serde(default)]
    pub panel_order: Vec<String>,
}

/// A flat panel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Panel {
    /// Place in space, file units.
    pub translation: [f64; 3],
    /// Intrinsic Euler angles `XYZ`, degrees.
    pub rotation: [f64; 3],
    /// Vertices in the panel's plane, file units, `y` up.
    pub vertices: Vec<[f64; 2]>,
    /// Edges in the order of the loop.
    pub edges: Vec<PanelEdge>,
    /// Part of the body that the panel covers, where the file says it; not used here.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub label: String,
}

/// An edge of a panel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PanelEdge {
    /// Indices of its start and its end among the panel's vertices.
    pub endpoints: [usize; 2],
    /// Its curve; straight without one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub curvature: Option<Curvature>,
    /// Name that the program gives the edge; not used here.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub label: Option<String>,
}

/// How an edge is curved.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Curvature {
    /// The older way to write a quadratic curve: its control point.
    Old([f64; 2]),
    /// A curve with its type.
    Typed(Curve),
}

/// A curve; control points are relative to the edge: along it, and to its left, both in lengths of the edge.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "type", content = "params", rename_all = "lowercase")]
pub enum Curve {
    /// Quadratic Bezier curve.
    Quadratic([[f64; 2]; 1]),
    /// Cubic Bezier curve.
    Cubic([[f64; 2]; 2]),
    /// Circular arc: radius in file units, whether it is the longer one, whether it turns left.
    Circle(f64, u8, u8),
}

/// Part of a stitch.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum StitchItem {
    /// An edge of a panel.
    Side {
        /// Name of the panel.
        panel: String,
        /// Index of the edge.
        edge: usize,
    },
    /// A word about the stitch, such as `right_wrong`.
    Flag(String),
}

/// Units and conventions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Properties {
    /// `relative` is the only one accepted.
    pub curvature_coords: String,
    /// File units in a metre.
    pub units_in_meter: f64,
    /// Whether the translations are of normalized panels; not used here.
    #[serde(default)]
    pub normalize_panel_translation: bool,
    /// Whether edges are in loop order.
    #[serde(default)]
    pub normalized_edge_loops: bool,
}
