//! Control mesh cut out of a fine mesh: plane sections give its rings, and faces join the rings.

use super::control::{ControlMesh, Layer, RING, Region, YOKE, YOKE_ROWS, YOKE_START};
use crate::BodyError;
use crate::measure::tape;
use geom::section::{Outline, Plane, section};
use geom::{TriMesh, V2, V3, hull};

/// Heights and planes of the rings, m.
#[derive(Clone, Debug)]
pub(crate) struct Cuts {
    /// Foot, ankle, calf, knee, mid-thigh, thigh.
    pub leg: [f64; 6],
    /// Hip, abdomen, waist, underbust, chest, axilla.
    pub trunk: [f64; 6],
    /// Neck base, neck.
    pub neck: [Plane; 2],
    /// Mouth, head girth.
    pub head: [f64; 2],
    /// Right armscye, upper arm, elbow, forearm, wrist: planes with the origin inside the arm, the first axis forward
    /// and the second upward.
    pub arm: [Plane; 5],
    pub crown: V3,
    pub hand: V3,
}

pub(crate) fn control_mesh(mesh: &TriMesh, cuts: &Cuts) -> Result<ControlMesh, BodyError> {
    let mut positions = Vec::with_capacity(Layer::ALL.len() * RING + 64);
    let mirror = |points: &[V3], turn: &dyn Fn(usize) -> usize| -> Vec<V3> {
        (0..RING).map(|i| points[turn(i) % RING]).map(|p| V3::new(-p.x, p.y, p.z)).collect()
    };
    let legs = cuts.leg.iter().map(|&z| leg_ring(mesh, z)).collect::<Result<Vec<_>, _>>()?;
    positions.extend(legs.iter().flatten());
    // The mirror image of a horizontal ring would begin on the other side. Its vertices are renumbered, so that vertex
    // 0 stays on the subject's right.
    positions.extend(legs.iter().flat_map(|ring| mirror(ring, &|i| RING + RING / 2 - i)));
    let horizontal = |&z: &f64| ring(mesh, &trunk_plane(mesh, z), 0.0, "trunk");
    for z in &cuts.trunk {
        positions.extend(horizontal(z)?);
    }
    for plane in &cuts.neck {
        positions.extend(ring(mesh, plane, 0.0, "neck")?);
    }
    for z in &cuts.head {
        positions.extend(horizontal(z)?);
    }
    let arms = cuts.arm.iter().map(|plane| ring(mesh, plane, -std::f64::consts::PI * 5.0 / 6.0, "arm"));
    let arms = arms.collect::<Result<Vec<_>, _>>()?;
    positions.extend(arms.iter().flatten());
    positions.extend(arms.iter().flat_map(|ring| mirror(ring, &|i| i)));
    add_yoke(mesh, &mut positions);
    let sole = positions[..RING].iter().sum::<V3>() / RING as f64;
    let sole = V3::new(sole.x, sole.y, 0.0);
    let left = |p: V3| V3::new(-p.x, p.y, p.z);
    positions.extend([sole, left(sole), cuts.crown, cuts.hand, left(cuts.hand)]);
    let mut control = ControlMesh { positions, faces: Vec::new(), regions: Vec::new() };
    join_rings(&mut control);
    Ok(control)
}

/// Vertex 0 lies at the angle `start` in the plane.
fn ring(mesh: &TriMesh, plane: &Plane, start: f64, part: &'static str) -> Result<Vec<V3>, BodyError> {
    let outlines = section(mesh, plane);
    // The origin may lie in an open mouth, so the hull of the outline counts, as it does for a tape.
    let round =
        |outline: &&Outline| Outline { points: hull::convex_hull(&outline.points), closed: true }.contains(V2::zeros());
    let outline = outlines.iter().filter(round).max_by(|a, b| tape::girth(a).total_cmp(&tape::girth(b)));
    let outline = outline.ok_or(BodyError::MissingPart { part, height_m: plane.origin.z })?;
    Ok(spokes(outline, start).into_iter().map(|p| plane.lift(p)).collect())
}

/// Horizontal plane with its origin in the middle of the outline: a head may lie wholly in front of the body's axis.
fn trunk_plane(mesh: &TriMesh, z: f64) -> Plane {
    let middle = tape::trunk_outline(mesh, z, 0.0).map_or(0.0, |outline| {
        let (front, back) = tape::depth_range(&outline);
        (front + back) / 2.0
    });
    Plane { origin: V3::new(0.0, middle, z), ..Plane::horizontal(z) }
}

