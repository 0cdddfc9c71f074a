//! Resolution of the names of a seam file to pieces and edges.

use std::borrow::Cow;
use std::collections::BTreeSet;

use super::corners::{cut_edge, mirror_edge, mirrored};
use super::correspond::Lost;
use super::named::called;
use super::nest_corners::corners_of;
use super::shrinkage::Shrinkage;
use super::upright;
use super::{Edge, EdgePoint, EdgeRef, PathPart, Seam, Style, StyleMeasurement, StylePiece, StyleReinforcement};
use crate::piece::Piece;
use crate::seams::{PieceEntry, SeamEntry, SeamFile, Stretch, StyleError};
use geom::V2;
use geom::units::{from_mm, mm};

/// Finds what the names of one seam file refer to.
pub(super) struct Reader<'a> {
    pub(super) file: &'a str,
    pub(super) entries: &'a SeamFile,
}

#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct CornerRange {
    /// Index of the first corner.
    from: usize,
    /// Number of corners from `from` to the end of the edge.
    span: usize,
    /// `None` if the seam file gives none.
    name: Option<String>,
}

impl Reader<'_> {
    pub(super) fn style(&self, pieces: &[Piece]) -> Result<Style, StyleError> {
        let mut style = Style {
            name: self.entries.name.clone(),
            size: String::new(),
            pieces: Vec::new(),
            seams: Vec::new(),
            measurements: Vec::new(),
            reinforcements: Vec::new(),
            fit_levels: Vec::new(),
            shrinkage: Shrinkage::default(),
        };
        for (id, entry) in &self.entries.piece {
            let drawn = self.drawn(id, entry, pieces)?;
            if let Some(size) = &drawn.size {
                style.size.clone_from(size);
            }
            style.pieces.push(self.piece(id, entry, drawn)?);
        }
        let mut sewn = BTreeSet::new();
        for entry in &self.entries.seam {
            let seam = self.seam(entry, &style)?;
            for &edge in seam.a.iter().chain(&seam.b) {
                if !sewn.insert(edge) {
                    let name = style.edge_name(edge);
                    return Err(self.contradiction(
                        format!("seam `{}`", entry.name),
                        format!("edge `{name}` is sewn twice"),
                        "each edge in at most one seam".to_owned(),
                    ));
                }
            }
            style.seams.push(seam);
        }
        self.shrink(&mut style)?;
        style.pieces.iter_mut().for_each(upright::set_upright);
        self.measure(&mut style)?;
        Ok(style)
    }

    pub(super) fn only_measures(&self) -> Result<(), StyleError> {
        match self.entries.piece.keys().next() {
            None if self.entries.seam.is_empty() => Ok(()),
            found => Err(self.contradiction(
                found.map_or_else(|| "a seam".to_owned(), |id| format!("piece `{id}`")),
                "pieces or seams beside a pattern that has its own".to_owned(),
                "[[measurement]] and [fit.*] only".to_owned(),
            )),
        }
    }

    pub(super) fn shrink(&self, style: &mut Style) -> Result<(), StyleError> {
        let refused = |[found, accepted]: [String; 2]| self.contradiction("the cloth".to_owned(), found, accepted);
        style.shrink(Shrinkage::of(self.entries).map_err(refused)?);
        Ok(())
    }

    pub(super) fn measure(&self, style: &mut Style) -> Result<(), StyleError> {
        let sewn: BTreeSet<EdgeRef> =
            style.seams.iter().flat_map(|seam| seam.a.iter().chain(&seam.b)).copied().collect();
        style.measurements.clear();
        for entry in &self.entries.measurement {
            let path = self.path(&format!("measurement {}", entry.no), &entry.path, style)?;
            style.measurements.push(StyleMeasurement {
                no: entry.no,
                name: entry.name.clone(),
                kind: entry.kind,
                l2d_m: style.path_length_m(&path),
                is_free_edge: path.iter().all(|part| matches!(part, PathPart::Edge(edge) if !sewn.contains(edge))),
                path,
            });
        }
        style.reinforcements = self.reinforcements(style)?;
        style.fit_levels.clear();
        for (level, entry) in &self.entries.fit {
            let path = self.path(&format!("fit level `{level}`"), &entry.path, style)?;
            style.fit_levels.push((level.clone(), path));
        }
        Ok(())
    }

    fn reinforcements(&self, style: &Style) -> Result<Vec<StyleReinforcement>, StyleError> {
        let mut all = Vec::new();
        for (number, entry) in self.entries.reinforce.iter().enumerate() {
            let place = format!("reinforce {}", number + 1);
            let (stiffness_n, length_factor) = (entry.stiffness_n, entry.length_factor);
            if !(0.0..=1e5).contains(&stiffness_n) || !(0.5..=1.5).contains(&length_factor) {
                let found = format!("stiffness_n = {stiffness_n}, length_factor = {length_factor}");
                let accepted = "a stiffness of 0 to 1e5 N and a length of 0.5 to 1.5 of the edge".to_owned();
                return Err(self.contradiction(place, found, accepted));
            }
            for name in &entry.edges {
                let edge = self.edge(&place, name, style)?;
                all.push(StyleReinforcement { edge, band: entry.kind, stiffness_n, length_factor });
            }
        }
        Ok(all)
    }

    /// Takes a block name or a piece name.
    fn drawn<'p>(&self, id: &str, entry: &PieceEntry, pieces: &'p [Piece]) -> Result<&'p Piece, StyleError> {
        let place = format!("piece `{id}`");
        let found = called(pieces, &entry.block, self.entries.size.as_deref());
        match found.as_slice() {
            &[only] => Ok(&pieces[only]),
            [] => {
                let blocks: Vec<&str> = pieces.iter().map(|piece| piece.block.as_str()).collect();
                Err(self.unknown(place, "block", &entry.block, &blocks))
            }
            several => Err(self.contradiction(
                place,
                format!("{} pieces are called `{}`", several.len(), entry.block),
                "a name that one piece of the size has".to_owned(),
            )),
        }
    }

    fn piece(&self, id: &str, entry: &PieceEntry, drawn: &Piece) -> Result<StylePiece, StyleError> {
        let place = format!("piece `{id}`");
        let corners = self.corners(&place, entry, drawn)?;
        let (drawn, corners) = self.sewn(&place, entry, drawn, corners)?;
        let outline = drawn.seam_outline();
        // Corner ranges are sorted by their first corner. Gaps between them become unnamed edges.
        let mut ranges: Vec<CornerRange> = Vec::new();
        for (name, &[from, to]) in &entry.edges {
            if from >= corners.len() || to >= corners.len() || from == to {
                return Err(self.contradiction(
                    place,
                    format!("edge `{name}` runs from corner {from} to corner {to}"),
                    format!("two different corners of 0 to {}", corners.len().saturating_sub(1)),
                ));
            }
            let span = (to + corners.len() - from) % corners.len();
            ranges.push(CornerRange { from, span, name: Some(name.clone()) });
        }
        ranges.sort();
        let ranges = self.without_gaps(&place, ranges, corners.len())?;
        let mut edges: Vec<Edge> =
            ranges.into_iter().map(|range| cut_edge(outline, &corners, range.from, range.span, range.name)).collect();
        let mut corner_places: Vec<V2> = corners.iter().map(|&vertex| outline[vertex]).collect();
        let mut grain = drawn.grain.and_then(|[from, to]| (to - from).try_normalize(0.0)).unwrap_or_else(V2::y);
        let mut notches = drawn.notches.clone();
        if entry.mirror {
            edges.reverse();
            edges.iter_mut().for_each(mirror_edge);
            grain = mirrored(grain);
            corner_places.iter_mut().for_each(|corner| *corner = mirrored(*corner));
            for notch in &mut notches {
                notch.at = mirrored(notch.at);
                notch.angle_deg = notch.angle_deg.map(|angle| (180.0 - angle).rem_euclid(360.0));
            }
        }
        Ok(StylePiece { id: id.to_owned(), role: entry.role, edges, grain, notches, corners: corner_places })
    }

    /// Vertices of the outline.
    fn corners(&self, place: &str, entry: &PieceEntry, drawn: &Piece) -> Result<Vec<usize>, StyleError> {
        corners_of(drawn, self.entries.size.as_deref(), &entry.corners_at).map_err(|Lost { corner, away_m }| {
            let found = format!(
                "no corner {corner} of corners_at in block `{}`: the nearest is {:.0} mm away",
                drawn.block,
                mm(away_m)
            );
            self.contradiction(place.to_owned(), found, "a size of the same piece, turned as it is".to_owned())
        })
    }

    /// The piece with its sew line, and its corners as vertices of the sew line. A piece that has only a cut line gets
    /// a sew line by the allowances of the seam file.
    fn sewn<'p>(
        &self,
        place: &str,
        entry: &PieceEntry,
        drawn: &'p Piece,
        corners: Vec<usize>,
    ) -> Result<(Cow<'p, Piece>, Vec<usize>), StyleError> {
        let is_net = self.entries.allowance_mm == 0.0 && entry.allowance_mm.is_empty();
        if is_net || drawn.sew_line.is_some() {
            return Ok((Cow::Borrowed(drawn), corners));
        }
        let mut distances_m = vec![from_mm(self.entries.allowance_mm); corners.len()];
        for (name, &allowance_mm) in &entry.allowance_mm {
            let Some(&[from, to]) = entry.edges.get(name) else {
                let names: Vec<&String> = entry.edges.keys().collect();
                return Err(self.unknown(format!("{place}, allowance_mm"), "edge", name, &names));
            };
            let span = (to + corners.len() - from) % corners.len();
            (0..span).for_each(|k| distances_m[(from + k) % corners.len()] = from_mm(allowance_mm));
        }
        let mut piece = drawn.clone();
        piece.cut_at(&corners, &distances_m).map_err(|found| {
            self.contradiction(place.to_owned(), found, "an allowance that the piece has room for".to_owned())
        })?;
        let line = piece.seam_outline();
        let vertex = |place: &V2| line.iter().position(|p| (p - place).norm() < 1e-6).unwrap_or(0);
        let corners = piece.turn_points.iter().map(vertex).collect();
        Ok((Cow::Owned(piece), corners))
    }

    /// Adds unnamed ranges between those given, which are sorted by their first corner.
    fn without_gaps(
        &self,
        place: &str,
        ranges: Vec<CornerRange>,
        corners: usize,
    ) -> Result<Vec<CornerRange>, StyleError> {
        let Some(first) = ranges.first().map(|range| range.from) else {
            return Err(self.contradiction(
                place.to_owned(),
                "no edges".to_owned(),
                "at least one named edge".to_owned(),
            ));
        };
        let mut complete = Vec::new();
        for (k, range) in ranges.iter().enumerate() {
            let next = ranges.get(k + 1).map_or(first + corners, |range| range.from);
            let end = range.from + range.span;
            if end > next {
                let (name, from) = (range.name.as_deref().unwrap_or_default(), range.from);
                return Err(self.contradiction(
                    place.to_owned(),
                    format!("edge `{name}` (corners {from} to {}) overlaps the edge after it", end % corners),
                    "edges that share at most their end corners".to_owned(),
                ));
            }
            complete.push(range.clone());
            if end < next {
                complete.push(CornerRange { from: end % corners, span: next - end, name: None });
            }
        }
        Ok(complete)
    }

    fn seam(&self, entry: &SeamEntry, style: &Style) -> Result<Seam, StyleError> {
        let place = format!("seam `{}`", entry.name);
        let resolve =
            |names: &[String]| names.iter().map(|name| self.edge(&place, name, style)).collect::<Result<Vec<_>, _>>();
        let (a, b) = (resolve(&entry.a)?, resolve(&entry.b)?);
        let length = |chain: &[EdgeRef]| chain.iter().map(|&edge| style.edge(edge).line.length()).sum::<f64>();
        let (length_a, length_b) = (length(&a), length(&b));
        if a.is_empty() || b.is_empty() {
            return Err(self.contradiction(
                place,
                "a side without edges".to_owned(),
                "at least one edge a side".to_owned(),
            ));
        }
        let Some(ease_mm) = entry.ease_mm.of_size(&style.size) else {
            let accepted = format!("a size of ease_mm = {}", entry.ease_mm);
            return Err(self.contradiction(place, format!("no ease of size `{}`", style.size), accepted));
        };
        let excess = length_a - length_b - from_mm(ease_mm);
        if excess.abs() > from_mm(self.entries.length_tolerance_mm) {
            return Err(self.contradiction(
                place,
                format!("a is {:.1} mm long and b {:.1} mm", mm(length_a), mm(length_b)),
                format!(
                    "a longer than b by ease_mm = {} within length_tolerance_mm = {}",
                    ease_mm, self.entries.length_tolerance_mm
                ),
            ));
        }
        Ok(Seam { name: entry.name.clone(), a, b, b_forwards: entry.same_direction })
    }

    fn path(&self, place: &str, stretches: &[Stretch], style: &Style) -> Result<Vec<PathPart>, StyleError> {
        if stretches.is_empty() {
            return Err(self.contradiction(place.to_owned(), "an empty path".to_owned(), "edges or lines".to_owned()));
        }
        stretches
            .iter()
            .map(|stretch| match stretch {
                Stretch::Edge(name) => self.edge(place, name, style).map(PathPart::Edge),
                Stretch::Line { line: [from, to] } => {
                    let ends = [self.point(place, from, style)?, self.point(place, to, style)?];
                    if ends[0].edge.piece != ends[1].edge.piece || style.place(ends[0]) == style.place(ends[1]) {
                        return Err(self.contradiction(
                            place.to_owned(),
                            format!("a line from `{from}` to `{to}`"),
                            "two different points of one piece".to_owned(),
                        ));
                    }
                    Ok(PathPart::Line(ends))
                }
            })
            .collect()
    }

    /// Takes `piece.edge`.
    fn edge(&self, place: &str, name: &str, style: &Style) -> Result<EdgeRef, StyleError> {
        let (piece_id, edge_name) = name.split_once('.').unwrap_or((name, ""));
        let ids: Vec<&str> = style.pieces.iter().map(|piece| piece.id.as_str()).collect();
        let piece = ids.iter().position(|&id| id == piece_id);
        let piece = piece.ok_or_else(|| self.unknown(place.to_owned(), "piece", piece_id, &ids))?;
        let edges = &style.pieces[piece].edges;
        let edge = edges.iter().position(|edge| edge.name.as_deref() == Some(edge_name));
        let edge = edge.ok_or_else(|| {
            let names = edges.iter().filter_map(|edge| edge.name.as_ref()).map(|n| format!("{piece_id}.{n}"));
            self.unknown(place.to_owned(), "edge", name, &names.collect::<Vec<_>>())
        })?;
        Ok(EdgeRef { piece, edge })
    }

    /// Takes `piece.edge.start`, `.mid` or `.end`.
    fn point(&self, place: &str, name: &str, style: &Style) -> Result<EdgePoint, StyleError> {
        let (edge_name, which) = name.rsplit_once('.').unwrap_or((name, ""));
        let share = match which {
            "start" => 0.0,
            "mid" => 0.5,
            "end" => 1.0,
            _ => return Err(self.unknown(place.to_owned(), "point", name, &["EDGE.start", "EDGE.mid", "EDGE.end"])),
        };
        let edge = self.edge(place, edge_name, style)?;
        Ok(EdgePoint { edge, arc_m: share * style.edge(edge).line.length() })
    }

    fn unknown<S: AsRef<str>>(&self, place: String, what: &'static str, found: &str, existing: &[S]) -> StyleError {
        let accepted = existing.iter().map(AsRef::as_ref).collect::<Vec<_>>().join(", ");
        StyleError::Unknown { file: self.file.to_owned(), place, what, found: found.to_owned(), accepted }
    }

    fn contradiction(&self, place: String, found: String, accepted: String) -> StyleError {
        StyleError::Contradiction { file: self.file.to_owned(), place, found, accepted }
    }
}
