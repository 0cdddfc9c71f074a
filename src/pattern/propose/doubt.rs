//! Doubt about names that outlines and seams contradict.
//!
//! A name may contain a garment term by chance: a T-shirt called `ROCK` is no German skirt. If a piece looks like
//! another kind than its name says, the garment is sewn both ways, and the reading with more confidence counts. The
//! user is asked if the name is that of a single piece. Words that all names of the file share belong to the style, and
//! are set aside without a question.

use super::align::upright;
use super::ask::Asker;
use super::details::DETAIL_SHARE;
use super::recognise::{CONTRADICTED, LEAST_UNNAMED_FIT, Reading};
use super::shape::Shape;
use super::templates::Template;
use super::told::Told;
use super::{Class, Face, Hand, ProposedSeam, Sewn, best_sewn};
use crate::piece::Piece;
use crate::trade::Named;

/// Kinds with a characteristic shape, which can contradict a name. Bands and skirts are rectangles, like much else.
const SHAPED: [Class; 3] = [Class::Body, Class::Leg, Class::Sleeve];
/// Least gain in worth (the sum of confidences less the number of missing seams) for which names are set aside: half a
/// seam. Pieces without names have less confidence anyway.
const LEAST_GAIN: f64 = 0.5;
/// Loss in worth up to which a claim that was set aside is restored.
const NO_LOSS: f64 = 0.05;
/// Least advantage in fit of another kind for a word that all names share to be doubted. Such a word is weaker evidence
/// than the name of a single piece.
const SHARED_MARGIN: f64 = 0.1;
/// Least confidence of every seam of a piece for its name to be trusted.
const WELL_SEWN: f64 = 0.5;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Says {
    /// The outline looks like the given other kind.
    Class(Class),
    /// The piece looks like a sleeve, or no piece is called the other.
    Face,
    /// No piece is called the other.
    Hand,
}

/// Doubtful statement of names, true for all of its pieces or none: of one piece by its name, or of several by shared
/// words.
#[derive(Clone, Debug, PartialEq)]
struct Claim {
    pieces: Vec<usize>,
    says: Says,
    is_own: bool,
}

/// Statements of names without the claims that do not hold, and the best reading of the pieces.
pub fn settled(pieces: &[Piece], told: &[Told], asker: &mut Asker<'_>) -> (Vec<Named>, Reading) {
    let all: Vec<Named> = told.iter().map(|told| told.all()).collect();
    let as_called = best_sewn(pieces, &all, asker);
    let mut claims = doubtful(pieces, told, &all, &well_sewn(pieces, &as_called));
    claims.retain(|claim| !claim.pieces.iter().any(|&piece| asker.is_dismissed(piece)));
    if claims.is_empty() {
        return (all, as_called.reading);
    }
    let mut aside = aside(pieces, &all, &claims, &as_called, asker);
    for (claim, is_aside) in claims.iter().zip(&mut aside).filter(|(claim, is_aside)| claim.is_own && **is_aside) {
        let piece = claim.pieces[0];
        let ClaimQuestion { text, choices } = question(&pieces[piece].name, all[piece], claim.says);
        *is_aside = asker.ask_of([piece], text, choices, Some(1)) == Some(1);
    }
    let named = without(&all, &claims, &aside);
    let reading = best_sewn(pieces, &named, asker).reading;
    (named, reading)
}

struct ClaimQuestion {
    text: String,
    choices: [String; 2],
}

fn question(name: &str, named: Named, says: Says) -> ClaimQuestion {
    match says {
        Says::Class(looks) => {
            let says = named.class.map_or("part", Class::as_str);
            let looks = looks.as_str();
            let text = format!("piece `{name}`: its name says a {says}, its outline a {looks}; which is it?");
            ClaimQuestion { text, choices: [says, looks].map(|class| format!("a {class}")) }
        }
        Says::Face => {
            let face = named.face.unwrap_or(Face::Front);
            let text =
                format!("piece `{name}`: its name says a {face}, and what is sewn to it something else; which is it?");
            ClaimQuestion { text, choices: [format!("a {face}"), "what its outline says".to_owned()] }
        }
        Says::Hand => {
            let hand = named.hand.unwrap_or(Hand::Right);
            let text = format!(
                "piece `{name}`: its name says the {hand} side, and no piece is the {}; which is it?",
                hand.other()
            );
            ClaimQuestion { text, choices: [format!("of the {hand} side alone"), "of both sides".to_owned()] }
        }
    }
}

