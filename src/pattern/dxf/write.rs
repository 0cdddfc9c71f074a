//! Writing of AAMA and ASTM DXF (R12), in millimetres: one block of unique name per piece, with one closed polyline on
//! layer 1.

use std::fmt::Write as _;

use super::block_names::block_names;
use crate::piece::Piece;
use geom::V2;
use geom::units::mm;

/// Candidates, by their names in `$DWGCODEPAGE`.
const CODE_PAGES: [(&str, &encoding_rs::Encoding); 4] = [
    ("ANSI_1252", encoding_rs::WINDOWS_1252),
    ("ANSI_1250", encoding_rs::WINDOWS_1250),
    ("ANSI_1251", encoding_rs::WINDOWS_1251),
    ("ANSI_1253", encoding_rs::WINDOWS_1253),
];

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Standard {
    /// ANSI/AAMA-292: grade rules are on the layer of the point that they move.
    #[default]
    Aama,
    /// ASTM D6673: grade rules are on layer 1, and quantities count left and right separately.
    Astm,
}

/// Writes millimetres. The texts of the style stand outside the blocks.
///
/// A file with ASCII texts is plain R12. Otherwise it names the first code page that has all letters of the texts. If
/// none has, it is UTF-8 in the version of AutoCAD 2007.
pub fn write_pieces(pieces: &[Piece], style: &[(String, String)], standard: Standard) -> Vec<u8> {
    let body = body(pieces, style, standard);
    let encoded = CODE_PAGES.iter().find_map(|(page, encoding)| {
        let (bytes, _, has_unknown) = encoding.encode(&body);
        (!has_unknown).then(|| (*page, bytes.into_owned()))
    });
    let (version, page, bytes) = match encoded {
        _ if body.is_ascii() => ("AC1009", None, body.into_bytes()),
        Some((page, bytes)) => ("AC1009", Some(page), bytes),
        None => ("AC1021", None, body.into_bytes()),
    };
    let mut head = Out { text: String::new(), standard };
    head.tag(999, if standard == Standard::Aama { "ANSI/AAMA" } else { "ASTM D6673" });
    head.section("HEADER", |out| {
        out.tag(9, "$ACADVER");
        out.tag(1, version);
        if let Some(page) = page {
            out.tag(9, "$DWGCODEPAGE");
            out.tag(3, page);
        }
    });
    [head.text.into_bytes(), bytes].concat()
}

/// There are no tables: R12 needs none, and AccuMark refuses files with tables.
fn body(pieces: &[Piece], style: &[(String, String)], standard: Standard) -> String {
    let mut out = Out { text: String::new(), standard };
    let names = block_names(pieces);
    out.section("BLOCKS", |out| names.iter().zip(pieces).for_each(|(name, piece)| out.block(name, piece)));
    let version = (String::new(), D6673.to_owned());
    out.section("ENTITIES", |out| {
        let units = ("Units".to_owned(), "METRIC".to_owned());
        let style = style.iter().filter(|(key, _)| !key.eq_ignore_ascii_case("units")).chain([&units]);
        let version = (standard == Standard::Astm).then_some(&version);
        let of_version = |(key, value): &&(String, String)| format!("{key}: {value}").contains("D13Proposal");
        for (line, (key, value)) in style.filter(|text| !of_version(text)).chain(version).enumerate() {
            out.text(V2::new(0.0, -0.02 - 0.005 * line as f64), key, value);
        }
        for name in &names {
            out.entity("INSERT", "1");
            out.tag(2, name);
            out.point(10, &V2::zeros());
        }
    });
    out.tag(0, "EOF");
    out.text
}

pub(crate) const D6673: &str = "ASTM/D13Proposal 1 Version: D 6673-04";

const ON_POINT_M: f64 = 0.1e-3;

struct Out {
    text: String,
    standard: Standard,
}

impl Out {
    fn tag(&mut self, code: i32, value: &str) {
        // A line break would end the value.
        let value = value.replace(|c: char| c.is_control(), " ");
        let _ = write!(self.text, "{code:3}\r\n{value}\r\n");
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
        // `-0.0` becomes `0.0`.
        self.tag(code, &format!("{:.4}", value + 0.0).replace("-0.0000", "0.0000"));
    }

