//! Cross sections of body and cloth, and the air gap between them.

use body::{Body, Joint};
use geom::polyline::signed_area;
use geom::section::{Outline, Plane, section};
use geom::{TriMesh, V2, V3};

/// Distance below armpit and crotch at which upper arm and thigh are cut, m: about where their girths are measured.
const BELOW_FOLD_M: f64 = 0.025;
/// Number of directions in which the gap is reported: every 10 degrees.
pub const DIRECTIONS: usize = 36;
/// Number of directions over which the area of air is integrated: every half degree.
const FINE: usize = 720;

#[derive(Clone, Debug, PartialEq)]
pub struct Site {
    /// Level: `chest`, `underbust`, `waist`, `hip`, `thigh`, `knee`, `upper_arm`, or a height in words.
    pub level: String,
    /// Plane whose first axis points to the subject's right, the second to the front.
    pub plane: Plane,
}

impl Site {
    /// Horizontal plane at a height above the floor. Below the crotch its origin lies in the right leg.
    pub fn at(level: &str, body: &Body, height_m: f64) -> Self {
        let is_leg = height_m < body.levels.crotch_m;
        let [high, low] = [body.skeleton.at(Joint::HipRight), body.skeleton.at(Joint::AnkleRight)];
        let share = ((high.z - height_m) / (high.z - low.z)).clamp(0.0, 1.0);
        let leg = high + (low - high) * share;
        let trunk = body.skeleton.at(Joint::Waist);
        let axis = if is_leg { leg } else { trunk };
        let plane = Plane { origin: V3::new(axis.x, axis.y, height_m), ..Plane::horizontal(height_m) };
        Self { level: level.to_owned(), plane }
    }

    /// True if the plane is horizontal.
    pub fn is_level(&self) -> bool {
        self.plane.normal().z.abs() > 1.0 - 1e-9
    }

    /// Height above the floor of the origin of the plane, which lies on the axis of the trunk or limb, m.
    pub fn height_m(&self) -> f64 {
        self.plane.origin.z
    }
}

/// Sections of a body, from the chest down, and across the right upper arm.
pub fn sites(body: &Body) -> Vec<Site> {
    let levels = &body.levels;
    let heights = [
        ("chest", levels.chest_m),
        ("underbust", levels.underbust_m),
        ("waist", levels.waist_m),
        ("hip", levels.hip_m),
        ("thigh", levels.crotch_m - BELOW_FOLD_M),
        ("knee", body.skeleton.at(Joint::KneeRight).z),
    ];
    let mut found: Vec<Site> = heights.iter().map(|(level, height_m)| Site::at(level, body, *height_m)).collect();
    found.extend(upper_arm(body));
    found
}

