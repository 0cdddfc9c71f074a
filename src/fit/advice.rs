//! What a customer is told: which size, and which picture.

use super::class::{FitClass, Simulator};
use super::ease::{Cuts, Ease, deciding};

/// Which drape to show a customer [T 6.4.2].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shown {
    /// FEM-GS: the garment is large enough, and cloth that hangs is what the customer would see.
    FemDrape,
    /// Hybrid-GS: it keeps the pattern's size.
    HybridDrape,
    /// Hybrid-GS with its gap map: the garment does not reach round the body, and where is what the customer must see.
    HybridGap,
}

impl Shown {
    /// In words.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::FemDrape => "FEM-GS drape",
            Self::HybridDrape => "Hybrid-GS drape",
            Self::HybridGap => "Hybrid-GS and its gap map",
        }
    }
}

/// The picture for a customer: of a garment smaller than the body where it does not close, else the drape of the
/// simulator that is recommended for the fit.
#[must_use]
pub fn shown(recommended: Simulator, is_undersized: bool) -> Shown {
    match (is_undersized, recommended) {
        (true, _) => Shown::HybridGap,
        (false, Simulator::Fem) => Shown::FemDrape,
        (false, Simulator::Hybrid) => Shown::HybridDrape,
    }
}

/// How one size sits on a subject.
#[derive(Clone, Debug, PartialEq)]
pub struct SizeFit {
    /// Size.
    pub size: String,
    /// Ease at every level that is known.
    pub levels: Vec<Ease>,
}

/// The size to buy.
#[derive(Clone, Debug, PartialEq)]
pub struct SizeAdvice {
    /// Size.
    pub size: String,
    /// Why this one and not the others.
    pub reason: String,
}

/// The size whose deciding ease is just, the nearest to the middle between the cuts; where none is, the smallest loose
/// one, for what is loose can be worn; where all are tight, the largest, unless it does not close. `None` where no ease
/// is known.
#[must_use]
pub fn advise(sizes: &[SizeFit], cuts: &Cuts) -> Option<SizeAdvice> {
    let eased: Vec<(&str, &Ease)> =
        sizes.iter().filter_map(|fit| Some((fit.size.as_str(), deciding(&fit.levels)?))).collect();
    let middle = 0.5 * (cuts.tight_below_m + cuts.loose_above_m);
    let of = |class: FitClass| eased.iter().filter(move |(_, ease)| ease.class == class);
    let off = |ease: &Ease| (ease.ease_m() - middle).abs();
    let nearest = of(FitClass::Just).min_by(|a, b| off(a.1).total_cmp(&off(b.1)));
    let smallest_loose = of(FitClass::Loose).min_by(|a, b| a.1.ease_m().total_cmp(&b.1.ease_m()));
    let largest = eased.iter().max_by(|a, b| a.1.ease_m().total_cmp(&b.1.ease_m()))?;
    let (&(size, ease), why) = match (nearest, smallest_loose) {
        (Some(found), _) => (found, "a just fit"),
        (None, Some(found)) => (found, "the smallest that is not tight"),
        (None, None) if largest.1.is_undersized() => {
            (largest, "the largest, and still smaller than the body: no size fits")
        }
        (None, None) => (largest, "the largest, and still tight"),
    };
    let told = |(size, ease): &(&str, &Ease)| {
        let mark = if ease.is_undersized() { ", undersized" } else { "" };
        format!("{size} {:+.0} mm ({}{mark})", 1e3 * ease.ease_m(), ease.class.as_str())
    };
    let others: Vec<String> = eased.iter().filter(|other| other.0 != size).map(told).collect();
    let mut reason = format!("{why}: {:+.0} mm at the {}, the level that decides", 1e3 * ease.ease_m(), ease.level);
    if !others.is_empty() {
        reason += &format!("; {}", others.join(", "));
    }
    Some(SizeAdvice { size: size.to_owned(), reason })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fits(eases_mm: &[(&str, &[f64])]) -> Vec<SizeFit> {
        let cuts = Cuts::default();
        let level = |(k, mm): (usize, &f64)| Ease {
            level: ["chest", "hip"][k].to_owned(),
            pattern_girth_m: 1.0 + 1e-3 * mm,
            body_girth_m: 1.0,
            class: cuts.classify(1e-3 * mm),
            borderline: false,
        };
        let size = |(size, eases): &(&str, &[f64])| SizeFit {
            size: (*size).to_owned(),
            levels: eases.iter().enumerate().map(level).collect(),
        };
        eases_mm.iter().map(size).collect()
    }

    #[test]
    fn the_size_is_the_one_that_sits() {
        let check = |eases_mm: &[(&str, &[f64])], size: &str, why: &str| {
            let advice = advise(&fits(eases_mm), &Cuts::default()).expect("eases are known");
            assert!(advice.size == size && advice.reason.starts_with(why), "{eases_mm:?}: {advice:?}");
        };
        check(&[("S", &[21.0]), ("M", &[81.0]), ("L", &[141.0])], "M", "a just fit: +81 mm at the chest");
        check(&[("S", &[55.0]), ("M", &[90.0])], "M", "a just fit");
        check(&[("S", &[10.0]), ("M", &[120.0]), ("L", &[180.0])], "M", "the smallest that is not tight");
        check(&[("S", &[-30.0]), ("M", &[10.0])], "M", "the largest, and still tight");
        check(&[("S", &[-80.0]), ("M", &[-20.0])], "M", "the largest, and still smaller than the body");
        // The hip decides although the chest is roomy.
        check(&[("S", &[90.0, 10.0]), ("M", &[150.0, 70.0])], "M", "a just fit: +70 mm at the hip");
        assert_eq!(advise(&fits(&[("S", &[])]), &Cuts::default()), None);
    }

    #[test]
    fn the_picture_follows_the_fit() {
        assert_eq!(shown(Simulator::Fem, false), Shown::FemDrape);
        assert_eq!(shown(Simulator::Hybrid, false), Shown::HybridDrape);
        assert_eq!(shown(Simulator::Fem, true), Shown::HybridGap);
    }
}
