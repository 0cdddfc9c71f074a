//! Choice among several pieces for one place, and the arrangement of waistbands.

use std::collections::BTreeMap;

use super::ask::Asker;
use super::recognised::{Recognised, is_whole_leg, length_m};
use super::worn_pieces::{self, id_of};
use super::{Class, Face, Hand, Label, PartName, sew};
use crate::piece::Piece;

const MOST_COMBINATIONS: usize = 256;
/// Ratio of a waistband all round to the edges that it is sewn to. It may have an underlap or be eased.
const ROUND: std::ops::RangeInclusive<f64> = 0.8..=1.35;
/// As [`ROUND`], for half a waistband.
const HALF: std::ops::RangeInclusive<f64> = 0.42..=0.68;

/// Takes one piece for each place: of several, the user's choice, or else the one whose edges fit its neighbours best.
pub fn choose(pieces: &[Piece], mut recognised: Vec<Recognised>, asker: &mut Asker<'_>) -> Vec<Recognised> {
    leave_out_sleeves_in_two(pieces, &mut recognised, asker);
    leave_out_half_sleeves(pieces, &mut recognised, asker);
    let mut places: BTreeMap<String, Vec<usize>> = BTreeMap::new();
    for (index, candidate) in
        recognised.iter().enumerate().filter(|(_, candidate)| !is_round_band(candidate) && candidate.gore.is_none())
    {
        places.entry(id_of(candidate, candidate.hand)).or_default().push(index);
    }
    places.retain(|_, rivals| rivals.len() > 1);
    let contested: Vec<&Vec<usize>> = places.values().collect();
    let mut taken = best_of(pieces, &recognised, &contested, asker);
    for (k, (place, rivals)) in places.iter().enumerate() {
        let names: Vec<&str> = rivals.iter().map(|&rival| pieces[recognised[rival].piece].name.as_str()).collect();
        // The identifier of a trunk piece does not say trunk.
        let place = if place.is_empty() { Class::Body.as_str().to_owned() } else { place.replace('_', " ") };
        let text = format!("which piece is the {place}?");
        let of_place = rivals.iter().map(|&rival| recognised[rival].piece);
        taken[k] = asker.ask_of(of_place, text, names, Some(taken[k])).unwrap_or(taken[k]);
    }
    let mut left = kept(&recognised, &contested, &taken);
    ask_band(pieces, &recognised, &mut left, asker);
    left
}

/// Asks which waistband is worn, if there are more than fit round the waist.
fn ask_band(pieces: &[Piece], all: &[Recognised], left: &mut Vec<Recognised>, asker: &mut Asker<'_>) {
    let bands: Vec<&Recognised> = all.iter().filter(|candidate| is_round_band(candidate)).collect();
    let is_left = |band: &&Recognised| left.iter().any(|candidate| candidate.piece == band.piece);
    let Some(stands) = bands.iter().position(is_left).filter(|_| !bands.iter().all(is_left)) else { return };
    let names: Vec<&str> = bands.iter().map(|band| pieces[band.piece].name.as_str()).collect();
    let of_band: Vec<usize> = bands.iter().map(|band| band.piece).collect();
    let taken = asker.ask_of(of_band, "which piece is the waistband?".to_owned(), names, Some(stands));
    if let Some(taken) = taken.filter(|&taken| taken != stands) {
        left.retain(|candidate| candidate.class != Class::Waistband);
        left.push(bands[taken].clone());
        go_round(left);
    }
}

/// Best candidate for each contested place: the one whose edges fit its neighbours best, or the first of equals.
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
        let worn = worn_pieces::worn(pieces, &kept(all, contested, &taken), None, &mut asker.aside());
        let sum: f64 = sew::sew(&worn, &mut asker.aside()).iter().map(|seam| seam.confidence).sum();
        if sum > best.0 + 1e-9 {
            best = (sum, taken);
        }
    }
    best.1
}

fn kept(all: &[Recognised], contested: &[&Vec<usize>], taken: &[usize]) -> Vec<Recognised> {
    let chosen =
        |index: usize| contested.iter().zip(taken).all(|(rivals, &k)| !rivals.contains(&index) || rivals[k] == index);
    let left = all.iter().enumerate().filter(|(index, _)| chosen(*index));
    let mut left: Vec<Recognised> = left.map(|(_, candidate)| candidate.clone()).collect();
    go_round(&mut left);
    left
}

/// Outlines do not show where their seams meet the armhole, and either alone is no sleeve.
fn leave_out_sleeves_in_two(pieces: &[Piece], recognised: &mut Vec<Recognised>, asker: &mut Asker<'_>) {
    let is_whole_sleeve = |candidate: &&Recognised| candidate.class == Class::Sleeve && candidate.face.is_none();
    let whole: Vec<&Recognised> = recognised.iter().filter(is_whole_sleeve).collect();
    let unders = whole.iter().filter(|candidate| candidate.part == Some(PartName::Under)).count();
    if unders > 0 && unders < whole.len() {
        let names =
            whole.iter().map(|candidate| format!("`{}`", pieces[candidate.piece].name)).collect::<Vec<_>>().join(", ");
        asker.tell(format!(
            "left out: {names}: a sleeve in two pieces; at which place of the armhole do its seams begin?"
        ));
        recognised.retain(|candidate| !is_whole_sleeve(&candidate));
    }
}

