//! What each piece is: from its name first, then from its outline, then from the other pieces.

use super::align::{Alignment, align};
use super::names;
use super::shape::Shape;
use super::templates::TEMPLATES;
use super::{Class, Face, Hand, Label};
use crate::pattern::piece::Piece;

/// Least fit of an outline whose name tells what it is.
const LEAST_NAMED_FIT: f64 = 0.35;
/// Least fit of an outline that nothing else tells of.
const LEAST_UNNAMED_FIT: f64 = 0.6;
/// Confidence in front and back told by comparing outlines.
const COMPARED: f64 = 0.75;
/// Least difference of two outlines that tells front from back, in units of the piece's longer side.
const LEAST_DIFFERENCE: f64 = 0.01;

/// A piece with what it was taken for.
#[derive(Clone, Debug, PartialEq)]
pub struct Recognised {
    /// Index of the piece.
    pub piece: usize,
    /// Kind.
    pub class: Class,
    /// Front or back.
    pub face: Option<Face>,
    /// Side of the wearer that the name says.
    pub hand: Option<Hand>,
    /// Outline.
    pub shape: Shape,
    /// Template laid round it.
    pub alignment: Alignment,
    /// 0 to 1.
    pub confidence: f64,
}

/// Recognises pieces; those that are left out have a question each, except what needs no seam of ours.
pub fn recognise(pieces: &[Piece], questions: &mut Vec<String>) -> Vec<Recognised> {
    let mut found = Vec::new();
    let has_sleeve = pieces.iter().any(|piece| names::read(&piece.name).class == Some(Class::Sleeve));
    for (index, piece) in pieces.iter().enumerate() {
        match recognise_one(index, piece, has_sleeve) {
            Ok(recognised) => found.push(recognised),
            Err(question) => questions.push(question),
        }
    }
    for class in [Class::Body, Class::Leg] {
        tell_faces(class, &mut found);
    }
    for one in &found {
        let needs_face = matches!(one.class, Class::Body | Class::Leg | Class::Skirt);
        if needs_face && one.face.is_none() {
            questions.push(format!("is piece `{}` a front or a back?", pieces[one.piece].name));
        }
    }
    found
}

/// A file with a sleeve (`has_sleeve`) holds no legs unless it calls them so.
fn recognise_one(index: usize, piece: &Piece, has_sleeve: bool) -> Result<Recognised, String> {
    let named = names::read(&piece.name);
    let ask = |what: &str| format!("piece `{}`: {what}; it is in no proposed seam", piece.name);
    if named.class == Some(Class::Other) {
        return Err(ask("its name says a part that is not sewn automatically"));
    }
    let shape = Shape::of(piece).ok_or_else(|| ask("its corners cannot be told"))?;
    let is_candidate = |class: Class| match (named.class, named.face) {
        (Some(named), _) => class == named,
        (None, _) if has_sleeve && class == Class::Leg => false,
        (None, Some(_)) => matches!(class, Class::Body | Class::Leg | Class::Skirt),
        // Bands and skirts are rectangles: so is anything.
        (None, None) => matches!(class, Class::Body | Class::Leg | Class::Sleeve),
    };
    // A sleeve that is called front or back is half of one.
    let is_half_sleeve = named.face.is_some();
    let candidates = TEMPLATES.iter().filter(|template| {
        is_candidate(template.class) && (template.class != Class::Sleeve || template.is_whole != is_half_sleeve)
    });
    let alignment = align(&shape, candidates).ok_or_else(|| ask("it has too few corners for what it is called"))?;
    let is_named = named.class.is_some() || named.face.is_some();
    let least = if is_named { LEAST_NAMED_FIT } else { LEAST_UNNAMED_FIT };
    if alignment.score < least {
        return Err(ask("neither its name nor its outline tells what it is"));
    }
    let fit = ((alignment.score - LEAST_NAMED_FIT) / (0.85 - LEAST_NAMED_FIT)).clamp(0.0, 1.0);
    let confidence = if is_named { 0.6 + 0.4 * fit } else { 0.3 + 0.5 * fit };
    Ok(Recognised {
        piece: index,
        class: alignment.template.class,
        face: named.face,
        hand: named.hand,
        shape,
        alignment,
        confidence,
    })
}

/// Tells front from back where exactly two pieces of a kind are told by nothing else: the front neck is cut deeper, and
/// the back seat seam reaches further out.
fn tell_faces(class: Class, found: &mut [Recognised]) {
    let unknown: Vec<usize> =
        (0..found.len()).filter(|&i| found[i].class == class && found[i].face.is_none()).collect();
    let known: Vec<Face> = found.iter().filter(|one| one.class == class).filter_map(|one| one.face).collect();
    match (unknown.as_slice(), known.as_slice()) {
        (&[only], [face]) => {
            found[only].face = Some(if *face == Face::Front { Face::Back } else { Face::Front });
            found[only].confidence *= COMPARED;
        }
        (&[first, second], []) => {
            let values = [frontness(&found[first]), frontness(&found[second])];
            let (Some(a), Some(b)) = (values[0], values[1]) else { return };
            if (a - b).abs() < LEAST_DIFFERENCE {
                return;
            }
            let (front, back) = if a > b { (first, second) } else { (second, first) };
            for (index, face) in [(front, Face::Front), (back, Face::Back)] {
                found[index].face = Some(face);
                found[index].confidence *= COMPARED;
            }
        }
        _ => {}
    }
}

/// How much a piece looks like a front beside its back.
fn frontness(one: &Recognised) -> Option<f64> {
    let (shape, _) = one.shape.framed(one.alignment.quarter_turns);
    let stretch = |label: Label| one.alignment.parts.iter().find(|part| part.label == label);
    match one.class {
        Class::Body => stretch(Label::Neck).map(|neck| {
            let [low, high] = shape.heights(neck.from, neck.span);
            high - low
        }),
        Class::Leg => stretch(Label::Crotch).map(|crotch| -shape.stretch(crotch.from, crotch.span).chord.x.abs()),
        _ => None,
    }
}
