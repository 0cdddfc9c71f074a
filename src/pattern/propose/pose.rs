//! How a piece of a known role is drawn: which side is up, and which half it is.

use super::align::{TURNED, align};
use super::names;
use super::shape::Shape;
use super::templates::{TEMPLATES, Template};
use super::{Class, Face, Hand, Label};
use crate::garment::Role;
use crate::style::StylePiece;

/// How a piece is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pose {
    /// Quarter turns, counter-clockwise, that set it upright.
    pub quarter_turns: usize,
    /// Whether it covers both sides of the body, or goes round the arm.
    pub is_whole: bool,
    /// Whether its outer side is to the left of the upright drawing; says nothing of a whole piece.
    is_mirrored: bool,
}

impl Pose {
    /// Side of the wearer that half a front or back is for, seen from outside; `None` for a whole piece.
    #[must_use]
    pub fn hand(&self, face: Face) -> Option<Hand> {
        (!self.is_whole).then(|| natural_hand(face, self.is_mirrored))
    }
}

/// Side of the wearer of half a piece whose outer side is to the right of the drawing, or to the left where mirrored.
pub fn natural_hand(face: Face, is_mirrored: bool) -> Hand {
    if (face == Face::Back) == is_mirrored { Hand::Left } else { Hand::Right }
}

/// How a piece is drawn, by the template of its role that fits best; `None` for a role without templates, or an outline
/// without corners.
#[must_use]
pub fn pose(piece: &StylePiece) -> Option<Pose> {
    let is_yoke = names::read(&piece.id).class == Some(Class::Yoke);
    let class = match piece.role {
        Role::Front | Role::Back | Role::BodiceFront | Role::BodiceBack if is_yoke => Class::Yoke,
        Role::Front | Role::Back | Role::BodiceFront | Role::BodiceBack => Class::Body,
        Role::SleeveRight | Role::SleeveLeft => Class::Sleeve,
        Role::LegFrontRight | Role::LegFrontLeft | Role::LegBackRight | Role::LegBackLeft => Class::Leg,
        Role::SkirtFront | Role::SkirtBack => Class::Skirt,
        Role::Waistband => Class::Waistband,
        Role::Other => return None,
    };
    let outline = piece.outline();
    let nearest = |corner: &geom::V2| {
        let distance = |i: &usize| (outline[*i] - corner).norm();
        (0..outline.len()).min_by(|i, j| distance(i).total_cmp(&distance(j)))
    };
    let mut corners: Vec<usize> = piece.corners.iter().filter_map(nearest).collect();
    corners.sort_unstable();
    corners.dedup();
    let shape = Shape::new(outline, corners)?;
    // As in a proposal, a sleeve that is called front or back is half of one.
    let is_whole_sleeve = names::read(&piece.id).face.is_none();
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
        _ => template.class == class,
    };
    // The grain runs up and down, except along a band.
    let is_along =
        |quarter_turns: usize| (piece.grain.x.abs() > piece.grain.y.abs()) == quarter_turns.is_multiple_of(2);
    let cost = |quarter_turns| if class != Class::Waistband && is_along(quarter_turns) { TURNED } else { 0.0 };
    let alignment = align(&shape, TEMPLATES.iter().filter(fits), cost)?;
    Some(Pose {
        quarter_turns: alignment.quarter_turns,
        is_whole: alignment.template.is_whole,
        is_mirrored: alignment.is_mirrored,
    })
}

/// What a name says of front or back and the side of the wearer.
#[must_use]
pub fn named_face_and_hand(name: &str) -> (Option<Face>, Option<Hand>) {
    let named = names::read(name);
    (named.face, named.hand)
}
