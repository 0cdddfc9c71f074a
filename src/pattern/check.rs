//! Checks for what a pattern and its seam file may contain by mistake: edges in no seam, unused pieces, gathers,
//! reversed seams, girths that do not close, no girth to judge the fit by, lengths that leap between sizes.

use std::collections::{BTreeMap, BTreeSet};

use super::garment::{Garment, MeasurementKind};
use super::piece::{Notch, Piece};
use super::pom::Point;
use super::seams::SeamFile;
use super::style::named::called;
use super::style::{EdgeRef, PathPart, Seam, Style};
use geom::polyline::Polyline;
use geom::units::mm;

/// Ratio of the lengths of its two sides from which a seam counts as gathered.
const GATHERED_RATIO: f64 = 1.2;
/// Greatest distance of a notch from the edge that it marks.
const ON_EDGE_M: f64 = 12e-3;
/// Least improvement of the notch match by reversing one side for a finding, as a share of the seam.
const TURNED_GAIN: f64 = 0.05;

/// Something that a person should look at.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Finding {
    pub kind: FindingKind,
    /// Name of the seam, edge, piece or measurement.
    pub place: String,
    pub found: String,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum FindingKind {
    /// Edge in no seam, with no measurement along it, and not listed as `open`.
    FreeEdge,
    UnusedPiece,
    Gathered,
    /// One side seems to run in the wrong direction.
    Direction,
    /// Measurement called `closed_girth` that does not close, or `open_length` that closes.
    Loop,
    /// No girth at chest or hip, so that no size can be judged on a body.
    FitLevel,
    /// Length that breaks the progression of the sizes.
    Leap,
}

impl FindingKind {
    pub fn as_str(self) -> &'static str {
        match self {
            Self::FreeEdge => "free edge",
            Self::UnusedPiece => "unused piece",
            Self::Gathered => "gathered",
            Self::Direction => "direction",
            Self::Loop => "loop",
            Self::FitLevel => "fit level",
            Self::Leap => "leap",
        }
    }

    /// True if an edit of the seam file can settle the finding.
    pub fn is_of_seams(self) -> bool {
        !matches!(self, Self::Gathered | Self::FitLevel | Self::Leap)
    }
}

pub fn findings(pieces: &[Piece], entries: &SeamFile, style: &Style) -> Vec<Finding> {
    let is_left_out = |piece: &Piece| Finding {
        kind: FindingKind::UnusedPiece,
        place: piece.name.clone(),
        found: "drawn, but the seam file does not name it".to_owned(),
    };
    let mut findings: Vec<Finding> = unused(pieces, entries).into_iter().map(is_left_out).collect();
    findings.extend(style.seams.iter().filter_map(|seam| gathered(style, seam)));
    findings.extend(style.seams.iter().filter_map(|seam| turned(style, seam)));
    let sewn: BTreeSet<EdgeRef> = style.seams.iter().flat_map(|seam| seam.a.iter().chain(&seam.b)).copied().collect();
    let measured: BTreeSet<EdgeRef> = style.measurements.iter().flat_map(|m| edges_of(&m.path)).collect();
    for (piece, worn) in style.pieces.iter().enumerate() {
        for (edge, line) in worn.edges.iter().enumerate() {
            let edge = EdgeRef { piece, edge };
            let is_meant = measured.contains(&edge) || entries.open.contains(&style.edge_name(edge));
            if !sewn.contains(&edge) && !is_meant {
                findings.push(Finding {
                    kind: FindingKind::FreeEdge,
                    place: style.edge_name(edge),
                    found: format!("{:.1} mm in no seam", mm(line.line.length())),
                });
            }
        }
    }
    findings
}

fn edges_of(path: &[PathPart]) -> impl Iterator<Item = EdgeRef> {
    path.iter().filter_map(|part| match *part {
        PathPart::Edge(edge) => Some(edge),
        PathPart::Line(_) => None,
    })
}

