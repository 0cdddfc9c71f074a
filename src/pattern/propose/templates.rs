//! What pieces look like: their edges in counter-clockwise order, upright, as they are drawn in practice.
//!
//! Directions, places and shares are typical of block patterns; alignment allows wide differences from them.

use super::{Class, Label};

/// One labelled stretch of a template.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Part {
    /// What it is.
    pub label: Label,
    /// Direction of its chord, degrees counter-clockwise from +u.
    pub direction_deg: f64,
    /// 1 where it bulges outwards, -1 where it is hollow, 0 where it is about straight.
    pub bow: f64,
    /// Its middle in the bounding box, 0 to 1 each way.
    pub at: [f64; 2],
    /// Share of the whole length.
    pub share: f64,
}

/// A kind of piece.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Template {
    /// Kind.
    pub class: Class,
    /// Whether the whole width is drawn; else it is one half, with the wearer's outer side to the right.
    pub is_whole: bool,
    /// Parts, counter-clockwise.
    pub parts: &'static [Part],
}

impl Template {
    /// Whether it has such a part.
    #[must_use]
    pub fn has(&self, label: Label) -> bool {
        self.parts.iter().any(|part| part.label == label)
    }

    /// Whether it is worn under or over shoulders: a yoke of which not, is one below the waist.
    #[must_use]
    pub fn has_shoulder(&self) -> bool {
        self.has(Shoulder)
    }
}

const fn part(label: Label, direction_deg: f64, bow: f64, at: [f64; 2], share: f64) -> Part {
    Part { label, direction_deg, bow, at, share }
}

use Label::{
    Armhole, Cap, Centre, Crotch, End, Hem, Inseam, Lower, Neck, Outseam, Shoulder, Side, Top, Underarm, Waist,
};

