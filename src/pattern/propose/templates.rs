//! Templates of pieces: their edges in counter-clockwise order, upright, with directions, positions and shares typical
//! of block patterns. The alignment tolerates large differences.

use super::{Class, Label};

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Part {
    pub label: Label,
    /// Counter-clockwise from +u, along the chord.
    pub direction_deg: f64,
    /// 1 for an edge that bulges outwards, -1 for a hollow edge, 0 for a nearly straight one.
    pub bow: f64,
    /// Position of the middle in the bounding box, 0 to 1 on each axis.
    pub at: [f64; 2],
    /// Share of the total length of the outline.
    pub share: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Template {
    pub class: Class,
    /// True if the whole width is drawn. Otherwise one half, with the wearer's outer side on the right.
    pub is_whole: bool,
    /// Counter-clockwise.
    pub parts: &'static [Part],
}

impl Template {
    pub fn has(&self, label: Label) -> bool {
        self.parts.iter().any(|part| part.label == label)
    }

    /// A yoke without a shoulder lies below the waist.
    pub fn has_shoulder(&self) -> bool {
        self.has(Shoulder)
    }

    /// True for a trunk or sleeve whose seam runs from the underarm to the neck.
    pub fn is_raglan(&self) -> bool {
        matches!(self.class, Class::Body | Class::Sleeve) && self.has(Neck) && !self.has(Shoulder)
    }

    /// True for a sleeve, or a leg in one piece: sewn to itself.
    pub fn is_limb(&self) -> bool {
        self.is_whole && matches!(self.class, Class::Sleeve | Class::Leg)
    }

    pub fn is_panel(&self) -> bool {
        self.has(Princess)
    }
}

const fn part(label: Label, direction_deg: f64, bow: f64, at: [f64; 2], share: f64) -> Part {
    Part { label, direction_deg, bow, at, share }
}

use Label::{
    Armhole, Cap, Centre, Crotch, End, Hem, Inseam, Lower, Neck, Outseam, Princess, Shoulder, Side, Top, Underarm,
    Waist,
};

/// A half is also tried as its mirror image.
pub const TEMPLATES: [Template; 27] = [
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
    // Trunk below a yoke over the shoulders.
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
    // Raglan.
    Template {
        class: Class::Body,
        is_whole: true,
        parts: &[
            part(Hem, 0.0, 0.0, [0.5, 0.0], 0.25),
            part(Side, 90.0, 0.0, [1.0, 0.3], 0.19),
            part(Armhole, 128.0, -0.5, [0.82, 0.8], 0.14),
            part(Neck, 180.0, -1.0, [0.5, 0.95], 0.1),
            part(Armhole, 232.0, -0.5, [0.18, 0.8], 0.14),
            part(Side, 270.0, 0.0, [0.0, 0.3], 0.19),
        ],
    },
    Template {
        class: Class::Body,
        is_whole: false,
        parts: &[
            part(Hem, 0.0, 0.0, [0.5, 0.0], 0.17),
            part(Side, 90.0, 0.0, [0.98, 0.3], 0.23),
            part(Armhole, 125.0, -0.5, [0.65, 0.8], 0.18),
            part(Neck, 215.0, -1.0, [0.15, 0.95], 0.08),
            part(Centre, 270.0, 0.0, [0.0, 0.45], 0.32),
        ],
    },
    // Between princess seams that begin at the shoulders.
    Template {
        class: Class::Body,
        is_whole: true,
        parts: &[
            part(Hem, 0.0, 0.0, [0.5, 0.0], 0.13),
            part(Princess, 85.0, 0.0, [0.9, 0.5], 0.28),
            part(Shoulder, 165.0, 0.0, [0.85, 0.97], 0.06),
            part(Neck, 180.0, -1.0, [0.5, 0.9], 0.14),
            part(Shoulder, 195.0, 0.0, [0.15, 0.97], 0.06),
            part(Princess, 275.0, 0.0, [0.1, 0.5], 0.28),
        ],
    },
    Template {
        class: Class::Body,
        is_whole: false,
        parts: &[
            part(Hem, 0.0, 0.0, [0.5, 0.0], 0.1),
            part(Princess, 85.0, 0.0, [0.9, 0.5], 0.36),
            part(Shoulder, 165.0, 0.0, [0.85, 0.97], 0.05),
            part(Neck, 215.0, -1.0, [0.3, 0.85], 0.14),
            part(Centre, 270.0, 0.0, [0.0, 0.35], 0.27),
        ],
    },
    // Between princess seams that begin at the armholes.
    Template {
        class: Class::Body,
        is_whole: true,
        parts: &[
            part(Hem, 0.0, 0.0, [0.5, 0.0], 0.16),
            part(Princess, 85.0, 0.0, [0.85, 0.35], 0.22),
            part(Armhole, 85.0, -0.5, [0.92, 0.8], 0.06),
            part(Shoulder, 160.0, 0.0, [0.83, 0.97], 0.08),
            part(Neck, 180.0, -1.0, [0.5, 0.9], 0.13),
            part(Shoulder, 200.0, 0.0, [0.17, 0.97], 0.08),
            part(Armhole, 275.0, -0.5, [0.08, 0.8], 0.06),
            part(Princess, 275.0, 0.0, [0.15, 0.35], 0.22),
        ],
    },
    Template {
        class: Class::Body,
        is_whole: false,
        parts: &[
            part(Hem, 0.0, 0.0, [0.4, 0.0], 0.12),
            part(Princess, 85.0, 0.0, [0.75, 0.35], 0.27),
            part(Armhole, 85.0, -0.5, [0.9, 0.8], 0.08),
            part(Shoulder, 160.0, 0.0, [0.7, 0.97], 0.08),
            part(Neck, 215.0, -1.0, [0.2, 0.9], 0.12),
            part(Centre, 270.0, 0.0, [0.0, 0.4], 0.3),
        ],
    },
    // Outside a princess seam that begins at the shoulder, and at the armhole.
    Template {
        class: Class::SidePanel,
        is_whole: false,
        parts: &[
            part(Hem, 0.0, 0.0, [0.55, 0.0], 0.13),
            part(Side, 90.0, 0.0, [0.97, 0.27], 0.19),
            part(Armhole, 95.0, -1.0, [0.8, 0.72], 0.2),
            part(Shoulder, 160.0, 0.0, [0.65, 0.97], 0.06),
            part(Princess, 265.0, 0.5, [0.1, 0.45], 0.4),
        ],
    },
    Template {
        class: Class::SidePanel,
        is_whole: false,
        parts: &[
            part(Hem, 0.0, 0.0, [0.5, 0.0], 0.18),
            part(Side, 90.0, 0.0, [0.97, 0.3], 0.28),
            part(Armhole, 140.0, -0.5, [0.6, 0.85], 0.18),
            part(Princess, 265.0, 0.5, [0.05, 0.45], 0.36),
        ],
    },
    // Between front and back, below the armhole.
    Template {
        class: Class::SidePanel,
        is_whole: true,
        parts: &[
            part(Hem, 0.0, 0.0, [0.5, 0.0], 0.1),
            part(Side, 90.0, 0.0, [1.0, 0.5], 0.4),
            part(Armhole, 180.0, -0.5, [0.5, 0.97], 0.1),
            part(Side, 270.0, 0.0, [0.0, 0.5], 0.4),
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
    // In one piece, without an outseam.
    Template {
        class: Class::Leg,
        is_whole: true,
        parts: &[
            part(Hem, 0.0, 0.0, [0.5, 0.0], 0.11),
            part(Inseam, 80.0, 0.0, [0.87, 0.35], 0.26),
            part(Crotch, 115.0, -1.0, [0.9, 0.85], 0.11),
            part(Waist, 180.0, 0.0, [0.5, 1.0], 0.15),
            part(Crotch, 245.0, -1.0, [0.1, 0.85], 0.11),
            part(Inseam, 280.0, 0.0, [0.13, 0.35], 0.26),
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
    // Raglan.
    Template {
        class: Class::Sleeve,
        is_whole: true,
        parts: &[
            part(Hem, 0.0, 0.0, [0.5, 0.0], 0.14),
            part(Underarm, 82.0, 0.0, [0.93, 0.3], 0.2),
            part(Cap, 115.0, -0.5, [0.75, 0.8], 0.2),
            part(Neck, 180.0, 0.0, [0.5, 1.0], 0.05),
            part(Cap, 245.0, -0.5, [0.25, 0.8], 0.2),
            part(Underarm, 278.0, 0.0, [0.07, 0.3], 0.2),
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
    Template {
        class: Class::Collar,
        is_whole: true,
        parts: &[
            part(Lower, 0.0, 0.0, [0.5, 0.0], 0.43),
            part(End, 90.0, 0.0, [1.0, 0.5], 0.07),
            part(Top, 180.0, 0.0, [0.5, 1.0], 0.43),
            part(End, 270.0, 0.0, [0.0, 0.5], 0.07),
        ],
    },
];