    /// Writes millimetres. `code` is the group code of x.
    fn point(&mut self, code: i32, point: &V2) {
        self.number(code, mm(point.x));
        self.number(code + 10, mm(point.y));
    }

    fn text(&mut self, at: V2, key: &str, value: &str) {
        self.entity("TEXT", "1");
        self.point(10, &at);
        self.number(40, 3.0);
        match key {
            "" => self.tag(1, value),
            _ => self.tag(1, &format!("{key}: {value}")),
        }
    }

    /// AAMA counts all pieces, ASTM left and right separately.
    fn quantity(&self, written: &str) -> String {
        let parts: Option<Vec<u32>> = written.split(',').map(|part| part.trim().parse().ok()).collect();
        match (self.standard, parts.as_deref()) {
            (Standard::Aama, Some(&[left, right])) => (left + right).to_string(),
            (Standard::Astm, Some(&[count])) => format!("{},{}", count.div_ceil(2), count / 2),
            _ => written.to_owned(),
        }
    }

    fn block(&mut self, name: &str, piece: &Piece) {
        self.tag(0, "BLOCK");
        self.tag(8, "0");
        self.tag(2, name);
        self.tag(70, "64");
        self.point(10, &V2::zeros());
        let mut texts = vec![("Piece Name", piece.name.as_str())];
        texts.extend(piece.size.as_deref().map(|size| ("Size", size)));
        let quantity = piece.quantity.as_deref().map(|quantity| self.quantity(quantity));
        texts.extend(quantity.as_deref().map(|quantity| ("Quantity", quantity)));
        texts.extend(piece.texts.iter().map(|(key, value)| (key.as_str(), value.as_str())));
        for (line, (key, value)) in texts.into_iter().enumerate() {
            self.text(V2::new(0.02, 0.1 - 0.005 * line as f64), key, value);
        }
        self.polyline("1", &piece.outline, true);
        self.points("2", &piece.turn_points);
        self.points("3", &piece.curve_points);
        for notch in &piece.notches {
            self.entity("POINT", "4");
            self.point(10, &notch.at);
            self.number(30, mm(notch.depth_m.unwrap_or(0.0)));
            self.number(50, notch.angle_deg.unwrap_or(0.0));
        }
        for (layer, line) in [("5", piece.grade_reference), ("6", piece.mirror_line), ("7", piece.grain)] {
            if let Some([from, to]) = line {
                self.entity("LINE", layer);
                self.point(10, &from);
                self.point(11, &to);
            }
        }
        for graded in &piece.grade_points {
            let is_turn = || piece.turn_points.iter().any(|turn| (turn - graded.at).norm() < ON_POINT_M);
            let is_notch = || piece.notches.iter().any(|notch| (notch.at - graded.at).norm() < ON_POINT_M);
            let layer = match self.standard {
                _ if graded.is_inner && is_notch() => "4",
                _ if graded.is_inner => "8",
                Standard::Astm => "1",
                Standard::Aama if is_turn() => "2",
                Standard::Aama => "3",
            };
            self.entity("TEXT", layer);
            self.point(10, &graded.at);
            self.number(40, 3.0);
            self.tag(1, &format!("# {}", graded.rule));
        }
        for (layer, lines) in [("8", &piece.internal_lines), ("11", &piece.cut_outs)] {
            lines.iter().for_each(|line| self.polyline(layer, line, false));
        }
        self.points("13", &piece.drill_holes);
        if let Some(line) = &piece.sew_line {
            self.polyline("14", line, true);
        }
        self.tag(0, "ENDBLK");
        self.tag(8, "0");
    }

