//! Ease at the levels of a body, and its fit class [T 6.2.3].

use super::class::FitClass;

#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Cuts {
    pub tight_below_m: f64,
    pub loose_above_m: f64,
}

impl Default for Cuts {
    fn default() -> Self {
        Self { tight_below_m: 0.05, loose_above_m: 0.10 }
    }
}

impl Cuts {
    pub fn classify(&self, ease_m: f64) -> FitClass {
        if ease_m < self.tight_below_m {
            FitClass::Tight
        } else if ease_m > self.loose_above_m {
            FitClass::Loose
        } else {
            FitClass::Just
        }
    }

    /// True where the ranges printed in the thesis overlap: up to 1 cm below the lower limit, 2 cm above the upper one.
    pub fn is_borderline(&self, ease_m: f64) -> bool {
        (self.tight_below_m - 0.01..self.tight_below_m).contains(&ease_m)
            || (ease_m > self.loose_above_m && ease_m <= self.loose_above_m + 0.02)
    }
}

#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Ease {
    /// Body level (`chest`, `hip`, ...).
    pub level: String,
    pub pattern_girth_m: f64,
    pub body_girth_m: f64,
    pub class: FitClass,
    pub borderline: bool,
    /// True if the cut holds the garment to the body there: too much ease is a fault.
    #[serde(default = "held")]
    pub is_held: bool,
}

/// Levels of outcomes that an earlier version wrote.
const fn held() -> bool {
    true
}

impl Ease {
    /// Pattern girth minus body girth, m.
    pub fn ease_m(&self) -> f64 {
        self.pattern_girth_m - self.body_girth_m
    }

    pub fn is_undersized(&self) -> bool {
        self.ease_m() < 0.0
    }
}

/// Takes levels: name, pattern girth, m, and true if the cut holds it to the body. Leaves out unknown body girths.
pub fn ease<'l>(
    levels: impl IntoIterator<Item = (&'l str, f64, bool)>,
    body_girth_m: impl Fn(&str) -> Option<f64>,
    cuts: &Cuts,
) -> Vec<Ease> {
    levels
        .into_iter()
        .filter_map(|(level, pattern_girth_m, is_held)| {
            let body_girth_m = body_girth_m(level)?;
            let ease_m = pattern_girth_m - body_girth_m;
            Some(Ease {
                level: level.to_owned(),
                pattern_girth_m,
                body_girth_m,
                class: cuts.classify(ease_m),
                borderline: cuts.is_borderline(ease_m),
                is_held,
            })
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn classes_follow_the_cuts() {
        let check = |ease_mm: f64, class: FitClass, borderline: bool| {
            let cuts = Cuts::default();
            assert_eq!(cuts.classify(ease_mm * 1e-3), class, "{ease_mm} mm");
            assert_eq!(cuts.is_borderline(ease_mm * 1e-3), borderline, "{ease_mm} mm");
        };
        check(-46.0, FitClass::Tight, false);
        check(39.9, FitClass::Tight, false);
        check(45.0, FitClass::Tight, true);
        check(50.0, FitClass::Just, false);
        check(100.0, FitClass::Just, false);
        check(111.1, FitClass::Loose, true);
        check(121.0, FitClass::Loose, false);
    }
}
