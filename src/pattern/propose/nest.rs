//! Check of a proposal made on one size against the other sizes: the corners are found on each size, and the ease of
//! its seams is recorded.

use std::collections::BTreeMap;

use super::{Proposal, ProposedSeam, Question};
use crate::piece::Piece;
use crate::progression::{Leap, leaps};
use crate::seam_edit::Sizes;
use crate::seams::{DEFAULT_LENGTH_TOLERANCE_MM, Ease, RATIO_DOUBT, SAME_EASE, SeamEntry, StyleError};
use crate::size_order;
use crate::style::{Seam, Style};
use geom::units::mm;

/// Greatest difference of the sides of a plain seam: an eighth of an inch, the usual sewing tolerance.
const PLAIN_MM: f64 = 3.0;
/// The same for a long seam, as a share of its length: cloth takes up as much without a pleat.
const PLAIN_SHARE: f64 = 0.02;

struct Sewn<'a> {
    size: &'a str,
    style: Style,
}

impl Proposal {
    /// Records the size of the proposal, and checks the proposal against the other sizes. Each mismatch becomes a
    /// question.
    pub fn hold_for(&mut self, sizes: &Sizes<'_>) {
        self.size = Some(sizes.name.to_owned());
        let own = std::iter::once((sizes.name, sizes.pieces));
        let mut all: Vec<_> =
            own.chain(sizes.others.iter().map(|(size, pieces)| (size.as_str(), &pieces[..]))).collect();
        size_order::sort(&mut all, |(size, _)| size);
        let (mut sewn, mut failed) = (Vec::new(), Vec::new());
        for (size, pieces) in all {
            match self.on(pieces) {
                Ok(style) => sewn.push(Sewn { size, style }),
                Err(error) => failed.push((size, error)),
            }
        }
        if let Some((_, error)) = failed.first() {
            let sizes: Vec<&str> = failed.iter().map(|(size, _)| *size).collect();
            self.tell(format!("it does not hold for size {}: {error}", sizes.join(", ")), Vec::new());
        }
        let Some(made_on) = sewn.iter().position(|sized| sized.size == sizes.name) else { return };
        for number in 0..self.seams.len() {
            if let Some(doubt) = self.ease_in(number, &sewn, made_on) {
                let SeamEntry { a, b, .. } = &self.seams[number].entry;
                self.tell(doubt, a.iter().chain(b).cloned().collect());
            }
        }
        doubted_leaps(&sewn).into_iter().for_each(|doubt| self.tell(doubt, Vec::new()));
    }

