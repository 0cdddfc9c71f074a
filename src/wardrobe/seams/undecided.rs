//! Open questions about the seams of a size, each with its likely answers.

use crate::seams::desk::{Desk, DeskEdge, DeskPiece, DeskSeam, SURE};
use crate::seams::step::SeamStep;
use pattern::Role;
use pattern::check::{Finding, FindingKind};
use pattern::propose::Question;
use pattern::seam_edit::Edit;

/// Index of a piece, and index of an edge on it.
type EdgeAt = (usize, usize);

/// Number of partners that are offered for an edge.
const OFFERED: usize = 4;
/// Number of left-out pieces that one question asks about.
pub const LEFT_OUT: usize = 4;
/// Weight of the distance between partners, divided by the extent of all pieces. The likeliest partner has the least
/// sum of the relative difference in length, this term and the next three.
const FAR: f64 = 0.25;
/// Term for notches that do not match.
const UNNOTCHED: f64 = 0.15;
/// Term for a side of two edges instead of one.
const OF_TWO: f64 = 0.05;
/// Term for a piece that the edge's own is not sewn to ([`may_meet`]).
const OWN: f64 = 0.3;
/// Greatest difference in length between partners, as a share of the longer.
const UNLIKE: f64 = 0.4;
/// Greatest difference in place between notches that match, as a share of the edge.
const SAME_NOTCH: f64 = 0.03;

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Choice {
    pub label: String,
    pub step: SeamStep,
    pub edges: Vec<EdgeAt>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Undecided {
    pub text: String,
    pub edges: Vec<EdgeAt>,
    /// Likely answers; empty where only an edit helps.
    pub choices: Vec<Choice>,
    /// Index of the answer that counts until another is given; `None` where none does.
    pub stands: Option<usize>,
    /// Index of the seam that the question is about, if any.
    pub seam: Option<usize>,
    /// True where the answer that counts is a sure proposal.
    pub is_sure: bool,
}

impl Undecided {
    /// `drawn` are the pieces of the desk by their names in the pattern file.
    pub(crate) fn asked(desk: &Desk, drawn: &[(String, usize)], question: Question) -> Self {
        let written = question.to_string();
        let answer = |(choice, label): (usize, &String)| Choice {
            label: label.clone(),
            step: SeamStep::Answer { question: question.text.clone(), choice },
            edges: desk.edges_of(drawn, label.split(", ").map(|name| name.trim_matches('`'))),
        };
        let mut choices: Vec<Choice> = question.choices.iter().enumerate().map(answer).collect();
        if choices.is_empty() {
            let step = SeamStep::Decide(written);
            choices.push(Choice { label: "it is as it should be".to_owned(), step, edges: vec![] });
        }
        let mut edges: Vec<EdgeAt> = question.about.iter().filter_map(|name| desk.edge_of(name)).collect();
        if edges.is_empty() {
            edges = desk.edges_of(drawn, question.text.split('`').skip(1).step_by(2));
        }
        Self {
            text: question.text.clone(),
            edges,
            choices,
            stands: question.taken.or(Some(0)),
            seam: None,
            is_sure: false,
        }
    }

    /// Asks if a proposed seam is right; `None` for a seam that is confirmed or was not proposed.
    pub(crate) fn unsure(desk: &Desk, seam: usize) -> Option<Self> {
        let found = &desk.seams[seam];
        let sure = 100.0 * found.confidence?;
        let DeskSeam { name, a, b, a_mm, b_mm, .. } = found;
        let [one, other] = [a, b].map(|chain| names(desk, chain));
        let ends = || Some((desk.edge_name(*a.first()?), desk.edge_name(*b.first()?)));
        let edit = |edit: fn(String, String) -> Edit| ends().map(|(a, b)| SeamStep::Edit(edit(a, b)));
        let choice = |label: &str, step: Option<SeamStep>| {
            step.map(|step| Choice { label: label.to_owned(), step, edges: vec![] })
        };
        let choices = [
            choice("yes", Some(SeamStep::Confirm(name.clone()))),
            choice("yes, but the other way round", edit(|a, b| Edit::Flip { a, b })),
            choice("no", edit(|a, b| Edit::Remove { a, b })),
        ];
        Some(Self {
            text: format!("Is {one} sewn to {other}? {a_mm:.1} to {b_mm:.1} mm, {sure:.0} % sure"),
            edges: a.iter().chain(b).copied().collect(),
            choices: choices.into_iter().flatten().collect(),
            stands: Some(0),
            seam: Some(seam),
            is_sure: found.confidence.is_some_and(|confidence| confidence >= SURE),
        })
    }

    pub fn seam(desk: &Desk, seam: usize) -> Self {
        let DeskSeam { name, a, b, a_mm, b_mm, .. } = &desk.seams[seam];
        let [one, other] = [a, b].map(|chain| names(desk, chain));
        let ends = a.first().zip(b.first()).map(|(a, b)| (desk.edge_name(*a), desk.edge_name(*b)));
        let choices = ends.map_or_else(Vec::new, |(a, b)| {
            let flip = SeamStep::Edit(Edit::Flip { a: a.clone(), b: b.clone() });
            let open = SeamStep::Edit(Edit::Remove { a, b });
            [("it runs the other way round", flip), ("it is opened", open)]
                .map(|(label, step)| Choice { label: label.to_owned(), step, edges: vec![] })
                .to_vec()
        });
        let text = format!("What of seam {name}? {one} is sewn to {other}, {a_mm:.1} to {b_mm:.1} mm");
        Self {
            text,
            edges: a.iter().chain(b).copied().collect(),
            choices,
            stands: None,
            seam: Some(seam),
            is_sure: false,
        }
    }

    pub(crate) fn found(desk: &Desk, finding: &Finding) -> Self {
        let free = if finding.kind == FindingKind::FreeEdge { desk.edge_of(&finding.place) } else { None };
        match free {
            Some(edge) => Self::free(desk, edge),
            None => {
                let text = format!("{}: {}: {}", finding.kind.as_str(), finding.place, finding.found);
                Self { text, edges: vec![], choices: vec![], stands: None, seam: None, is_sure: false }
            }
        }
    }

    /// Asks what an edge in no seam is sewn to.
    pub fn free(desk: &Desk, edge: EdgeAt) -> Self {
        let (name, length_mm) = (desk.edge_name(edge), desk.edge(edge).length_mm);
        let sewn = |partner: Vec<EdgeAt>| {
            let partner_mm: f64 = partner.iter().map(|edge| desk.edge(*edge).length_mm).sum();
            let ease_mm = length_mm - partner_mm;
            let b = partner.iter().map(|edge| desk.edge_name(*edge)).collect::<Vec<_>>().join("+");
            Choice {
                label: format!("sewn to {}, {partner_mm:.1} mm, ease {ease_mm:+.1}", names(desk, &partner)),
                step: SeamStep::Edit(Edit::Add { a: name.clone(), b, name: None, is_eased: true }),
                edges: partner,
            }
        };
        let mut choices: Vec<Choice> = partners(desk, edge).into_iter().map(sewn).collect();
        let open = SeamStep::Edit(Edit::Open { edge: name.clone() });
        choices.push(Choice { label: "nothing: it stays open".to_owned(), step: open, edges: vec![] });
        let text = format!("What is {name} sewn to? It is {length_mm:.1} mm long and in no seam");
        Self { text, edges: vec![edge], choices, stands: None, seam: None, is_sure: false }
    }

    /// Asks for the role of a piece that nothing is sewn to.
    pub(crate) fn unsewn(desk: &Desk, piece: usize) -> Self {
        let asked = Self::piece(desk, piece);
        Self {
            text: format!("Nothing is sewn to {}. What is it worn as?", desk.pieces[piece].id),
            stands: Some(0),
            ..asked
        }
    }

    /// Asks which of the left-out pieces, from index `first` on, is worn too; `None` where no more are left out.
    pub fn left_out(desk: &Desk, first: usize) -> Option<Self> {
        let shown = desk.left_out.get(first..)?;
        let taken = |name: &String, is_pair: bool| Choice {
            label: format!("{name}{}", if is_pair { ", right and left" } else { "" }),
            step: SeamStep::Edit(Edit::TakeIn { drawn: name.clone(), is_pair }),
            edges: vec![],
        };
        let choices = shown.iter().take(LEFT_OUT).flat_map(|name| [taken(name, false), taken(name, true)]).collect();
        let text = format!("{} drawn pieces are left out. Which is worn too?", desk.left_out.len());
        let asked = Self { text, edges: vec![], choices, stands: None, seam: None, is_sure: false };
        (!shown.is_empty()).then_some(asked)
    }

    /// Asks for the role of a piece, and if it is worn at all.
    pub fn piece(desk: &Desk, piece: usize) -> Self {
        let drawn = &desk.pieces[piece];
        let role = |role: Role| Choice {
            label: role.as_str().replace('_', " "),
            step: SeamStep::Edit(Edit::Role { piece: drawn.id.clone(), role: role.as_str().to_owned() }),
            edges: vec![],
        };
        let out = Choice {
            label: "not at all: leave it out".to_owned(),
            step: SeamStep::Edit(Edit::LeaveOut { piece: drawn.id.clone() }),
            edges: vec![],
        };
        let others = roles(desk).into_iter().filter(|role| *role != drawn.role);
        Self {
            text: format!("What is {} worn as? It is {} now", drawn.id, drawn.role.as_str().replace('_', " ")),
            edges: (0..drawn.edges.len()).map(|edge| (piece, edge)).collect(),
            choices: std::iter::once(out).chain(others.map(role)).collect(),
            stands: None,
            seam: None,
            is_sure: false,
        }
    }
}

impl Desk {
    pub fn edge(&self, (piece, edge): EdgeAt) -> &DeskEdge {
        &self.pieces[piece].edges[edge]
    }

    /// Name of an edge in edits: `front.side_left`, or `front.3` for an edge without a name.
    pub fn edge_name(&self, (piece, edge): EdgeAt) -> String {
        let drawn = &self.pieces[piece].edges[edge];
        format!("{}.{}", self.pieces[piece].id, drawn.name.clone().unwrap_or_else(|| drawn.number.to_string()))
    }

    /// True if nothing is sewn to a piece and its role is not known.
    pub(crate) fn is_unsewn(&self, piece: usize) -> bool {
        let DeskPiece { role, edges, .. } = &self.pieces[piece];
        *role == Role::Other && edges.iter().all(|edge| edge.seam.is_none())
    }

    fn edges_of<'n>(&self, drawn: &[(String, usize)], names: impl Iterator<Item = &'n str>) -> Vec<EdgeAt> {
        let pieces = names.flat_map(|name| drawn.iter().filter(move |(drawn, _)| drawn == name));
        pieces.flat_map(|(_, piece)| (0..self.pieces[*piece].edges.len()).map(|edge| (*piece, edge))).collect()
    }

    pub fn open_edges(&self) -> Vec<String> {
        self.all_edges().filter(|edge| self.edge(*edge).seam.is_none()).map(|edge| self.edge_name(edge)).collect()
    }

    fn edge_of(&self, name: &str) -> Option<EdgeAt> {
        self.all_edges().find(|edge| self.edge_name(*edge) == name)
    }

    fn all_edges(&self) -> impl Iterator<Item = EdgeAt> + '_ {
        self.pieces.iter().enumerate().flat_map(|(piece, drawn)| (0..drawn.edges.len()).map(move |edge| (piece, edge)))
    }
}

