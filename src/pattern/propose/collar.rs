//! Collars and stands: a band with one long edge about as long as the neckline, or half of one. Left out unless the user says that it is
//! sewn. It then stands up as it is cut, for no file says along which line a collar is turned down.

use std::ops::RangeInclusive;

use super::align::{Alignment, LEAST_FIT, Labelled, upright};
use super::ask::Asker;
use super::recognised::{Recognised, length_m};
use super::sew::{ANSWERED, Chain, EASED_DOUBT, PLAIN_DOUBT, Tailor};
use super::shape::Shape;
use super::worn_pieces::{self, Worn};
use super::{Class, Face, Hand, Label, PartName, SeamKind};
use crate::piece::Piece;
use crate::style::named::reference;
use crate::trade::Named;
use geom::units::mm;

/// Length of a collar over that of the neckline. A collar is held in by a tenth at most, and a stand laps over at the front
/// by twice 20 mm. A rib that is stretched further is folded in half, and would stand twice too high.
const FITS: RangeInclusive<f64> = 0.9..=1.12;
/// Height of half a collar over its length. A neck is half as high as it is round on one side; half a hood is higher.
const HIGHEST: f64 = 0.5;
/// Distance from the middle of a front neckline within which a corner is the centre front.
const AT_CENTRE_M: f64 = 5e-3;

/// Adds the collar that fits the neckline best, if the user says that it is sewn. `may_be` is true for each piece that is
/// worn as nothing else.
pub fn sewn(
    pieces: &[Piece],
    named: &[Named],
    recognised: Vec<Recognised>,
    may_be: impl Fn(usize) -> bool,
    asker: &mut Asker<'_>,
) -> Vec<Recognised> {
    let opened: Vec<Recognised> = recognised.iter().map(|candidate| with_centre_front(candidate.clone())).collect();
    let worn = worn_pieces::worn(pieces, &opened, None, &mut asker.aside());
    let chain = Tailor::new(&worn, &mut asker.aside()).neckline();
    let neck_m: f64 = chain.iter().map(|along| along.edge.length).sum();
    let is_collar =
        |k: &usize| named[*k].class == Some(Class::Other) && named[*k].part == Some(PartName::Neck) && may_be(*k);
    let share = |collar: &Recognised| around_m(collar) / neck_m;
    let readings = |piece: usize| {
        let is_low = |half: &Recognised| length_m(half, Label::Centre) < HIGHEST * length_m(half, Label::Lower);
        let half = band(pieces, piece, 0.5 * neck_m).map(halved).filter(is_low);
        [band(pieces, piece, neck_m), half].into_iter().flatten()
    };
    let bands = (0..pieces.len()).filter(is_collar).flat_map(readings);
    let fitting = bands.filter(|collar| FITS.contains(&share(collar)));
    let best = fitting.min_by(|a, b| share(a).ln().abs().total_cmp(&share(b).ln().abs()));
    let Some(collar) = best else { return recognised };
    // Lengths stand in a choice: the question is the same in every size.
    let name = reference(pieces, collar.piece);
    let text = match is_half(&collar) {
        true => format!("`{name}` and its mirror image are about as long as the neckline: are they sewn on?"),
        false => format!("`{name}` is about as long as the neckline: is it sewn on?"),
    };
    let no = format!("no: it is left out, {:.0} mm at a neckline of {:.0} mm", mm(around_m(&collar)), mm(neck_m));
    let yes = "yes, standing up as it is cut".to_owned();
    let ring = (!is_half(&collar)).then(|| "yes, as a ring: its ends are sewn to each other".to_owned());
    // Whoever has it sewn on is surer than the outline of a band.
    let confirmed = Recognised { confidence: ANSWERED, ..collar };
    match asker.ask(text, [no, yes].into_iter().chain(ring), Some(0)) {
        Some(1) => opened.into_iter().chain([confirmed]).collect(),
        Some(2) => opened.into_iter().chain([closed(confirmed)]).collect(),
        _ => recognised,
    }
}