fn without(all: &[Named], claims: &[Claim], aside: &[bool]) -> Vec<Named> {
    let mut named = all.to_vec();
    for (claim, _) in claims.iter().zip(aside).filter(|(_, is_aside)| **is_aside) {
        for &piece in &claim.pieces {
            match claim.says {
                Says::Class(_) => named[piece].class = None,
                Says::Face => named[piece].face = None,
                Says::Hand => named[piece].hand = None,
            }
        }
    }
    named
}

/// True for each claim to set aside: without it the seams have more confidence.
fn aside(pieces: &[Piece], all: &[Named], claims: &[Claim], as_called: &Sewn, asker: &Asker<'_>) -> Vec<bool> {
    // Setting a claim aside must make its piece another kind, and sewn to other pieces. Otherwise it is of no use.
    let is_vain = |sewn: &Sewn, claim: &Claim| {
        let is_otherwise = |&piece: &usize| {
            let class = sewn.worn.iter().find(|worn| worn.piece == piece).map(|worn| worn.class);
            let is_other = !matches!(claim.says, Says::Class(_)) || class != all[piece].class;
            is_other && seams_of(sewn, piece).iter().any(|own| own.pieces.iter().any(|other| *other != piece))
        };
        !claim.pieces.iter().any(is_otherwise)
    };
    let worth_of = |aside: &[bool]| {
        let sewn = best_sewn(pieces, &without(all, claims, aside), asker);
        let mut set = claims.iter().zip(aside).filter(|(_, is_aside)| **is_aside);
        if set.any(|(claim, _)| is_vain(&sewn, claim)) { f64::NEG_INFINITY } else { sewn.worth() }
    };
    let mut aside = vec![false; claims.len()];
    let mut best = as_called.worth();
    let is_detail = |claim: &Claim| all[claim.pieces[0]].class == Some(Class::Other);
    let worn: Vec<bool> = claims.iter().map(|claim| !is_detail(claim)).collect();
    for trial in [worn, vec![true; claims.len()]] {
        let found = worth_of(&trial);
        if found > best + LEAST_GAIN {
            (aside, best) = (trial, found);
        }
    }
    // Each claim is then changed alone: restored if setting it aside was needless, or set aside if that helps.
    for k in 0..claims.len() {
        aside[k] = !aside[k];
        let changed = worth_of(&aside);
        if changed > best + if aside[k] { LEAST_GAIN } else { -NO_LOSS } {
            best = changed;
        } else {
            aside[k] = !aside[k];
        }
    }
    aside
}