/// Leaves them out if there is a whole sleeve: files may hold both variants.
fn leave_out_half_sleeves(pieces: &[Piece], recognised: &mut Vec<Recognised>, asker: &mut Asker<'_>) {
    let is_half = |candidate: &Recognised| candidate.class == Class::Sleeve && candidate.face.is_some();
    let has_whole = recognised.iter().any(|candidate| candidate.class == Class::Sleeve && !is_half(candidate));
    let halves: Vec<String> = recognised
        .iter()
        .filter(|candidate| is_half(candidate))
        .map(|candidate| format!("`{}`", pieces[candidate.piece].name))
        .collect();
    if has_whole && !halves.is_empty() {
        let text = "a sleeve in one piece, or in halves?".to_owned();
        let in_halves = Some(1) == asker.ask(text, ["in one piece".to_owned(), halves.join(", ")], Some(0));
        let is_whole = |candidate: &Recognised| candidate.class == Class::Sleeve && !is_half(candidate);
        recognised.retain(|candidate| if in_halves { !is_whole(candidate) } else { !is_half(candidate) });
    }
}

fn is_round_band(candidate: &Recognised) -> bool {
    candidate.class == Class::Waistband && candidate.face.is_none() && candidate.hand.is_none()
}

/// Arranges waistbands whose names give neither a side nor front or back: one all round, a right and a left one, or one
/// that is cut twice. The ratio of their length to that of the edges that they are sewn to decides. Further bands are
/// dropped.
fn go_round(chosen: &mut Vec<Recognised>) {
    let bands: Vec<usize> = (0..chosen.len()).filter(|&i| is_round_band(&chosen[i])).collect();
    let waist = waist_m(chosen);
    if bands.is_empty() || waist <= 0.0 {
        return;
    }
    let share = |i: usize| length_m(&chosen[i], Label::Lower) / waist;
    let halves: Vec<usize> = bands.iter().copied().filter(|&i| HALF.contains(&share(i))).collect();
    // Candidate arrangements, each with its total ratio and its bands. Two different halves come before one that is cut
    // twice.
    let two = halves.iter().enumerate().flat_map(|(k, &i)| halves[k + 1..].iter().map(move |&j| vec![i, j]));
    let two = two.map(|pair| (pair.iter().map(|&i| share(i)).sum::<f64>(), pair));
    let single = bands.iter().map(|&i| (share(i), vec![i]));
    let twice = halves.iter().map(|&i| (2.0 * share(i), vec![i, i]));
    let ways = two.chain(single).chain(twice).filter(|(total, _)| ROUND.contains(total));
    let Some((_, way)) = ways.min_by(|a, b| a.0.ln().abs().total_cmp(&b.0.ln().abs())) else { return };
    if let [first, second] = way[..] {
        chosen[first].is_pair = first == second;
        if first != second {
            chosen[first].hand = Some(Hand::Right);
            chosen[second].hand = Some(Hand::Left);
        }
    }
    let mut index = 0;
    chosen.retain(|_| {
        index += 1;
        !bands.contains(&(index - 1)) || way.contains(&(index - 1))
    });
}

/// Edges that a waistband is sewn to, as worn: those of skirt or legs, or else the lower edge of the trunk.
fn waist_m(chosen: &[Recognised]) -> f64 {
    let total_m = |class: Class, label: Label| -> f64 {
        let copies = |candidate: &Recognised| match candidate.gore {
            Some(cut) => f64::from(cut.times()),
            None if (candidate.alignment.template.is_whole && !is_whole_leg(candidate)) || candidate.hand.is_some() => {
                1.0
            }
            None => 2.0,
        };
        // A yoke takes the place of the pieces that it is sewn onto.
        let has_yoke = |face: Option<Face>| {
            let is_low = |candidate: &Recognised| {
                candidate.class == Class::Yoke && candidate.alignment.template.has(Label::Waist)
            };
            chosen.iter().any(|candidate| is_low(candidate) && candidate.face == face)
        };
        let is_it = |candidate: &&Recognised| {
            let is_yoke =
                candidate.class == Class::Yoke && class != Class::Body && candidate.alignment.template.has(label);
            let is_panel = class == Class::Body && candidate.class == Class::SidePanel;
            is_yoke || is_panel || (candidate.class == class && (class == Class::Body || !has_yoke(candidate.face)))
        };
        chosen.iter().filter(is_it).map(|candidate| copies(candidate) * length_m(candidate, label)).sum()
    };
    [(Class::Skirt, Label::Waist), (Class::Leg, Label::Waist), (Class::Body, Label::Hem)]
        .into_iter()
        .find(|(class, _)| chosen.iter().any(|candidate| candidate.class == *class))
        .map_or(0.0, |(class, label)| total_m(class, label))
}
