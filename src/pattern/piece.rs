//! Pattern pieces as a file draws them, in metres, before anything is sewn.

use std::sync::Arc;

use geom::V2;
use geom::polyline::{perimeter, signed_area};

/// Mark cut into the edge, matched with that of the seam partner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Notch {
    pub at: V2,
    /// `None` if the file does not give it.
    pub depth_m: Option<f64>,
    /// Counter-clockwise from +u. `None` if the file does not give it.
    pub angle_deg: Option<f64>,
}

/// Point that a rule of the grade rule table moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GradePoint {
    /// Position, m, on the outline or near it.
    pub at: V2,
    pub rule: u32,
    /// True for a notch and a point of an internal line, cut-out or drill hole, however near the outline it lies.
    pub is_inner: bool,
}

/// One piece of one size.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Piece {
    pub block: String,
    /// `Piece Name` of the file, or else the name of the block.
    pub name: String,
    pub beside: Beside,
    /// Size, if the piece or the file names one.
    pub size: Option<String>,
    /// Quantity to cut, as written: `2`, or `1,1` for left and right.
    pub quantity: Option<String>,
    /// Other texts as `(key, value)`. The key is empty for a text without one.
    pub texts: Vec<(String, String)>,
    /// Closed outline, counter-clockwise, first vertex not repeated. The cut line, if there is a sew line too.
    pub outline: Vec<V2>,
    /// Length of the outline as drawn, before loops and spikes were cut away, and before it followed its quality curve.
    /// `None` if the outline is as drawn.
    pub drawn_perimeter_m: Option<f64>,
    pub is_clockwise_in_file: bool,
    /// Corners, in the order of the file.
    pub turn_points: Vec<V2>,
    /// In the order of the file.
    pub curve_points: Vec<V2>,
    /// In the order of the file.
    pub notches: Vec<Notch>,
    /// Grain line from its first to its second end.
    pub grain: Option<[V2; 2]>,
    /// Fold line of a half piece.
    pub mirror_line: Option<[V2; 2]>,
    /// From its first to its second end: the x axis of the grade rules. `None` for a horizontal x axis.
    pub grade_reference: Option<[V2; 2]>,
    pub grade_points: Vec<GradePoint>,
    /// Lines of layer 8, open or closed.
    pub internal_lines: Vec<Vec<V2>>,
    /// Closed lines of holes inside the outline.
    pub cut_outs: Vec<Vec<V2>>,
    pub drill_holes: Vec<V2>,
    /// Closed, inside the cut line. `None` if the file draws none.
    pub sew_line: Option<Vec<V2>>,
}

/// Rest of the file that concerns a piece.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Beside {
    /// Names of the garment and of its sample size. As part of the name of a piece, they do not describe the piece.
    pub garment: Vec<String>,
    /// Line number of its block in the file, from 1. `None` outside all blocks, and for other files than DXF.
    pub line: Option<usize>,
    /// Line at which the piece was unfolded. `None` if the file does not draw half of it.
    pub fold: Option<[V2; 2]>,
    /// The piece in every size, from the smallest. Empty if the file holds one size.
    pub sizes: Arc<[Piece]>,
}

impl Piece {
    pub fn perimeter_m(&self) -> f64 {
        perimeter(&self.outline)
    }

    pub fn area_m2(&self) -> f64 {
        signed_area(&self.outline).abs()
    }

    /// Sew line, or the outline of a piece without one.
    pub fn seam_outline(&self) -> &[V2] {
        self.sew_line.as_deref().unwrap_or(&self.outline)
    }
}