/// Chain of edges in words, such as `front.armhole + back.armhole`.
fn names(desk: &Desk, chain: &[EdgeAt]) -> String {
    chain.iter().map(|edge| desk.edge_name(*edge)).collect::<Vec<_>>().join(" + ")
}

/// Sides that an edge may be sewn to, each of one or two edges in no seam, the likeliest first.
fn partners(desk: &Desk, edge: EdgeAt) -> Vec<Vec<EdgeAt>> {
    let free: Vec<EdgeAt> = desk.all_edges().filter(|at| *at != edge && desk.edge(*at).seam.is_none()).collect();
    let extent_mm = extent_mm(desk);
    let unlikely = |side: &[EdgeAt]| {
        let lengths: f64 = side.iter().map(|at| desk.edge(*at).length_mm).sum();
        let own_mm = desk.edge(edge).length_mm;
        let unlike = (lengths - own_mm).abs() / lengths.max(own_mm).max(1e-6);
        let away: f64 = side.iter().map(|at| distance_mm(desk.edge(*at), desk.edge(edge))).sum();
        let away = away / side.len() as f64 / extent_mm;
        let notched = match side {
            [sole] if !notches_match(desk.edge(edge), desk.edge(*sole)) => UNNOTCHED,
            _ => 0.0,
        };
        let two = if side.len() > 1 { OF_TWO } else { 0.0 };
        let own = if side.iter().all(|at| may_meet(desk, edge.0, at.0)) { 0.0 } else { OWN };
        (unlike <= UNLIKE).then_some(unlike + FAR * away + notched + two + own)
    };
    let pairs = free.iter().flat_map(|first| {
        free.iter()
            .filter(move |second| first.0 < second.0 || (first.0 == second.0 && first.1 + 1 == second.1))
            .map(move |second| vec![*first, *second])
    });
    let sides = free.iter().map(|edge| vec![*edge]).chain(pairs);
    let mut found: Vec<(f64, Vec<EdgeAt>)> = sides.filter_map(|side| Some((unlikely(&side)?, side))).collect();
    found.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    found.into_iter().take(OFFERED).map(|(_, side)| side).collect()
}