fn closed(mut band: Recognised) -> Recognised {
    for part in band.alignment.parts.iter_mut().filter(|part| part.label == Label::End) {
        part.label = Label::Side;
    }
    band
}

/// A piece as a band whose lower edge is the one that is nearer to the length of the neckline. `None` for another shape.
fn band(pieces: &[Piece], piece: usize, neck_m: f64) -> Option<Recognised> {
    let shape = Shape::of(&pieces[piece])?;
    let alignment = upright(&shape, |template| template.class == Class::Collar)?;
    let confidence = Some(alignment.score).filter(|score| *score >= LEAST_FIT)?;
    let read = Recognised {
        piece,
        class: Class::Collar,
        face: None,
        hand: None,
        shape,
        alignment,
        confidence,
        rival: None,
        is_pair: false,
        gore: None,
        part: Some(PartName::Neck),
    };
    let away = |label: Label| (length_m(&read, label) - neck_m).abs();
    let is_upside_down = away(Label::Top) < away(Label::Lower);
    Some(if is_upside_down { Recognised { alignment: turned(read.alignment), ..read } } else { read })
}

fn is_half(collar: &Recognised) -> bool {
    !collar.alignment.template.is_whole
}

/// Length of the lower edge all round.
fn around_m(collar: &Recognised) -> f64 {
    length_m(collar, Label::Lower) * if is_half(collar) { 2.0 } else { 1.0 }
}

/// Half of a collar. Its end at centre back is the squarer one, for the fold of the cloth lies there.
fn halved(band: Recognised) -> Recognised {
    let parts = &band.alignment.parts;
    let ends = (0..parts.len()).filter(|&k| parts[k].label == Label::End);
    let back = ends.min_by(|&j, &k| off_square(&band.shape, parts[j]).total_cmp(&off_square(&band.shape, parts[k])));
    let Some(back) = back else { return band };
    let mut alignment = band.alignment;
    alignment.parts[back].label = Label::Centre;
    alignment.template.is_whole = false;
    alignment.is_mirrored = alignment.parts[back].is_right;
    Recognised { alignment, face: Some(Face::Back), ..band }
}

/// Greatest cosine, in magnitude, of the angles between an edge and its neighbours: 0 for two right angles.
fn off_square(shape: &Shape, part: Labelled) -> f64 {
    let n = shape.len();
    let cosine = |corner: usize| {
        let (before, after) = (shape.points((corner + n - 1) % n), shape.points(corner % n));
        let ends = before.last_chunk::<2>().zip(after.first_chunk::<2>());
        ends.map_or(1.0, |([a, b], [c, d])| (b - a).normalize().dot(&(d - c).normalize()).abs())
    };
    cosine(part.from).max(cosine(part.from + part.span))
}

fn turned(alignment: Alignment) -> Alignment {
    let turn = |part: Labelled| Labelled {
        label: match part.label {
            Label::Lower => Label::Top,
            Label::Top => Label::Lower,
            other => other,
        },
        is_right: !part.is_right,
        ..part
    };
    let parts = alignment.parts.into_iter().map(turn).collect();
    Alignment { parts, quarter_turns: (alignment.quarter_turns + 2) % 4, ..alignment }
}

/// A whole front with its neckline in two halves, which meet at centre front. Any other piece as it is.
fn with_centre_front(mut candidate: Recognised) -> Recognised {
    let is_front =
        candidate.class == Class::Body && candidate.face == Some(Face::Front) && candidate.alignment.template.is_whole;
    let necks = candidate.alignment.parts.iter().filter(|part| part.label == Label::Neck).count();
    let place = candidate.alignment.parts.iter().position(|part| part.label == Label::Neck);
    let Some(place) = place.filter(|_| is_front && necks == 1) else { return candidate };
    let neck = candidate.alignment.parts[place];
    let Some((shape, corner)) = with_corner_in_the_middle(&candidate.shape, neck) else { return candidate };
    let is_added = shape.len() > candidate.shape.len();
    let n = shape.len();
    for part in &mut candidate.alignment.parts {
        part.from += usize::from(is_added && part.from >= corner);
    }
    let from = candidate.alignment.parts[place].from;
    let span = neck.span + usize::from(is_added);
    let first = (corner + n - from) % n;
    let half = |from, span, is_right| Labelled { from, span, is_right, ..neck };
    let halves = [half(from, first, true), half(corner % n, span - first, false)];
    candidate.alignment.parts.splice(place..=place, halves);
    candidate.shape = shape;
    candidate
}

