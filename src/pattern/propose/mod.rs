//! Proposal of a seam file for the pieces of one size: kind of each piece, and seams.
//!
//! Names are read first (`told`, `names`). The outline of every piece is aligned with templates (`align`), which labels
//! its edges. Then matching edges are sewn (`sew`), and equal lengths raise the confidence in the pieces (`agree`).
//! Where that leaves a piece or a seam out, and every piece is drawn, seams are found by evidence (`evident`).
//! Every piece and seam has a confidence, and each doubt becomes a question to the user.

mod agree;
mod align;
mod ask;
mod cap;
mod choose;
mod circle_skirt;
mod collar;
mod cutting;
mod details;
mod doubt;
mod drawn_dart;
mod evident;
mod faces;
#[cfg(test)]
mod garment_tests;
mod gore;
#[cfg(test)]
mod kind_tests;
mod lengths;
#[cfg(test)]
mod name_tests;
mod nest;
mod notched;
mod panels;
mod pose;
mod raglan;
mod recognise;
mod recognised;
mod seam_kind;
mod sew;
mod shape;
mod templates;
#[cfg(test)]
mod tests;
mod told;
mod waist;
mod wear;
mod worn_pieces;
mod write;

use std::collections::BTreeSet;

pub use self::ask::{Answers, Question, UnknownAnswer};
use self::ask::{Asked, Asker};
use self::evident::Evident;
pub(super) use self::pose::{Pose, named_face_and_hand, pose};
use self::recognise::Reading;
use self::recognised::Recognised;
pub use self::seam_kind::SeamKind;
pub use self::wear::Unwearable;
use self::worn_pieces::Worn;
use super::garment::Role;
use super::piece::Piece;
use super::seams::SeamEntry;
use super::style::named::reference;
use super::trade::{self, Named, PartName};
pub use super::trade::{Class, Face, Hand};

/// Least share of the outlines that is sure for a proposal by evidence to be taken where rules leave questions.
const LEAST_SURETY: f64 = 0.3;

/// Least gain in [`Sewn::worth`] for a less likely reading of the pieces to be taken: about one seam.
const SURER: f64 = 1.0;

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Label {
    /// Free lower edge, or the lower edge of a bodice.
    Hem,
    Side,
    /// Seam between a side panel and the panel in the middle.
    Princess,
    /// Of a raglan, the whole edge up to the neck.
    Armhole,
    Shoulder,
    /// From shoulder to shoulder or to the centre.
    Neck,
    Centre,
    /// Upper edge of a skirt or leg.
    Waist,
    Outseam,
    Inseam,
    /// Seat seam, from the waist to the fork.
    Crotch,
    /// Edge of a sleeve that meets the armhole. Of a raglan sleeve, either edge beside its neck.
    Cap,
    /// Lower lengthwise edge of a sleeve.
    Underarm,
    /// Upper lengthwise edge of half a sleeve.
    Top,
    Lower,
    End,
}

impl Label {
    fn as_str(self) -> &'static str {
        match self {
            Self::Hem => "hem",
            Self::Side => "side",
            Self::Princess => "princess",
            Self::Armhole => "armhole",
            Self::Shoulder => "shoulder",
            Self::Neck => "neck",
            Self::Centre => "centre",
            Self::Waist => "waist",
            Self::Outseam => "outseam",
            Self::Inseam => "inseam",
            Self::Crotch => "crotch",
            Self::Cap => "cap",
            Self::Underarm => "underarm",
            Self::Top => "top",
            Self::Lower => "lower",
            Self::End => "end",
        }
    }
}

/// `is_bodice` is true if something is sewn to the lower edge of the trunk.
fn role_of(class: Option<Class>, face: Option<Face>, hand: Option<Hand>, is_bodice: bool) -> Role {
    match (class, face, hand) {
        // A panel between front and back is placed with the front.
        (Some(Class::Body | Class::SidePanel) | None, Some(Face::Front), _) | (Some(Class::SidePanel), None, _) => {
            if is_bodice {
                Role::BodiceFront
            } else {
                Role::Front
            }
        }
        (Some(Class::Body | Class::SidePanel) | None, Some(Face::Back), _) => {
            if is_bodice {
                Role::BodiceBack
            } else {
                Role::Back
            }
        }
        (Some(Class::Sleeve), _, Some(Hand::Right)) => Role::SleeveRight,
        (Some(Class::Sleeve), _, Some(Hand::Left)) => Role::SleeveLeft,
        (Some(Class::Leg), Some(Face::Front), Some(Hand::Right)) => Role::LegFrontRight,
        (Some(Class::Leg), Some(Face::Front), Some(Hand::Left)) => Role::LegFrontLeft,
        (Some(Class::Leg), Some(Face::Back), Some(Hand::Right)) => Role::LegBackRight,
        (Some(Class::Leg), Some(Face::Back), Some(Hand::Left)) => Role::LegBackLeft,
        (Some(Class::Leg), None, Some(Hand::Right)) => Role::LegRight,
        (Some(Class::Leg), None, Some(Hand::Left)) => Role::LegLeft,
        (Some(Class::Skirt), Some(Face::Front), _) => Role::SkirtFront,
        (Some(Class::Skirt), Some(Face::Back), _) => Role::SkirtBack,
        (Some(Class::Waistband), ..) => Role::Waistband,
        _ => Role::Other,
    }
}

