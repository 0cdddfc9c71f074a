//! Pose of a drawn piece of known role: which side is up, and which half of a piece it is.

use super::align::{TURNED, align, parts_of};
use super::shape::{Shape, quarter_turned};
use super::templates::{TEMPLATES, Template};
use super::{Class, Face, Hand, Label};
use crate::garment::Role;
use crate::style::{Edge, StylePiece};
use crate::trade::{self, PartName};
use geom::V2;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Counter-clockwise, to set the piece upright.
    pub quarter_turns: usize,
    /// True if the piece covers both sides of the body, or goes round the arm.
    pub is_whole: bool,
    /// True if the outer side is on the left of the upright drawing. Without meaning for a whole piece.
    is_mirrored: bool,
    /// Fit of the template, at most 1, less the penalty for a grain across the piece.
    pub score: f64,
}

impl Pose {
    /// Side as seen from outside. `None` for a whole piece.
    pub fn hand(&self, face: Face) -> Option<Hand> {
        (!self.is_whole).then(|| natural_hand(face, self.is_mirrored))
    }
}

/// Side of the wearer that half a piece covers. Its outer side is on the right of the drawing, or on the left if
/// mirrored.
pub fn natural_hand(face: Face, is_mirrored: bool) -> Hand {
    if (face == Face::Back) == is_mirrored { Hand::Left } else { Hand::Right }
}

/// Takes the best template of the role. `None` for a role without templates, or an outline without corners.
pub fn pose(piece: &StylePiece) -> Option<Pose> {
    let said = trade::read(&piece.id);
    let is_yoke = said.class == Some(Class::Yoke);
    let is_between = (said.part, said.face) == (Some(PartName::Side), None);
    let class = match piece.role {
        Role::Front | Role::Back | Role::BodiceFront | Role::BodiceBack if is_between => Class::SidePanel,
        Role::Front | Role::Back | Role::BodiceFront | Role::BodiceBack if is_yoke => Class::Yoke,
        Role::Front | Role::Back | Role::BodiceFront | Role::BodiceBack => Class::Body,
        Role::SleeveRight | Role::SleeveLeft => Class::Sleeve,
        Role::LegFrontRight | Role::LegFrontLeft | Role::LegBackRight | Role::LegBackLeft => Class::Leg,
        Role::LegRight | Role::LegLeft => Class::Leg,
        Role::SkirtFront | Role::SkirtBack => Class::Skirt,
        Role::Waistband => Class::Waistband,
        Role::Other => return None,
    };
    let outline = piece.outline();
    let nearest = |corner: &V2| {
        let distance = |i: &usize| (outline[*i] - corner).norm();
        (0..outline.len()).min_by(|i, j| distance(i).total_cmp(&distance(j)))
    };
    let mut corners: Vec<usize> = piece.corners.iter().filter_map(nearest).collect();
    corners.sort_unstable();
    corners.dedup();
    let shape = Shape::new(outline, corners)?;
    // As in a proposal, a sleeve called front or back is half a sleeve.
    let is_whole_sleeve = trade::read(&piece.id).face.is_none();
    let has = |label: Label| {
        piece.edges.iter().any(|edge| edge.name.as_deref().is_some_and(|name| name.starts_with(label.as_str())))
    };
    let (hangs_from_yoke, is_panel) = (has(Label::Top), has(Label::Princess));
    let is_raglan = has(Label::Neck) && !has(Label::Shoulder);
    let fits = |template: &&Template| match class {
        Class::Body if is_panel => template.is_panel(),
        Class::Body if is_raglan || template.is_raglan() => {
            template.class == class && template.is_raglan() == is_raglan
        }
        Class::Body => template.class == class && !template.is_panel() && template.has_shoulder() != hangs_from_yoke,
        Class::Sleeve => {
            let is_it = template.is_whole == is_whole_sleeve && template.is_raglan() == has(Label::Neck);
            template.class == class && is_it
        }
        Class::Yoke => template.class == class && template.has_shoulder(),
        Class::SidePanel => template.class == class && template.is_whole,
        Class::Leg => {
            let is_whole = matches!(piece.role, Role::LegRight | Role::LegLeft);
            template.class == class && template.is_whole == is_whole
        }
        _ => template.class == class,
    };
    if let Some(pose) = by_edges(piece, TEMPLATES.iter().filter(fits)) {
        return Some(pose);
    }
    // The grain of a band runs along the band, that of any other piece runs vertically.
    let is_along =
        |quarter_turns: usize| (piece.grain.x.abs() > piece.grain.y.abs()) == quarter_turns.is_multiple_of(2);
    let cost = |_: &Template, turns| if class != Class::Waistband && is_along(turns) { TURNED } else { 0.0 };
    let alignment = align(&shape, TEMPLATES.iter().filter(fits), cost)?;
    Some(Pose {
        quarter_turns: alignment.quarter_turns,
        is_whole: alignment.template.is_whole,
        is_mirrored: alignment.is_mirrored,
        score: alignment.score,
    })
}