/// Shape with a corner in the middle of a part, and its index: that of a V-neck, or else a new one.
fn with_corner_in_the_middle(shape: &Shape, part: Labelled) -> Option<(Shape, usize)> {
    let lengths = |count: usize| -> f64 { (0..count).map(|k| shape.length((part.from + k) % shape.len())).sum() };
    let middle_m = 0.5 * lengths(part.span);
    let known = (1..part.span).find(|&count| (lengths(count) - middle_m).abs() < AT_CENTRE_M);
    match known {
        Some(count) => Some((shape.clone(), (part.from + count) % shape.len())),
        None => shape.with_middle(part.from, part.span),
    }
}

impl<'w> Tailor<'w, '_, '_> {
    /// Edges of the neckline clockwise, from centre front over the wearer's left, the back and the right. Empty unless
    /// it has both halves of a front.
    pub fn neckline(&self) -> Chain<'w> {
        let of_front = |hand: Hand| {
            let front = self.find(Class::Body, Some(Face::Front), hand);
            front.map_or_else(Vec::new, |front| front.chain_back(Label::Neck, Some(hand)))
        };
        let of_sleeve = |hand: Hand| {
            let sleeve = self.find(Class::Sleeve, None, hand);
            sleeve.map_or_else(Vec::new, |sleeve| sleeve.chain_back(Label::Neck, None))
        };
        let of_back = |class: Class| -> Chain<'w> {
            let row: Vec<&'w Worn> = self.row(class, Face::Back);
            row.iter().flat_map(|worn| worn.chain_back(Label::Neck, None)).collect()
        };
        let [left, right] = [Hand::Left, Hand::Right].map(of_front);
        let is_open =
            |half: &Chain<'_>| half.iter().all(|along| along.piece.hand.is_some() || along.edge.hand.is_some());
        if left.is_empty() || right.is_empty() || !is_open(&left) || !is_open(&right) {
            return Vec::new();
        }
        let back = Some(of_back(Class::Yoke)).filter(|yokes| !yokes.is_empty());
        let back = back.unwrap_or_else(|| of_back(Class::Body));
        [left, of_sleeve(Hand::Left), back, of_sleeve(Hand::Right), right].concat()
    }

    pub fn collar(&mut self) {
        let whole = self.find(Class::Collar, None, Hand::Left);
        let [left, right] = [Hand::Left, Hand::Right].map(|hand| self.find(Class::Collar, Some(Face::Back), hand));
        // The walk goes from centre front over the wearer's left.
        let collar: Vec<&'w Worn> = whole.map_or_else(|| left.into_iter().chain(right).collect(), |whole| vec![whole]);
        if let (Some(left), Some(right)) = (left, right) {
            let (a, b) = (left.chain(Label::Centre, None), right.chain_back(Label::Centre, None));
            self.add(SeamKind::CollarBack, a, b, &[left, right], PLAIN_DOUBT);
        }
        if let Some(ring) = whole.filter(|whole| whole.has(Label::Side)) {
            let (a, b) = (ring.chain(Label::Side, Some(Hand::Left)), ring.chain_back(Label::Side, Some(Hand::Right)));
            self.add(SeamKind::CollarEnds, a, b, &[ring], PLAIN_DOUBT);
        }
        let neckline = self.neckline();
        let pieces: Vec<&Worn> = neckline.iter().map(|along| along.piece).chain(collar.iter().copied()).collect();
        let lower = collar.iter().flat_map(|half| half.chain(Label::Lower, None)).collect();
        self.add(SeamKind::Collar, lower, neckline, &pieces, EASED_DOUBT);
    }
}
