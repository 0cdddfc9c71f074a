//! Which pieces are meant where a file holds several for one place, and how waistbands go round.

use std::collections::BTreeMap;

use super::recognise::Recognised;
use super::worn::{self, id_of};
use super::{Class, Face, Hand, Label, names, sew};
use crate::piece::Piece;

/// Most combinations of pieces that are tried.
const MOST_COMBINATIONS: usize = 256;
/// Length of a waistband over that of all it is sewn to: all round, with an underlap or eased.
const ROUND: std::ops::RangeInclusive<f64> = 0.8..=1.35;
/// The same of half a waistband.
const HALF: std::ops::RangeInclusive<f64> = 0.42..=0.68;

/// The pieces that make a garment, one for each place: of several those whose edges fit their neighbours' best. Those left
/// over have a question each.
pub fn choose(pieces: &[Piece], mut recognised: Vec<Recognised>, questions: &mut Vec<String>) -> Vec<Recognised> {
    leave_out_sleeves_in_two(pieces, &mut recognised, questions);
    leave_out_half_sleeves(pieces, &mut recognised, questions);
    let mut places: BTreeMap<String, Vec<usize>> = BTreeMap::new();
    for (index, one) in recognised.iter().enumerate().filter(|(_, one)| !is_round_band(one) && one.gore.is_none()) {
        places.entry(id_of(one, one.hand)).or_default().push(index);
    }
    let contested: Vec<&Vec<usize>> = places.values().filter(|rivals| rivals.len() > 1).collect();
    let count = contested.iter().fold(1_usize, |count, rivals| count.saturating_mul(rivals.len()));
    let mut best: Option<(f64, Vec<Recognised>)> = None;
    for number in 0..count.min(MOST_COMBINATIONS) {
        let mut rest = number;
        let mut dropped: Vec<usize> = Vec::new();
        for rivals in &contested {
            let kept = rivals[rest % rivals.len()];
            rest /= rivals.len();
            dropped.extend(rivals.iter().filter(|&&rival| rival != kept));
        }
        let kept = recognised.iter().enumerate().filter(|(index, _)| !dropped.contains(index));
        let mut chosen: Vec<Recognised> = kept.map(|(_, one)| one.clone()).collect();
        go_round(&mut chosen);
        if count == 1 {
            best = Some((0.0, chosen));
            break;
        }
        let sewn = sew::sew(&worn::worn(pieces, &chosen, None, &mut Vec::new()), &mut Vec::new());
        let sum: f64 = sewn.iter().map(|seam| seam.confidence).sum();
        // Of equals the first counts.
        if best.as_ref().is_none_or(|(found, _)| sum > found + 1e-9) {
            best = Some((sum, chosen));
        }
    }
    let Some((_, chosen)) = best else { return recognised };
    let name = |one: &Recognised| &pieces[one.piece].name;
    for one in recognised.iter().filter(|one| !chosen.iter().any(|kept| kept.piece == one.piece)) {
        let place = id_of(one, None);
        if let Some(kept) = chosen.iter().find(|kept| id_of(kept, None) == place) {
            questions.push(format!("`{0}` and `{1}` are both {place}: `{0}` is taken", name(kept), name(one)));
        }
    }
    chosen
}

/// Takes out an upper and an under sleeve: where their seams meet the armhole no outline says, and one of them alone is no
/// sleeve.
fn leave_out_sleeves_in_two(pieces: &[Piece], recognised: &mut Vec<Recognised>, questions: &mut Vec<String>) {
    let is_whole_sleeve = |one: &&Recognised| one.class == Class::Sleeve && one.face.is_none();
    let names: Vec<&str> =
        recognised.iter().filter(is_whole_sleeve).map(|one| pieces[one.piece].name.as_str()).collect();
    let unders = names.iter().filter(|name| names::is_under_sleeve(name)).count();
    if unders > 0 && unders < names.len() {
        let names = names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
        questions.push(format!(
            "left out: {names}: a sleeve in two pieces; at which place of the armhole do its seams begin?"
        ));
        recognised.retain(|one| !is_whole_sleeve(&one));
    }
}