/// Takes a hem to be below and a cap above, whatever the outline looks like. `None` if fewer than two kinds of edges
/// are named as in the templates.
fn by_edges<'t>(piece: &StylePiece, templates: impl Iterator<Item = &'t Template>) -> Option<Pose> {
    let named: Vec<(Label, V2)> =
        piece.edges.iter().filter_map(|edge| Some((label_of(edge.name.as_deref()?)?, middle(edge)))).collect();
    if named.iter().all(|(label, _)| *label == named[0].0) {
        return None;
    }
    let outline = piece.outline();
    let templates: Vec<&Template> = templates.collect();
    let mut best: Option<Pose> = None;
    for quarter_turns in 0..4 {
        let turned = |p: &V2| quarter_turned(p, quarter_turns);
        let points = outline.iter().map(turned);
        let (low, high) = points.fold((V2::repeat(f64::MAX), V2::repeat(f64::MIN)), |(l, h), p| (l.inf(&p), h.sup(&p)));
        let scale = (high - low).max().max(f64::MIN_POSITIVE);
        let size = (high - low) / scale;
        for template in &templates {
            for is_mirrored in if template.is_whole { &[false][..] } else { &[false, true] } {
                let parts = parts_of(template, *is_mirrored);
                let away = |(label, at): &(Label, V2)| {
                    let at = (turned(at) - low) / scale;
                    let of_label = parts.iter().filter(|part| part.label == *label);
                    of_label
                        .map(|part| (at - V2::new(part.at[0] * size.x, part.at[1] * size.y)).norm_squared())
                        .reduce(f64::min)
                };
                let Some(sum) = named.iter().map(away).sum::<Option<f64>>() else { continue };
                let score = 1.0 - sum / named.len() as f64;
                if best.as_ref().is_none_or(|best| score > best.score) {
                    best = Some(Pose { quarter_turns, is_whole: template.is_whole, is_mirrored: *is_mirrored, score });
                }
            }
        }
    }
    best
}

/// Reads the beginning of a name. `None` for another name.
fn label_of(name: &str) -> Option<Label> {
    use Label::{
        Armhole, Cap, Centre, Crotch, End, Hem, Inseam, Lower, Neck, Outseam, Princess, Shoulder, Side, Top, Underarm,
        Waist,
    };
    let word = name.split('_').next()?;
    let body = [Armhole, Centre, Hem, Neck, Princess, Shoulder, Side, Top, Waist];
    let limbs = [Cap, Crotch, End, Inseam, Lower, Outseam, Underarm];
    body.into_iter().chain(limbs).find(|label| label.as_str() == word)
}

/// Midpoint by length.
fn middle(edge: &Edge) -> V2 {
    let half = 0.5 * edge.line.length();
    let k = edge.line.arcs().partition_point(|&arc| arc < half).clamp(1, edge.line.points().len() - 1);
    let (from, to) = (edge.line.arcs()[k - 1], edge.line.arcs()[k]);
    edge.line.points()[k - 1].lerp(&edge.line.points()[k], (half - from) / (to - from).max(f64::MIN_POSITIVE))
}

pub fn named_face_and_hand(name: &str) -> (Option<Face>, Option<Hand>) {
    let named = trade::read(name);
    (named.face, named.hand)
}
