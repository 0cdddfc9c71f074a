//! Panels of fronts and backs with princess seams: one in the middle, one at either side.

use super::align::{Alignment, LEAST_FIT, upright};
use super::shape::Shape;
use super::templates::Template;
use super::{Class, Face, Label};
use crate::piece::Piece;
use crate::trade::Named;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Panel {
    /// [`Class::Body`] between the princess seams, [`Class::SidePanel`] outside.
    pub class: Class,
    /// False for a seam that begins at the armhole.
    from_shoulder: bool,
}

impl Panel {
    pub fn fits(self, template: &Template) -> bool {
        let begins_at_shoulder = match self.class {
            Class::SidePanel => template.has_shoulder(),
            _ => !template.has(Label::Armhole),
        };
        template.is_panel() && template.class == self.class && begins_at_shoulder == self.from_shoulder
    }
}

/// Greatest relative length difference between both sides of a princess seam, into which at most the bust is eased.
const UNLIKE: f64 = 0.08;

/// `None` for a piece that is no panel. There are no panels if a face has one piece, or if two of its pieces fit a
/// whole or half front or back better.
pub fn panels(pieces: &[Piece], named: &[Named]) -> Vec<Option<Panel>> {
    let mut found = vec![None; pieces.len()];
    for face in Face::BOTH {
        let of_face = (0..pieces.len()).filter(|&k| named[k].class.is_none() && named[k].face == Some(face));
        let outlines: Vec<(usize, Shape)> = of_face.filter_map(|k| Some((k, Shape::of(&pieces[k])?))).collect();
        let pairs = outlines.iter().flat_map(|outline| outlines.iter().map(move |other| [outline, other]));
        let pairs = pairs.filter(|[outline, other]| outline.0 != other.0);
        let fit = |pair: [&(usize, Shape); 2]| {
            Some((together(pair.map(|(_, shape)| shape))?, pair.map(|(number, _)| *number)))
        };
        let best = pairs.filter_map(fit).max_by(|a, b| a.0.gain.total_cmp(&b.0.gain));
        if let Some((pair, numbers)) = best {
            for (number, panel) in numbers.into_iter().zip(pair.panels) {
                found[number] = Some(panel);
            }
        }
    }
    found
}

struct PanelPair {
    /// Advantage in fit over whole pieces or halves.
    gain: f64,
    panels: [Panel; 2],
}

/// Middle and side panel. `None` if they do not fit together.
fn together(outlines: [&Shape; 2]) -> Option<PanelPair> {
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
        ((a - b).abs() <= UNLIKE * a.max(b)).then_some(PanelPair { gain: sum - plain, panels })
    };
    [true, false].into_iter().filter_map(from).max_by(|a, b| a.gain.total_cmp(&b.gain)).filter(|pair| pair.gain > 0.0)
}

/// `None` without a princess seam.
fn seam_m(shape: &Shape, alignment: &Alignment) -> Option<f64> {
    let part = alignment.parts.iter().find(|part| part.label == Label::Princess)?;
    Some(shape.sewn_length(part.from, part.span))
}
