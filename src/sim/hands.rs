//! Hands as they slip into a sleeve: folded while a garment is sewn, then opened inside it.
//!
//! Fingers and thumbs are thinner than the triangles of a coarse mesh, and pass between its contact points. A narrow
//! sleeve that is drawn together about an open hand leaves the thumb outside. Until the finest mesh has settled, the
//! cloth therefore meets a convex solid in place of a hand that it comes near. At first the solid is folded: beyond the
//! wrist it is narrower than the wrist and tapers. Then it is widened until it contains the whole hand, and pushes the
//! cloth outwards from within. Only the last phase resolves fingers.
//!
//! The solid is the intersection of the half-spaces `n . p <= h(n)` for directions `n` all around, `h` its support
//! function. The greatest `n . p - h(n)` approximates the signed distance. It is interpolated linearly between the
//! folded and the open solid.

use std::collections::BTreeSet;

use body::{Body, Joint};
use geom::{DistanceField, V3};

geom::constants! {
    "hands",
    /// Greatest distance of a hand's skin from the wrist.
    const REACH_M: f64 = 0.25;
    /// Greatest distance of a hand's skin from its axis. If any lies farther, a scan's hand has grown together with the
    /// thigh.
    const WIDEST_M: f64 = 0.15;
    /// Share of the hand's length, at its end, whose middle gives the hand's direction.
    const END: f64 = 0.4;
    /// Length of the wrist that gives the half width of a folded hand.
    const WRIST_M: f64 = 0.02;
    /// Half width of a folded hand over that of the wrist. A narrow hem on the coarsest mesh has four corners or three,
    /// and closes only about a solid that is so much thinner than a wrist: the incircle of a triangle has 0.6 of its
    /// perimeter.
    const FOLDED: f64 = 0.65;
    /// Half width of a folded hand at its end over that at its root.
    const NARROWING: f64 = 0.5;
    /// Distance from a hand within which cloth meets the solid.
    const NEAR_M: f64 = 0.08;
    /// Distance from the solid beyond which the field is left unchanged: the fields hold no distances beyond that.
    const SHELL_M: f64 = 0.0125;
    /// Distance of the open solid from the hand: triangles of 15 mm cut its corners.
    const ROOM_M: f64 = 4e-3;
    const OPENINGS: u32 = 4;
    /// Steps in which the solid shrinks to the hand itself.
    const BARINGS: u32 = 4;
}

pub struct Hand {
    pub tip: V3,
    /// Vertices of the body's mesh, in order.
    pub skin: Vec<usize>,
    /// Support function of the solid in each direction, folded and open, m.
    supports: [Vec<f64>; 2],
}

impl Hand {
    /// `side` is 1 right, -1 left. `None` where no skin is a hand's.
    pub fn of(body: &Body, side: f64) -> Option<Self> {
        let joints =
            if side > 0.0 { [Joint::ElbowRight, Joint::WristRight] } else { [Joint::ElbowLeft, Joint::WristLeft] };
        let [elbow, wrist] = joints.map(|joint| body.skeleton.at(joint));
        let skin = skin_beyond(body, wrist, (wrist - elbow).try_normalize(0.0)?);
        let points: Vec<V3> = skin.iter().map(|&v| body.mesh.positions[v] - wrist).collect();
        let tip = *points.iter().max_by(|a, b| a.norm_squared().total_cmp(&b.norm_squared()))?;
        let end = points.iter().filter(|p| p.norm() > (1.0 - END) * tip.norm());
        let along = end.sum::<V3>().try_normalize(0.0)?;
        let length = points.iter().map(|p| p.dot(&along)).fold(0.0, f64::max);
        let across = |p: &V3| p - along * p.dot(&along);
        if points.iter().any(|p| across(p).norm() > WIDEST_M) {
            return None;
        }
        let at_wrist = points.iter().filter(|p| p.dot(&along) < WRIST_M);
        let half_width = FOLDED * at_wrist.map(|p| across(p).norm()).reduce(f64::max)?;
        let fold = |p: &V3| {
            let share = (p.dot(&along) / length).clamp(0.0, 1.0);
            let most = half_width * (1.0 - (1.0 - NARROWING) * share);
            let from_axis = across(p);
            p - from_axis * (1.0 - most / from_axis.norm().max(most))
        };
        let support = |room_m: f64, place: &dyn Fn(&V3) -> V3| {
            let most = |n: V3| points.iter().map(|p| n.dot(&(wrist + place(p)))).fold(f64::MIN, f64::max) + room_m;
            directions().map(most).collect()
        };
        Some(Self { tip: wrist + tip, supports: [support(0.0, &fold), support(ROOM_M, &|p| *p)], skin })
    }

