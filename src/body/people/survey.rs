//! Joint distribution of body dimensions in the ANSUR II survey, by which missing dimensions are estimated.

use super::dimension::{COUNT, Dimension};
use crate::Sex;
use nalgebra::{DMatrix, DVector};

/// Joint normal distribution of the natural logarithms of the dimensions (m, kg) of one sex. The distribution of some
/// dimensions given others follows by conditioning. In logarithms, girths grow with the root of the mass and are never
/// negative.
///
/// Means, standard deviations and correlations of 4,082 men and 1,986 women [Gordon 2014]. Dimensions of the survey are
/// converted into those of ISO 8559-1 by constant factors for men and women. From the waist at the navel they are 0.997
/// and 0.968, from flexed to relaxed upper arm and forearm 0.92 and 0.95, from lower thigh to knee 0.93. From
/// biacromial breadth to tape across the back neck point they are 1.066 and 1.115 (means of three reference bodies of
/// each sex). The under-bust girth follows from chest and waist, by least squares for 80 model bodies of each sex
/// (MakeHuman, CC0-1.0).
pub(crate) struct Survey {
    mean: [f64; COUNT],
    sd: [f64; COUNT],
    /// Correlations below the diagonal, row by row.
    correlation: [f64; COUNT * (COUNT - 1) / 2],
}

/// Normal distribution of the logarithm of a dimension.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Expected {
    mean: f64,
    sd: f64,
}

impl Expected {
    /// Median, m or kg.
    pub fn median(self) -> f64 {
        self.mean.exp()
    }

    /// Normal score of a value: deviation of its logarithm from the mean, in standard deviations.
    pub fn score(self, value: f64) -> f64 {
        (value.ln() - self.mean) / self.sd
    }

    pub fn at(self, score: f64) -> f64 {
        (self.mean + score * self.sd).exp()
    }
}

impl Survey {
    pub fn of(sex: Sex) -> &'static Self {
        match sex {
            Sex::Male => &MALE,
            Sex::Female => &FEMALE,
        }
    }

    fn covariance(&self, a: Dimension, b: Dimension) -> f64 {
        let (low, high) = ((a as usize).min(b as usize), (a as usize).max(b as usize));
        let correlation = if low == high { 1.0 } else { self.correlation[high * (high - 1) / 2 + low] };
        correlation * self.sd[low] * self.sd[high]
    }

    /// Means and covariance of the logarithms of all dimensions, in the order of [`Dimension`].
    pub fn logarithms(&self) -> (DVector<f64>, DMatrix<f64>) {
        let every = || Dimension::ALL.into_iter().chain([Dimension::ShoulderBreadth]);
        let mut covariance = DMatrix::zeros(COUNT, COUNT);
        for (a, b) in every().flat_map(|a| every().map(move |b| (a, b))) {
            covariance[(a as usize, b as usize)] = self.ridged(a, b);
        }
        (DVector::from_column_slice(&self.mean), covariance)
    }

    /// Covariance with a thousandth of each variance taken as independent: correlations rounded to three places need
    /// not be positive definite.
    fn ridged(&self, a: Dimension, b: Dimension) -> f64 {
        let covariance = self.covariance(a, b);
        covariance * (1.0 - RIDGE) + if a == b { RIDGE * covariance } else { 0.0 }
    }

    /// Distribution of `wanted` dimensions among people with the `given` values (m or kg), each dimension at most once.
    pub fn expect(&self, wanted: &[Dimension], given: &[(Dimension, f64)]) -> Vec<Expected> {
        let count = given.len();
        let covariance = DMatrix::from_fn(count, count, |i, j| self.ridged(given[i].0, given[j].0));
        let solver = covariance
            .cholesky()
            .expect("correlations of a survey are positive definite, and each dimension is given once");
        let off = DVector::from_fn(count, |i, _| given[i].1.ln() - self.mean[given[i].0 as usize]);
        let weights = solver.solve(&off);
        let conditional = |&dimension: &Dimension| {
            let with = DVector::from_fn(count, |i, _| self.covariance(given[i].0, dimension));
            let variance = self.covariance(dimension, dimension);
            let left = (variance - with.dot(&solver.solve(&with))).max(LEAST_SHARE * variance);
            Expected { mean: self.mean[dimension as usize] + with.dot(&weights), sd: left.sqrt() }
        };
        wanted.iter().map(conditional).collect()
    }
}

/// Share of each variance that is taken as independent of all other dimensions, against rounding.
const RIDGE: f64 = 1e-3;

/// Least share of a variance that remains, however much is given. Judgement.
const LEAST_SHARE: f64 = 0.02;