fn leg_ring(mesh: &TriMesh, z: f64) -> Result<Vec<V3>, BodyError> {
    let legs = tape::right_limbs(mesh, z, 0.0);
    let leg = legs.iter().min_by(|a, b| a.bounds().0.x.total_cmp(&b.bounds().0.x));
    let (low, high) = leg.ok_or(BodyError::MissingPart { part: "leg", height_m: z })?.bounds();
    let centre = V3::new((low.x + high.x) / 2.0, (low.y + high.y) / 2.0, z);
    ring(mesh, &Plane { origin: centre, ..Plane::horizontal(z) }, 0.0, "leg")
}

/// Points at which [`RING`] rays from the origin of the plane leave an outline.
fn spokes(outline: &Outline, start: f64) -> Vec<V2> {
    let hit = |i: usize| {
        let (sin, cos) = (start + i as f64 / RING as f64 * std::f64::consts::TAU).sin_cos();
        let (ray, normal) = (V2::new(cos, sin), V2::new(-sin, cos));
        let next = outline.points.iter().cycle().skip(1);
        let crossing = |(a, b): (&V2, &V2)| {
            let (da, db) = (a.dot(&normal), b.dot(&normal));
            let along = (a + (b - a) * (da / (da - db))).dot(&ray);
            ((da >= 0.0) != (db >= 0.0) && along > 0.0).then_some(along)
        };
        ray * outline.points.iter().zip(next).filter_map(crossing).fold(0.0, f64::max)
    };
    (0..RING).map(hit).collect()
}

fn add_yoke(mesh: &TriMesh, positions: &mut Vec<V3>) {
    for start in YOKE_START {
        for row in 1..=YOKE_ROWS {
            let share = row as f64 / (YOKE_ROWS + 1) as f64;
            for place in 0..YOKE {
                let below = positions[Layer::Axilla as usize * RING + start + place];
                let above = positions[Layer::NeckBase as usize * RING + start + place];
                let side = if start == YOKE_START[0] { 1.0 } else { -1.0 };
                positions.push(on_skin(mesh, below.lerp(&above, share), side));
            }
        }
    }
}

/// Point of the skin in front of (`side` 1) or behind (-1) a point.
fn on_skin(mesh: &TriMesh, point: V3, side: f64) -> V3 {
    let plane = Plane { origin: point, u: V3::y() * side, v: V3::z() };
    let crossings = section(mesh, &plane).into_iter().flat_map(|outline| {
        let next = outline.points.clone().into_iter().cycle().skip(1);
        outline.points.into_iter().zip(next).filter(|(a, b)| (a.y > 0.0) != (b.y > 0.0)).collect::<Vec<_>>()
    });
    let places = crossings.map(|(a, b)| a.x + (b.x - a.x) * (-a.y / (b.y - a.y)));
    places.max_by(f64::total_cmp).map_or(point, |along| plane.lift(V2::new(along, 0.0)))
}

fn join_rings(control: &mut ControlMesh) {
    use Layer as L;
    use Region as R;
    let tubes = [
        (L::FootRight, L::AnkleRight, R::ShankRight),
        (L::AnkleRight, L::CalfRight, R::ShankRight),
        (L::CalfRight, L::KneeRight, R::ShankRight),
        (L::KneeRight, L::MidThighRight, R::ThighRight),
        (L::MidThighRight, L::ThighRight, R::ThighRight),
        (L::FootLeft, L::AnkleLeft, R::ShankLeft),
        (L::AnkleLeft, L::CalfLeft, R::ShankLeft),
        (L::CalfLeft, L::KneeLeft, R::ShankLeft),
        (L::KneeLeft, L::MidThighLeft, R::ThighLeft),
        (L::MidThighLeft, L::ThighLeft, R::ThighLeft),
        (L::Hip, L::Abdomen, R::Abdomen),
        (L::Abdomen, L::Waist, R::Abdomen),
        (L::Waist, L::UnderBust, R::Chest),
        (L::UnderBust, L::Chest, R::Chest),
        (L::Chest, L::Axilla, R::Chest),
        (L::NeckBase, L::Neck, R::Neck),
        (L::Neck, L::Mouth, R::Head),
        (L::Mouth, L::HeadGirth, R::Head),
        (L::ArmscyeRight, L::UpperArmRight, R::UpperArmRight),
        (L::UpperArmRight, L::ElbowRight, R::UpperArmRight),
        (L::ElbowRight, L::ForearmRight, R::ForearmRight),
        (L::ForearmRight, L::WristRight, R::ForearmRight),
        (L::WristLeft, L::ForearmLeft, R::ForearmLeft),
        (L::ForearmLeft, L::ElbowLeft, R::ForearmLeft),
        (L::ElbowLeft, L::UpperArmLeft, R::UpperArmLeft),
        (L::UpperArmLeft, L::ArmscyeLeft, R::UpperArmLeft),
    ];
    for (below, above, region) in tubes {
        for i in 0..RING {
            let vertex = |layer, i| control.ring_vertex(layer, i);
            let quad = vec![vertex(below, i), vertex(below, i + 1), vertex(above, i + 1), vertex(above, i)];
            add(control, quad, region);
        }
    }
    join_legs(control);
    join_shoulders(control);
    close_ends(control);
}

