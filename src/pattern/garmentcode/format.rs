//! Data model of the JSON of a GarmentCode specification, as `pygarment` writes it.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

/// Root of the file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Document {
    /// Panels and stitches.
    pub pattern: Pattern,
    /// Parameters of the program that made the file. Ignored.
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
    /// Stitches: two sides, and the flag `right_wrong` if both run in the same direction.
    pub stitches: Vec<Vec<StitchItem>>,
    /// Order in which panels are drawn.
    #[serde(default)]
    pub panel_order: Vec<String>,
}

/// A flat panel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Panel {
    /// Position in space, file units.
    pub translation: [f64; 3],
    /// Intrinsic Euler angles `XYZ`, degrees.
    pub rotation: [f64; 3],
    /// Vertices in the plane of the panel, file units, `y` up.
    pub vertices: Vec<[f64; 2]>,
    /// Edges in the order of the loop.
    pub edges: Vec<PanelEdge>,
    /// Part of the body that the panel covers, if the file gives it: `body`, `arm` or `leg`.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub label: String,
}

/// An edge of a panel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PanelEdge {
    /// Indices of start and end among the vertices of the panel.
    pub endpoints: [usize; 2],
    /// Curve of the edge. `None` for a straight edge.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub curvature: Option<Curvature>,
    /// Name that the program gives the edge. Ignored.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub label: Option<String>,
}

/// Curve of an edge.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Curvature {
    /// Older notation of a quadratic curve: its control point.
    Old([f64; 2]),
    /// A curve with its type.
    Typed(Curve),
}

/// Curve with control points relative to the edge: coordinates along the edge and to its left, divided by its length.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "type", content = "params", rename_all = "lowercase")]
pub enum Curve {
    /// Quadratic Bezier curve.
    Quadratic([[f64; 2]; 1]),
    /// Cubic Bezier curve.
    Cubic([[f64; 2]; 2]),
    /// Circular arc: radius in file units, 1 for the longer of the two arcs (else 0), 1 for a left turn (else 0).
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
    /// A flag of the stitch, such as `right_wrong`.
    Flag(String),
}

/// Units and conventions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Properties {
    /// Kind of coordinates of control points. Only `relative` is accepted.
    pub curvature_coords: String,
    /// File units in a metre.
    pub units_in_meter: f64,
    /// True if the translations are those of normalised panels. Ignored.
    #[serde(default)]
    pub normalize_panel_translation: bool,
    /// True if the edges are in loop order.
    #[serde(default)]
    pub normalized_edge_loops: bool,
}