/// Roles to offer for a style's pieces: of trousers, of a garment with a skirt, or of a top.
fn roles(desk: &Desk) -> [Role; 8] {
    use Role::{
        Back, BodiceBack, BodiceFront, Front, LegBackLeft, LegBackRight, LegFrontLeft, LegFrontRight, LegLeft,
        LegRight, Other, SkirtBack, SkirtFront, SleeveLeft, SleeveRight, Waistband,
    };
    let has = |kind: &str| desk.pieces.iter().any(|piece| piece.role.as_str().starts_with(kind));
    if has("leg") {
        return [LegFrontRight, LegFrontLeft, LegBackRight, LegBackLeft, LegRight, LegLeft, Waistband, Other];
    }
    if has("skirt") || has("bodice") {
        return [BodiceFront, BodiceBack, SkirtFront, SkirtBack, SleeveRight, SleeveLeft, Waistband, Other];
    }
    [Front, Back, SleeveRight, SleeveLeft, SkirtFront, SkirtBack, Waistband, Other]
}

/// True if two pieces may be sewn to each other. A piece is sewn to itself only where it closes around a limb or the
/// waist, and the two sleeves are never sewn to each other.
fn may_meet(desk: &Desk, one: usize, other: usize) -> bool {
    use Role::{LegLeft, LegRight, Other, SleeveLeft, SleeveRight, Waistband};
    let [role, partner] = [one, other].map(|piece| desk.pieces[piece].role);
    if one == other {
        return matches!(role, SleeveRight | SleeveLeft | LegRight | LegLeft | Waistband | Other);
    }
    !matches!((role, partner), (SleeveRight, SleeveLeft) | (SleeveLeft, SleeveRight))
}