/// Statements of the names and texts of the pieces.
pub fn named(pieces: &[Piece]) -> Vec<Named> {
    told::told(pieces).into_iter().map(told::Told::all).collect()
}

pub(super) fn said(name: &str) -> Named {
    trade::read(name)
}

pub(super) fn roles(named: &[Named]) -> Vec<Role> {
    let is_below = |named: &Named| matches!(named.class, Some(Class::Skirt | Class::Leg | Class::Waistband));
    let is_bodice = named.iter().any(is_below);
    named.iter().map(|named| role_of(named.class, named.face, named.hand, is_bodice)).collect()
}

#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct ProposedPiece {
    /// Identifier in the seam file. `None` for a piece in no seam.
    pub id: Option<String>,
    pub name: String,
    /// `None` if the piece was not recognised.
    pub class: Option<Class>,
    pub face: Option<Face>,
    /// `None` for a piece on both sides.
    pub hand: Option<Hand>,
    /// From 0 (guessed) to 1 (certain).
    pub confidence: f64,
}

#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct ProposedSeam {
    #[serde(flatten)]
    pub entry: SeamEntry,
    #[serde(skip)]
    pub kind: SeamKind,
    pub a_mm: f64,
    pub b_mm: f64,
    /// From 0 (guessed) to 1 (certain).
    pub confidence: f64,
}

impl ProposedSeam {
    /// Ratio of the lengths of `a` and `b`: 1 for a plain seam, more if `a` is eased or gathered.
    pub fn ratio(&self) -> f64 {
        self.a_mm / self.b_mm
    }
}

#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Proposal {
    /// In the order of the file. A piece that is cut twice occurs twice.
    pub pieces: Vec<ProposedPiece>,
    /// Surest first of each kind.
    pub seams: Vec<ProposedSeam>,
    /// Edges that are proposed to stay free: hems, necklines, armholes without a sleeve, waists without a band.
    pub open: Vec<String>,
    pub questions: Vec<Question>,
    /// Notes on what was left out or assumed without a question.
    pub notes: Vec<String>,
    /// Size that the proposal was made on. `None` if it was checked against no other size.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub size: Option<String>,
    /// Seam allowance that was added to the pieces.
    #[serde(skip)]
    pub allowance_m: f64,
    #[serde(skip)]
    made: Made,
    #[serde(skip)]
    worn: Vec<Worn>,
    /// Texts of the questions that are to be answered before anything is draped.
    #[serde(skip)]
    unsettled: Vec<String>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Made {
    ByRules,
    ByEvidence,
}

impl Proposal {
    pub fn is_empty(&self) -> bool {
        self.worn.is_empty()
    }
}

/// Proposes a seam file for the pieces of one size, half pieces unfolded ([`super::dxf::PatternFile::to_sew`]).
pub fn propose(pieces: &[Piece]) -> Proposal {
    propose_told(pieces, &Answers::new())
}

/// Proposes as [`propose`] does, with answers of the user. Answers to questions that are not asked are ignored.
pub fn propose_told(pieces: &[Piece], answers: &Answers) -> Proposal {
    let mut proposal = with_answers(pieces, answers);
    ask::number(&mut proposal.questions, &mut Vec::new());
    proposal
}