    /// Approximate signed distance from the solid, folded and open, m, negative inside.
    fn distances(&self, p: &V3) -> [f64; 2] {
        let most = |supports: &Vec<f64>| directions().zip(supports).map(|(n, h)| n.dot(p) - h).fold(f64::MIN, f64::max);
        [most(&self.supports[0]), most(&self.supports[1])]
    }

    fn is_near(&self, p: &V3) -> bool {
        self.distances(p)[1] < NEAR_M
    }

    fn nodes(&self, body: &Body, field: &DistanceField) -> Vec<Node> {
        let reach = V3::repeat(SHELL_M + ROOM_M);
        let points = || self.skin.iter().map(|&v| body.mesh.positions[v]);
        let low = points().fold(V3::repeat(f64::MAX), |low, p| low.inf(&p)) - reach;
        let high = points().fold(V3::repeat(f64::MIN), |high, p| high.sup(&p)) + reach;
        let is_near = |p: &V3| (p - low).min() > -SHELL_M && (high - p).min() > -SHELL_M;
        let near: Vec<usize> = (0..body.mesh.positions.len()).filter(|&v| is_near(&body.mesh.positions[v])).collect();
        let node = |(index, place, value): (usize, V3, f64)| {
            let distances = self.distances(&place);
            (distances[1] < SHELL_M).then(|| {
                let from = |v: &usize| (body.mesh.positions[*v] - place).norm_squared();
                let nearest = near.iter().min_by(|a, b| from(a).total_cmp(&from(b)));
                let is_hands = nearest.is_some_and(|v| self.skin.binary_search(v).is_ok());
                Node { index, distances, value, is_hands }
            })
        };
        field.nodes_within(low, high).filter_map(node).collect()
    }
}

/// Mirrored pairs all around, from the middle of a cube to a grid on its faces.
fn directions() -> impl Iterator<Item = V3> {
    let coordinate = |k: i32| f64::from(k - 2);
    let grid = (0..125).map(move |i| V3::new(coordinate(i / 25), coordinate(i / 5 % 5), coordinate(i % 5)));
    grid.filter(|n| n.amax() == 2.0).map(|n| n.normalize())
}

fn skin_beyond(body: &Body, wrist: V3, along: V3) -> Vec<usize> {
    let positions = &body.mesh.positions;
    let is_beyond = |v: usize| {
        let p = positions[v] - wrist;
        p.dot(&along) > 0.0 && p.norm() < REACH_M
    };
    let triangles: Vec<[usize; 3]> =
        body.mesh.triangles.iter().copied().filter(|t| t.iter().all(|v| is_beyond(*v))).collect();
    let distance = |v: &usize| (positions[*v] - wrist).norm_squared();
    let nearest = triangles.iter().flatten().copied().min_by(|a, b| distance(a).total_cmp(&distance(b)));
    let mut skin: BTreeSet<usize> = nearest.into_iter().collect();
    let mut count = 0;
    while skin.len() > count {
        count = skin.len();
        for t in &triangles {
            if t.iter().any(|v| skin.contains(v)) {
                skin.extend(t);
            }
        }
    }
    skin.into_iter().collect()
}

struct Node {
    index: usize,
    /// Approximate signed distances from the folded and the open hand, m.
    distances: [f64; 2],
    value: f64,
    /// True if the nearest skin is the hand's.
    is_hands: bool,
}

pub struct Hands<'a> {
    field: &'a DistanceField,
    hands: Vec<Hand>,
    nodes: Vec<Node>,
}

impl<'a> Hands<'a> {
    /// `None` where cloth at `x` comes near none.
    pub fn near(body: &Body, field: &'a DistanceField, x: &[V3]) -> Option<Self> {
        let hands = [1.0, -1.0].into_iter().filter_map(|side| Hand::of(body, side));
        let hands: Vec<Hand> = hands.filter(|hand| x.iter().any(|p| hand.is_near(p))).collect();
        let nodes: Vec<Node> = hands.iter().flat_map(|hand| hand.nodes(body, field)).collect();
        (!nodes.is_empty()).then_some(Self { field, hands, nodes })
    }

