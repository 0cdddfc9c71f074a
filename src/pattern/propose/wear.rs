//! What of a proposal can be draped with nobody to ask: pieces that are not sewn for sure are left out, and what is left must
//! be closed on the body.

use super::{Class, Face, Hand, Proposal, ProposedPiece, ProposedSeam, sew};
use crate::seams::PieceEntry;

/// Least confidence of a seam that is sewn with nobody to ask.
const SURE: f64 = 0.4;

/// Kinds of piece that a garment can be worn without, the outermost first.
const SPARED: [Class; 3] = [Class::Cuff, Class::Waistband, Class::Sleeve];

/// Why a proposal cannot be draped: what keeps what is left of it from being closed on the body.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("how it is sewn is not sure enough: {reason}")]
pub struct Unwearable {
    /// What is missing, and what was asked.
    pub reason: String,
}

impl Proposal {
    /// The part of the proposal that is worn with nobody to ask. Bands, cuffs and sleeves whose seams are not sure, and pieces
    /// that are sewn to nothing, are left out, on both sides alike; each is said so in a question.
    ///
    /// # Errors
    /// [`Unwearable`] where what is left is not closed: a side, shoulder, leg or yoke is not sewn for sure.
    pub fn to_drape(&self) -> Result<Self, Unwearable> {
        let mut left = self.clone();
        while let Some((class, reason)) = left.loose() {
            left.leave_out(class, &reason);
        }
        let missing = left.missing();
        if missing.is_empty() {
            return Ok(left);
        }
        let reason = missing.into_iter().chain(left.questions).collect::<Vec<_>>().join("; ");
        Err(Unwearable { reason })
    }

    /// A kind of piece that is not sewn on for sure and can be spared, and why; the outermost first.
    fn loose(&self) -> Option<(Class, String)> {
        let of = |class: Class| self.pieces.iter().filter(move |piece| piece.class == Some(class));
        let spared = SPARED.into_iter().flat_map(of);
        let mut of_seams = spared.filter_map(|piece| {
            let id = piece.id.as_deref()?;
            let own = self.seams.iter().filter(|seam| touches(seam, id));
            let unsure = own.clone().find(|seam| !is_sure(seam));
            let is_held = own.clone().any(|seam| self.is_hold(seam, piece.class));
            let reason = match unsure {
                Some(seam) => format!("seam {} is not sure", seam.entry.name),
                None if !is_held => "what it is sewn to was not found".to_owned(),
                None => return None,
            };
            Some((piece.class?, reason))
        });
        of_seams.next()
    }

    /// Whether a seam joins pieces of `class` to another kind of piece that it is worn on.
    fn is_hold(&self, seam: &ProposedSeam, class: Option<Class>) -> bool {
        let of =
            |id: &str| self.pieces.iter().find(|piece| piece.id.as_deref() == Some(id)).and_then(|piece| piece.class);
        ids(seam).any(|id| of(id) != class)
    }

    /// Takes all pieces of a kind out of the seams.
    fn leave_out(&mut self, class: Class, reason: &str) {
        // A left sleeve goes with the right one, half a waistband with the other half.
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
        self.questions.push(format!("left out: {}: {reason}", names.join(", ")));
        let is_gone = |id: &str| ids_gone.iter().any(|gone| gone == id);
        self.seams.retain(|seam| !ids(seam).any(is_gone));
        self.entries.retain(|(id, _)| !is_gone(id));
        let was_open = |edge: &String| !edge.split_once('.').is_some_and(|(id, _)| is_gone(id));
        self.open.retain(was_open);
        for piece in self.pieces.iter_mut().filter(|piece| piece.id.as_deref().is_some_and(is_gone)) {
            piece.id = None;
        }
    }