fn doubtful(pieces: &[Piece], told: &[Told], all: &[Named], well_sewn: &[bool]) -> Vec<Claim> {
    let worn: Vec<&Named> = all.iter().filter(|named| named.class != Some(Class::Other)).collect();
    let faces: Vec<Face> = worn.iter().filter_map(|named| named.face).collect();
    let is_one_face = faces.len() > 1 && faces.iter().all(|face| *face == faces[0]);
    let is_alone = |hand: Hand| worn.iter().all(|named| named.hand != Some(hand.other()));
    // Of several pieces for one place, one is worn.
    let is_spare = |k: usize| {
        let is_rival = |other: usize| (all[other].class, all[other].face) == (all[k].class, all[k].face);
        (0..all.len()).any(|other| well_sewn[other] && is_rival(other))
    };
    let largest_m2 = pieces.iter().map(Piece::area_m2).fold(0.0, f64::max);
    let mut claims: Vec<Claim> = Vec::new();
    let mut doubt = |piece: usize, says: Says| {
        let is_own = |told: &Told| match says {
            Says::Class(_) => told.own.class.is_some(),
            Says::Face => told.own.face.is_some(),
            Says::Hand => told.own.hand.is_some(),
        };
        let is_same =
            |claim: &Claim| !claim.is_own && std::mem::discriminant(&claim.says) == std::mem::discriminant(&says);
        if is_own(&told[piece]) {
            claims.push(Claim { pieces: vec![piece], says, is_own: true });
        } else if !claims.iter().any(is_same) {
            let pieces = (0..told.len()).filter(|&other| !is_own(&told[other])).collect();
            claims.push(Claim { pieces, says, is_own: false });
        }
    };
    for (k, named) in all.iter().enumerate() {
        let Some(shape) = Shape::of(&pieces[k]).filter(|_| !named.is_nameless()) else { continue };
        let kinds: Vec<Class> = SHAPED.into_iter().filter(|&class| named.class != Some(class)).collect();
        let (looks, fit) = best_of(&shape, &kinds);
        let is_like_another = fit >= LEAST_UNNAMED_FIT;
        let gain = named.class.map_or(0.0, |class| fit - best_of(&shape, &[class]).1);
        let is_doubtful = match named.class {
            _ if !is_like_another => false,
            None => false,
            Some(Class::Other) => pieces[k].area_m2() >= DETAIL_SHARE * largest_m2,
            Some(_) if told[k].own.class.is_none() && gain > SHARED_MARGIN => true,
            Some(_) => gain > CONTRADICTED || !is_spare(k),
        };
        if is_doubtful {
            doubt(k, Says::Class(looks));
        }
        let is_sleeve = named.class.is_none() && is_like_another && looks == Class::Sleeve;
        if named.face.is_some() && named.class != Some(Class::Other) && (is_one_face || is_sleeve) {
            doubt(k, Says::Face);
        }
        if named.class != Some(Class::Other) && named.hand.is_some_and(is_alone) {
            doubt(k, Says::Hand);
        }
    }
    claims
}

fn well_sewn(pieces: &[Piece], sewn: &Sewn) -> Vec<bool> {
    let is_well_sewn = |piece: usize| {
        let own = seams_of(sewn, piece);
        own.iter().all(|joined| joined.seam.confidence >= WELL_SEWN)
            && own.iter().any(|joined| joined.pieces.iter().any(|other| *other != piece))
    };
    (0..pieces.len()).map(is_well_sewn).collect()
}

fn edges_of(seam: &ProposedSeam) -> impl Iterator<Item = &String> {
    seam.entry.a.iter().chain(&seam.entry.b)
}

struct JoinedSeam<'s> {
    seam: &'s ProposedSeam,
    /// One for each edge.
    pieces: Vec<usize>,
}

fn seams_of(sewn: &Sewn, piece: usize) -> Vec<JoinedSeam<'_>> {
    let drawn = |edge: &String| {
        let id = edge.split_once('.').map(|(id, _)| id);
        sewn.worn.iter().find(|worn| Some(worn.id.as_str()) == id).map(|worn| worn.piece)
    };
    let joined = |seam| JoinedSeam { seam, pieces: edges_of(seam).filter_map(drawn).collect() };
    sewn.seams.iter().map(joined).filter(|joined| joined.pieces.contains(&piece)).collect()
}

fn best_of(shape: &Shape, classes: &[Class]) -> (Class, f64) {
    let fit = |class: Class| {
        let is_one = |template: &Template| template.class == class && !template.is_panel();
        upright(shape, is_one).map_or(f64::NEG_INFINITY, |found| found.score)
    };
    let fits = classes.iter().map(|&class| (class, fit(class)));
    fits.reduce(|best, found| if found.1 > best.1 { found } else { best }).unwrap_or((Class::Other, f64::NEG_INFINITY))
}
