//! Conversion of the entities of one block into a piece.

use std::collections::BTreeMap;

use dxf::Block;
use dxf::entities::{Entity, EntityType};

use super::figures::{Curves, Figure, Placement, figure};
use super::guard::Foreign;
use super::mtext;
use super::outline::{
    LOOPS_SHARE, Line, MOST_LINES, TRIFLE_M2, counter_clockwise, cut_loops, cut_spikes, joined, part_touching, text_mm,
    without_copies,
};
use super::plain;
use super::quality;
use super::sew_line::sew_line;
use crate::piece::{Beside, GradePoint, Notch, Piece};
use geom::V2;
use geom::polyline::{perimeter, signed_area};
use geom::units::mm;

const LEAST_AREA_M2: f64 = 1e-6;
const DEEPEST_INSERT: usize = 8;
/// Greatest number of entities and points that are read for one piece.
const MOST_PARTS: usize = 400_000;

/// Blocks of a file by name, to resolve insertions.
#[derive(Clone, Debug)]
pub struct Library<'d>(BTreeMap<String, Vec<&'d Block>>);

impl<'d> Library<'d> {
    /// Upper and lower case count as equal.
    pub fn of(blocks: &[&'d Block]) -> Self {
        let mut by_name: BTreeMap<String, Vec<&'d Block>> = BTreeMap::new();
        for block in blocks {
            by_name.entry(block.name.to_ascii_uppercase()).or_default().push(block);
        }
        Self(by_name)
    }

    fn find(&self, name: &str) -> Result<Option<&'d Block>, String> {
        match self.0.get(&name.to_ascii_uppercase()).map(Vec::as_slice) {
            Some([block]) => Ok(Some(block)),
            Some(several) => {
                Err(format!("block `{name}` inserted, of which there are {}; accepted: one", several.len()))
            }
            None => Ok(None),
        }
    }
}

#[derive(Clone, Debug, PartialEq)]
pub struct Text {
    pub at: V2,
    pub value: String,
    /// True on the layer of notches, internal lines, cut-outs or drill holes.
    is_inner: bool,
}

/// Drawing of a block, m, by AAMA layer.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Drawn {
    /// Layer 1.
    pub boundary: Vec<Line>,
    sew_lines: Vec<Line>,
    internal: Vec<Line>,
    cut_outs: Vec<Line>,
    drill_holes: Vec<V2>,
    grain: Vec<Line>,
    mirror: Vec<Line>,
    grade_reference: Vec<Line>,
    turn_points: Vec<V2>,
    curve_points: Vec<V2>,
    notches: Vec<Notch>,
    /// Curves of boundary (layer 84) and sew line (layer 87).
    quality: [Vec<Line>; 2],
    pub texts: Vec<Text>,
    missing: Vec<String>,
    /// Unreadable parts of layers 1 and 14, each with the reason.
    pub unreadable: Vec<String>,
    pub flattened: BTreeMap<&'static str, usize>,
    pub unused: BTreeMap<String, usize>,
    /// Boundary lines that duplicate another boundary line.
    copies: Vec<Line>,
    /// Number of used entities other than texts.
    used: usize,
    parts: usize,
}

