//! Fronts and backs: told apart by their outlines, and by the pieces that they are sewn to.

use super::ask::Asker;
use super::recognised::{Recognised, is_whole_leg, length_m};
use super::{Class, Face, Label};
use crate::piece::Piece;
use crate::style::named::reference;
use crate::trade::Named;

/// Factor on the confidence if only a comparison of outlines tells front from back.
const COMPARED: f64 = 0.75;

/// Least difference of two outlines that tells front from back, as a share of the longer side of the piece.
const LEAST_DIFFERENCE: f64 = 0.01;

/// Difference at which a skirt contradicts both names of its halves. Nobody eases in as much by chance.
const CLEAR_WAIST_M: f64 = 10e-3;

/// Least such difference if only one half has a name: the precision of drawn outlines.
const ANY_WAIST_M: f64 = 0.1e-3;

/// Tells front from back of two pieces of a kind that have no other evidence: the front neck is deeper, and the back
/// seat seam reaches further out.
pub fn tell_faces(class: Class, found: &mut [Recognised]) {
    let unknown: Vec<usize> = (0..found.len())
        .filter(|&i| found[i].class == class && found[i].face.is_none() && !is_whole_leg(&found[i]))
        .collect();
    let known: Vec<Face> =
        found.iter().filter(|candidate| candidate.class == class).filter_map(|candidate| candidate.face).collect();
    match (unknown.as_slice(), known.as_slice()) {
        (&[only], [face]) => {
            found[only].face = Some(if *face == Face::Front { Face::Back } else { Face::Front });
            found[only].confidence *= COMPARED;
        }
        (&[first, second], []) => {
            // A piece without shoulders hangs from a yoke, so it is the back.
            let has_shoulder = |i: usize| class != Class::Body || found[i].alignment.template.has_shoulder();
            let by_shoulder = match [first, second].map(has_shoulder) {
                [true, false] => Some((first, second)),
                [false, true] => Some((second, first)),
                _ => None,
            };
            let by_outline = || {
                let (a, b) = (frontness(&found[first])?, frontness(&found[second])?);
                let is_clear = (a - b).abs() >= LEAST_DIFFERENCE;
                is_clear.then_some(if a > b { (first, second) } else { (second, first) })
            };
            let Some((front, back)) = by_shoulder.or_else(by_outline) else { return };
            for (index, face) in [(front, Face::Front), (back, Face::Back)] {
                found[index].face = Some(face);
                found[index].confidence *= COMPARED;
            }
        }
        _ => {}
    }
}

/// Asks about a front and a back of which each looks like the other. The default is what the names say, or the outlines
/// if only one of the pieces has a name.
pub fn doubt_faces(class: Class, pieces: &[Piece], named: &[Named], found: &mut [Recognised], asker: &mut Asker<'_>) {
    let of_class: Vec<usize> =
        (0..found.len()).filter(|&i| found[i].class == class && !is_whole_leg(&found[i])).collect();
    let Some([front, back]) = front_and_back(found, &of_class) else { return };
    if let (Some(a), Some(b)) = (frontness(&found[front]), frontness(&found[back]))
        && b - a >= LEAST_DIFFERENCE
    {
        ask_faces([front, back], pieces, named, found, asker);
    }
}

fn front_and_back(found: &[Recognised], two: &[usize]) -> Option<[usize; 2]> {
    let &[first, second] = two else { return None };
    match [first, second].map(|i| found[i].face) {
        [Some(Face::Front), Some(Face::Back)] => Some([first, second]),
        [Some(Face::Back), Some(Face::Front)] => Some([second, first]),
        _ => None,
    }
}

/// Asks if a front and a back are swapped, where a name says what they are, and swaps them on that answer.
fn ask_faces(pair: [usize; 2], pieces: &[Piece], named: &[Named], found: &mut [Recognised], asker: &mut Asker<'_>) {
    let called: Vec<usize> = pair.into_iter().filter(|&i| named[found[i].piece].face.is_some()).collect();
    let Some(&asked) = called.first() else { return };
    let Some(says) = found[asked].face else { return };
    let looks = says.other();
    let name = reference(pieces, found[asked].piece);
    let text = format!("piece `{name}`: its name says a {says}, its outline a {looks}; which is it?");
    let stands = usize::from(called.len() == 1);
    if asker.ask(text, [says, looks].map(|face| format!("a {face}")), Some(stands)) == Some(1) {
        for index in pair {
            found[index].face = found[index].face.map(Face::other);
            found[index].confidence *= COMPARED;
        }
    }
}