/// Takes out sleeves in halves where there is a whole one: they are another way to cut it.
fn leave_out_half_sleeves(pieces: &[Piece], recognised: &mut Vec<Recognised>, questions: &mut Vec<String>) {
    let is_half = |one: &Recognised| one.class == Class::Sleeve && one.face.is_some();
    let has_whole = recognised.iter().any(|one| one.class == Class::Sleeve && !is_half(one));
    let halves: Vec<String> =
        recognised.iter().filter(|one| is_half(one)).map(|one| format!("`{}`", pieces[one.piece].name)).collect();
    if has_whole && !halves.is_empty() {
        let halves = halves.join(", ");
        questions.push(format!("a sleeve in one piece, or in halves ({halves})? The one in one piece is taken"));
        recognised.retain(|one| !is_half(one));
    }
}

/// A waistband that its name gives to no side and no face.
fn is_round_band(one: &Recognised) -> bool {
    one.class == Class::Waistband && one.face.is_none() && one.hand.is_none()
}

/// Settles how waistbands without a side or a face go round, by their length beside that of what they are sewn to: one all
/// round, two for the right and the left side, or one cut twice. Bands beyond these are dropped.
fn go_round(chosen: &mut Vec<Recognised>) {
    let bands: Vec<usize> = (0..chosen.len()).filter(|&i| is_round_band(&chosen[i])).collect();
    let waist = waist_m(chosen);
    if bands.is_empty() || waist <= 0.0 {
        return;
    }
    let share = |i: usize| length_m(&chosen[i], Label::Lower) / waist;
    let halves: Vec<usize> = bands.iter().copied().filter(|&i| HALF.contains(&share(i))).collect();
    // Total share, then the bands of a way to go round; two different halves before one cut twice.
    let two = halves.iter().enumerate().flat_map(|(k, &i)| halves[k + 1..].iter().map(move |&j| vec![i, j]));
    let two = two.map(|pair| (pair.iter().map(|&i| share(i)).sum::<f64>(), pair));
    let one = bands.iter().map(|&i| (share(i), vec![i]));
    let twice = halves.iter().map(|&i| (2.0 * share(i), vec![i, i]));
    let ways = two.chain(one).chain(twice).filter(|(total, _)| ROUND.contains(total));
    let Some((_, way)) = ways.min_by(|a, b| a.0.ln().abs().total_cmp(&b.0.ln().abs())) else { return };
    if let [one, other] = way[..] {
        chosen[one].is_pair = one == other;
        if one != other {
            chosen[one].hand = Some(Hand::Right);
            chosen[other].hand = Some(Hand::Left);
        }
    }
    let mut index = 0;
    chosen.retain(|_| {
        index += 1;
        !bands.contains(&(index - 1)) || way.contains(&(index - 1))
    });
}

/// Length of all edges that a waistband is sewn to, as worn, m: of skirt or legs, or else of the lower edge of a trunk.
fn waist_m(chosen: &[Recognised]) -> f64 {
    let of = |class: Class, label: Label| -> f64 {
        let copies = |one: &Recognised| match one.gore {
            Some(cut) => f64::from(cut.times()),
            None if one.alignment.template.is_whole || one.hand.is_some() => 1.0,
            None => 2.0,
        };
        // A yoke stands for what it lies on.
        let has_yoke = |face: Option<Face>| {
            let is_low = |one: &Recognised| one.class == Class::Yoke && one.alignment.template.has(Label::Waist);
            chosen.iter().any(|one| is_low(one) && one.face == face)
        };
        let is_it = |one: &&Recognised| {
            let is_yoke = one.class == Class::Yoke && class != Class::Body && one.alignment.template.has(label);
            let is_panel = class == Class::Body && one.class == Class::SidePanel;
            is_yoke || is_panel || (one.class == class && (class == Class::Body || !has_yoke(one.face)))
        };
        chosen.iter().filter(is_it).map(|one| copies(one) * length_m(one, label)).sum()
    };
    [(Class::Skirt, Label::Waist), (Class::Leg, Label::Waist), (Class::Body, Label::Hem)]
        .into_iter()
        .find(|(class, _)| chosen.iter().any(|one| one.class == *class))
        .map_or(0.0, |(class, label)| of(class, label))
}

/// Length of what a piece calls so, darts closed, m.
fn length_m(one: &Recognised, label: Label) -> f64 {
    let parts = one.alignment.parts.iter().filter(|part| part.label == label);
    parts.map(|part| one.shape.sewn_length(part.from, part.span)).sum()
}
