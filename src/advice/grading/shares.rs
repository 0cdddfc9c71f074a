//! Shares of a grade: how far each length of a garment grows with its leading girth, as published size charts grade.

use body::Sex;
use pattern::Handle;

/// Step of the leading girth to which the shares refer.
pub const GIRTH_M: f64 = 40e-3;

/// Part of a garment, whose lengths grow with one girth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// Above the waist: lengths grow with the chest.
    Upper,
    /// Below the waist: lengths grow with the hip.
    Lower,
}

pub struct Share {
    pub handle: Handle,
    pub part: Part,
    /// Growth for women and for men in 40 mm of girth, mm. Of a girth it is half, as that of its handle.
    of_40_mm: [f64; 2],
}

impl Share {
    /// Mean growth of the length in 40 mm of girth for people of these sexes.
    pub fn of_girth_m(&self, sexes: &[Sex]) -> f64 {
        let of = |sex: &Sex| self.of_40_mm[usize::from(*sex == Sex::Male)];
        1e-3 * sexes.iter().map(of).sum::<f64>() / sexes.len().max(1) as f64
    }
}

/// Shares, of the size charts of W. Aldrich, *Metric Pattern Cutting for Women's Wear* and *for Menswear* (sizes 40 mm
/// apart): shoulder, neck, armscye depth, top arm, wrist, sleeve length, nape to waist and waist to hip, waist to knee,
/// inside leg, trouser bottom width. Those of men were set beside the regressions on chest and hip of a survey alone
/// (docs/experiments/alterations.md). A neck drafted as there is a fifth of its girth wide on either side, and as deep in
/// front. Thigh and knee are no part of those charts: they keep their ratio to the hip, 0.6 and, as straight legs, that
/// of the lower edge.
pub const SHARES: [Share; 15] = [
    upper(Handle::ShoulderLength, [2.5, 2.5]),
    upper(Handle::FrontNeckDepth, [2.0, 2.0]),
    upper(Handle::NeckWidth, [4.0, 4.0]),
    upper(Handle::ArmholeDepth, [5.0, 4.0]),
    upper(Handle::Bicep, [6.0, 5.0]),
    upper(Handle::Cuff, [2.5, 2.0]),
    upper(Handle::SleeveLength, [5.0, 6.0]),
    upper(Handle::BodyLength, [8.0, 7.0]),
    lower(Handle::Hem, [20.0, 20.0]),
    lower(Handle::Thigh, [12.0, 12.0]),
    lower(Handle::Knee, [5.0, 5.0]),
    lower(Handle::LegOpening, [5.0, 5.0]),
    lower(Handle::Fork, [2.0, 2.0]),
    lower(Handle::LegLength, [3.0, 10.0]),
    lower(Handle::SkirtLength, [5.0, 5.0]),
];

/// Girths of the trunk, each of which leads: 40 mm of one go with 40 mm of the others.
pub const LEADS: [Handle; 4] = [Handle::Chest, Handle::Waist, Handle::Hip, Handle::Hem];

/// Least and greatest step of waist and hip per step of the first girth: published charts grade the waist by 0.75 of
/// the hip in small sizes and by 1.25 of the chest in large ones [EN 13402-3].
pub const RATIO: [f64; 2] = [0.75, 1.25];

const fn upper(handle: Handle, of_40_mm: [f64; 2]) -> Share {
    Share { handle, part: Part::Upper, of_40_mm }
}

const fn lower(handle: Handle, of_40_mm: [f64; 2]) -> Share {
    Share { handle, part: Part::Lower, of_40_mm }
}

/// Leads of a garment that has some handles, among those that are free to be sought, with the lengths that grow with
/// each in one step of [`GIRTH_M`], m. A length grows with the hip or the chest, or else with the first lead.
pub fn growing(free: &[Handle], all: &[Handle], sexes: &[Sex]) -> Vec<Vec<(Handle, f64)>> {
    let leads: Vec<Handle> = LEADS.into_iter().filter(|lead| free.contains(lead)).collect();
    let lead_of = |part: Part| {
        let wanted = if part == Part::Upper { &[Handle::Chest][..] } else { &[Handle::Hip, Handle::Hem] };
        wanted.iter().find_map(|lead| leads.iter().position(|known| known == lead)).unwrap_or(0)
    };
    let mut growing: Vec<Vec<(Handle, f64)>> = leads.iter().map(|lead| vec![(*lead, 0.5 * GIRTH_M)]).collect();
    let followers =
        LEADS.into_iter().filter(|girth| *girth != Handle::Hem && all.contains(girth) && !leads.contains(girth));
    if let Some(first) = growing.first_mut() {
        first.extend(followers.map(|girth| (girth, 0.5 * GIRTH_M)));
    }
    for share in SHARES.iter().filter(|share| all.contains(&share.handle) && !leads.contains(&share.handle)) {
        if let Some(lead) = growing.get_mut(lead_of(share.part)) {
            lead.push((share.handle, share.of_girth_m(sexes)));
        }
    }
    growing
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_length_grows_with_one_girth() {
        let check = |free: &[Handle], all: &[Handle], expect: &[&[Handle]]| {
            let found = growing(free, all, &[Sex::Female, Sex::Male]);
            let found: Vec<Vec<Handle>> =
                found.iter().map(|lead| lead.iter().map(|(handle, _)| *handle).collect()).collect();
            assert_eq!(found, expect);
        };
        use Handle::*;
        let tee = [Chest, Waist, Hem, ShoulderLength, ArmholeDepth, Bicep];
        check(
            &[Chest, Waist, Hem, ShoulderLength],
            &tee,
            &[&[Chest, ShoulderLength, ArmholeDepth, Bicep], &[Waist], &[Hem]],
        );
        check(&[Chest], &tee, &[&[Chest, Waist, ShoulderLength, ArmholeDepth, Bicep, Hem]]);
        check(&[Waist, Hip, Thigh], &[Waist, Hip, Thigh, LegLength], &[&[Waist], &[Hip, Thigh, LegLength]]);
        check(&[Bicep], &tee, &[]);
        let both = growing(&[Chest], &[Chest, ArmholeDepth], &[Sex::Female, Sex::Male]);
        let [(Chest, chest_m), (ArmholeDepth, armhole_m)] = both[0][..] else { panic!("{both:?}") };
        assert!((chest_m - 0.02).abs() < 1e-9 && (armhole_m - 0.0045).abs() < 1e-9, "{both:?}");
    }
}