/// Diagonal of the bounding box of all pieces on the desk, mm.
fn extent_mm(desk: &Desk) -> f64 {
    let points = || desk.pieces.iter().flat_map(|piece| &piece.edges).flat_map(|edge| &edge.line_mm);
    let size = |k: usize| {
        let (low, high) = points().fold((f64::MAX, f64::MIN), |(low, high), p| (low.min(p[k]), high.max(p[k])));
        high - low
    };
    size(0).hypot(size(1)).max(1.0)
}

/// Distance between the midpoints.
fn distance_mm(one: &DeskEdge, other: &DeskEdge) -> f64 {
    let ([[a, b], _], [[c, d], _]) = (one.middle(), other.middle());
    (a - c).hypot(b - d)
}

/// True if two edges have as many notches, at the same shares of their lengths in either direction.
fn notches_match(one: &DeskEdge, other: &DeskEdge) -> bool {
    let shares = |edge: &DeskEdge| {
        let mut shares: Vec<f64> = edge.notches_mm.iter().map(|mm| mm / edge.length_mm.max(1e-6)).collect();
        shares.sort_by(f64::total_cmp);
        shares
    };
    let (one, other) = (shares(one), shares(other));
    let back: Vec<f64> = other.iter().rev().map(|share| 1.0 - share).collect();
    let is_same = |other: &[f64]| one.iter().zip(other).all(|(p, q)| (p - q).abs() <= SAME_NOTCH);
    one.len() == other.len() && (is_same(&other) || is_same(&back))
}

#[cfg(test)]
mod tests {
    use super::*;
    use pattern::Style;
    use pattern::draft::Model;