    fn polyline(&mut self, layer: &str, points: &[V2], is_closed: bool) {
        self.entity("POLYLINE", layer);
        self.tag(66, "1");
        self.tag(70, if is_closed { "1" } else { "0" });
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

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;
    use crate::draft::Model;
    use crate::{Style, dxf};

    fn blocks_and_inserts(bytes: &[u8]) -> (Vec<(String, Vec<String>)>, Vec<String>) {
        let text = String::from_utf8(bytes.to_vec()).expect("UTF-8");
        let lines: Vec<&str> = text.lines().map(str::trim).collect();
        assert!(lines.len().is_multiple_of(2) && lines.ends_with(&["0", "EOF"]));
        let (mut blocks, mut inserts, mut entity, mut is_inside) = (Vec::new(), Vec::new(), "", false);
        for tag in lines.chunks(2) {
            match (tag[0], entity) {
                ("0", _) => {
                    entity = tag[1];
                    assert!(!(is_inside && entity == "BLOCK"), "a block in a block");
                    is_inside = entity == "BLOCK" || is_inside && entity != "ENDBLK";
                }
                ("2", "BLOCK") => blocks.push((tag[1].to_owned(), Vec::new())),
                ("2", "INSERT") => inserts.push(tag[1].to_owned()),
                ("1", "TEXT") if is_inside => blocks.last_mut().expect("a block").1.push(tag[1].to_owned()),
                _ => {}
            }
        }
        (blocks, inserts)
    }

    #[test]
    fn every_piece_of_a_nest_is_a_block_of_its_own() {
        // Nine sizes of every draft, with names of sizes that are no names of blocks, and a second sleeve.
        let nest = |model: Model, sizes: [&str; 9]| -> Vec<Piece> {
            let drawn = model.drafts().swap_remove(0).pieces;
            let again = drawn.last().cloned();
            let drawn: Vec<Piece> = drawn.into_iter().chain(again).collect();
            let sized = |size: &str| -> Vec<Piece> {
                drawn.iter().map(|piece| Piece { size: Some(size.to_owned()), ..piece.clone() }).collect()
            };
            sizes.into_iter().flat_map(sized).collect()
        };
        let letters = ["3XS", "XXS", "XS", "S", "M", "L", "XL", "XXL", "3XL"];
        let double = ["30/32", "32/34", "34 1/2", "36", "38/40", "40-42", "42.5", "44*", "46/48 long"];
        for (model, standard) in Model::ALL.into_iter().flat_map(|m| [(m, Standard::Aama), (m, Standard::Astm)]) {
            for sizes in [letters, double] {
                let pieces = nest(model, sizes);
                let written = write_pieces(&pieces, &[], standard);
                let (blocks, inserts) = blocks_and_inserts(&written);
                assert_eq!(blocks.len(), pieces.len());
                let names: Vec<&String> = blocks.iter().map(|(name, _)| name).collect();
                assert_eq!(inserts.iter().collect::<Vec<_>>(), names, "each block is inserted once");
                assert_eq!(names.iter().map(|name| name.to_uppercase()).collect::<BTreeSet<_>>().len(), names.len());
                let is_plain = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
                assert!(names.iter().all(|name| name.len() <= 31 && name.chars().all(is_plain)), "{names:?}");
                for (piece, (name, texts)) in pieces.iter().zip(&blocks) {
                    let size = piece.size.as_deref().unwrap_or_default();
                    for text in [format!("Piece Name: {}", piece.name), format!("Size: {size}")] {
                        assert!(texts.contains(&text), "{name}: {texts:?}");
                    }
                }
                let read = dxf::read(&written, "nest.dxf", None).expect("our own file");
                assert!(read.refused.is_empty() && read.warnings.is_empty(), "{:?}", read.warnings);
                for (again, piece) in read.pieces.iter().zip(&pieces) {
                    assert_eq!((&again.name, &again.size), (&piece.name, &piece.size));
                    assert!((again.perimeter_m() - piece.perimeter_m()).abs() < 1e-5);
                }
            }
        }
    }

    #[test]
    fn a_nest_is_sewn_by_the_seams_of_its_sizes() {
        for model in Model::ALL {
            let pieces: Vec<Piece> = model.drafts().into_iter().flat_map(|draft| draft.pieces).collect();
            let nest = dxf::read(&write_pieces(&pieces, &[], Standard::Aama), "a.dxf", None).expect("our own file");
            for draft in model.drafts() {
                let drawn = Style::read(&draft.pieces, model.seams(), "a").expect("our own seams");
                let sized = nest.to_sew(Some(&draft.size)).expect("every size is there");
                let again = Style::read(&sized, model.seams(), "a").expect("the same seams");
                let ids = |style: &Style| style.pieces.iter().map(|piece| piece.id.clone()).collect::<Vec<_>>();
                assert_eq!((ids(&again), again.seams.len()), (ids(&drawn), drawn.seams.len()), "{model:?}");
            }
        }
    }
}
