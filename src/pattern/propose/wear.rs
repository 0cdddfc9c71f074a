//! Part of a proposal that can be draped without questions: pieces with uncertain seams are left out, and the rest must
//! be closed on the body.

use super::worn_pieces::Worn;
use super::{Class, Face, Hand, Label, Made, Proposal, ProposedPiece, ProposedSeam, Question, SeamKind, sew};

/// Least confidence of a seam that is sewn without a question.
const SURE: f64 = 0.4;

/// Kinds of pieces that can be left out, the outermost first.
const SPARED: [Class; 3] = [Class::Cuff, Class::Waistband, Class::Sleeve];

/// The certain part of a proposal is not closed on the body.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("how it is sewn is not sure enough: {reason}")]
pub struct Unwearable {
    pub reason: String,
}

impl Proposal {
    /// Part of the proposal that can be draped without questions. Bands, cuffs and sleeves with uncertain seams, and
    /// pieces that are sewn to nothing, are left out on both sides alike, each with a note. Fails where the rest is not
    /// closed, or where it is to be said first what a wide piece is that would be left out.
    pub fn to_drape(&self) -> Result<Self, Unwearable> {
        let mut left = self.clone();
        while let Some((class, reason)) = left.loose().filter(|_| self.made == Made::ByRules) {
            left.leave_out(class, &reason);
        }
        let missing = left.missing();
        if missing.is_empty() && left.unsettled.is_empty() {
            return Ok(left);
        }
        let reason = missing
            .into_iter()
            .chain(left.questions.iter().map(Question::to_string))
            .chain(left.notes)
            .collect::<Vec<_>>()
            .join("; ");
        Err(Unwearable { reason })
    }

    /// Outermost kind of piece that is not attached with certainty and can be left out, with the reason.
    fn loose(&self) -> Option<(Class, String)> {
        let pieces_of = |class: Class| self.pieces.iter().filter(move |piece| piece.class == Some(class));
        let spared = SPARED.into_iter().flat_map(pieces_of);
        let mut of_seams = spared.filter_map(|piece| {
            let id = piece.id.as_deref()?;
            let own = self.seams.iter().filter(|seam| touches(seam, id));
            let unsure = own.clone().find(|seam| !is_sure(seam));
            let is_held = own.clone().any(|seam| self.is_hold(seam, piece.class));
            // Halves of a sleeve that are not joined hang open.
            let is_open = piece.class == Some(Class::Sleeve) && piece.face.is_some() && {
                let lengthwise =
                    |seam: &ProposedSeam| matches!(seam.kind, SeamKind::SleeveTop(_) | SeamKind::SleeveUnderarm(_));
                own.clone().filter(|seam| lengthwise(seam)).count() < 2
            };
            let reason = match unsure {
                None if is_open => "its halves are not joined".to_owned(),
                Some(seam) => format!("seam {} is not sure", seam.kind),
                None if !is_held => "what it is sewn to was not found".to_owned(),
                None => return None,
            };
            Some((piece.class?, reason))
        });
        of_seams.next()
    }

    fn is_hold(&self, seam: &ProposedSeam, class: Option<Class>) -> bool {
        let class_of =
            |id: &str| self.pieces.iter().find(|piece| piece.id.as_deref() == Some(id)).and_then(|piece| piece.class);
        ids(seam).any(|id| class_of(id) != class)
    }

    fn leave_out(&mut self, class: Class, reason: &str) {
        // Left and right sleeves go together, as do both halves of a waistband.
        let gone = |piece: &ProposedPiece| piece.class == Some(class);
        let ids_gone: Vec<String> =
            self.pieces.iter().filter(|piece| gone(piece)).filter_map(|piece| piece.id.clone()).collect();
        let mut names: Vec<String> = self
            .pieces
            .iter()
            .filter(|piece| gone(piece) && piece.id.is_some())
            .map(|p| format!("`{}`", p.name))
            .collect();
        names.dedup();
        self.notes.push(format!("left out: {}: {reason}", names.join(", ")));
        let is_gone = |id: &str| ids_gone.iter().any(|gone| gone == id);
        self.seams.retain(|seam| !ids(seam).any(is_gone));
        self.worn.retain(|worn| !is_gone(&worn.id));
        let was_open = |edge: &String| !edge.split_once('.').is_some_and(|(id, _)| is_gone(id));
        self.open.retain(was_open);
        for piece in self.pieces.iter_mut().filter(|piece| piece.id.as_deref().is_some_and(is_gone)) {
            piece.id = None;
        }
    }

    fn missing(&self) -> Vec<String> {
        let mut missing: Vec<String> = self
            .seams
            .iter()
            .filter(|seam| !is_sure(seam))
            .map(|seam| format!("is {} sewn to {}?", seam.entry.a.join(" "), seam.entry.b.join(" ")))
            .collect();
        if self.seams.is_empty() {
            missing.push("no seams were found".to_owned());
            return missing;
        }
        match self.made {
            Made::ByRules => missing.extend(lacking(&self.worn, &self.seams)),
            Made::ByEvidence => missing.extend(apart(&self.worn, &self.seams)),
        }
        missing
    }
}