    fn desk(opened: &[&str]) -> Desk {
        let mut style = Style::read(&Model::Tshirt.drafts()[0].pieces, Model::Tshirt.seams(), "t").expect("our own");
        style.seams.retain(|seam| !opened.contains(&seam.name.as_str()));
        Desk::of(&style)
    }

    #[test]
    fn partners_are_offered_by_length_notches_and_place() {
        let check = |opened: &[&str], edge: &str, expect: &str| {
            let desk = desk(opened);
            let at = desk.edge_of(edge).unwrap_or_else(|| panic!("{edge}"));
            let asked = Undecided::free(&desk, at);
            assert!(asked.choices[0].label.contains(expect), "{edge}: {:?}", asked.choices);
            assert!(asked.choices.last().is_some_and(|last| last.label.contains("open")));
        };
        let names: Vec<String> = desk(&[]).seams.iter().map(|seam| seam.name.clone()).collect();
        let all: Vec<&str> = names.iter().map(String::as_str).collect();
        check(&["side_right"], "front.side_right", "sewn to back.side_right,");
        check(&all, "front.side_right", "sewn to back.side_right,");
        check(&all, "front.shoulder_left", "sewn to back.shoulder_left,");
        check(&all, "sleeve_left.cap", "armhole_left");
    }

    #[test]
    fn a_question_of_a_proposal_is_about_the_edges_and_pieces_that_it_names() {
        let desk = desk(&[]);
        let drawn = [("TEE-F".to_owned(), 1), ("TEE-SLV".to_owned(), 2), ("TEE-SLV".to_owned(), 3)];
        let check = |written: &str, edges: &[EdgeAt], of_first: &[EdgeAt]| {
            let asked = Undecided::asked(&desk, &drawn, Question::parse(written));
            assert_eq!((&asked.edges[..], &asked.choices[0].edges[..]), (edges, of_first), "{written}");
        };
        let all = |piece: usize| (0..desk.pieces[piece].edges.len()).map(|edge| (piece, edge)).collect::<Vec<_>>();
        let [one, other] = [(0, 1), (2, 0)].map(|at| (at, desk.edge_name(at)));
        let about = format!("what is sewn there? [{}, {}] a: nothing; b: ease (a is taken)", one.1, other.1);
        check(&about, &[one.0, other.0], &[]);
        check("is `TEE-F` a front? a: yes; b: no", &all(1), &[]);
        check("which is the sleeve? a: TEE-SLV; b: TEE-F", &[], &[all(2), all(3)].concat());
        check("is `TEE-POCKET` worn? [front.gone] a: `TEE-F`; b: no", &[], &all(1));
    }

    /// Number of seams between two edges, all opened, whose first edge is offered its partner first; is offered it at
    /// all; and of all such seams.
    fn offered(style: &Style) -> [usize; 3] {
        let whole = Desk::of(style);
        let opened = Desk::of(&Style { seams: vec![], ..style.clone() });
        let mut counts = [0; 3];
        for DeskSeam { a, b, .. } in &whole.seams {
            let ([one], [other]) = (a.as_slice(), b.as_slice()) else { continue };
            let asked = Undecided::free(&opened, *one);
            let place = asked.choices.iter().position(|choice| choice.edges == [*other]);
            counts[0] += usize::from(place == Some(0));
            counts[1] += usize::from(place.is_some());
            counts[2] += 1;
        }
        counts
    }

    #[test]
    fn partners_are_offered_on_foreign_patterns() {
        let folder = std::path::PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../shared/patterns/garmentcode");
        let Ok(entries) = std::fs::read_dir(&folder) else {
            return eprintln!("skipped: {} is not there", folder.display());
        };
        let mut sum = [0; 3];
        for path in
            entries.flatten().map(|entry| entry.path()).filter(|path| path.extension().is_some_and(|e| e == "json"))
        {
            let bytes = std::fs::read(&path).expect("readable");
            let Ok(read) = pattern::garmentcode::read(&bytes, "foreign") else { continue };
            let counts = offered(&read.style());
            sum = [0, 1, 2].map(|k| sum[k] + counts[k]);
        }
        eprintln!("of {} seams the other edge is offered first for {}, at all for {}", sum[2], sum[0], sum[1]);
        assert!(sum[2] == 0 || 2 * sum[1] > sum[2], "{sum:?}");
    }
}
