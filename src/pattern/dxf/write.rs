//! Writing AAMA DXF (R12): one block a piece, millimetres, one closed polyline on layer 1.

use std::fmt::Write as _;

use crate::geom::V2;
use crate::pattern::draft::Draft;
use crate::pattern::piece::Piece;
use crate::units::mm;

/// Writes a draft as AAMA DXF in millimetres: boundary, turn and curve points, notches and grain of each piece.
///
/// The bytes depend on the draft only: no date is written.
#[must_use]
pub fn write(draft: &Draft) -> Vec<u8> {
    let mut out = Out(String::new());
    out.tag(999, "ANSI/AAMA");
    out.section("HEADER", |out| {
        out.tag(9, "$ACADVER");
        out.tag(1, "AC1009");
    });
    out.section("BLOCKS", |out| draft.pieces.iter().for_each(|piece| out.block(piece)));
    out.section("ENTITIES", |out| {
        for (line, (key, value)) in
            [("Author", "Toile"), ("Style Name", &draft.style), ("Sample Size", &draft.size), ("Units", "METRIC")]
                .into_iter()
                .enumerate()
        {
            out.text(V2::new(0.0, -0.02 - 0.005 * line as f64), key, value);
        }
        for piece in &draft.pieces {
            out.entity("INSERT", "1");
            out.tag(2, &piece.block);
            out.point(10, &V2::zeros());
        }
    });
    out.tag(0, "EOF");
    out.0.into_bytes()
}

struct Out(String);

impl Out {
    fn tag(&mut self, code: i32, value: &str) {
        // Writing to a string cannot fail.
        let _ = write!(self.0, "{code:3}\r\n{value}\r\n");
    }

    fn section(&mut self, name: &str, content: impl FnOnce(&mut Self)) {
        self.tag(0, "SECTION");
        self.tag(2, name);
        content(self);
        self.tag(0, "ENDSEC");
    }

    fn entity(&mut self, kind: &str, layer: &str) {
        self.tag(0, kind);
        self.tag(8, layer);
    }

    fn number(&mut self, code: i32, value: f64) {
        // Adding zero turns -0 into 0.
        self.tag(code, &format!("{:.4}", value + 0.0).replace("-0.0000", "0.0000"));
    }

    /// Coordinates in millimetres; `code` is that of x.
    fn point(&mut self, code: i32, point: &V2) {
        self.number(code, mm(point.x));
        self.number(code + 10, mm(point.y));
    }

    fn text(&mut self, at: V2, key: &str, value: &str) {
        self.entity("TEXT", "1");
        self.point(10, &at);
        self.number(40, 3.0);
        self.tag(1, &format!("{key}: {value}"));
    }

    fn block(&mut self, piece: &Piece) {
        self.tag(0, "BLOCK");
        self.tag(8, "0");
        self.tag(2, &piece.block);
        self.tag(70, "64");
        self.point(10, &V2::zeros());
        let mut texts = vec![("Piece Name", piece.name.as_str())];
        texts.extend(piece.size.as_deref().map(|size| ("Size", size)));
        texts.extend(piece.quantity.as_deref().map(|quantity| ("Quantity", quantity)));
        texts.extend(piece.texts.iter().map(|(key, value)| (key.as_str(), value.as_str())));
        for (line, (key, value)) in texts.into_iter().enumerate() {
            self.text(V2::new(0.02, 0.1 - 0.005 * line as f64), key, value);
        }
        self.polyline("1", &piece.outline);
        self.points("2", &piece.turn_points);
        self.points("3", &piece.curve_points);
        for notch in &piece.notches {
            self.entity("POINT", "4");
            self.point(10, &notch.at);
            self.number(30, mm(notch.depth_m.unwrap_or(0.0)));
            self.number(50, notch.angle_deg.unwrap_or(0.0));
        }
        for (layer, line) in [("6", piece.mirror_line), ("7", piece.grain)] {
            if let Some([from, to]) = line {
                self.entity("LINE", layer);
                self.point(10, &from);
                self.point(11, &to);
            }
        }
        if let Some(line) = &piece.sew_line {
            self.polyline("14", line);
        }
        self.tag(0, "ENDBLK");
        self.tag(8, "0");
    }

    fn polyline(&mut self, layer: &str, points: &[V2]) {
        self.entity("POLYLINE", layer);
        self.tag(66, "1");
        self.tag(70, "1");
        for point in points {
            self.entity("VERTEX", layer);
            self.point(10, point);
        }
        self.entity("SEQEND", layer);
    }

    fn points(&mut self, layer: &str, points: &[V2]) {
        for point in points {
            self.entity("POINT", layer);
            self.point(10, point);
        }
    }
}