/// True if every seam is sure and none is missing.
pub fn is_closed(worn: &[Worn], seams: &[ProposedSeam]) -> bool {
    seams.iter().all(is_sure) && lacking(worn, seams).is_empty()
}

/// Remarks on what keeps pieces from closing on the body: missing seams, and a piece that is sewn to nothing.
pub fn lacking(worn: &[Worn], seams: &[ProposedSeam]) -> Vec<String> {
    let needed = needed(worn);
    let not_sewn = needed.iter().filter(|kind| !seams.iter().any(|seam| seam.kind == **kind));
    not_sewn.map(|kind| format!("the seam {kind} was not found")).chain(apart(worn, seams)).collect()
}

fn needed(worn: &[Worn]) -> Vec<SeamKind> {
    let has = |class: Class| worn.iter().any(|worn| worn.class == class);
    let has_edge = |label: Label| worn.iter().any(|worn| worn.has(label));
    let has_shoulder = has_edge(Label::Shoulder);
    // At the top of a raglan, nothing else joins front and back.
    let is_raglan = !has_shoulder && has(Class::Body) && has_edge(Label::Neck);
    let skirts_round = worn.iter().filter(|worn| worn.class == Class::Skirt && worn.face.is_none()).count();
    let mut needed = Vec::new();
    for hand in Hand::BOTH {
        if has(Class::Body) {
            let is_between = |worn: &&Worn| worn.class == Class::SidePanel && worn.face.is_none();
            match worn.iter().filter(is_between).any(|worn| worn.hand == Some(hand)) {
                true => needed.extend(Face::BOTH.map(|face| SeamKind::SideOf(face, hand))),
                false => needed.push(SeamKind::Side(hand)),
            }
            if is_raglan {
                needed.extend(Face::BOTH.map(|face| SeamKind::Raglan(face, hand)));
            }
            if has_shoulder {
                needed.push(SeamKind::Shoulder(hand));
            }
        }
        if has(Class::Leg) {
            needed.push(SeamKind::Inseam(hand));
        }
        if has_edge(Label::Outseam) {
            needed.push(SeamKind::Outseam(hand));
        }
        if has(Class::Skirt) && skirts_round == 0 {
            needed.push(SeamKind::SkirtSide(hand));
        }
    }
    match skirts_round {
        0 => {}
        1 => needed.push(SeamKind::SkirtRound),
        gores => needed.extend((1..=gores).map(SeamKind::Gore)),
    }
    needed.extend(Face::BOTH.into_iter().flat_map(|face| needed_of(worn, face)));
    needed
}

fn needed_of(worn: &[Worn], face: Face) -> Vec<SeamKind> {
    let pieces_of = |class: Class| worn.iter().filter(move |worn| worn.class == class && worn.face == Some(face));
    let mut needed = Vec::new();
    if pieces_of(Class::Body).any(|worn| worn.has(Label::Top)) {
        needed.push(SeamKind::Yoke(face));
    }
    if pieces_of(Class::Leg).count() > 0 || worn.iter().any(|worn| worn.class == Class::Leg && worn.is_whole) {
        needed.push(SeamKind::Crotch(face));
    }
    if pieces_of(Class::SidePanel).count() > 0 {
        needed.extend(Hand::BOTH.map(|hand| SeamKind::Princess(face, hand)));
    }
    if pieces_of(Class::Body).count() > 1 {
        needed.push(SeamKind::Centre(face));
    }
    if pieces_of(Class::Skirt).count() > 1 {
        needed.push(SeamKind::SkirtCentre(face));
    }
    needed
}

/// Remark on a piece that no chain of seams joins to the first piece. `None` without such a piece.
fn apart(worn: &[Worn], seams: &[ProposedSeam]) -> Option<String> {
    let mut joined: Vec<&str> = worn.first().map(|worn| worn.id.as_str()).into_iter().collect();
    let mut at = 0;
    while let Some(&id) = joined.get(at) {
        for seam in seams.iter().filter(|seam| touches(seam, id)) {
            for other in ids(seam) {
                if !joined.contains(&other) {
                    joined.push(other);
                }
            }
        }
        at += 1;
    }
    let apart = &worn.iter().find(|worn| !joined.contains(&worn.id.as_str()))?.id;
    Some(format!("no seam joins {apart} to {}", joined.first()?))
}

/// Halves that are mirror images are closed at the centre in any case: by a seam, buttons or a fold.
fn is_sure(seam: &ProposedSeam) -> bool {
    seam.confidence >= if seam.kind.is_centre() { SURE * sew::CENTRE_CONFIDENCE } else { SURE }
}

fn ids(seam: &ProposedSeam) -> impl Iterator<Item = &str> {
    seam.entry.a.iter().chain(&seam.entry.b).filter_map(|edge| edge.split_once('.').map(|(id, _)| id))
}

fn touches(seam: &ProposedSeam, id: &str) -> bool {
    ids(seam).any(|found| found == id)
}
