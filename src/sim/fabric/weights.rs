//! Bending rigidity of known cloths by weight: percentiles of 618 fabrics [Feng et al. 2022].

use std::fmt;
use std::sync::LazyLock;

#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct Cloths {
    percentiles: Vec<f64>,
    weight: Vec<Weight>,
}

#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct Weight {
    /// Upper bound of the density. Not applied to the last class.
    to_kg_m2: f64,
    cloths: usize,
    /// Percentiles of the rigidity along the grain line.
    warp_nm: Vec<f64>,
    /// Percentiles of the rigidity across the grain line.
    weft_nm: Vec<f64>,
}

static CLOTHS: LazyLock<Cloths> =
    LazyLock::new(|| toml::from_str(include_str!("weights.toml")).expect("the built-in quantiles are valid"));

/// Percentage of the known cloths of its weight that bend more easily.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Standing {
    /// Lowest known percentile.
    Below(f64),
    /// Interpolated percentile.
    At(f64),
    /// Highest known percentile.
    Above(f64),
}

impl fmt::Display for Standing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Below(percent) => write!(f, "<p{percent:.0}"),
            Self::At(percent) => write!(f, "p{percent:.0}"),
            Self::Above(percent) => write!(f, ">p{percent:.0}"),
        }
    }
}

/// Rigidity percentile along and across the grain line among the known cloths of a weight, N m. Limited to the known
/// percentiles.
pub fn rigidities(density_kg_m2: f64, percentile: f64) -> [f64; 2] {
    let Weight { warp_nm, weft_nm, .. } = class_of(density_kg_m2);
    [warp_nm, weft_nm].map(|quantiles| quantile(quantiles, percentile))
}

/// Along and across the grain line, among the known cloths of a weight.
pub fn standings(density_kg_m2: f64, rigidities_nm: [f64; 2]) -> [Standing; 2] {
    let Weight { warp_nm, weft_nm, .. } = class_of(density_kg_m2);
    [standing(warp_nm, rigidities_nm[0]), standing(weft_nm, rigidities_nm[1])]
}

/// Lowest and highest known percentile. The range between them is reported as scatter.
pub fn ends() -> [f64; 2] {
    let percentiles = &CLOTHS.percentiles;
    [percentiles[0], percentiles[percentiles.len() - 1]]
}

pub fn count(density_kg_m2: f64) -> usize {
    class_of(density_kg_m2).cloths
}

fn class_of(density_kg_m2: f64) -> &'static Weight {
    let classes = &CLOTHS.weight;
    classes.iter().find(|class| density_kg_m2 < class.to_kg_m2).unwrap_or(&classes[classes.len() - 1])
}

/// Interpolates in the logarithm of the rigidity.
fn quantile(quantiles: &[f64], percentile: f64) -> f64 {
    let shares = &CLOTHS.percentiles;
    let last = shares.len() - 1;
    let Some(k) = (0..last).rev().find(|&k| shares[k] <= percentile) else { return quantiles[0] };
    if percentile >= shares[last] {
        return quantiles[last];
    }
    let share = (percentile - shares[k]) / (shares[k + 1] - shares[k]);
    quantiles[k] * (quantiles[k + 1] / quantiles[k]).powf(share)
}

/// Inverse of [`quantile`].
fn standing(quantiles: &[f64], rigidity_nm: f64) -> Standing {
    let shares = &CLOTHS.percentiles;
    let last = shares.len() - 1;
    let Some(k) = (0..=last).rev().find(|&k| quantiles[k] <= rigidity_nm) else { return Standing::Below(shares[0]) };
    if k == last {
        let is_last = rigidity_nm <= quantiles[last];
        return if is_last { Standing::At(shares[last]) } else { Standing::Above(shares[last]) };
    }
    let share = (rigidity_nm / quantiles[k]).ln() / (quantiles[k + 1] / quantiles[k]).ln();
    Standing::At(shares[k] + share * (shares[k + 1] - shares[k]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_rise_and_their_cloths_are_all_there() {
        let rises = |numbers: &[f64]| numbers.windows(2).all(|two| two[0] < two[1]);
        let classes = &CLOTHS.weight;
        assert!(rises(&CLOTHS.percentiles) && rises(&classes.iter().map(|class| class.to_kg_m2).collect::<Vec<_>>()));
        for class in classes {
            for quantiles in [&class.warp_nm, &class.weft_nm] {
                assert!(rises(quantiles) && quantiles.len() == CLOTHS.percentiles.len(), "up to {}", class.to_kg_m2);
            }
        }
        assert_eq!(classes.iter().map(|class| class.cloths).sum::<usize>(), 618);
    }

    #[test]
    fn a_quantile_stands_at_its_own_share() {
        for class in &CLOTHS.weight {
            let density = class.to_kg_m2 - 1e-3;
            for (k, &share) in CLOTHS.percentiles.iter().enumerate() {
                let quantiles = [class.warp_nm[k], class.weft_nm[k]];
                assert_eq!(rigidities(density, share), quantiles);
                assert_eq!(standings(density, quantiles), [Standing::At(share); 2]);
            }
        }
    }

    #[test]
    fn standings_lie_between_quantiles_and_say_when_they_are_beyond() {
        let check = |factor: f64, share: f64, expect: &str| {
            let rigidity = factor * rigidities(0.12, share)[0];
            assert_eq!(standings(0.12, [rigidity; 2])[0].to_string(), expect, "{factor} of p{share}");
        };
        check(1.0, 50.0, "p50");
        check(1.0, 62.0, "p62");
        check(1.0, 81.0, "p81");
        check(0.99, 10.0, "<p10");
        check(1.01, 90.0, ">p90");
        // Beyond the ends nothing is known: the end itself.
        check(1.0, 3.0, "p10");
        check(1.0, 99.0, "p90");
    }

    #[test]
    fn a_weight_at_a_bound_is_of_the_heavier_class() {
        let check = |density: f64, cloths: usize| assert_eq!(count(density), cloths, "{density}");
        check(0.0, 63);
        check(0.0599, 63);
        check(0.06, 84);
        check(0.4, 66);
        check(0.45, 43);
        check(2.0, 43);
    }
}