    /// What is not closed for sure, one remark each.
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
        let has = |class: Class| self.worn().any(|piece| piece.class == Some(class));
        let is_sewn = |name: &str| self.seams.iter().any(|seam| seam.entry.name == name);
        let skirts_round =
            self.worn().filter(|piece| piece.class == Some(Class::Skirt) && piece.face.is_none()).count();
        let has_shoulder =
            self.entries.iter().any(|(_, entry)| entry.edges.keys().any(|edge| edge.starts_with("shoulder")));
        // Nothing else joins front and back of a raglan at the top.
        let is_raglan = !has_shoulder
            && self.worn().any(|piece| piece.class == Some(Class::Body))
            && self.entries.iter().any(|(_, entry)| entry.edges.keys().any(|edge| edge.starts_with("neck")));
        let mut need = |name: String| {
            if !is_sewn(&name) {
                missing.push(format!("the seam {name} was not found"));
            }
        };
        for hand in Hand::BOTH.map(Hand::as_str) {
            if has(Class::Body) {
                need(format!("side_{hand}"));
                for face in Face::BOTH.into_iter().filter(|_| is_raglan) {
                    need(format!("raglan_{}_{hand}", face.as_str()));
                }
                if has_shoulder {
                    need(format!("shoulder_{hand}"));
                }
            }
            if has(Class::Leg) {
                need(format!("inseam_{hand}"));
                need(format!("outseam_{hand}"));
            }
            if has(Class::Skirt) && skirts_round == 0 {
                need(format!("skirt_side_{hand}"));
            }
        }
        for k in 1..=skirts_round {
            need(if skirts_round > 1 { format!("skirt_side_{k}") } else { "skirt_side".to_owned() });
        }
        for face in Face::BOTH {
            let of = |class: Class| {
                self.worn().filter(|piece| piece.class == Some(class) && piece.face == Some(face)).count()
            };
            let is_under_yoke = |(id, entry): &(String, PieceEntry)| id.starts_with(face.as_str()) && has_top(entry);
            if self.entries.iter().any(is_under_yoke) {
                need(format!("yoke_{}", face.as_str()));
            }
            if of(Class::Leg) > 0 {
                need(format!("crotch_{}", face.as_str()));
            }
            if of(Class::SidePanel) > 0 {
                for hand in Hand::BOTH {
                    need(format!("princess_{}_{}", face.as_str(), hand.as_str()));
                }
            }
            if of(Class::Body) > 1 {
                need(format!("centre_{}", face.as_str()));
            }
            if of(Class::Skirt) > 1 {
                need(format!("skirt_centre_{}", face.as_str()));
            }
        }
        missing.extend(self.apart());
        missing
    }

    /// A piece that no seam, over however many others, joins to the first.
    fn apart(&self) -> Option<String> {
        let mut joined: Vec<&str> = self.entries.first().map(|(id, _)| id.as_str()).into_iter().collect();
        let mut at = 0;
        while let Some(&id) = joined.get(at) {
            for seam in self.seams.iter().filter(|seam| touches(seam, id)) {
                for other in ids(seam) {
                    if !joined.contains(&other) {
                        joined.push(other);
                    }
                }
            }
            at += 1;
        }
        let (apart, _) = self.entries.iter().find(|(id, _)| !joined.contains(&id.as_str()))?;
        Some(format!("no seam joins {apart} to {}", joined.first()?))
    }

    fn worn(&self) -> impl Iterator<Item = &ProposedPiece> {
        self.pieces.iter().filter(|piece| piece.id.is_some())
    }
}

/// Whether a seam is sewn with nobody to ask. Two halves that are each other's mirror image are closed in the middle, be that a
/// seam, buttons or a fold.
fn is_sure(seam: &ProposedSeam) -> bool {
    let is_centre = seam.entry.name.contains("centre");
    seam.confidence >= if is_centre { SURE * sew::CENTRE_CONFIDENCE } else { SURE }
}

/// Pieces of a seam, by identifier, as often as they have edges in it.
fn ids(seam: &ProposedSeam) -> impl Iterator<Item = &str> {
    seam.entry.a.iter().chain(&seam.entry.b).filter_map(|edge| edge.split_once('.').map(|(id, _)| id))
}

fn touches(seam: &ProposedSeam, id: &str) -> bool {
    ids(seam).any(|found| found == id)
}

/// Whether a piece ends in an edge that a yoke is sewn to.
fn has_top(entry: &PieceEntry) -> bool {
    entry.edges.keys().any(|edge| edge == "top" || edge.starts_with("top_"))
}