    /// Records the ease of a seam in every size whose length ratio is plausible. Returns a question about the other
    /// sizes. `None` without such a size.
    fn ease_in(&mut self, number: usize, sewn: &[Sewn<'_>], made_on: usize) -> Option<String> {
        let seam = &mut self.seams[number];
        let sides_mm: Vec<[f64; 2]> =
            sewn.iter().map(|sized| lengths_mm(&sized.style, &sized.style.seams[number])).collect();
        let doubted = doubted_sizes(&sides_mm, made_on);
        if let Ease::Same(own_mm) = seam.entry.ease_mm {
            let tolerance_mm = SAME_EASE * DEFAULT_LENGTH_TOLERANCE_MM;
            let is_other = |[a_mm, b_mm]: &[f64; 2]| (a_mm - b_mm - own_mm).abs() > tolerance_mm;
            if sides_mm.iter().any(is_other) {
                let sure = sewn.iter().zip(&sides_mm).zip(&doubted).filter(|(_, is_doubted)| !**is_doubted);
                let ease_mm = |[a_mm, b_mm]: [f64; 2]| ((a_mm - b_mm) * 10.0).round() / 10.0;
                let eases = sure.map(|((sized, sides_mm), _)| (sized.size.to_owned(), ease_mm(*sides_mm)));
                seam.entry.ease_mm = Ease::BySize(eases.collect());
            }
        }
        doubt(seam, sewn, &sides_mm, &doubted)
    }

    fn tell(&mut self, text: String, about: Vec<String>) {
        let number = self.questions.iter().map(|question| question.number).max().unwrap_or(0) + 1;
        self.questions.push(Question { number, about, ..Question::told(text) });
    }

    /// Builds another size, whatever the length differences of its seams.
    fn on(&self, pieces: &[Piece]) -> Result<Style, StyleError> {
        let mut entries = self.seam_file("");
        entries.length_tolerance_mm = f64::INFINITY;
        Style::of(pieces, &entries, "proposed")
    }
}

/// True for each size in which the length ratio of both sides of a seam is doubtful. A plain seam must be plain in
/// every size. The ratio of any other seam is compared with that of the nearest undoubted size towards `made_on`.
fn doubted_sizes(sides_mm: &[[f64; 2]], made_on: usize) -> Vec<bool> {
    let ratio = |size: usize| sides_mm[size][0] / sides_mm[size][1];
    let is_plain = |size: usize| {
        let [a_mm, b_mm] = sides_mm[size];
        (a_mm - b_mm).abs() <= PLAIN_MM.max(PLAIN_SHARE * b_mm)
    };
    let mut doubted = vec![false; sides_mm.len()];
    let mut go = |way: &mut dyn Iterator<Item = usize>| {
        let mut sound = ratio(made_on);
        for size in way {
            let is_other = match is_plain(made_on) {
                true => !is_plain(size),
                false => (ratio(size) / sound - 1.0).abs() > RATIO_DOUBT,
            };
            doubted[size] = is_other;
            if !is_other {
                sound = ratio(size);
            }
        }
    };
    go(&mut (made_on + 1..sides_mm.len()));
    go(&mut (0..made_on).rev());
    doubted
}

fn doubt(seam: &ProposedSeam, sewn: &[Sewn<'_>], sides_mm: &[[f64; 2]], doubted: &[bool]) -> Option<String> {
    let first = doubted.iter().position(|is_doubted| *is_doubted)?;
    let doubted_ones = sewn.iter().zip(doubted).filter(|(_, is_doubted)| **is_doubted);
    let sizes: Vec<&str> = doubted_ones.map(|(sized, _)| sized.size).collect();
    let [a_mm, b_mm] = sides_mm[first];
    Some(format!(
        "{}: {:.0} to {:.0} mm as proposed, {a_mm:.0} to {b_mm:.0} mm in {}: is it the same seam in size {}? No ease is written there",
        seam.kind,
        seam.a_mm,
        seam.b_mm,
        sewn[first].size,
        sizes.join(", ")
    ))
}

fn doubted_leaps(sewn: &[Sewn<'_>]) -> Vec<String> {
    let sizes: Vec<String> = sewn.iter().map(|sized| sized.size.to_owned()).collect();
    let styles: Vec<&Style> = sewn.iter().map(|sized| &sized.style).collect();
    let mut by_sizes: BTreeMap<[usize; 2], Vec<Leap>> = BTreeMap::new();
    leaps(&styles).into_iter().for_each(|leap| by_sizes.entry(leap.sizes).or_default().push(leap));
    let told = |([before, after], leaps): (&[usize; 2], &Vec<Leap>)| {
        let each: Vec<String> = leaps.iter().map(Leap::told).collect();
        format!(
            "from size {} to {} lengths leap: {}; are its corners where they should be?",
            sizes[*before],
            sizes[*after],
            each.join(", ")
        )
    };
    by_sizes.iter().map(told).collect()
}

fn lengths_mm(style: &Style, seam: &Seam) -> [f64; 2] {
    [&seam.a, &seam.b].map(|chain| chain.iter().map(|&edge| mm(style.edge(edge).line.length())).sum())
}

#[cfg(test)]
mod tests {
    use super::doubted_sizes;

    #[test]
    fn a_seam_is_doubted_where_its_sides_part_and_as_long_as_they_stay_so() {
        let check = |sides_mm: &[[f64; 2]], made_on: usize, expect: &[bool]| {
            assert_eq!(doubted_sizes(sides_mm, made_on), expect, "{sides_mm:?}");
        };
        check(
            &[[100.0, 100.0], [110.0, 110.0], [120.0, 150.0], [130.0, 160.0], [140.0, 140.0]],
            0,
            &[false, false, true, true, false],
        );
        check(&[[100.0, 140.0], [119.0, 110.0], [129.0, 120.0]], 2, &[true, false, false]);
        // An ease that grows with the sizes, and one that a plain seam gets.
        check(&[[505.0, 490.0], [536.0, 517.0], [567.0, 544.0]], 0, &[false, false, false]);
        check(&[[290.0, 290.0], [291.0, 286.0], [294.0, 287.0]], 0, &[false, false, true]);
        check(&[[99.0, 100.0], [103.0, 100.0], [104.0, 100.0]], 0, &[false, false, true]);
    }
}
