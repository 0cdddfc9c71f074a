//! Target ease of an intended fit, by level.

use std::collections::BTreeMap;

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Intended {
    /// Smaller than the body, of stretch cloth.
    Compression,
    Slim,
    #[default]
    Regular,
    Loose,
}

impl Intended {
    /// All intended fits, the closest first.
    pub const ALL: [Self; 4] = [Self::Compression, Self::Slim, Self::Regular, Self::Loose];

    /// Name in study files and SQL.
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::Compression => "compression",
            Self::Slim => "slim",
            Self::Regular => "regular",
            Self::Loose => "loose",
        }
    }

    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|fit| fit.as_str() == name)
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TargetLevel {
    pub level: &'static str,
    /// `Some(true)` only for garments that cover the chest, `Some(false)` only for others, `None` for all.
    pub of_top: Option<bool>,
    eases_mm: [[i32; 2]; 4],
}

impl TargetLevel {
    /// Least and greatest ease of each intended fit, in the order of [`Intended::ALL`].
    pub const fn eases_mm(&self) -> [[i32; 2]; 4] {
        self.eases_mm
    }
}

/// Target eases by level and fit. The bands of chest and hip end where the fit classes do [T 6.2.3]. The other bands
/// are the same share of the girth, and allow for bending of limbs (docs/fit.md).
pub const TARGETS: [TargetLevel; 12] = [
    row("across_shoulder", None, [[-20, 5], [-10, 20], [0, 50], [20, 140]]),
    row("chest", None, [[-150, -30], [20, 60], [50, 120], [100, 300]]),
    row("underbust", None, [[-150, -20], [20, 110], [50, 200], [100, 380]]),
    row("waist", Some(true), [[-150, -20], [20, 130], [50, 230], [100, 420]]),
    row("waist", Some(false), [[-80, -10], [0, 20], [0, 40], [20, 80]]),
    row("hip", None, [[-150, -30], [10, 60], [40, 120], [100, 320]]),
    row("thigh", None, [[-90, -15], [15, 60], [40, 120], [100, 280]]),
    row("knee", None, [[-60, -10], [20, 80], [50, 160], [120, 340]]),
    row("upper_arm", None, [[-60, -10], [20, 80], [40, 180], [140, 340]]),
    row("forearm", None, [[-50, -10], [20, 80], [40, 160], [110, 320]]),
    row("wrist", None, [[-25, 0], [10, 50], [20, 100], [40, 200]]),
    row("bust", None, [[-150, -30], [20, 60], [50, 120], [100, 300]]),
];

const fn row(level: &'static str, of_top: Option<bool>, eases_mm: [[i32; 2]; 4]) -> TargetLevel {
    TargetLevel { level, of_top, eases_mm }
}

#[derive(Clone, Debug, Default, PartialEq)]
pub struct Target {
    /// Gives the ease of levels that are not in `own_m`.
    pub intended: Intended,
    /// Least and greatest ease of some levels, for this garment alone, m.
    pub own_m: BTreeMap<String, [f64; 2]>,
    pub is_rigid: bool,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Band {
    /// Least and greatest ease, m. The greatest is infinite where the garment hangs free.
    pub ends_m: [f64; 2],
    /// True for a closed girth of a fabric that does not stretch: smaller than the body, it cannot be worn.
    pub must_close: bool,
}

impl Band {
    /// Departure of an ease from the band, m, negative if the garment is too tight.
    pub fn off_m(&self, ease_m: f64) -> f64 {
        (ease_m - self.ends_m[0]).min(0.0) + (ease_m - self.ends_m[1]).max(0.0)
    }

    /// Weighted departure of an ease, m (`v_fit.weight_mm`). A tight departure counts double, because a tight garment
    /// cannot be worn. A girth that cannot be closed counts a grade step more, and so is out of reach.
    pub fn weight_m(&self, ease_m: f64) -> f64 {
        let cannot_close = if self.must_close && ease_m < 0.0 { GRADE_STEP_M } else { 0.0 };
        let off_m = self.off_m(ease_m);
        cannot_close + if off_m < 0.0 { -2.0 * off_m } else { off_m }
    }
}

/// Ends of a band of ease, mm, in words. The greatest may be infinite.
pub fn band_words([least_mm, most_mm]: [f64; 2]) -> String {
    if most_mm.is_finite() { format!("{least_mm:.0} to {most_mm:.0}") } else { format!("from {least_mm:.0}") }
}

/// True for a girth of the body round which cloth closes: a neckline lies below the neck, a shoulder is a width.
pub fn is_girth(level: &str) -> bool {
    !matches!(level, "neck" | "across_shoulder")
}

impl Target {
    /// Ease that is meant at a level. `None` without a target, as at the neckline of a garment without a collar.
    /// `is_top` is true if the garment covers the chest. Where the cut does not hold the garment to the body
    /// (`is_held`), the greatest ease is infinite, unless the maker means it ([`Target::is_firm`]).
    pub fn band(&self, level: &str, is_top: bool, is_held: bool) -> Option<Band> {
        let [least, most] = self.meant_m(level, is_top)?;
        let most = if is_held || self.is_firm(level) { most } else { f64::INFINITY };
        Some(Band { ends_m: [least, most], must_close: self.is_rigid && is_girth(level) })
    }

