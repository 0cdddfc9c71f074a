//! Places of comments in the pictures of a fit sheet.

use crate::picture::{self, Dressed};
use crate::reporting::sheets::PICTURE;
use body::{Body, Joint};
use engine::stages::Model;
use fit::on_body::{Site, sites};
use geom::V3;
use geom::units::from_mm;
use render::{Camera, Frame, View};
use store::comments::{Remark, Side};
use store::{JobId, Result, StageKind, Store};

/// Places of remarks in the pictures, as shares of the width from the left and of the height from the top; `None` for a
/// place that nothing has or that the picture does not show.
pub(super) fn spots(store: &Store, job: JobId, frame: Frame, remarks: &[&Remark]) -> Result<Vec<Option<[f64; 2]>>> {
    let Model { body } = picture::product(store, job, StageKind::Body)?;
    let Dressed { cloth, .. } = picture::dressed(store, job)?;
    let spot = |remark: &&Remark| {
        let found = place(&body, &cloth.positions, remark)?;
        let [across, down] = share(frame, remark.side, found);
        let is_shown = [across, down].iter().all(|share| (0.0..=1.0).contains(share));
        is_shown.then_some([across, down])
    };
    Ok(remarks.iter().map(spot).collect())
}

fn share(frame: Frame, side: Side, point: V3) -> [f64; 2] {
    let view = match side {
        Side::Front => View::Front,
        Side::Side => View::Side,
        Side::Back => View::Back,
    };
    let [right, up, _] = Camera::new(view, frame).axes();
    let (off, width_m) = (point - frame.centre, frame.height_m * f64::from(PICTURE.0) / f64::from(PICTURE.1));
    [0.5 + off.dot(&right) / width_m, 0.5 - off.dot(&up) / frame.height_m]
}

/// Point that a remark is about: a height, or the first part that its place names. Of limbs it is the right one.
fn place(body: &Body, cloth: &[V3], remark: &Remark) -> Option<V3> {
    let place = remark.place.replace('_', " ").to_lowercase();
    if let Some(height_cm) = place.strip_suffix(" cm above the floor").and_then(|cm| cm.parse::<f64>().ok()) {
        return Some(Site::at(&place, body, from_mm(10.0 * height_cm)).plane.origin);
    }
    let known = sites(body).into_iter().map(|site| (site.level.replace('_', " "), site.plane.origin));
    let parts = parts(body, cloth, remark.side).into_iter().map(|(name, point)| (name.to_owned(), point));
    let mut named: Vec<(String, V3)> = known.chain(parts).filter(|(name, _)| place.contains(name.as_str())).collect();
    // Of names within each other, such as bust and underbust, the longest is meant.
    named.sort_by_key(|(name, _)| std::cmp::Reverse(name.len()));
    named.first().map(|(_, point)| *point)
}

fn parts(body: &Body, cloth: &[V3], side: Side) -> Vec<(&'static str, V3)> {
    let middle = |a: V3, b: V3| 0.5 * (a + b);
    let at = |joint: Joint| body.skeleton.at(joint);
    let marks = &body.landmarks;
    let shoulders = middle(marks.shoulder[0], marks.shoulder[1]);
    let levels = sites(body).into_iter();
    let level = |name: &str| levels.clone().find(|site| site.level == name).map(|site| site.plane.origin);
    let mut parts = vec![
        ("neck", if side == Side::Back { marks.back_neck } else { marks.front_neck }),
        ("across shoulder", shoulders),
        ("across back", middle(shoulders, middle(marks.armpit[0], marks.armpit[1]))),
        ("across front", middle(shoulders, middle(marks.armpit[0], marks.armpit[1]))),
        ("shoulder", middle(marks.shoulder[0], marks.side_neck[0])),
        ("armhole", marks.armpit[0]),
        ("elbow", at(Joint::ElbowRight)),
        ("sleeve", middle(at(Joint::ShoulderRight), at(Joint::ElbowRight))),
        ("forearm", middle(at(Joint::ElbowRight), at(Joint::WristRight))),
        ("crotch", marks.crotch),
        ("lower leg", middle(at(Joint::KneeRight), at(Joint::AnkleRight))),
    ];
    parts.extend(level("chest").map(|point| ("bust", point)));
    parts.extend(level("hip").map(|point| ("seat", point)));
    parts.extend(cloth.iter().min_by(|a, b| a.z.total_cmp(&b.z)).map(|point| ("hem", *point)));
    let mean = cloth.iter().sum::<V3>() / cloth.len().max(1) as f64;
    parts.extend((!cloth.is_empty()).then_some(("side seam", mean)));
    parts
}

#[cfg(test)]
mod tests {
    use super::*;
    use body::{Measurements, Sex};
    use store::comments::Severity;

    fn man() -> Body {
        body::build(&Measurements::of(Sex::Male, 1.76)).expect("a body")
    }

    fn remark(side: Side, place: &str) -> Remark {
        let [said, cause, action] = [const { String::new() }; 3];
        Remark { side, place: place.to_owned(), said, severity: Severity::Minor, cause, action, quantity: None }
    }

    #[test]
    fn a_comment_lies_at_its_level() {
        let body = man();
        let cloth = [V3::new(0.1, 0.0, 0.75), V3::new(0.0, 0.0, 1.25)];
        let check = |said: &str, height_m: Option<f64>| {
            let found = place(&body, &cloth, &remark(Side::Front, said)).map(|point| point.z);
            let is_there = found.zip(height_m).is_some_and(|(found, height_m)| (found - height_m).abs() < 1e-9);
            assert!(is_there || found == height_m, "{said}: {found:?}, not {height_m:?}");
        };
        check("hip", Some(body.levels.hip_m));
        check("chest", Some(body.levels.chest_m));
        check("underbust", Some(body.levels.underbust_m));
        check("high bust", Some(body.levels.chest_m));
        check("83 cm above the floor", Some(0.83));
        check("hem", Some(0.75));
        check("side seam", Some(1.0));
        check("thighs", Some(body.levels.crotch_m - 0.025));
        check("across_shoulder", Some(0.5 * (body.landmarks.shoulder[0].z + body.landmarks.shoulder[1].z)));
        check("lining", None);
    }

    #[test]
    fn a_place_is_seen_from_its_side() {
        let frame = Frame { centre: V3::new(0.0, 0.0, 1.0), height_m: 0.9 };
        let check = |side: Side, point: V3, expect: [f64; 2]| {
            let found = share(frame, side, point);
            let off = found.iter().zip(expect).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(off < 0.01, "{side:?}: {found:?}, not {expect:?}");
        };
        check(Side::Front, frame.centre, [0.5, 0.5]);
        // A quarter of the picture's height up, and the subject's right: on the left from the front, on the right from behind.
        let right = V3::new(0.2, 0.0, 1.225);
        check(Side::Front, right, [0.25, 0.25]);
        check(Side::Back, right, [0.75, 0.25]);
        check(Side::Side, right, [0.5, 0.25 + 0.2 / 0.9 * 0.087]);
    }
}
