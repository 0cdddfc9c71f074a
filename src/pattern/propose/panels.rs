//! Fronts and backs that are cut lengthwise by princess seams: a part in the middle and one at either side.

use super::align::{Alignment, LEAST_FIT, upright};
use super::names::Named;
use super::shape::Shape;
use super::templates::Template;
use super::{Class, Face, Label};
use crate::piece::Piece;

/// A part of a front or back.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Panel {
    /// The part between the princess seams, or [`Class::SidePanel`], outside one.
    pub class: Class,
    /// Whether the seam begins at the shoulder; else at the armhole.
    from_shoulder: bool,
}

impl Panel {
    /// Whether a template is one of this part.
    pub fn fits(self, template: &Template) -> bool {
        let begins_at_shoulder = match self.class {
            Class::SidePanel => template.has_shoulder(),
            _ => !template.has(Label::Armhole),
        };
        template.is_panel() && template.class == self.class && begins_at_shoulder == self.from_shoulder
    }
}

/// Greatest difference of the two sides of a princess seam, share of the longer: the bust is eased in at most.
const UNLIKE: f64 = 0.08;

/// What part each piece is, and `None` for a piece that is no part.
///
/// Nothing is a part where a face has one piece, or where two pieces fit a whole front or back, or half of one, better.
pub fn panels(pieces: &[Piece], named: &[Named]) -> Vec<Option<Panel>> {
    let mut found = vec![None; pieces.len()];
    for face in Face::BOTH {
        let of_face = (0..pieces.len()).filter(|&k| named[k].class.is_none() && named[k].face == Some(face));
        let outlines: Vec<(usize, Shape)> = of_face.filter_map(|k| Some((k, Shape::of(&pieces[k])?))).collect();
        let pairs = outlines.iter().flat_map(|one| outlines.iter().map(move |other| [one, other]));
        let pairs = pairs.filter(|[one, other]| one.0 != other.0);
        let together = |pair: [&(usize, Shape); 2]| Some((together(pair.map(|one| &one.1))?, pair.map(|one| one.0)));
        let best = pairs.filter_map(together).max_by(|a, b| a.0.0.total_cmp(&b.0.0));
        if let Some(((_, panels), numbers)) = best {
            for (number, panel) in numbers.into_iter().zip(panels) {
                found[number] = Some(panel);
            }
        }
    }
    found
}

/// Two outlines as the middle and the side of a front or back, and how much better they fit that than whole ones or halves;
/// `None` where they do not.
fn together(outlines: [&Shape; 2]) -> Option<(f64, [Panel; 2])> {
    let of_trunk = |template: &Template| template.class == Class::Body && !template.is_panel();
    let plain: f64 = outlines.into_iter().filter_map(|shape| upright(shape, of_trunk)).map(|found| found.score).sum();
    let from = |from_shoulder: bool| {
        let panels = [Class::Body, Class::SidePanel].map(|class| Panel { class, from_shoulder });
        let mut sum = 0.0;
        let mut seams = [0.0; 2];
        for ((shape, panel), seam) in outlines.into_iter().zip(panels).zip(&mut seams) {
            let found = upright(shape, |template| panel.fits(template)).filter(|found| found.score >= LEAST_FIT)?;
            sum += found.score;
            *seam = seam_m(shape, &found)?;
        }
        let [a, b] = seams;
        ((a - b).abs() <= UNLIKE * a.max(b)).then_some((sum - plain, panels))
    };
    [true, false].into_iter().filter_map(from).max_by(|a, b| a.0.total_cmp(&b.0)).filter(|(gain, _)| *gain > 0.0)
}

/// Length of the princess seam on one side, m.
fn seam_m(shape: &Shape, alignment: &Alignment) -> Option<f64> {
    let part = alignment.parts.iter().find(|part| part.label == Label::Princess)?;
    Some(shape.sewn_length(part.from, part.span))
}