static MALE: Survey = Survey {
    mean: [
        0.5624, 4.4351, 0.0536, -0.0713, 0.0165, -0.9243, -0.8150, -0.4741, -0.9689, -0.9387, -1.4746, -1.1149,
        -1.2248, -1.7390, -0.1688, -0.5069, -1.3061, -0.6745, -0.0163,
    ],
    sd: [
        0.0390, 0.1654, 0.0825, 0.1185, 0.0750, 0.0642, 0.0462, 0.0936, 0.0777, 0.0756, 0.0636, 0.0968, 0.0708, 0.0508,
        0.0549, 0.0506, 0.0484, 0.0636, 0.0897,
    ],
    correlation: [
        0.472, 0.248, 0.910, 0.208, 0.888, 0.886, 0.341, 0.936, 0.840, 0.877, 0.197, 0.797, 0.794, 0.746, 0.715, 0.532,
        0.588, 0.516, 0.383, 0.490, 0.475, 0.253, 0.907, 0.809, 0.829, 0.942, 0.690, 0.445, 0.300, 0.880, 0.759, 0.773,
        0.871, 0.662, 0.442, 0.881, 0.266, 0.833, 0.728, 0.707, 0.794, 0.638, 0.452, 0.806, 0.836, 0.371, 0.727, 0.587,
        0.557, 0.678, 0.519, 0.441, 0.669, 0.747, 0.817, 0.190, 0.818, 0.792, 0.684, 0.748, 0.721, 0.455, 0.794, 0.743,
        0.715, 0.578, 0.302, 0.811, 0.750, 0.640, 0.711, 0.743, 0.507, 0.729, 0.731, 0.718, 0.617, 0.879, 0.492, 0.721,
        0.603, 0.548, 0.617, 0.599, 0.535, 0.565, 0.652, 0.629, 0.680, 0.598, 0.723, 0.859, 0.311, 0.118, 0.054, 0.184,
        0.078, 0.427, 0.136, 0.161, 0.133, 0.226, 0.111, 0.206, 0.339, 0.818, 0.418, 0.241, 0.185, 0.294, 0.192, 0.497,
        0.233, 0.251, 0.218, 0.272, 0.187, 0.285, 0.429, 0.854, 0.719, 0.487, 0.305, 0.232, 0.370, 0.278, 0.518, 0.325,
        0.387, 0.376, 0.491, 0.307, 0.415, 0.557, 0.688, 0.695, 0.314, 0.883, 0.887, 0.792, 0.817, 0.759, 0.698, 0.799,
        0.744, 0.721, 0.598, 0.803, 0.766, 0.624, 0.178, 0.292, 0.359, 0.233, 0.886, 0.950, 0.898, 0.833, 0.766, 0.471,
        0.798, 0.748, 0.708, 0.567, 0.748, 0.706, 0.576, 0.099, 0.222, 0.280, 0.845,
    ],
};

static FEMALE: Survey = Survey {
    mean: [
        0.4869, 4.2030, -0.0584, -0.1889, 0.0183, -1.1110, -0.8993, -0.4884, -0.9909, -0.9884, -1.5360, -1.2739,
        -1.3852, -1.8669, -0.2471, -0.5947, -1.4025, -0.7998, -0.1561,
    ],
    sd: [
        0.0394, 0.1605, 0.0865, 0.1149, 0.0740, 0.0576, 0.0503, 0.0904, 0.0867, 0.0760, 0.0686, 0.0996, 0.0698, 0.0504,
        0.0571, 0.0539, 0.0505, 0.0636, 0.0975,
    ],
    correlation: [
        0.539, 0.263, 0.830, 0.233, 0.838, 0.844, 0.382, 0.916, 0.747, 0.807, 0.299, 0.764, 0.726, 0.702, 0.645, 0.564,
        0.464, 0.291, 0.257, 0.333, 0.363, 0.317, 0.896, 0.698, 0.764, 0.940, 0.622, 0.315, 0.326, 0.830, 0.577, 0.625,
        0.810, 0.556, 0.294, 0.843, 0.343, 0.801, 0.561, 0.569, 0.737, 0.537, 0.321, 0.767, 0.855, 0.371, 0.621, 0.401,
        0.402, 0.540, 0.396, 0.331, 0.544, 0.674, 0.771, 0.251, 0.858, 0.747, 0.758, 0.793, 0.705, 0.282, 0.819, 0.769,
        0.721, 0.509, 0.359, 0.820, 0.659, 0.655, 0.714, 0.716, 0.381, 0.736, 0.740, 0.722, 0.573, 0.854, 0.545, 0.715,
        0.525, 0.497, 0.565, 0.606, 0.488, 0.543, 0.609, 0.616, 0.648, 0.604, 0.740, 0.849, 0.399, 0.120, 0.121, 0.244,
        0.188, 0.470, 0.227, 0.238, 0.219, 0.215, 0.176, 0.277, 0.401, 0.811, 0.517, 0.271, 0.261, 0.371, 0.313, 0.524,
        0.343, 0.317, 0.300, 0.260, 0.290, 0.384, 0.485, 0.863, 0.722, 0.540, 0.284, 0.265, 0.397, 0.363, 0.519, 0.379,
        0.408, 0.411, 0.432, 0.327, 0.444, 0.579, 0.715, 0.723, 0.360, 0.865, 0.815, 0.792, 0.771, 0.729, 0.565, 0.757,
        0.655, 0.631, 0.469, 0.793, 0.733, 0.605, 0.241, 0.383, 0.398, 0.235, 0.742, 0.893, 0.755, 0.668, 0.649, 0.260,
        0.623, 0.516, 0.501, 0.358, 0.668, 0.589, 0.469, 0.107, 0.242, 0.254, 0.728,
    ],
};
