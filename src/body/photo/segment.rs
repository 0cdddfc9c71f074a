//! Segmentation of a person from a plain background.
//!
//! The logarithm of the background's intensity is a smooth surface, because of uneven light. It is fitted to the border
//! of the picture, and then to all pixels that are similar to it. A pixel belongs to the person if its colour differs
//! from that surface, except in shadows on the background, where all channels fall by about the same factor. Then
//! specks are removed. [`Mask::cleaned`] does the rest.

use super::silhouette::Mask;
use nalgebra::{SMatrix, SVector};

/// Number of terms of the background: a cubic polynomial in `x` and `y`. Judgement.
const TERMS: usize = 10;

/// Stride of the pixels that are fitted. It divides no usual picture width, so that they do not form columns.
const STRIDE: usize = 31;

/// Number of rounds of fitting the background and choosing its pixels. Judgement.
const ROUNDS: usize = 4;

/// Width of the border as a share of each side. Judgement.
const BORDER: f64 = 0.04;

/// Least difference between a pixel of the person and the background (log of intensity): in standard deviations of the
/// background, and in absolute terms. Judgement.
const OFF: f64 = 5.0;
const LEAST: f64 = 0.06;

/// Least share of the light that a shadow leaves: on the wall behind the person, and near the feet, where it is
/// darkest. Then the share of the figure, from below, that counts as feet. Judgement.
const DARKEST: [f64; 2] = [0.62, 0.45];
const FEET_ZONE: f64 = 0.10;

/// Greatest spread of the channels (log of intensity, from their mean) in a shadow. Judgement.
const HUE: f64 = 0.08;

/// Number of pixels over which an edge may be blurred. Judgement.
const BLUR: usize = 3;

/// Standard deviation from which a background is not plain. Judgement.
const PLAIN: f64 = 0.25;

/// Logarithms of the intensities of a picture, three channels a pixel.
struct Logs {
    width: usize,
    height: usize,
    values: Vec<[f64; 3]>,
}

/// Background: a polynomial of position for each channel, with the standard deviation of pixels from it.
struct Background {
    coefficients: [SVector<f64, TERMS>; 3],
    spread: [f64; 3],
}

/// Mask of the person. `None` if the border is not a plain background.
pub(super) fn segment(picture: &image::DynamicImage) -> Option<Mask> {
    let logs = Logs::of(picture);
    Some(Background::fit(&logs)?.person(&logs))
}

impl Logs {
    fn of(picture: &image::DynamicImage) -> Self {
        let rgb = picture.to_rgb8();
        let log = |v: u8| (f64::from(v) + 6.0).ln();
        let values = rgb.pixels().map(|p| [log(p[0]), log(p[1]), log(p[2])]).collect();
        Self { width: rgb.width() as usize, height: rgb.height() as usize, values }
    }

    fn place(&self, i: usize) -> [f64; 2] {
        let scale = |at: usize, size: usize| 2.0 * at as f64 / size as f64 - 1.0;
        [scale(i % self.width, self.width), scale(i / self.width, self.height)]
    }

    fn on_border(&self, i: usize) -> bool {
        self.place(i).iter().any(|c| c.abs() > 1.0 - 2.0 * BORDER)
    }
}

impl Background {
    fn fit(logs: &Logs) -> Option<Self> {
        let mut fitted: Option<Self> = None;
        for _ in 0..ROUNDS {
            let belongs = |i: usize| match &fitted {
                None => logs.on_border(i),
                Some(background) => {
                    background.off(logs, i).iter().zip(background.spread).all(|(o, s)| o.abs() < 3.0 * s)
                }
            };
            let chosen: Vec<usize> = (0..logs.values.len()).step_by(STRIDE).filter(|&i| belongs(i)).collect();
            fitted = Some(Self::through(logs, &chosen)?);
        }
        fitted.filter(|background| background.spread.iter().all(|&spread| spread < PLAIN))
    }