    /// True if the greatest ease counts where cloth hangs free: for an own target, or a garment to press everywhere.
    pub fn is_firm(&self, level: &str) -> bool {
        self.own_m.contains_key(level) || self.intended == Intended::Compression
    }

    /// Least and greatest ease at a level that the cut holds to the body, m.
    pub fn meant_m(&self, level: &str, is_top: bool) -> Option<[f64; 2]> {
        let is_asked = |row: &&TargetLevel| row.level == level && row.of_top.is_none_or(|of_top| of_top == is_top);
        let table = || {
            TARGETS.iter().find(is_asked).map(|row| row.eases_mm[self.intended as usize].map(|mm| 1e-3 * f64::from(mm)))
        };
        self.own_m.get(level).copied().or_else(table)
    }
}

/// Grade step, m of girth: the step of the drafted letter sizes from S to M and from M to L.
pub const GRADE_STEP_M: f64 = 0.06;

/// Tension at which a fabric that stretches yields a twentieth of its length, N/m. Round a waist of 0.13 m radius it
/// presses with 0.2 kPa, a tenth of what wearers begin to call uncomfortable.
const YIELDING_N_M: f64 = 30.0;

/// True if a closed girth of a fabric cannot be worn smaller than the body. Takes the stiffness round the body.
pub fn is_rigid(membrane_weft_n_m: f64) -> bool {
    0.05 * membrane_weft_n_m > YIELDING_N_M
}

/// True if a size whose worst level departs by `weight_m` may be worn. Beyond a grade step a further size of the grade
/// would lie nearer: as there is none, the sizes do not reach this body.
pub fn is_within_reach(weight_m: f64) -> bool {
    weight_m <= GRADE_STEP_M
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bands_are_those_of_the_fit_and_of_the_garment() {
        let check = |intended, level: &str, is_top, expect_mm: Option<[f64; 2]>| {
            let target = Target { intended, ..Target::default() };
            let found = target.meant_m(level, is_top).map(|band| band.map(|m| (1e3 * m).round()));
            assert_eq!(found, expect_mm, "{level}");
        };
        check(Intended::Regular, "chest", true, Some([50.0, 120.0]));
        check(Intended::Regular, "waist", true, Some([50.0, 230.0]));
        check(Intended::Regular, "waist", false, Some([0.0, 40.0]));
        check(Intended::Slim, "hip", true, Some([10.0, 60.0]));
        check(Intended::Regular, "neck", true, None);
        let own = Target { own_m: [("neck".to_owned(), [0.01, 0.03])].into(), ..Target::default() };
        assert_eq!(own.meant_m("neck", true), Some([0.01, 0.03]));
    }

    #[test]
    fn too_much_ease_counts_where_the_cut_holds_or_the_maker_means_it() {
        let own = BTreeMap::from([("hip".to_owned(), [0.02, 0.08])]);
        let check = |target: &Target, level: &str, is_held: bool, most: f64| {
            assert_eq!(target.band(level, true, is_held).map(|band| band.ends_m[1]), Some(most), "{level}");
        };
        let target = Target { own_m: own, ..Target::default() };
        check(&target, "chest", true, 0.12);
        check(&target, "waist", false, f64::INFINITY);
        check(&target, "hip", false, 0.08);
        check(&Target { intended: Intended::Compression, ..Target::default() }, "waist", false, -0.02);
    }

    #[test]
    fn a_girth_that_cannot_be_closed_is_out_of_reach() {
        let check = |level: &str, is_rigid: bool, ease_m: f64, expect: bool| {
            let target = Target { is_rigid, ..Target::default() };
            let band = target.band(level, false, true).expect("a target");
            assert_eq!(is_within_reach(band.weight_m(ease_m)), expect, "{level} {ease_m}");
        };
        check("waist", true, -0.004, false);
        check("waist", true, 0.0, true);
        check("waist", false, -0.004, true);
        check("across_shoulder", true, -0.004, true);
    }

    #[test]
    fn what_is_too_tight_counts_double() {
        let check = |ease_m, off: f64, weight: f64| {
            let band = Band { ends_m: [0.05, 0.12], must_close: false };
            let found = [band.off_m(ease_m) - off, band.weight_m(ease_m) - weight];
            assert!(found.iter().all(|off| off.abs() < 1e-12), "{ease_m}: {found:?}");
        };
        check(0.02, -0.03, 0.06);
        check(0.05, 0.0, 0.0);
        check(0.13, 0.01, 0.01);
    }

    #[test]
    fn a_size_is_within_reach_up_to_a_grade_step() {
        let check = |ease_m: f64, expect: bool| {
            let found = is_within_reach(Band { ends_m: [0.05, 0.23], must_close: false }.weight_m(ease_m));
            assert_eq!(found, expect, "{ease_m}");
        };
        check(0.1, true);
        check(0.29, true);
        check(0.351, false);
        // Too tight counts double.
        check(0.021, true);
        check(0.019, false);
    }

    #[test]
    fn closer_fits_have_less_ease_and_no_band_is_empty() {
        for row in TARGETS {
            assert!(row.eases_mm.iter().all(|[least, most]| least < most), "{}", row.level);
            let rises = |pair: &[[i32; 2]]| pair[0][0] <= pair[1][0] && pair[0][1] <= pair[1][1];
            assert!(row.eases_mm.windows(2).all(rises), "{}", row.level);
        }
    }
}
