//! Pressure of cloth by region of the body.

use body::{Body, Dimension, Joint};
use geom::{TriMesh, V3};

/// Least pressure that counts, kPa: several times that of a heavy cloth by its weight.
const PRESSING_KPA: f64 = 0.02;
/// Share of the pressing area above the greatest reported pressure, so that single vertices do not decide it.
const SHARE: f64 = 0.01;

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Region {
    Neck,
    Shoulders,
    Chest,
    Waist,
    Hip,
    Thighs,
    LowerLegs,
    UpperArms,
    Forearms,
}

impl Region {
    pub const ALL: [Self; 9] = [
        Self::Neck,
        Self::Shoulders,
        Self::Chest,
        Self::Waist,
        Self::Hip,
        Self::Thighs,
        Self::LowerLegs,
        Self::UpperArms,
        Self::Forearms,
    ];

    /// Name in tables and SQL.
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::Neck => "neck",
            Self::Shoulders => "shoulders",
            Self::Chest => "chest",
            Self::Waist => "waist",
            Self::Hip => "hip",
            Self::Thighs => "thighs",
            Self::LowerLegs => "lower_legs",
            Self::UpperArms => "upper_arms",
            Self::Forearms => "forearms",
        }
    }

    /// Region of a point on or in front of the skin: that of the nearest bone, with distances divided by the radius of
    /// the limb. On trunk and legs the height decides, with limits at neck points, armpits, half-way heights between
    /// the levels, crotch and knee.
    pub fn of(body: &Body, point: V3) -> Self {
        let position = |joint: Joint| body.skeleton.at(joint);
        let bone = |from: Joint, to: Joint, girth: Dimension| {
            let radius_m = body.girths.get(girth).unwrap_or(1.0) / std::f64::consts::TAU;
            off_segment(point, position(from), position(to)) / radius_m
        };
        let arms = [
            (bone(Joint::ShoulderRight, Joint::ElbowRight, Dimension::UpperArmGirth), Self::UpperArms),
            (bone(Joint::ShoulderLeft, Joint::ElbowLeft, Dimension::UpperArmGirth), Self::UpperArms),
            (bone(Joint::ElbowRight, Joint::WristRight, Dimension::ForearmGirth), Self::Forearms),
            (bone(Joint::ElbowLeft, Joint::WristLeft, Dimension::ForearmGirth), Self::Forearms),
        ];
        let trunk = bone(Joint::Pelvis, Joint::Chest, Dimension::ChestGirth).min(bone(
            Joint::Chest,
            Joint::Neck,
            Dimension::ChestGirth,
        ));
        let nearest = arms.into_iter().min_by(|a, b| a.0.total_cmp(&b.0));
        match nearest {
            Some((off, region)) if off < trunk => region,
            _ => Self::of_height(body, point.z),
        }
    }

    fn of_height(body: &Body, z: f64) -> Self {
        let levels = &body.levels;
        let armpit_m = 0.5 * (body.landmarks.armpit[0].z + body.landmarks.armpit[1].z);
        let neck_m = 0.5 * (body.landmarks.side_neck[0].z + body.landmarks.side_neck[1].z);
        let knee_m = body.skeleton.at(Joint::KneeRight).z;
        let floors = [
            (neck_m, Self::Neck),
            (armpit_m, Self::Shoulders),
            (0.5 * (levels.underbust_m + levels.waist_m), Self::Chest),
            (0.5 * (levels.waist_m + levels.hip_m), Self::Waist),
            (levels.crotch_m, Self::Hip),
            (knee_m, Self::Thighs),
        ];
        floors.into_iter().find(|(floor, _)| z >= *floor).map_or(Self::LowerLegs, |(_, region)| region)
    }
}

