//! A proposal made on one size held to the others: the corners are found on each, and the ease of each is written down.

use super::{Proposal, ProposedSeam, Question};
use crate::piece::Piece;
use crate::seams::{DEFAULT_LENGTH_TOLERANCE_MM, Ease, RATIO_DOUBT, SAME_EASE, StyleError};
use crate::style::{Seam, Style};
use geom::units::mm;

impl Proposal {
    /// Says on which size it was made, and holds it to others. What does not hold there is a question.
    pub fn hold_for(&mut self, made_on: &str, others: &[(String, Vec<Piece>)]) {
        self.size = Some(made_on.to_owned());
        let (mut sides_mm, mut failed) = (vec![Vec::new(); self.seams.len()], Vec::new());
        for (size, pieces) in others {
            match self.on(pieces) {
                Ok(style) => {
                    for (sides_mm, seam) in sides_mm.iter_mut().zip(&style.seams) {
                        sides_mm.push((size.as_str(), lengths_mm(&style, seam)));
                    }
                }
                Err(error) => failed.push((size.as_str(), error)),
            }
        }
        if let Some((_, error)) = failed.first() {
            let sizes: Vec<&str> = failed.iter().map(|(size, _)| *size).collect();
            self.tell(format!("it does not hold for size {}: {error}", sizes.join(", ")));
        }
        let doubts: Vec<String> =
            self.seams.iter().zip(&sides_mm).filter_map(|(seam, sides_mm)| doubt(seam, made_on, sides_mm)).collect();
        doubts.into_iter().for_each(|doubt| self.tell(doubt));
        for (seam, sides_mm) in self.seams.iter_mut().zip(sides_mm) {
            let Ease::Same(own) = seam.entry.ease_mm else { continue };
            let tolerance_mm = SAME_EASE * DEFAULT_LENGTH_TOLERANCE_MM;
            if sides_mm.iter().any(|(_, [a_mm, b_mm])| (a_mm - b_mm - own).abs() > tolerance_mm) {
                let all = sides_mm.into_iter().chain([(made_on, [seam.a_mm, seam.b_mm])]);
                let eases = all.map(|(size, [a_mm, b_mm])| (size.to_owned(), ((a_mm - b_mm) * 10.0).round() / 10.0));
                seam.entry.ease_mm = Ease::BySize(eases.collect());
            }
        }
    }

    /// Adds what has no choices.
    fn tell(&mut self, text: String) {
        let number = self.questions.iter().map(|question| question.number).max().unwrap_or(0) + 1;
        self.questions.push(Question { number, ..Question::told(text) });
    }

    /// The style that another size makes, however long its seams are.
    fn on(&self, pieces: &[Piece]) -> Result<Style, StyleError> {
        let mut entries = self.seam_file("");
        entries.length_tolerance_mm = f64::INFINITY;
        Style::of(pieces, &entries, "proposed")
    }
}

/// A question where the sides of a seam are to each other in some sizes as they are not in the one it was made on.
fn doubt(seam: &ProposedSeam, made_on: &str, sides_mm: &[(&str, [f64; 2])]) -> Option<String> {
    let differs = |(_, [a_mm, b_mm]): &&(&str, [f64; 2])| (a_mm / b_mm / seam.ratio() - 1.0).abs() > RATIO_DOUBT;
    let others: Vec<_> = sides_mm.iter().filter(differs).collect();
    let (size, [a_mm, b_mm]) = others.first()?;
    let sizes: Vec<&str> = others.iter().map(|(size, _)| *size).collect();
    Some(format!(
        "{}: {:.0} to {:.0} mm in {made_on}, {a_mm:.0} to {b_mm:.0} mm in {size}: is it the same seam in size {}?",
        seam.kind,
        seam.a_mm,
        seam.b_mm,
        sizes.join(", ")
    ))
}

/// Lengths of the sides of a seam, mm.
fn lengths_mm(style: &Style, seam: &Seam) -> [f64; 2] {
    [&seam.a, &seam.b].map(|chain| chain.iter().map(|&edge| mm(style.edge(edge).line.length())).sum())
}