/// Plane across the right upper arm below the armpit. `None` for an arm without length.
fn upper_arm(body: &Body) -> Option<Site> {
    let [shoulder, elbow] = [Joint::ShoulderRight, Joint::ElbowRight].map(|joint| body.skeleton.at(joint));
    let up = (shoulder - elbow).try_normalize(1e-6)?;
    let along_m = (shoulder - body.landmarks.armpit[0]).dot(&up) + BELOW_FOLD_M;
    let v = (V3::y() - up * up.y).try_normalize(1e-6)?;
    let plane = Plane { origin: shoulder - up * along_m, u: v.cross(&up), v };
    Some(Site { level: "upper_arm".to_owned(), plane })
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Angle {
    /// Direction from the front towards the subject's right, degrees.
    pub deg: f64,
    /// Distance from the centroid of the outline to the skin, m.
    pub skin_m: f64,
    /// Distance from the skin outwards to the first cloth, negative inside the body. `None` without cloth there.
    pub gap_m: Option<f64>,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Section {
    pub site: Site,
    pub skin: Outline,
    pub others: Vec<Outline>,
    pub cloth: Vec<Outline>,
    /// Centroid of the outline of the skin, in the plane.
    pub centre: V2,
}

#[derive(Clone, Copy, Default)]
struct Ray {
    /// Distance at which the ray last leaves the skin, m.
    skin_m: f64,
    cloth_m: Option<f64>,
}

impl Section {
    /// Cuts a body and the sewn cloth on it. `None` if the plane does not meet the body.
    ///
    /// The trunk or limb is the outline round the origin of the plane, or else the nearest outline. Cloth belongs to
    /// this outline if it encloses its centroid, or lies nearer to this outline than to the others of the body.
    pub fn cut(site: Site, body: &TriMesh, cloth: &TriMesh) -> Option<Self> {
        let mut outlines: Vec<Outline> =
            section(body, &site.plane).into_iter().filter(|outline| outline.closed).collect();
        let axis = V2::zeros();
        let off = |outline: &Outline| if outline.contains(axis) { 0.0 } else { distance(axis, outline) };
        let own = (0..outlines.len()).min_by(|a, b| off(&outlines[*a]).total_cmp(&off(&outlines[*b])))?;
        let skin = outlines.swap_remove(own);
        let centre = centroid(&skin.points);
        let belongs = |cloth: &Outline| {
            if cloth.contains(centre) {
                return true;
            }
            let own = mean_distance(cloth, &skin);
            outlines.iter().all(|other| own <= mean_distance(cloth, other))
        };
        let cloth = section(cloth, &site.plane).into_iter().filter(belongs).collect();
        Some(Self { site, skin, others: outlines, cloth, centre })
    }

    pub fn body_area_m2(&self) -> f64 {
        signed_area(&self.skin.points).abs()
    }

    pub fn cloth_length_m(&self) -> f64 {
        self.cloth.iter().flat_map(segments).map(|(a, b)| (b - a).norm()).sum()
    }

    /// Air gap in `count` directions, from the front towards the subject's right.
    pub fn gaps(&self, count: usize) -> Vec<Angle> {
        let angle = |k: usize| {
            let deg = k as f64 / count as f64 * 360.0;
            let Ray { skin_m, cloth_m } = self.ray(deg).unwrap_or_default();
            Angle { deg, skin_m, gap_m: cloth_m.map(|cloth_m| cloth_m - skin_m) }
        };
        (0..count).map(angle).collect()
    }

    /// Area between skin and first cloth, in the directions with cloth, m2. Cloth inside the body counts negative.
    pub fn air_m2(&self) -> f64 {
        let rays = (0..FINE).filter_map(|k| self.ray((k as f64 + 0.5) / FINE as f64 * 360.0));
        let sectors = rays.filter_map(|ray| Some(0.5 * (ray.cloth_m?.powi(2) - ray.skin_m.powi(2))));
        sectors.sum::<f64>() * std::f64::consts::TAU / FINE as f64
    }

    /// Ray from the centroid at an angle. Cloth counts if no other limb lies in front of it, and it is nearer to this
    /// limb than to any other, to which the air would belong otherwise. `None` if the ray does not meet the skin.
    fn ray(&self, deg: f64) -> Option<Ray> {
        let (sin, cos) = deg.to_radians().sin_cos();
        let way = V2::new(sin, cos);
        let skin = crossings(self.centre, way, &self.skin)
            .fold(None, |far: Option<f64>, at| Some(far.map_or(at, |f| f.max(at))))?;
        let own = |at: &f64| {
            let point = self.centre + way * *at;
            let off = distance(point, &self.skin);
            self.others.iter().all(|other| off <= distance(point, other))
        };
        let first = |outlines: &[Outline]| {
            outlines.iter().flat_map(|outline| crossings(self.centre, way, outline)).min_by(f64::total_cmp)
        };
        let wall = first(&self.others).unwrap_or(f64::INFINITY);
        Some(Ray { skin_m: skin, cloth_m: first(&self.cloth).filter(|cloth| *cloth < wall).filter(own) })
    }
}

/// Segments of an outline, including the closing segment of a closed outline.
fn segments(outline: &Outline) -> impl Iterator<Item = (V2, V2)> {
    let points = &outline.points;
    let count = if outline.closed { points.len() } else { points.len().saturating_sub(1) };
    (0..count).map(|k| (points[k], points[(k + 1) % points.len()]))
}

fn crossings(from: V2, way: V2, outline: &Outline) -> impl Iterator<Item = f64> {
    segments(outline).filter_map(move |(a, b)| {
        let (a, b) = (a - from, b - from);
        let (left, right) = (way.perp(&a), way.perp(&b));
        // A point on the ray counts as left of the ray, so that a corner on the ray is crossed once.
        ((left >= 0.0) != (right >= 0.0))
            .then(|| (a + (b - a) * (left / (left - right))).dot(&way))
            .filter(|at| *at >= 0.0)
    })
}

/// Centroid of the area of a polygon, or the mean of its points if it has no area.
fn centroid(points: &[V2]) -> V2 {
    let first = points.first().copied().unwrap_or_default();
    let local: Vec<V2> = points.iter().map(|p| p - first).collect();
    let whole = signed_area(&local);
    if whole == 0.0 {
        return points.iter().sum::<V2>() / points.len().max(1) as f64;
    }
    let next = local.iter().cycle().skip(1);
    first + local.iter().zip(next).map(|(a, b)| (a + b) * a.perp(b)).sum::<V2>() / (6.0 * whole)
}

/// Distance of a point from the nearest vertex of an outline.
fn distance(point: V2, outline: &Outline) -> f64 {
    outline.points.iter().map(|p| (p - point).norm()).fold(f64::INFINITY, f64::min)
}

fn mean_distance(outline: &Outline, other: &Outline) -> f64 {
    outline.points.iter().map(|p| distance(*p, other)).sum::<f64>() / outline.points.len().max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use body::{Measurements, Sex};

    fn tube(x: f64, radius: impl Fn(f64) -> f64, around: usize, is_solid: bool) -> TriMesh {
        let mut mesh = TriMesh { positions: Vec::new(), triangles: Vec::new() };
        for z in [-0.1, 0.1] {
            for k in 0..around {
                let angle = std::f64::consts::TAU * k as f64 / around as f64;
                let r = radius(angle);
                mesh.positions.push(V3::new(x + r * angle.sin(), r * angle.cos(), z));
            }
        }
        for k in 0..around {
            let (a, b) = (k, (k + 1) % around);
            mesh.triangles.extend([[a, a + around, b], [b, a + around, b + around]]);
        }
        if is_solid {
            for (z, flip) in [(0, true), (around, false)] {
                let corners = (1..around - 1).map(|k| [z, z + k, z + k + 1]);
                mesh.triangles.extend(corners.map(|[a, b, c]| if flip { [a, b, c] } else { [a, c, b] }));
            }
        }
        mesh
    }

    fn joined(parts: &[TriMesh]) -> TriMesh {
        let mut all = TriMesh { positions: Vec::new(), triangles: Vec::new() };
        for part in parts {
            let first = all.positions.len();
            all.positions.extend(&part.positions);
            all.triangles.extend(part.triangles.iter().map(|t| t.map(|v| v + first)));
        }
        all
    }

    fn site(x: f64) -> Site {
        Site { level: "waist".into(), plane: Plane { origin: V3::new(x, 0.0, 0.0), ..Plane::horizontal(0.0) } }
    }

    #[test]
    fn the_gap_of_a_cylinder_in_a_tube_is_that_of_their_radii() {
        // A tube of a ripple of eight waves: the gap in a direction is the tube's radius there less the cylinder's.
        let outer = |angle: f64| 0.17 + 0.01 * (8.0 * angle).cos();
        let (body, cloth) = (tube(0.0, |_| 0.15, 720, true), tube(0.0, outer, 720, false));
        let cut = Section::cut(site(0.0), &body, &cloth).expect("it is cut");
        for Angle { deg, gap_m, .. } in cut.gaps(36) {
            let expected = outer(deg.to_radians()) - 0.15;
            let found = gap_m.expect("cloth all round");
            assert!((found - expected).abs() < 0.2e-3, "{deg} degrees: {found}, not {expected}");
        }
        let polygon = |r: f64| 360.0 * r * r * (std::f64::consts::TAU / 720.0).sin();
        assert!((cut.body_area_m2() - polygon(0.15)).abs() < 1e-12);
        // Mean of the squared radius: 0.17^2 + 0.01^2 / 2.
        let air = std::f64::consts::PI * (0.17_f64.powi(2) + 0.5e-4 - 0.15_f64.powi(2));
        assert!((cut.air_m2() - air).abs() < 1e-3 * air, "{} {air}", cut.air_m2());
    }

    #[test]
    fn cloth_belongs_to_the_limb_that_it_goes_round() {
        let leg = |x: f64| tube(x, |_| 0.08, 90, true);
        let body = joined(&[leg(0.1), leg(-0.1)]);
        let check = |cloth: TriMesh, gap_mm: [Option<f64>; 4]| {
            let cut = Section::cut(site(0.1), &body, &cloth).expect("it is cut");
            let found = cut.gaps(4);
            for (Angle { deg, gap_m, .. }, expected) in found.iter().zip(gap_mm) {
                let same = gap_m.zip(expected).is_some_and(|(gap, mm)| (gap - 1e-3 * mm).abs() < 0.3e-3);
                assert!(
                    same || (gap_m.is_none() && expected.is_none()),
                    "{deg} degrees: {gap_m:?}, not {expected:?} mm"
                );
            }
        };
        // Two trouser legs: only the right one counts.
        let round = |x: f64| tube(x, |_| 0.09, 90, false);
        check(joined(&[round(0.1), round(-0.1)]), [Some(10.0); 4]);
        // A skirt round both: to the left the other leg stands between.
        let half = (0.25_f64.powi(2) - 0.01).sqrt() - 0.08;
        check(tube(0.0, |_| 0.25, 720, false), [Some(1e3 * half), Some(70.0), Some(1e3 * half), None]);
        // A tube inside the leg, as Hybrid-GS may leave it.
        check(tube(0.1, |_| 0.07, 90, false), [Some(-10.0); 4]);
    }

    #[test]
    fn the_area_of_a_body_s_section_is_that_of_the_cut_triangles() {
        let body = body::build(&Measurements::of(Sex::Female, 1.68)).expect("a body of norm");
        for site in sites(&body) {
            let normal = site.plane.normal();
            let cut = Section::cut(site.clone(), &body.mesh, &TriMesh { positions: vec![], triangles: vec![] });
            let cut = cut.expect("it is cut");
            // Green's theorem over the segments of the triangles, in no order: all limbs that the plane cuts.
            let mut whole = 0.0;
            for triangle in &body.mesh.triangles {
                let corners = triangle.map(|v| body.mesh.positions[v]);
                let heights = corners.map(|p| (p - site.plane.origin).dot(&normal));
                let mut ends = Vec::new();
                for k in 0..3 {
                    let (low, high) = (heights[k], heights[(k + 1) % 3]);
                    if (low >= 0.0) != (high >= 0.0) {
                        let at = corners[k] + (corners[(k + 1) % 3] - corners[k]) * (low / (low - high));
                        ends.push((site.plane.project(at), low >= 0.0));
                    }
                }
                if let [(a, a_down), (b, _)] = ends.as_slice() {
                    whole += if *a_down { 0.5 * a.perp(b) } else { 0.5 * b.perp(a) };
                }
            }
            let found = cut.body_area_m2() + cut.others.iter().map(|limb| signed_area(&limb.points).abs()).sum::<f64>();
            let level = &site.level;
            assert!((found - whole.abs()).abs() < 1e-6 * found, "{level}: {found}, {whole}");
            assert!(cut.skin.contains(cut.centre) && cut.body_area_m2() > 4e-3, "{level}: {}", cut.body_area_m2());
        }
    }
}