impl Drawn {
    /// Inserted blocks are drawn at their insertion points.
    pub fn collect<'e>(
        entities: impl IntoIterator<Item = &'e Entity>,
        placement: &Placement,
        library: &Library<'_>,
    ) -> Self {
        let mut drawn = Self::default();
        drawn.add_all(entities, placement, library, None, DEEPEST_INSERT);
        if drawn.boundary.len() > MOST_LINES {
            let found = format!("{} boundary lines; accepted: at most {MOST_LINES}", drawn.boundary.len());
            drawn.unreadable.push(found);
        } else {
            (drawn.boundary, drawn.copies) = without_copies(drawn.boundary);
        }
        drawn
    }

    /// True for the model and paper space of some writers.
    pub fn is_empty(&self) -> bool {
        self.is_no_piece() && self.texts.is_empty() && self.unused.is_empty()
    }

    pub fn is_no_piece(&self) -> bool {
        self.used == 0 && self.unreadable.is_empty()
    }

    fn add_all<'e>(
        &mut self,
        entities: impl IntoIterator<Item = &'e Entity>,
        placement: &Placement,
        library: &Library<'_>,
        layer_of_insert: Option<&str>,
        depth: usize,
    ) {
        for entity in entities {
            self.parts += 1;
            if self.parts > MOST_PARTS {
                self.unreadable.push(format!("more than {MOST_PARTS} points; accepted: fewer"));
                return;
            }
            // An entity on layer 0 of a block takes the layer of the insertion [DXF reference, BLOCKS].
            let own = entity.common.layer.trim();
            let layer = layer_of_insert.filter(|_| own == "0").unwrap_or(own);
            let EntityType::Insert(insert) = &entity.specific else {
                self.add(entity, layer, placement);
                continue;
            };
            let found = library.find(&insert.name);
            if matches!(found, Ok(None)) {
                self.missing.push(insert.name.clone());
                continue;
            }
            let inner = found.and_then(|block| {
                let block = block.ok_or_else(|| format!("block `{}` is not there", insert.name))?;
                if depth == 0 {
                    return Err(format!(
                        "blocks inserted in each other more than {DEEPEST_INSERT} deep; accepted: fewer"
                    ));
                }
                Ok((placement.of_insert(insert, &block.base_point)?, block))
            });
            match inner {
                Ok((inner, block)) => self.add_all(&block.entities, &inner, library, Some(layer), depth - 1),
                Err(reason) => self.unreadable.push(reason),
            }
        }
    }

    fn add(&mut self, entity: &Entity, layer: &str, placement: &Placement) {
        let figure = match figure(entity, placement) {
            Ok(Figure::Text { at, lines }) => {
                let is_inner = matches!(layer, "4" | "8" | "11" | "13" | "80" | "81" | "82" | "83");
                return self.texts.extend(lines.into_iter().map(|value| Text { at, value, is_inner }));
            }
            Ok(Figure::Label) => return,
            Ok(_) if !is_used(layer) => return self.leave_out(layer),
            Ok(figure) => figure,
            Err(reason) if layer == "1" || layer == "14" => {
                self.used += 1;
                return self.unreadable.push(format!("{reason} (on layer {layer})"));
            }
            Err(_) => return self.leave_out(layer),
        };
        match figure {
            Figure::Text { .. } | Figure::Label => return,
            Figure::Line { points, is_closed, curves: Curves { count, kind } } => {
                self.parts += points.len();
                if count > 0 {
                    *self.flattened.entry(kind).or_default() += count;
                }
                let Some(line) = Line::new(points, is_closed) else { return };
                if line.points.len() == 1 && layer != "1" {
                    return self.leave_out(layer);
                }
                match layer {
                    "13" => self.drill_holes.push(middle(&line.points)),
                    "4" | "80" | "81" | "82" | "83" => self.notches.push(notch(&line)),
                    "2" | "3" => return self.leave_out(layer),
                    _ => self.lines_of(layer).push(line),
                }
            }
            Figure::Circle { centre, points } => {
                self.parts += points.len();
                match layer {
                    "13" => self.drill_holes.push(centre),
                    "1" | "8" | "11" | "14" => {
                        *self.flattened.entry("circle").or_default() += 1;
                        self.lines_of(layer).extend(Line::new(points, true));
                    }
                    _ => return self.leave_out(layer),
                }
            }
            Figure::Point { at, depth_m, angle_deg } => match layer {
                "2" => self.turn_points.push(at),
                "3" => self.curve_points.push(at),
                "13" => self.drill_holes.push(at),
                "4" | "80" | "81" | "82" | "83" => {
                    let depth_m = (depth_m != 0.0).then_some(depth_m);
                    self.notches.push(Notch { at, depth_m, angle_deg: Some(angle_deg) });
                }
                _ => return self.leave_out(layer),
            },
        }
        self.used += 1;
    }

    pub fn add_foreign(&mut self, foreign: &Foreign<'_>) {
        for (&(layer, kind), &count) in foreign {
            if layer == b"1" || layer == b"14" {
                let layer = String::from_utf8_lossy(layer);
                let accepted = "polylines, lines, arcs, circles, ellipses and splines";
                self.unreadable.push(format!("{kind} on layer {layer}; accepted: {accepted}"));
            } else {
                *self.unused.entry(String::from_utf8_lossy(layer).into_owned()).or_default() += count;
            }
        }
    }

    fn leave_out(&mut self, layer: &str) {
        *self.unused.entry(layer.to_owned()).or_default() += 1;
    }

    /// Layers without a list of lines share that of layer 8.
    fn lines_of(&mut self, layer: &str) -> &mut Vec<Line> {
        match layer {
            "1" => &mut self.boundary,
            "14" => &mut self.sew_lines,
            "11" => &mut self.cut_outs,
            "7" => &mut self.grain,
            "6" => &mut self.mirror,
            "5" => &mut self.grade_reference,
            "84" => &mut self.quality[0],
            "87" => &mut self.quality[1],
            _ => &mut self.internal,
        }
    }

    /// Joins the boundary. Duplicate lines count once, unless the outline closes only with both: they are then the two
    /// sides of a slit.
    fn outline(&self, block: &str, remarks: &mut Vec<String>) -> Result<Vec<V2>, String> {
        let once = joined(&self.boundary, "outline (layer 1)");
        if self.copies.is_empty() {
            return once;
        }
        let what = "outline (layer 1)";
        let both = || joined(&[&self.boundary[..], &self.copies[..]].concat(), what);
        // A slit drawn there and back as one line ends where it begins. Without it the outline is closed.
        let neither = || {
            let is_single = |line: &&Line| !self.copies.iter().any(|copy| copy.is_drawn_again_by(line));
            joined(&self.boundary.iter().filter(is_single).cloned().collect::<Vec<_>>(), what)
        };
        let (outline, said) = match once {
            Ok(outline) => (outline, "drawn twice and taken once"),
            Err(reason) => {
                let slit = both().or_else(|_| neither()).map_err(|_| reason)?;
                (slit, "drawn twice, as the sides of a slit")
            }
        };
        remarks.push(format!("block `{block}`: {} boundary lines are {said}", self.copies.len()));
        Ok(outline)
    }

    /// Layers that are not read, the fullest first, with their numbers of entities.
    pub fn layers_beside(&self) -> Option<String> {
        const LISTED: usize = 6;
        let mut layers: Vec<(&String, &usize)> = self.unused.iter().collect();
        layers.sort_by_key(|(_, count)| std::cmp::Reverse(**count));
        let told: Vec<String> =
            layers.iter().take(LISTED).map(|(layer, count)| format!("`{layer}` ({count})")).collect();
        (!told.is_empty()).then(|| told.join(", "))
    }

    pub fn into_piece(mut self, block: &str, remarks: &mut Vec<String>) -> Result<Piece, String> {
        if let Some(reason) = std::mem::take(&mut self.unreadable).into_iter().next() {
            return Err(reason);
        }
        let mut outline = self.outline(block, remarks)?;
        let places = |points: &[V2]| points.iter().map(text_mm).collect::<Vec<_>>().join(", ");
        let drawn = outline.clone();
        let [of_boundary, of_sew_line] = std::mem::take(&mut self.quality);
        if let Some(away_m) = quality::follow(&mut outline, &of_boundary) {
            remarks.push(quality::remark(block, "boundary", "84", drawn.len(), away_m));
        }
        let spikes = cut_spikes(&mut outline);
        if !spikes.is_empty() {
            let places = places(&spikes);
            remarks.push(format!("block `{block}`: its outline runs out to {places} and back over itself: cut away"));
        }
        let parted = part_touching(&mut outline);
        if !parted.is_empty() {
            let places = places(&parted);
            remarks
                .push(format!("block `{block}`: its outline touches itself at {places}: parted by a hair's breadth"));
        }
        let loops = if self.sew_lines.is_empty() {
            cut_loops(&mut outline, "outline", TRIFLE_M2)?
        } else {
            let trifle_m2 = LOOPS_SHARE * signed_area(&outline).abs();
            cut_loops(&mut outline, "cut line", trifle_m2)?
        };
        if !loops.is_empty() {
            let (places, line) = (places(&loops), if self.sew_lines.is_empty() { "outline" } else { "cut line" });
            remarks.push(format!("block `{block}`: its {line} crosses itself at {places}: loops cut away"));
        }
        let area = signed_area(&outline);
        if area.abs() < LEAST_AREA_M2 {
            return Err(format!("the outline encloses {:.3} mm2; accepted: an area", area.abs() * 1e6));
        }
        let drawn_perimeter_m = (outline != drawn).then(|| perimeter(&drawn));
        let is_clockwise_in_file = counter_clockwise(&mut outline);
        let mut sew_line = sew_line(self.sew_lines, &mut self.internal, &outline)?;
        if let Some(line) = &mut sew_line {
            let drawn = line.len();
            if let Some(away_m) = quality::follow(line, &of_sew_line) {
                remarks.push(quality::remark(block, "sew line", "87", drawn, away_m));
            }
        }
        let grade_points = self.texts.iter().filter_map(grade_point).collect();
        let others = self.texts.iter().filter(|text| grade_point(text).is_none());
        let mut texts: Vec<(String, String)> = others.map(|text| key_and_value(&text.value)).collect();
        let take = |texts: &mut Vec<(String, String)>, key: &str| {
            let index = texts.iter().position(|(found, value)| is_key(found, key) && !value.is_empty());
            index.map(|index| texts.remove(index).1)
        };
        let ends = |lines: &[Line]| lines.first().map(Line::ends);
        let points = |lines: Vec<Line>| lines.into_iter().map(|line| line.points).collect();
        Ok(Piece {
            block: block.to_owned(),
            name: take(&mut texts, "piece name").unwrap_or_else(|| block.to_owned()),
            beside: Beside::default(),
            size: take(&mut texts, "size"),
            quantity: take(&mut texts, "quantity"),
            texts,
            outline,
            drawn_perimeter_m,
            is_clockwise_in_file,
            turn_points: self.turn_points,
            curve_points: self.curve_points,
            notches: self.notches,
            grain: ends(&self.grain),
            mirror_line: ends(&self.mirror),
            grade_reference: ends(&self.grade_reference),
            grade_points,
            internal_lines: points(self.internal),
            cut_outs: points(self.cut_outs),
            drill_holes: self.drill_holes,
            sew_line,
        })
    }

    pub fn size(&self) -> Option<String> {
        let texts = self.texts.iter().map(|text| key_and_value(&text.value));
        texts.filter(|(key, value)| is_key(key, "size") && !value.is_empty()).map(|(_, value)| value).next()
    }

    pub fn place(&self) -> Option<V2> {
        let lines = [&self.boundary, &self.sew_lines, &self.internal, &self.cut_outs];
        let more = [&self.grain, &self.mirror, &self.grade_reference];
        let on_line = lines.into_iter().chain(more).flatten().map(|line| middle(&line.ends()));
        let points = [&self.turn_points, &self.curve_points, &self.drill_holes].into_iter().flatten().copied();
        let first_of_boundary = self.boundary.iter().map(|line| line.points[0]);
        first_of_boundary
            .chain(on_line)
            .chain(points)
            .chain(self.notches.iter().map(|notch| notch.at))
            .chain(self.texts.iter().map(|text| text.at))
            .next()
    }

    pub fn remarks(&self, block: &str) -> Vec<String> {
        let error_mm = mm(super::curves::CHORD_ERROR_M);
        let mut remarks = Vec::new();
        if !self.flattened.is_empty() {
            let count =
                |(kind, count): (&&str, &usize)| format!("{count} {kind}{}", if *count == 1 { "" } else { "s" });
            let counts: Vec<String> = self.flattened.iter().map(count).collect();
            remarks.push(format!("block `{block}`: {} flattened, chords within {error_mm} mm", counts.join(", ")));
        }
        for missing in &self.missing {
            remarks.push(format!("block `{block}`: inserts block `{missing}`, which the file does not hold: left out"));
        }
        remarks
    }
}