    pub fn near_triangles(&self, triangles: &[[usize; 3]], x: &[V3]) -> Vec<[usize; 3]> {
        let is_near: Vec<bool> = x.iter().map(|p| self.hands.iter().any(|hand| hand.is_near(p))).collect();
        triangles.iter().copied().filter(|t| t.iter().any(|v| is_near[*v])).collect()
    }

    pub fn folded(&self) -> DistanceField {
        self.field(Shape { open: 0.0, bare: 0.0, is_passing: false })
    }

    /// Shapes that a level meets without friction, with their fields.
    pub fn of_level(&self, level: usize, finest: usize) -> impl Iterator<Item = (Shape, DistanceField)> {
        Shape::of_level(level, finest).into_iter().map(|shape| (shape, self.field(shape)))
    }

    fn field(&self, shape: Shape) -> DistanceField {
        let value = |node: &Node| {
            let [folded, open] = node.distances;
            let solid = folded + (open - folded) * shape.open;
            let hand = solid + (node.value - solid) * shape.bare;
            (node.index, if node.is_hands { hand } else { hand.min(node.value) })
        };
        self.field.with(self.nodes.iter().map(value))
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shape {
    /// 0 for the folded hand, 1 for the open solid.
    open: f64,
    /// 0 for the solid, 1 for the hand itself.
    bare: f64,
    /// True if the cloth takes only a few steps on it before the next.
    pub is_passing: bool,
}

impl Shape {
    /// Hands are folded on the coarsest level, open on the next, and become bare on the finest.
    fn of_level(level: usize, finest: usize) -> Vec<Self> {
        let steps = |count: u32| (1..count).map(move |step| f64::from(step) / f64::from(count));
        if level == 0 && finest > 0 {
            return vec![Self { open: 0.0, bare: 0.0, is_passing: false }];
        }
        let opening = steps(OPENINGS).filter(|_| level <= 1).map(|open| Self { open, bare: 0.0, is_passing: true });
        let open = Self { open: 1.0, bare: 0.0, is_passing: false };
        let baring = steps(BARINGS).filter(|_| level == finest).map(|bare| Self { bare, is_passing: true, ..open });
        opening.chain([open]).chain(baring).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use body::{self, Measurements, Pose, Sex};

    fn stretched_out() -> (Body, DistanceField) {
        let body = body::build(&Measurements::of(Sex::Male, 1.75)).expect("a body");
        let body = body::pose(&body, Pose { arm_deg: Some(90.0), ..Pose::default() }).expect("arms reach so far");
        let field = DistanceField::build(&body.mesh, 0.008).expect("a closed body");
        (body, field)
    }

    #[test]
    fn the_open_solid_holds_the_hand_and_the_folded_one_leaves_its_thumb_out() {
        let (body, field) = stretched_out();
        let wrist = body.skeleton.at(Joint::WristRight);
        let hand = Hand::of(&body, 1.0).expect("it has a right hand");
        let hands = Hands::near(&body, &field, &[wrist]).expect("the wrist is near");
        let greatest = |shape: Shape| {
            let field = hands.field(shape);
            let places = hand.skin.iter().map(|&v| field.value_and_gradient(&body.mesh.positions[v]).0);
            places.fold(f64::MIN, f64::max)
        };
        let shapes = Shape::of_level(0, 0);
        let open = shapes.iter().copied().find(|shape| !shape.is_passing).expect("one is settled on");
        assert!(greatest(open) < 0.0, "skin {} m outside of the open solid", greatest(open));
        let folded = Shape { open: 0.0, ..open };
        assert!(greatest(folded) > 0.01, "skin no more than {} m outside of the folded hand", greatest(folded));
        for pair in shapes.windows(2).filter(|pair| pair[1].bare == 0.0) {
            assert!(greatest(pair[1]) < greatest(pair[0]), "it opens from {:?} to {:?}", pair[0], pair[1]);
        }
        let chest = body.landmarks.front_neck;
        assert_eq!(hands.field(open).value_and_gradient(&chest), field.value_and_gradient(&chest));
        assert!(Hands::near(&body, &field, &[chest]).is_none(), "the neck is far from the hands");
    }
}