/// Tells the front of a skirt from its back by the waists of the trunk that they hang from, if nothing else tells.
pub fn tell_skirt_faces(pieces: &[Piece], named: &[Named], found: &mut [Recognised], asker: &mut Asker<'_>) {
    let hem_m = |face: Face| {
        let is_it = |candidate: &&Recognised| candidate.class == Class::Body && candidate.face == Some(face);
        Some(length_m(found.iter().find(is_it)?, Label::Hem))
    };
    let skirts: Vec<usize> =
        (0..found.len()).filter(|&i| found[i].class == Class::Skirt && found[i].gore.is_none()).collect();
    let &[first, second] = skirts.as_slice() else { return };
    let waists = hem_m(Face::Front).zip(hem_m(Face::Back));
    let waist = |i: usize| length_m(&found[i], Label::Waist);
    let apart = |a: usize, b: usize| waists.map(|(front, back)| (waist(a) - front).abs() + (waist(b) - back).abs());
    let [straight, turned] = [apart(first, second), apart(second, first)];
    match [first, second].map(|i| found[i].face) {
        [None, None] => {
            let (Some(straight), Some(turned)) = (straight, turned) else { return };
            let order = if turned < straight { [second, first] } else { [first, second] };
            for (index, face) in order.into_iter().zip(Face::BOTH) {
                found[index].face = Some(face);
                found[index].confidence *= COMPARED;
            }
            return;
        }
        [Some(face), None] => found[second].face = Some(face.other()),
        [None, Some(face)] => found[first].face = Some(face.other()),
        _ => {}
    }
    let Some([front, back]) = front_and_back(found, &skirts) else { return };
    let (as_named, otherwise) = if front == first { (straight, turned) } else { (turned, straight) };
    let are_called = skirts.iter().all(|&i| named[found[i].piece].face.is_some());
    let least = if are_called { CLEAR_WAIST_M } else { ANY_WAIST_M };
    let Some((as_named, otherwise)) = as_named.zip(otherwise) else { return };
    if as_named > otherwise + least {
        ask_faces([front, back], pieces, named, found, asker);
    } else if !are_called && as_named > otherwise - least {
        // The name of one tells both apart.
        let Some(&called) = [front, back].iter().find(|&&i| named[found[i].piece].face.is_some()) else { return };
        let text = format!("is piece `{}` a front or a back?", reference(pieces, found[called].piece));
        let says = usize::from(found[called].face == Some(Face::Back));
        if asker.ask(text, ["a front", "a back"], Some(says)).is_some_and(|choice| choice != says) {
            for index in [front, back] {
                found[index].face = found[index].face.map(Face::other);
            }
        }
    }
}

/// Sets front or back of yokes without it: that of a trunk piece without shoulders, the back first.
pub fn tell_yoke_faces(found: &mut [Recognised]) {
    let is_under = |face: Face| {
        let is_it = |candidate: &Recognised| candidate.class == Class::Body && candidate.face == Some(face);
        found.iter().any(|candidate| is_it(candidate) && !candidate.alignment.template.has_shoulder())
    };
    let face = if !is_under(Face::Back) && is_under(Face::Front) { Face::Front } else { Face::Back };
    for yoke in found.iter_mut().filter(|candidate| candidate.class == Class::Yoke) {
        yoke.face = yoke.face.or(Some(face));
    }
}

/// Measure that is greater for a front than for a back of the same kind. `None` for a kind without one.
fn frontness(candidate: &Recognised) -> Option<f64> {
    let (shape, _) = candidate.shape.framed(candidate.alignment.quarter_turns);
    let section = |label: Label| candidate.alignment.parts.iter().find(|part| part.label == label);
    match candidate.class {
        Class::Body => section(Label::Neck).map(|neck| {
            let [low, high] = shape.heights(neck.from, neck.span);
            high - low
        }),
        Class::Leg => section(Label::Crotch).map(|crotch| -shape.section(crotch.from, crotch.span).chord.x.abs()),
        _ => None,
    }
}