fn off_segment(point: V3, from: V3, to: V3) -> f64 {
    let way = to - from;
    let share = ((point - from).dot(&way) / way.norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    (point - from - way * share).norm()
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pressed {
    pub region: Region,
    /// Area of the cloth that presses, m2.
    pub area_m2: f64,
    /// Mean pressure on that area, kPa.
    pub mean_kpa: f64,
    /// Pressure that a hundredth of that area exceeds, kPa.
    pub most_kpa: f64,
}

/// Leaves out regions without pressure.
pub fn pressed(body: &Body, cloth: &TriMesh, pressure_kpa: &[f64]) -> Vec<Pressed> {
    let mut patches: Vec<Vec<Patch>> = vec![Vec::new(); Region::ALL.len()];
    for triangle in &cloth.triangles {
        let [a, b, c] = triangle.map(|v| cloth.positions[v]);
        let kpa = triangle.iter().map(|v| pressure_kpa[*v]).sum::<f64>() / 3.0;
        if kpa >= PRESSING_KPA {
            let region = Region::of(body, (a + b + c) / 3.0);
            patches[region as usize].push(Patch { kpa, area_m2: 0.5 * (b - a).cross(&(c - a)).norm() });
        }
    }
    Region::ALL.into_iter().zip(patches).filter_map(|(region, patches)| summed(region, patches)).collect()
}

#[derive(Clone, Copy)]
struct Patch {
    kpa: f64,
    area_m2: f64,
}

fn summed(region: Region, mut patches: Vec<Patch>) -> Option<Pressed> {
    let area_m2: f64 = patches.iter().map(|patch| patch.area_m2).sum();
    if area_m2 == 0.0 {
        return None;
    }
    patches.sort_by(|a, b| b.kpa.total_cmp(&a.kpa));
    let mut beyond = 0.0;
    let most = patches.iter().find(|patch| {
        beyond += patch.area_m2;
        beyond >= SHARE * area_m2
    });
    let mean_kpa = patches.iter().map(|patch| patch.kpa * patch.area_m2).sum::<f64>() / area_m2;
    Some(Pressed { region, area_m2, mean_kpa, most_kpa: most.map_or(0.0, |patch| patch.kpa) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use body::{Measurements, Sex};

    fn body() -> Body {
        body::build(&Measurements::of(Sex::Male, 1.78)).expect("a body of norm")
    }

    #[test]
    fn a_point_of_the_skin_has_the_region_that_a_fitter_would_name() {
        let body = body();
        let (levels, marks) = (&body.levels, &body.landmarks);
        let front = |z: f64| V3::new(0.0, 0.12, z);
        let check = |point: V3, expect: Region| assert_eq!(Region::of(&body, point), expect, "{point:?}");
        check(front(levels.chest_m), Region::Chest);
        check(
            V3::new(body.girths.get(Dimension::ChestGirth).unwrap_or(1.0) / 6.5, 0.0, levels.underbust_m),
            Region::Chest,
        );
        check(front(levels.waist_m), Region::Waist);
        check(front(levels.hip_m), Region::Hip);
        check(0.5 * (marks.side_neck[0] + marks.shoulder[0]), Region::Shoulders);
        check(body.skeleton.at(Joint::Neck) + V3::new(0.0, 0.06, 0.03), Region::Neck);
        let along = |from: Joint, to: Joint| {
            body.skeleton.at(from) * 0.5 + body.skeleton.at(to) * 0.5 + V3::new(0.03, 0.03, 0.0)
        };
        check(along(Joint::ShoulderLeft, Joint::ElbowLeft), Region::UpperArms);
        check(along(Joint::ElbowRight, Joint::WristRight), Region::Forearms);
        check(along(Joint::HipRight, Joint::KneeRight), Region::Thighs);
        check(along(Joint::KneeLeft, Joint::AnkleLeft), Region::LowerLegs);
    }

    #[test]
    fn a_region_s_pressure_is_the_mean_over_what_presses() {
        // A strip across the front at the waist: two parts of five press with 1 kPa, one with 3.
        let body = body();
        let z = body.levels.waist_m;
        let mut cloth = TriMesh { positions: Vec::new(), triangles: Vec::new() };
        let mut kpa = Vec::new();
        for k in 0..300 {
            let x = -0.06 + 0.12 * f64::from(k) / 300.0;
            let first = cloth.positions.len();
            let (presses_kpa, height) = [(0.0, 0.02), (1.0, 0.02), (3.0, 0.01)][k as usize / 100];
            cloth.positions.extend([V3::new(x, 0.12, z), V3::new(x + 4e-4, 0.12, z), V3::new(x, 0.12, z + height)]);
            cloth.triangles.push([first, first + 1, first + 2]);
            kpa.extend([presses_kpa; 3]);
        }
        let found = pressed(&body, &cloth, &kpa);
        assert_eq!(found.len(), 1, "{found:?}");
        assert_eq!(found[0].region, Region::Waist);
        assert!((found[0].mean_kpa - 5.0 / 3.0).abs() < 1e-12 && (found[0].most_kpa - 3.0).abs() < 1e-12, "{found:?}");
        assert!((found[0].area_m2 - 100.0 * (4e-6 + 2e-6)).abs() < 1e-12, "{found:?}");
    }
}