fn is_used(layer: &str) -> bool {
    let layers = ["1", "2", "3", "4", "5", "6", "7", "8", "11", "13", "14", "80", "81", "82", "83", "84", "87"];
    layers.contains(&layer)
}

/// Reads a line from the edge inwards.
fn notch(line: &Line) -> Notch {
    let [at, inner] = line.ends();
    let cut = inner - at;
    let angle_deg = Some(cut.y.atan2(cut.x).to_degrees().rem_euclid(360.0));
    Notch { at, depth_m: Some(cut.norm()), angle_deg }
}

/// Centre of the bounding box.
fn middle(points: &[V2]) -> V2 {
    let low = points.iter().fold(points[0], |low, p| low.inf(p));
    let high = points.iter().fold(points[0], |high, p| high.sup(p));
    (low + high) * 0.5
}

/// A text `# n`: rule `n` applies at its position.
fn grade_point(text: &Text) -> Option<GradePoint> {
    let rule = text.value.trim().strip_prefix('#')?.trim().parse().ok()?;
    Some(GradePoint { at: text.at, rule, is_inner: text.is_inner })
}

/// Texts as `(key, value)`.
pub fn texts<'e>(entities: impl Iterator<Item = &'e Entity>) -> Vec<(String, String)> {
    let lines = |entity: &'e Entity| match &entity.specific {
        EntityType::Text(text) => vec![text.value.clone()],
        EntityType::MText(text) => mtext::lines_of(text),
        _ => Vec::new(),
    };
    entities.flat_map(lines).map(|line| key_and_value(&line)).collect()
}

/// True in any spelling: `Piece Name`, `PIECE_NAME`, `piecename`.
fn is_key(found: &str, key: &str) -> bool {
    plain(found) == plain(key)
}

/// Splits `Key: value`. A text without a key has the key `""`.
pub fn key_and_value(text: &str) -> (String, String) {
    match text.split_once(':') {
        Some((key, value)) => (key.trim().to_owned(), value.trim().to_owned()),
        None => (String::new(), text.trim().to_owned()),
    }
}