fn add(control: &mut ControlMesh, face: Vec<usize>, region: Region) {
    control.faces.push(face);
    control.regions.push(region);
}

fn join_legs(control: &mut ControlMesh) {
    use Layer::{Hip, ThighLeft, ThighRight};
    let right = |i: usize| ThighRight as usize * RING + i % RING;
    let left = |i: usize| ThighLeft as usize * RING + i % RING;
    let hip = |i: usize| Hip as usize * RING + i % RING;
    for i in 18..30 {
        add(control, vec![right(i), right(i + 1), hip(i + 1), hip(i)], Region::Pelvis);
    }
    for i in 6..18 {
        add(control, vec![left(i), left(i + 1), hip(i + 1), hip(i)], Region::Pelvis);
        // Vertex i of the right thigh faces its mirror image on the left thigh.
        add(control, vec![right(i), right(i + 1), left(36 - i - 1), left(36 - i)], Region::Pelvis);
    }
    add(control, vec![hip(6), right(6), left(6)], Region::Pelvis);
    add(control, vec![hip(18), left(18), right(18)], Region::Pelvis);
}

fn join_shoulders(control: &mut ControlMesh) {
    for (side, start) in YOKE_START.into_iter().enumerate() {
        let row = |row: usize, place: usize| match row {
            0 => Layer::Axilla as usize * RING + start + place,
            r if r <= YOKE_ROWS => ControlMesh::yoke(side, r - 1, place),
            _ => Layer::NeckBase as usize * RING + start + place,
        };
        for r in 0..=YOKE_ROWS {
            for place in 0..YOKE - 1 {
                add(
                    control,
                    vec![row(r, place), row(r, place + 1), row(r + 1, place + 1), row(r + 1, place)],
                    Region::Shoulders,
                );
            }
        }
    }
    for (right, armscye) in [(true, Layer::ArmscyeRight), (false, Layer::ArmscyeLeft)] {
        let edge = armhole(right);
        for i in 0..RING {
            let (j, arm) = ((i + 1) % RING, |i: usize| armscye as usize * RING + i);
            let face = vec![edge[i], edge[j], arm(j), arm(i)];
            add(control, if right { face } else { face.into_iter().rev().collect() }, Region::Shoulders);
        }
    }
}

/// The 24 vertices round an armhole: from the lower back through the front and over the shoulder.
fn armhole(right: bool) -> Vec<usize> {
    // On the right, the rings are walked from 20 through 0 to 4. On the left, mirrored, from 16 through 12 to 8.
    let place = |i: usize| if right { (20 + i) % RING } else { 16 - i };
    let (front, back) = if right { (0, YOKE - 1) } else { (YOKE - 1, 0) };
    let axilla = (0..9).map(|i| Layer::Axilla as usize * RING + place(i));
    let up = (0..YOKE_ROWS).map(|row| ControlMesh::yoke(0, row, front));
    let neck = (0..9).rev().map(|i| Layer::NeckBase as usize * RING + place(i));
    let down = (0..YOKE_ROWS).rev().map(|row| ControlMesh::yoke(1, row, back));
    axilla.chain(up).chain(neck).chain(down).collect()
}

fn close_ends(control: &mut ControlMesh) {
    let ends = [
        (Layer::FootRight, Region::ShankRight, false),
        (Layer::FootLeft, Region::ShankLeft, false),
        (Layer::HeadGirth, Region::Head, true),
        (Layer::WristRight, Region::ForearmRight, true),
        (Layer::WristLeft, Region::ForearmLeft, false),
    ];
    for (end, (layer, region, forward)) in ends.into_iter().enumerate() {
        let tip = ControlMesh::end(end);
        for i in 0..RING {
            let (a, b) = (control.ring_vertex(layer, i), control.ring_vertex(layer, i + 1));
            add(control, if forward { vec![a, b, tip] } else { vec![b, a, tip] }, region);
        }
    }
}
