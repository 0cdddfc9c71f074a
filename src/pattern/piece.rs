//! Pattern pieces as drawn: what a DXF block says, in metres, before anything is sewn.

use std::sync::Arc;

use geom::V2;
use geom::polyline::{perimeter, signed_area};

/// A notch: a mark cut into the edge so that partners can be matched.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Notch {
    /// Place on the outline.
    pub at: V2,
    /// Depth of the cut, m; `None` where the file does not say.
    pub depth_m: Option<f64>,
    /// Direction of the cut, degrees counter-clockwise from +u; `None` where the file does not say.
    pub angle_deg: Option<f64>,
}

/// A point that grading moves by a rule of a grade rule table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GradePoint {
    /// Place, on the outline or near it.
    pub at: V2,
    /// Number of the rule.
    pub rule: u32,
    /// Whether it is a point of an inner line, cut-out or drill hole, however near the outline it lies.
    pub is_inner: bool,
}

/// One piece of one size.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Piece {
    /// Name of its block in the file.
    pub block: String,
    /// `Piece Name`, or the block's name where none is given.
    pub name: String,
    /// What its file says beside it.
    pub beside: Beside,
    /// Size, where the piece or the file names one.
    pub size: Option<String>,
    /// How many are cut, as written (`2`, or `1,1` for left and right).
    pub quantity: Option<String>,
    /// The other texts of the block as `(key, value)`; the key is empty for a text without one.
    pub texts: Vec<(String, String)>,
    /// Closed outline (cut line where the file has a sew line too), counter-clockwise, first vertex not repeated.
    pub outline: Vec<V2>,
    /// Length of the outline as the file draws it, m, where that had to be mended (loops and spikes cut away).
    pub drawn_perimeter_m: Option<f64>,
    /// Whether the file drew the outline clockwise.
    pub is_clockwise_in_file: bool,
    /// Turn points (corners), in the order of the file.
    pub turn_points: Vec<V2>,
    /// Curve points, in the order of the file.
    pub curve_points: Vec<V2>,
    /// Marks cut into the outline, in the order of the file.
    pub notches: Vec<Notch>,
    /// Grain line from its first to its second end.
    pub grain: Option<[V2; 2]>,
    /// Fold line of a half piece.
    pub mirror_line: Option<[V2; 2]>,
    /// Line along which grade rules have their x, from its first to its second end; horizontal without one.
    pub grade_reference: Option<[V2; 2]>,
    /// Points that a grade rule table moves.
    pub grade_points: Vec<GradePoint>,
    /// Lines drawn inside the outline (layer 8), open or closed.
    pub internal_lines: Vec<Vec<V2>>,
    /// Closed lines along which holes are cut inside the outline.
    pub cut_outs: Vec<Vec<V2>>,
    /// Centres of the drill holes.
    pub drill_holes: Vec<V2>,
    /// Closed sew line inside the cut line.
    pub sew_line: Option<Vec<V2>>,
}

/// What a file says beside a piece.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Beside {
    /// What it calls the garment and its sample size: such words in a name say nothing of the piece.
    pub garment: Vec<String>,
    /// The piece in every size, from the smallest; empty where the file holds one size.
    pub sizes: Arc<[Piece]>,
}

impl Piece {
    /// Length of the outline, m.
    #[must_use]
    pub fn perimeter_m(&self) -> f64 {
        perimeter(&self.outline)
    }

    /// Area within the outline, m2.
    #[must_use]
    pub fn area_m2(&self) -> f64 {
        signed_area(&self.outline).abs()
    }

    /// The line that is sewn: the sew line where there is one, else the outline (a net piece).
    #[must_use]
    pub fn seam_outline(&self) -> &[V2] {
        self.sew_line.as_deref().unwrap_or(&self.outline)
    }
}