/// Proposes as [`propose`] does, with answers of the user in the order given, each as number of the question and letter
/// of the choice. Questions that an answer raises are numbered after the earlier ones.
pub fn propose_answered(pieces: &[Piece], given: &[(usize, char)]) -> Result<Proposal, UnknownAnswer> {
    let (mut answers, mut known) = (Answers::new(), Vec::new());
    let mut proposal = with_answers(pieces, &answers);
    ask::number(&mut proposal.questions, &mut known);
    for &(number, letter) in given {
        let unknown = |accepted: String| UnknownAnswer { number, letter, accepted };
        let of_number = |question: &&Question| question.number == number;
        let Some(question) = proposal.questions.iter().find(of_number) else {
            let numbers: Vec<String> = proposal.questions.iter().map(|question| question.number.to_string()).collect();
            return Err(unknown(format!("a question of {}", numbers.join(", "))));
        };
        let choice = (0..question.choices.len()).find(|&choice| Question::letter(choice) == letter);
        let choice = choice.ok_or_else(|| unknown(question.to_string()))?;
        answers.insert(question.text.clone(), choice);
        proposal = with_answers(pieces, &answers);
        ask::number(&mut proposal.questions, &mut known);
    }
    Ok(proposal)
}

struct Sewn {
    reading: Reading,
    worn: Vec<Worn>,
    seams: Vec<ProposedSeam>,
}

impl Sewn {
    /// Sum of the confidences of the seams, less one for each missing seam.
    fn worth(&self) -> f64 {
        let sum: f64 = self.seams.iter().map(|seam| seam.confidence).sum();
        sum - wear::lacking(&self.worn, &self.seams).len() as f64
    }
}

/// Reading of the pieces with the greatest worth, made without asking.
fn best_sewn(pieces: &[Piece], named: &[Named], asker: &Asker<'_>) -> Sewn {
    let ways = Reading::ways(pieces, named);
    let (&first, rest) = ways.split_first().expect("there is always one way");
    let surer = |best: Sewn, &way: &Reading| {
        let found = sewn(pieces, named, way, asker);
        if found.worth() > best.worth() + SURER { found } else { best }
    };
    rest.iter().fold(sewn(pieces, named, first, asker), surer)
}

fn sewn(pieces: &[Piece], named: &[Named], reading: Reading, asker: &Asker<'_>) -> Sewn {
    let recognised = recognise::recognise(pieces, named, reading, &mut asker.aside());
    let chosen = choose::choose(pieces, recognised, &mut asker.aside());
    let worn = worn_pieces::worn(pieces, &chosen, None, &mut asker.aside());
    let seams = sew::sew(&worn, &mut asker.aside());
    Sewn { reading, worn, seams }
}

/// Leaves out pieces that an answer dismisses, and reads the rest again.
fn with_answers(pieces: &[Piece], answers: &Answers) -> Proposal {
    let (mut dismissed, mut settled) = (BTreeSet::new(), Vec::new());
    loop {
        let (mut proposal, dismissing) = without(pieces, answers, &dismissed);
        if dismissing.is_empty() {
            let is_new = |question: &Question| proposal.questions.iter().all(|asked| asked.text != question.text);
            let kept: Vec<Question> = settled.into_iter().filter(is_new).collect();
            proposal.questions.splice(0..0, kept);
            return proposal;
        }
        settled.extend(proposal.questions.into_iter().filter(|question| question.is_answered));
        dismissed.extend(dismissing);
    }
}

fn left_out(pieces: &[Piece], is_it: impl Fn(usize) -> bool, why: &str) -> Option<String> {
    let mut listed: Vec<String> =
        (0..pieces.len()).filter(|&k| is_it(k)).map(|k| format!("`{}`", pieces[k].name)).collect();
    listed.dedup();
    (!listed.is_empty()).then(|| format!("left out: {}: {why}", listed.join(", ")))
}