/// All templates. Halves are aligned as their mirror images too.
pub const TEMPLATES: [Template; 15] = [
    Template {
        class: Class::Body,
        is_whole: true,
        parts: &[
            part(Hem, 0.0, 0.0, [0.5, 0.0], 0.25),
            part(Side, 90.0, 0.0, [1.0, 0.3], 0.18),
            part(Armhole, 95.0, -1.0, [0.9, 0.7], 0.11),
            part(Shoulder, 160.0, 0.0, [0.78, 0.96], 0.06),
            part(Neck, 180.0, -1.0, [0.5, 0.9], 0.12),
            part(Shoulder, 200.0, 0.0, [0.22, 0.96], 0.06),
            part(Armhole, 265.0, -1.0, [0.1, 0.7], 0.11),
            part(Side, 270.0, 0.0, [0.0, 0.3], 0.18),
        ],
    },
    Template {
        class: Class::Body,
        is_whole: false,
        parts: &[
            part(Hem, 0.0, 0.0, [0.5, 0.0], 0.18),
            part(Side, 90.0, 0.0, [0.97, 0.3], 0.24),
            part(Armhole, 100.0, -1.0, [0.8, 0.7], 0.16),
            part(Shoulder, 160.0, 0.0, [0.55, 0.96], 0.07),
            part(Neck, 215.0, -1.0, [0.15, 0.92], 0.09),
            part(Centre, 270.0, 0.0, [0.0, 0.4], 0.28),
        ],
    },
    // What hangs from a yoke over the shoulders.
    Template {
        class: Class::Body,
        is_whole: true,
        parts: &[
            part(Hem, 0.0, 0.0, [0.5, 0.0], 0.27),
            part(Side, 90.0, 0.0, [1.0, 0.3], 0.2),
            part(Armhole, 100.0, -1.0, [0.93, 0.8], 0.08),
            part(Top, 180.0, 0.0, [0.5, 1.0], 0.17),
            part(Armhole, 260.0, -1.0, [0.07, 0.8], 0.08),
            part(Side, 270.0, 0.0, [0.0, 0.3], 0.2),
        ],
    },
    Template {
        class: Class::Body,
        is_whole: false,
        parts: &[
            part(Hem, 0.0, 0.0, [0.5, 0.0], 0.17),
            part(Side, 90.0, 0.0, [0.98, 0.3], 0.23),
            part(Armhole, 105.0, -1.0, [0.88, 0.8], 0.12),
            part(Top, 180.0, 0.0, [0.4, 1.0], 0.15),
            part(Centre, 270.0, 0.0, [0.0, 0.5], 0.33),
        ],
    },
    // Over the shoulders.
    Template {
        class: Class::Yoke,
        is_whole: true,
        parts: &[
            part(Lower, 0.0, 0.0, [0.5, 0.0], 0.34),
            part(Armhole, 90.0, 0.0, [1.0, 0.15], 0.08),
            part(Shoulder, 160.0, 0.0, [0.83, 0.4], 0.16),
            part(Neck, 180.0, -1.0, [0.5, 0.35], 0.18),
            part(Shoulder, 200.0, 0.0, [0.17, 0.4], 0.16),
            part(Armhole, 270.0, 0.0, [0.0, 0.15], 0.08),
        ],
    },
    Template {
        class: Class::Yoke,
        is_whole: false,
        parts: &[
            part(Lower, 0.0, 0.0, [0.5, 0.0], 0.33),
            part(Armhole, 90.0, 0.0, [1.0, 0.15], 0.11),
            part(Shoulder, 162.0, 0.0, [0.65, 0.4], 0.25),
            part(Neck, 215.0, -1.0, [0.15, 0.4], 0.15),
            part(Centre, 270.0, 0.0, [0.0, 0.15], 0.14),
        ],
    },
    // Below the waist.
    Template {
        class: Class::Yoke,
        is_whole: true,
        parts: &[
            part(Lower, 0.0, 0.0, [0.5, 0.0], 0.42),
            part(Side, 90.0, 0.0, [1.0, 0.12], 0.08),
            part(Waist, 180.0, 0.0, [0.5, 0.25], 0.42),
            part(Side, 270.0, 0.0, [0.0, 0.12], 0.08),
        ],
    },
    Template {
        class: Class::Yoke,
        is_whole: false,
        parts: &[
            part(Lower, 0.0, 0.0, [0.5, 0.0], 0.37),
            part(Side, 90.0, 0.0, [1.0, 0.15], 0.11),
            part(Waist, 180.0, 0.0, [0.5, 0.3], 0.37),
            part(Centre, 270.0, 0.0, [0.0, 0.15], 0.15),
        ],
    },
    Template {
        class: Class::Leg,
        is_whole: false,
        parts: &[
            part(Hem, 0.0, 0.0, [0.5, 0.0], 0.09),
            part(Outseam, 90.0, 0.0, [0.95, 0.5], 0.38),
            part(Waist, 180.0, 0.0, [0.55, 1.0], 0.1),
            part(Crotch, 245.0, -1.0, [0.15, 0.82], 0.13),
            part(Inseam, 272.0, 0.0, [0.1, 0.35], 0.28),
        ],
    },
    Template {
        class: Class::Sleeve,
        is_whole: true,
        parts: &[
            part(Hem, 0.0, 0.0, [0.5, 0.0], 0.2),
            part(Underarm, 80.0, 0.0, [0.93, 0.35], 0.22),
            part(Cap, 180.0, 1.0, [0.5, 1.0], 0.36),
            part(Underarm, 280.0, 0.0, [0.07, 0.35], 0.22),
        ],
    },
    Template {
        class: Class::Sleeve,
        is_whole: false,
        parts: &[
            part(Underarm, 0.0, 0.0, [0.6, 0.0], 0.28),
            part(Hem, 90.0, 0.0, [1.0, 0.5], 0.18),
            part(Top, 180.0, 0.0, [0.5, 1.0], 0.32),
            part(Cap, 285.0, 0.0, [0.1, 0.5], 0.25),
        ],
    },
    Template {
        class: Class::Skirt,
        is_whole: true,
        parts: &[
            part(Hem, 0.0, 0.0, [0.5, 0.0], 0.25),
            part(Side, 92.0, 0.0, [1.0, 0.5], 0.28),
            part(Waist, 180.0, 0.0, [0.5, 1.0], 0.19),
            part(Side, 268.0, 0.0, [0.0, 0.5], 0.28),
        ],
    },
    Template {
        class: Class::Skirt,
        is_whole: false,
        parts: &[
            part(Hem, 0.0, 0.0, [0.5, 0.0], 0.18),
            part(Side, 95.0, 0.3, [0.97, 0.5], 0.33),
            part(Waist, 180.0, 0.0, [0.45, 1.0], 0.15),
            part(Centre, 270.0, 0.0, [0.0, 0.5], 0.33),
        ],
    },
    Template {
        class: Class::Waistband,
        is_whole: true,
        parts: &[
            part(Lower, 0.0, 0.0, [0.5, 0.0], 0.44),
            part(End, 90.0, 0.0, [1.0, 0.5], 0.06),
            part(Top, 180.0, 0.0, [0.5, 1.0], 0.44),
            part(End, 270.0, 0.0, [0.0, 0.5], 0.06),
        ],
    },
    Template {
        class: Class::Cuff,
        is_whole: true,
        parts: &[
            part(Lower, 0.0, 0.0, [0.5, 0.0], 0.38),
            part(End, 90.0, 0.0, [1.0, 0.5], 0.12),
            part(Top, 180.0, 0.0, [0.5, 1.0], 0.38),
            part(End, 270.0, 0.0, [0.0, 0.5], 0.12),
        ],
    },
];