/// Measurements that close or not against their kind, and a missing girth at chest and hip.
pub fn of_garment(style: &Style, garment: &Garment) -> Vec<Finding> {
    let welded = welded(garment);
    let mut findings = Vec::new();
    for measurement in &garment.measurements {
        // In a closed loop every end of a run coincides with the end of another run.
        let mut ends: BTreeMap<usize, usize> = BTreeMap::new();
        for point in measurement.runs.iter().flat_map(|run| [run.points.first(), run.points.last()]).flatten() {
            let heaviest = (0..3).max_by(|&i, &j| point.weights[i].total_cmp(&point.weights[j])).unwrap_or(0);
            *ends.entry(welded[point.vertices[heaviest]]).or_default() += 1;
        }
        let is_loop = ends.values().all(|count| count % 2 == 0);
        if is_loop != (measurement.kind == MeasurementKind::ClosedGirth) {
            let found = if is_loop {
                "called open_length, but it closes"
            } else {
                "called closed_girth, but its ends do not meet"
            };
            findings.push(Finding {
                kind: FindingKind::Loop,
                place: format!("measurement {}", measurement.no),
                found: found.to_owned(),
            });
        }
    }
    let is_stated = style.fit_levels.iter().any(|(level, _)| ["chest", "hip"].contains(&level.as_str()));
    let is_found =
        || style.points_of_measure().iter().any(|measure| matches!(measure.point, Point::HalfChest | Point::HalfHip));
    if !is_stated && !is_found() {
        let found =
            "no girth at chest or hip: its pieces' roles show none, and neither [fit.chest] nor [fit.hip] says it"
                .to_owned();
        findings.push(Finding { kind: FindingKind::FitLevel, place: garment.name.clone(), found });
    }
    findings
}

/// Smallest index among the vertices that seams join to each vertex, directly or through others.
fn welded(garment: &Garment) -> Vec<usize> {
    let mut least: Vec<usize> = (0..garment.rest.len()).collect();
    let pairs = || garment.seams.iter().flat_map(|seam| &seam.pairs);
    // The number of rounds is that of the seams that meet in one point, so it is small.
    loop {
        let before = least.clone();
        for &[a, b] in pairs() {
            let both = least[a].min(least[b]);
            (least[a], least[b]) = (both, both);
        }
        if before == least {
            return least;
        }
    }
}

pub(super) fn unused<'p>(pieces: &'p [Piece], entries: &SeamFile) -> Vec<&'p Piece> {
    let made_on = entries.size.as_deref();
    let used: BTreeSet<usize> =
        entries.piece.values().flat_map(|entry| called(pieces, &entry.block, made_on)).collect();
    pieces.iter().enumerate().filter(|(index, _)| !used.contains(index)).map(|(_, piece)| piece).collect()
}

fn length(style: &Style, chain: &[EdgeRef]) -> f64 {
    chain.iter().map(|&edge| style.edge(edge).line.length()).sum()
}

fn gathered(style: &Style, seam: &Seam) -> Option<Finding> {
    let (a, b) = (length(style, &seam.a), length(style, &seam.b));
    let ratio = (a / b).max(b / a);
    (ratio > GATHERED_RATIO).then(|| Finding {
        kind: FindingKind::Gathered,
        place: seam.name.clone(),
        found: format!("{:.1} mm to {:.1} mm, ratio {ratio:.2}", mm(a), mm(b)),
    })
}

/// Outlines are counter-clockwise, so the sides of a seam must run in opposite directions. If they do, one side still
/// seems reversed where the notches match better that way.
fn turned(style: &Style, seam: &Seam) -> Option<Finding> {
    let found = if seam.b_forwards {
        "both sides run counter-clockwise: one of the pieces is sewn inside out".to_owned()
    } else {
        let a = notch_shares(style, &seam.a, true);
        let b = notch_shares(style, &seam.b, false);
        let turned: Vec<f64> = b.iter().rev().map(|share| 1.0 - share).collect();
        let worst = |shares: &[f64]| a.iter().zip(shares).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        if a.is_empty() || a.len() != b.len() || worst(&turned) + TURNED_GAIN > worst(&b) {
            return None;
        }
        format!("{} notches a side match better with b turned round", a.len())
    };
    Some(Finding { kind: FindingKind::Direction, place: seam.name.clone(), found })
}

/// In the direction of sewing, as shares of its length.
fn notch_shares(style: &Style, chain: &[EdgeRef], is_forwards: bool) -> Vec<f64> {
    let total = length(style, chain);
    let mut shares = Vec::new();
    let mut before = 0.0;
    for &edge in chain {
        let line = &style.edge(edge).line;
        let on_edge = style.pieces[edge.piece].notches.iter().filter_map(|notch| arc_of(line, notch));
        let along = |arc: f64| if is_forwards { arc } else { line.length() - arc };
        shares.extend(on_edge.map(|arc| (before + along(arc)) / total));
        before += line.length();
    }
    shares.sort_by(f64::total_cmp);
    shares
}