/// Proposal without the pieces that the user dismissed, and the pieces that an answer dismisses besides.
fn without(pieces: &[Piece], answers: &Answers, dismissed: &BTreeSet<usize>) -> (Proposal, BTreeSet<usize>) {
    let mut asker = Asker::new(answers, dismissed.clone());
    let mut told = told::told(pieces);
    for &piece in dismissed {
        told[piece].own.class = Some(Class::Other);
    }
    let (named, reading) = doubt::settled(pieces, &told, &mut asker);
    let (details, is_spare) = (details::details(pieces, &named), details::spares(pieces));
    let mut notes: Vec<String> = Vec::new();
    let is_plain = |k: usize| details[k] && !is_spare[k] && !dismissed.contains(&k);
    let recognised = recognise::recognise(pieces, &named, reading, &mut asker);
    let mut recognised = choose::choose(pieces, recognised, &mut asker);
    lengths::settle(pieces, &mut recognised, &asker);
    let recognised = collar::sewn(pieces, &named, recognised, is_plain, &mut asker);
    let is_left = |k: usize| is_plain(k) && recognised.iter().all(|found| found.piece != k);
    notes.extend(left_out(pieces, is_left, "by their names or their size details that a drape does without"));
    notes.extend(left_out(pieces, |k| is_spare[k], "their quantity is 0: alternatives that are not cut"));
    // The notches of a sleeve tell for which arm it is drawn, once they are compared with those of the armhole.
    let first = worn_pieces::worn(pieces, &recognised, None, &mut asker.aside());
    let drawn = notched::drawn_sleeve(&first).or_else(|| cap::drawn_sleeve(&recognised, &mut notes));
    let drawn = drawn.or_else(|| worn_pieces::ask_drawn_sleeve(pieces, &recognised, &mut asker));
    let worn = worn_pieces::worn(pieces, &recognised, drawn, &mut asker);
    let is_worn = |k: &usize| worn.iter().any(|worn| worn.piece == *k);
    for k in (0..pieces.len()).filter(is_worn) {
        drawn_dart::doubt(&reference(pieces, k), &pieces[k]).into_iter().for_each(|doubt| asker.tell(doubt));
    }
    let fitted = sew::sew(&worn, &mut asker.aside());
    let worn = agree::assured(worn, &fitted);
    let seams = sew::sew(&worn, &mut asker);
    let is_part = |k: usize| named[k].class == Some(Class::Other) && named[k].part != Some(PartName::Neck);
    let may_be_worn = |k: usize| !is_part(k) && !is_spare[k] && !dismissed.contains(&k);
    let is_read = (0..pieces.len()).all(|k| !may_be_worn(k) || worn.iter().any(|worn| worn.piece == k));
    let is_told = is_read && wear::is_closed(&worn, &seams);
    let evident = (!is_told && evident::is_drawn_whole(pieces, may_be_worn)).then(|| {
        let mut aside = asker.aside();
        (evident::evident(pieces, &named, may_be_worn, &mut aside), aside)
    });
    let sure = evident.and_then(|(evident, aside)| Some((evident.filter(|it| it.surety > LEAST_SURETY)?, aside)));
    if let Some((evident, aside)) = sure {
        let Asked { mut questions, dismissing, unsettled } = aside.into_asked();
        let Evident { worn, seams, open, asked, .. } = evident;
        for (text, edge) in asked {
            let about = questions.iter_mut().filter(|question| question.text == text);
            about.for_each(|question| question.about.extend(edge.clone()));
        }
        let spare = left_out(pieces, |k| is_spare[k], "their quantity is 0: alternatives that are not cut");
        let parts = left_out(pieces, |k| is_part(k) && !is_spare[k] && !dismissed.contains(&k), "by their names");
        let dismissed = left_out(pieces, |k| dismissed.contains(&k), "so it was answered");
        let notes = [parts, spare, dismissed].into_iter().flatten().collect();
        let pieces = listed(pieces, &[], &worn);
        let made = Made::ByEvidence;
        return (
            Proposal { pieces, seams, open, questions, notes, size: None, allowance_m: 0.0, made, worn, unsettled },
            dismissing,
        );
    }
    let Asked { questions, dismissing, unsettled } = asker.into_asked();
    let open = sew::open(&worn, &seams);
    let pieces = listed(pieces, &recognised, &worn);
    let proposal = Proposal {
        pieces,
        seams,
        open,
        questions,
        notes,
        size: None,
        allowance_m: 0.0,
        made: Made::ByRules,
        worn,
        unsettled,
    };
    (proposal, dismissing)
}

fn listed(pieces: &[Piece], recognised: &[Recognised], worn: &[Worn]) -> Vec<ProposedPiece> {
    let mut listed: Vec<ProposedPiece> = Vec::new();
    for (index, piece) in pieces.iter().enumerate() {
        let recognised = recognised.iter().find(|found| found.piece == index);
        let of_this: Vec<_> = worn.iter().filter(|worn| worn.piece == index).collect();
        let plain = ProposedPiece {
            id: None,
            name: piece.name.clone(),
            class: recognised.map(|found| found.class),
            face: recognised.and_then(|found| found.face),
            hand: recognised.and_then(|found| found.hand),
            confidence: recognised.map_or(0.0, |found| found.confidence),
        };
        if of_this.is_empty() {
            listed.push(plain.clone());
        }
        listed.extend(of_this.iter().map(|worn| ProposedPiece {
            id: Some(worn.id.clone()),
            name: plain.name.clone(),
            class: Some(worn.class),
            face: worn.face,
            hand: worn.hand,
            confidence: worn.confidence,
        }));
    }
    listed
}