    fn through(logs: &Logs, chosen: &[usize]) -> Option<Self> {
        let mut normal = SMatrix::<f64, TERMS, TERMS>::identity() * 1e-6;
        let mut right = [SVector::<f64, TERMS>::zeros(); 3];
        for &i in chosen {
            let terms = terms(logs.place(i));
            normal += terms * terms.transpose();
            (0..3).for_each(|channel| right[channel] += terms * logs.values[i][channel]);
        }
        let solver = normal.cholesky()?;
        let mut background = Self { coefficients: right.map(|side| solver.solve(&side)), spread: [0.0; 3] };
        for channel in 0..3 {
            let mut off: Vec<f64> = chosen.iter().map(|&i| background.off(logs, i)[channel].abs()).collect();
            off.sort_by(f64::total_cmp);
            // Median absolute deviation, scaled to the standard deviation of a normal distribution.
            background.spread[channel] = 1.4826 * off.get(off.len() / 2).copied()?.max(0.004);
        }
        Some(background)
    }

    /// Difference of a pixel from the background (log of intensity).
    fn off(&self, logs: &Logs, i: usize) -> [f64; 3] {
        let terms = terms(logs.place(i));
        std::array::from_fn(|channel| logs.values[i][channel] - self.coefficients[channel].dot(&terms))
    }

    fn person(&self, logs: &Logs) -> Mask {
        let limit = self.spread.map(|spread| (OFF * spread).max(LEAST));
        let off: Vec<[f64; 3]> = (0..logs.values.len()).map(|i| self.off(logs, i)).collect();
        let differs = |o: &[f64; 3]| o.iter().zip(limit).any(|(o, limit)| o.abs() > limit);
        let first = Mask::new(logs.width, logs.height, off.iter().map(differs).collect()).opened();
        let Some((top, bottom)) = first.cleaned().rows() else { return first };
        let feet = bottom as f64 - FEET_ZONE * (bottom - top) as f64;
        // Limit on the difference between the channels of a shadow.
        let hue_limit = limit.iter().fold(HUE, |most: f64, limit| most.max(*limit));
        let is_shadow = |i: usize| {
            let mean = off[i].iter().sum::<f64>() / 3.0;
            let hue = off[i].iter().map(|o| (o - mean).abs()).fold(0.0, f64::max);
            let darkest = DARKEST[usize::from((i / logs.width) as f64 > feet)];
            mean < 0.0 && mean > darkest.ln() && hue < hue_limit
        };
        let kept = (0..off.len()).map(|i| first.bits[i] && !is_shadow(i)).collect();
        self.trimmed(logs, Mask::new(logs.width, logs.height, kept).opened())
    }

    /// Trims rows to where the picture is half way between person and background, so that blur does not widen them.
    fn trimmed(&self, logs: &Logs, mut mask: Mask) -> Mask {
        for row in 0..mask.height {
            for (start, end) in mask.runs(row) {
                if end - start < 2 * BLUR + 2 {
                    continue;
                }
                let pixel = |column: usize| row * mask.width + column;
                let left =
                    (0..BLUR).take_while(|&i| !self.is_person(logs, pixel(start + i), pixel(start + BLUR))).count();
                let right =
                    (0..BLUR).take_while(|&i| !self.is_person(logs, pixel(end - 1 - i), pixel(end - 1 - BLUR))).count();
                let gone = [start..start + left, end - right..end];
                gone.into_iter().flatten().for_each(|column| mask.bits[row * mask.width + column] = false);
            }
        }
        mask
    }

    /// True if a pixel is nearer in colour to pixel `within` than to the background, in the channel of most contrast.
    fn is_person(&self, logs: &Logs, i: usize, within: usize) -> bool {
        let terms = terms(logs.place(i));
        let light = |log: f64| log.exp();
        let parts = (0..3).map(|channel| {
            let background = light(self.coefficients[channel].dot(&terms));
            (light(logs.values[i][channel]) - background, light(logs.values[within][channel]) - background)
        });
        let most = parts.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
        most.is_none_or(|(here, there)| here * there.signum() >= there.abs() / 2.0)
    }
}

fn terms([x, y]: [f64; 2]) -> SVector<f64, TERMS> {
    SVector::from([1.0, x, y, x * x, x * y, y * y, x * x * x, x * x * y, x * y * y, y * y * y])
}