/// Arc length of the vertex nearest to a notch, m. `None` if that vertex is an end of the edge, or the notch lies on
/// another edge.
fn arc_of(line: &Polyline, notch: &Notch) -> Option<f64> {
    let distance = |i: &usize| (line.points()[*i] - notch.at).norm();
    let nearest = (0..line.points().len()).min_by(|i, j| distance(i).total_cmp(&distance(j)))?;
    let is_end = nearest == 0 || nearest + 1 == line.points().len();
    (distance(&nearest) < ON_EDGE_M && !is_end).then(|| line.arcs()[nearest])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draft::{TSHIRT_SEAMS, TshirtSize, tshirt};

    fn of(edit: impl Fn(&str) -> String) -> Vec<Finding> {
        let text = edit(std::str::from_utf8(TSHIRT_SEAMS).expect("it is UTF-8"));
        let pieces = tshirt(TshirtSize::S).pieces;
        let style = Style::read(&pieces, text.as_bytes(), "a.toml").expect("it is a style");
        findings(&pieces, &toml::from_str(&text).expect("it reads"), &style)
    }

    #[test]
    fn edges_that_are_neither_sewn_nor_measured_nor_open_are_found() {
        let places = |edit: &dyn Fn(&str) -> String| {
            let found = of(edit);
            assert!(found.iter().all(|finding| finding.kind == FindingKind::FreeEdge), "{found:?}");
            found.into_iter().map(|finding| finding.place).collect::<Vec<_>>()
        };
        assert!(places(&str::to_owned).is_empty());
        assert_eq!(places(&|text| text.replace("open = [\"sleeve_left.opening\"]", "")), ["sleeve_left.opening"]);
        // The seam goes; only one of its edges is measured.
        let seam = "[[seam]]\nname = \"side_right\"\na = [\"front.side_right\"]\nb = [\"back.side_right\"]\n";
        assert_eq!(places(&|text| text.replace(seam, "")), ["back.side_right"]);
    }

    #[test]
    fn girths_close_and_lengths_do_not() {
        for model in crate::draft::Model::ALL {
            for draft in model.drafts() {
                let style = Style::read(&draft.pieces, model.seams(), "a.toml").expect("it is a style");
                assert_eq!(of_garment(&style, &style.mesh(30e-3).expect("it meshes")), [], "{model:?}");
            }
        }
        let text = std::str::from_utf8(TSHIRT_SEAMS).expect("it is UTF-8").replacen("closed_girth", "open_length", 1);
        let text = text.replacen("[fit.chest]", "[fit.waist]", 1).replace(", \"back.neck\"]", "]");
        // Without its role, nothing tells where the chest is.
        let text = text.replace("role = \"front\"", "role = \"other\"");
        let style = Style::read(&tshirt(TshirtSize::S).pieces, text.as_bytes(), "a.toml").expect("it is a style");
        let found = of_garment(&style, &style.mesh(30e-3).expect("it meshes"));
        let told: Vec<(FindingKind, &str)> = found.iter().map(|f| (f.kind, f.place.as_str())).collect();
        let expect = [
            (FindingKind::Loop, "measurement 1"),
            (FindingKind::Loop, "measurement 6"),
            (FindingKind::FitLevel, "Mens T-shirt"),
        ];
        assert_eq!(told, expect);
    }

    #[test]
    fn a_seam_turned_round_and_a_piece_left_out_are_found() {
        let turned = of(|text| {
            text.replacen("b = [\"back.shoulder_right\"]", "b = [\"back.shoulder_right\"]\nsame_direction = true", 1)
        });
        let directions: Vec<&Finding> = turned.iter().filter(|f| f.kind == FindingKind::Direction).collect();
        assert!(directions.len() == 1 && directions[0].place == "shoulder_right", "{directions:?}");
        let mut pieces = tshirt(TshirtSize::S).pieces;
        let style = Style::read(&pieces, TSHIRT_SEAMS, "a.toml").expect("it is a style");
        let entries = toml::from_str(std::str::from_utf8(TSHIRT_SEAMS).expect("it is UTF-8")).expect("it reads");
        let collar = Piece { block: "COLLAR".to_owned(), name: "COLLAR".to_owned(), ..pieces[0].clone() };
        pieces.push(collar);
        let found = findings(&pieces, &entries, &style);
        let unused: Vec<&Finding> = found.iter().filter(|f| f.kind == FindingKind::UnusedPiece).collect();
        assert!(unused.len() == 1 && unused[0].place == "COLLAR", "{unused:?}");
    }
}
