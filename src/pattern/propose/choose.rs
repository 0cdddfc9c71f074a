//! Which pieces are meant where a file holds several for one place, and how waistbands go round.

use std::collections::BTreeMap;

use super::ask::Asker;
use super::names::Part;
use super::recognise::{Recognised, is_whole_leg, length_m};
use super::worn::{self, id_of};
use super::{Class, Face, Hand, Label, sew};
use crate::piece::Piece;

/// Most combinations of pieces that are tried.
const MOST_COMBINATIONS: usize = 256;
/// Length of a waistband over that of all it is sewn to: all round, with an underlap or eased.
const ROUND: std::ops::RangeInclusive<f64> = 0.8..=1.35;
/// The same of half a waistband.
const HALF: std::ops::RangeInclusive<f64> = 0.42..=0.68;

/// The pieces that make a garment, one for each place: of several the one that the person names, or else
/// those whose edges fit their neighbours' best.
pub fn choose(pieces: &[Piece], mut recognised: Vec<Recognised>, asker: &mut Asker<'_>) -> Vec<Recognised> {
    leave_out_sleeves_in_two(pieces, &mut recognised, asker);
    leave_out_half_sleeves(pieces, &mut recognised, asker);
    let mut places: BTreeMap<String, Vec<usize>> = BTreeMap::new();
    for (index, one) in recognised.iter().enumerate().filter(|(_, one)| !is_round_band(one) && one.gore.is_none()) {
        places.entry(id_of(one, one.hand)).or_default().push(index);
    }
    places.retain(|_, rivals| rivals.len() > 1);
    let contested: Vec<&Vec<usize>> = places.values().collect();
    let mut taken = best_of(pieces, &recognised, &contested, asker);
    for (k, (place, rivals)) in places.iter().enumerate() {
        let names: Vec<&str> = rivals.iter().map(|&rival| pieces[recognised[rival].piece].name.as_str()).collect();
        // The trunk has no word in identifiers.
        let place = if place.is_empty() { Class::Body.as_str().to_owned() } else { place.replace('_', " ") };
        let text = format!("which piece is the {place}?");
        taken[k] = asker.ask(text, names, Some(taken[k])).unwrap_or(taken[k]);
    }
    let mut left = kept(&recognised, &contested, &taken);
    ask_band(pieces, &recognised, &mut left, asker);
    left
}

/// Asks which waistband is worn where there are more than go round.
fn ask_band(pieces: &[Piece], all: &[Recognised], left: &mut Vec<Recognised>, asker: &mut Asker<'_>) {
    let bands: Vec<&Recognised> = all.iter().filter(|one| is_round_band(one)).collect();
    let is_left = |band: &&Recognised| left.iter().any(|one| one.piece == band.piece);
    let Some(stands) = bands.iter().position(is_left).filter(|_| !bands.iter().all(is_left)) else { return };
    let names: Vec<&str> = bands.iter().map(|band| pieces[band.piece].name.as_str()).collect();
    let taken = asker.ask("which piece is the waistband?".to_owned(), names, Some(stands));
    if let Some(taken) = taken.filter(|&taken| taken != stands) {
        left.retain(|one| one.class != Class::Waistband);
        left.push(bands[taken].clone());
        go_round(left);
    }
}

/// For each contested place which of its rivals is taken: those whose edges fit their neighbours' best; of equals the first.
fn best_of(pieces: &[Piece], all: &[Recognised], contested: &[&Vec<usize>], asker: &Asker<'_>) -> Vec<usize> {
    let count = contested.iter().fold(1_usize, |count, rivals| count.saturating_mul(rivals.len()));
    let mut best = (f64::NEG_INFINITY, vec![0; contested.len()]);
    if count == 1 {
        return best.1;
    }
    for number in 0..count.min(MOST_COMBINATIONS) {
        let mut rest = number;
        let digit = |rivals: &&Vec<usize>| {
            let digit = rest % rivals.len();
            rest /= rivals.len();
            digit
        };
        let taken: Vec<usize> = contested.iter().map(digit).collect();
        let worn = worn::worn(pieces, &kept(all, contested, &taken), None, &mut asker.aside());
        let sum: f64 = sew::sew(&worn, &mut asker.aside()).iter().map(|seam| seam.confidence).sum();
        if sum > best.0 + 1e-9 {
            best = (sum, taken);
        }
    }
    best.1
}

/// What is left when each contested place has one of its rivals; waistbands go round.
fn kept(all: &[Recognised], contested: &[&Vec<usize>], taken: &[usize]) -> Vec<Recognised> {
    let chosen =
        |index: usize| contested.iter().zip(taken).all(|(rivals, &k)| !rivals.contains(&index) || rivals[k] == index);
    let left = all.iter().enumerate().filter(|(index, _)| chosen(*index));
    let mut left: Vec<Recognised> = left.map(|(_, one)| one.clone()).collect();
    go_round(&mut left);
    left
}

/// Takes out an upper and an under sleeve: where their seams meet the armhole no outline says, and one of them alone
/// is no sleeve.
fn leave_out_sleeves_in_two(pieces: &[Piece], recognised: &mut Vec<Recognised>, asker: &mut Asker<'_>) {
    let is_whole_sleeve = |one: &&Recognised| one.class == Class::Sleeve && one.face.is_none();
    let whole: Vec<&Recognised> = recognised.iter().filter(is_whole_sleeve).collect();
    let unders = whole.iter().filter(|one| one.part == Some(Part::Under)).count();
    if unders > 0 && unders < whole.len() {
        let names = whole.iter().map(|one| format!("`{}`", pieces[one.piece].name)).collect::<Vec<_>>().join(", ");
        asker.tell(format!(
            "left out: {names}: a sleeve in two pieces; at which place of the armhole do its seams begin?"
        ));
        recognised.retain(|one| !is_whole_sleeve(&one));
    }
}

/// Takes out sleeves in halves where there is a whole one: they are another way to cut it.
fn leave_out_half_sleeves(pieces: &[Piece], recognised: &mut Vec<Recognised>, asker: &mut Asker<'_>) {
    let is_half = |one: &Recognised| one.class == Class::Sleeve && one.face.is_some();
    let has_whole = recognised.iter().any(|one| one.class == Class::Sleeve && !is_half(one));
    let halves: Vec<String> =
        recognised.iter().filter(|one| is_half(one)).map(|one| format!("`{}`", pieces[one.piece].name)).collect();
    if has_whole && !halves.is_empty() {
        let text = "a sleeve in one piece, or in halves?".to_owned();
        let in_halves = Some(1) == asker.ask(text, ["in one piece".to_owned(), halves.join(", ")], Some(0));
        let is_whole = |one: &Recognised| one.class == Class::Sleeve && !is_half(one);
        recognised.retain(|one| if in_halves { !is_whole(one) } else { !is_half(one) });
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
            None if (one.alignment.template.is_whole && !is_whole_leg(one)) || one.hand.is_some() => 1.0,
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
