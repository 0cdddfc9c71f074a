//! Flat layout of the pieces about the head, the arrangement of [T 3.3.3] before pieces are placed about the body.
//!
//! The origin is the head, seen from above. `x` grows to the wearer's right, fronts lie at `y > 0`, backs at `y < 0`.
//! The upper edge of each piece faces the origin, as if the garment were opened along its sides and laid flat. Sleeves
//! lie beside, caps towards the body. A piece is turned and shifted, never mirrored: its outline says which side is up,
//! and its grain line sets it straight.

use super::garment::Role;
use super::propose::{self, Face, Hand, Pose};
use super::style::{Style, StylePiece};
use geom::V2;

/// Clearance between pieces, and round the head.
const GAP_M: f64 = 0.06;
/// Greatest angle by which a piece is turned to set its grain line straight. Further off, it is cut on the bias.
const STRAIGHTEN_DEG: f64 = 30.0;

#[derive(Clone, Debug, PartialEq)]
pub struct Placed {
    /// Counter-clockwise, radians.
    pub turn: f64,
    /// Translation after the rotation, m.
    pub shift: V2,
}

impl Placed {
    /// Maps a point of the piece's plane into the layout, m.
    pub fn at(&self, point: V2) -> V2 {
        turned(point, self.turn) + self.shift
    }
}

fn turned(p: V2, angle: f64) -> V2 {
    let (sin, cos) = angle.sin_cos();
    V2::new(cos * p.x - sin * p.y, sin * p.x + cos * p.y)
}

struct Piece {
    /// Row from the head down: 0 trunk, 1 waistband, 2 skirt or leg. `None` for a whole sleeve or an unknown role.
    level: Option<usize>,
    face: Option<Face>,
    hand: Option<Hand>,
    is_sleeve: bool,
    turn: f64,
    low: V2,
    high: V2,
}

impl Piece {
    fn of(piece: &StylePiece) -> Self {
        let pose = propose::pose(piece);
        let (face, hand) = face_and_hand(piece, pose.as_ref());
        let is_sleeve = matches!(piece.role, Role::SleeveRight | Role::SleeveLeft);
        let is_whole_sleeve = is_sleeve && pose.as_ref().is_none_or(|pose| pose.is_whole);
        let quarter = std::f64::consts::FRAC_PI_2;
        let worn = match (is_whole_sleeve, hand, face) {
            // The cap faces the body, and the front half of the sleeve lies at y > 0.
            (true, Some(Hand::Right), _) => quarter,
            (true, ..) => -quarter,
            (_, _, Some(Face::Front)) => 2.0 * quarter,
            _ => 0.0,
        };
        let upright = quarter * pose.as_ref().map_or(0, |pose| pose.quarter_turns) as f64;
        let turn = upright + straightening(turned(piece.grain, upright)) + worn;
        let points: Vec<V2> = piece.outline().iter().map(|&p| turned(p, turn)).collect();
        let level = match piece.role {
            Role::Other => None,
            _ if is_whole_sleeve || face.is_none() => None,
            Role::Waistband => Some(1),
            Role::SkirtFront | Role::SkirtBack => Some(2),
            Role::LegFrontRight | Role::LegFrontLeft | Role::LegBackRight | Role::LegBackLeft => Some(2),
            _ => Some(0),
        };
        Self {
            level,
            face,
            hand,
            is_sleeve,
            turn,
            low: points.iter().fold(V2::repeat(f64::MAX), |low, p| low.inf(p)),
            high: points.iter().fold(V2::repeat(f64::MIN), |high, p| high.sup(p)),
        }
    }

    fn size(&self) -> V2 {
        self.high - self.low
    }
}

/// From the role, or else from the identifier and the outline.
fn face_and_hand(piece: &StylePiece, pose: Option<&Pose>) -> (Option<Face>, Option<Hand>) {
    let (named_face, named_hand) = propose::named_face_and_hand(&piece.id);
    let face = match piece.role {
        Role::Front | Role::BodiceFront | Role::SkirtFront | Role::LegFrontRight | Role::LegFrontLeft => {
            Some(Face::Front)
        }
        Role::Back | Role::BodiceBack | Role::SkirtBack | Role::LegBackRight | Role::LegBackLeft => Some(Face::Back),
        _ => named_face,
    };
    let hand = match piece.role {
        Role::SleeveRight | Role::LegFrontRight | Role::LegBackRight | Role::LegRight => Some(Hand::Right),
        Role::SleeveLeft | Role::LegFrontLeft | Role::LegBackLeft | Role::LegLeft => Some(Hand::Left),
        _ => named_hand.or_else(|| pose.and_then(|pose| pose.hand(face?))),
    };
    (face, hand)
}

/// Smallest rotation that sets a grain line along an axis, radians; 0 for a grain on the bias.
fn straightening(grain: V2) -> f64 {
    let off = grain.y.atan2(grain.x).to_degrees().rem_euclid(90.0);
    let turn = if off > 45.0 { 90.0 - off } else { -off };
    if turn.abs() <= STRAIGHTEN_DEG { turn.to_radians() } else { 0.0 }
}

pub fn arrange(style: &Style) -> Vec<Placed> {
    let pieces: Vec<Piece> = style.pieces.iter().map(Piece::of).collect();
    let mut placed: Vec<Placed> = pieces.iter().map(|piece| Placed { turn: piece.turn, shift: V2::zeros() }).collect();
    let mut reach = GAP_M;
    // Half the width of the rows so far, m.
    let mut half_width = 0.0_f64;
    for level in 0..=2 {
        let of_level: Vec<usize> = (0..pieces.len()).filter(|&i| pieces[i].level == Some(level)).collect();
        for face in Face::BOTH {
            let row: Vec<usize> = of_level.iter().copied().filter(|&i| pieces[i].face == Some(face)).collect();
            // Next free |x| on the wearer's right and left. Pieces across the middle are placed first, sleeves last.
            let mut next = [0.5 * GAP_M; 2];
            let mut order = row.clone();
            order.sort_by_key(|&i| (pieces[i].hand.is_some(), pieces[i].is_sleeve));
            for i in order {
                let piece = &pieces[i];
                let x = match piece.hand {
                    Some(hand) => {
                        let free = &mut next[usize::from(hand == Hand::Left)];
                        let from = *free;
                        *free += piece.size().x + GAP_M;
                        if hand == Hand::Right { from - piece.low.x } else { -from - piece.high.x }
                    }
                    None => {
                        let half = 0.5 * piece.size().x;
                        // A second piece across the middle goes beside the first.
                        let is_first = next[0] <= GAP_M;
                        let middle = if is_first { 0.0 } else { next[0] + half };
                        next = next.map(|free| free.max(middle + half + GAP_M));
                        middle - 0.5 * (piece.low.x + piece.high.x)
                    }
                };
                let y = if face == Face::Front { reach - piece.low.y } else { -reach - piece.high.y };
                placed[i].shift = V2::new(x, y);
            }
            half_width = next.iter().fold(half_width, |most, &free| most.max(free));
        }
        let tallest = of_level.iter().map(|&i| pieces[i].size().y).fold(0.0, f64::max);
        reach += if of_level.is_empty() { 0.0 } else { tallest + GAP_M };
    }
    beside(&pieces, half_width, &mut placed);
    placed
}

pub fn arranged(style: &Style) -> Style {
    let mut moved = style.clone();
    for (piece, placed) in moved.pieces.iter_mut().zip(arrange(style)) {
        piece.turn(placed.turn);
        piece.shift(placed.shift);
    }
    moved
}

/// Returns the style as [`arranged`] does, but with all fronts head up beside the rest, as a specification sheet shows
/// them.
pub fn hung(style: &Style) -> Style {
    let mut moved = arranged(style);
    let is_front = |piece: &StylePiece| {
        let Piece { level, face, .. } = Piece::of(piece);
        level.is_some() && face == Some(Face::Front)
    };
    let fronts: Vec<bool> = style.pieces.iter().map(is_front).collect();
    for (piece, _) in moved.pieces.iter_mut().zip(&fronts).filter(|(_, is_front)| **is_front) {
        piece.turn(std::f64::consts::PI);
    }
    let x_of = |is_front: bool| {
        let of_kind = moved.pieces.iter().zip(&fronts).filter(move |(_, front)| **front == is_front);
        of_kind.flat_map(|(piece, _)| piece.outline()).map(|p| p.x)
    };
    let (end, start) = (x_of(false).reduce(f64::max), x_of(true).reduce(f64::min));
    let aside = end.zip(start).map_or(0.0, |(end, start)| end + GAP_M - start);
    for (piece, _) in moved.pieces.iter_mut().zip(&fronts).filter(|(_, is_front)| **is_front) {
        piece.shift(V2::new(aside, 0.0));
    }
    moved
}

/// Places whole sleeves on both sides of the trunk. Pieces without a known place go further out, to the wearer's right.
fn beside(pieces: &[Piece], half_width: f64, placed: &mut [Placed]) {
    let mut next = [half_width.max(GAP_M); 2];
    let of_kind = |is_sleeve: bool| {
        (0..pieces.len()).filter(move |&i| pieces[i].level.is_none() && pieces[i].is_sleeve == is_sleeve)
    };
    for i in of_kind(true).chain(of_kind(false)) {
        let piece = &pieces[i];
        let is_left = piece.is_sleeve && piece.hand == Some(Hand::Left);
        let free = &mut next[usize::from(is_left)];
        let x = if is_left { -*free - piece.high.x } else { *free - piece.low.x };
        *free += piece.size().x + GAP_M;
        placed[i].shift = V2::new(x, -0.5 * (piece.low.y + piece.high.y));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::draft::Model;

    fn boxes(style: &Style) -> Vec<(String, V2, V2)> {
        let placed = arrange(style);
        let box_of = |(piece, placed): (&StylePiece, &Placed)| {
            let points: Vec<V2> = piece.outline().iter().map(|&p| placed.at(p)).collect();
            let low = points.iter().fold(V2::repeat(f64::MAX), |low, p| low.inf(p));
            let high = points.iter().fold(V2::repeat(f64::MIN), |high, p| high.sup(p));
            (piece.id.clone(), low, high)
        };
        style.pieces.iter().zip(&placed).map(box_of).collect()
    }

    fn style(model: Model, turn: f64) -> Style {
        let mut draft = model.drafts().swap_remove(0);
        for piece in &mut draft.pieces {
            let turn = |p: &mut V2| *p = turned(*p, turn);
            piece.outline.iter_mut().chain(&mut piece.turn_points).for_each(turn);
            piece.notches.iter_mut().for_each(|notch| turn(&mut notch.at));
            piece.grain.iter_mut().flatten().for_each(turn);
        }
        Style::read(&draft.pieces, model.seams(), "a.toml").expect("it is a style")
    }

    #[test]
    fn fronts_backs_and_sides_lie_where_they_belong_however_drawn() {
        for model in Model::ALL {
            // Upright, lying on their side, upside down, and a little askew.
            for degrees in [0.0_f64, 90.0, 180.0, 7.0] {
                let all = boxes(&style(model, degrees.to_radians()));
                for (id, low, high) in &all {
                    let what = format!("{model:?} {degrees} {id}: {low:?} {high:?}");
                    match id {
                        id if id.starts_with("sleeve") => assert!(low.y < 0.0 && high.y > 0.0, "{what}"),
                        id if id.contains("front") => assert!(low.y > 0.0, "{what}"),
                        id => assert!(id.contains("back") && high.y < 0.0, "{what}"),
                    }
                    match id {
                        id if id.ends_with("right") => assert!(low.x > 0.0, "{what}"),
                        id if id.ends_with("left") => assert!(high.x < 0.0, "{what}"),
                        _ => assert!((low.x + high.x).abs() < 1e-6, "{what}"),
                    }
                }
                let is_apart = |a: &(String, V2, V2), b: &(String, V2, V2)| {
                    (0..2).any(|k| a.1[k] > b.2[k] - 1e-9 || b.1[k] > a.2[k] - 1e-9)
                };
                for (k, a) in all.iter().enumerate() {
                    assert!(all[k + 1..].iter().all(|b| is_apart(a, b)), "{model:?} {degrees}: {} overlaps", a.0);
                }
            }
        }
    }

    #[test]
    fn all_heads_are_up_on_a_specification_sheet() {
        for model in Model::ALL {
            let hung = hung(&style(model, 0.0));
            let mut boxes: Vec<(V2, V2)> = Vec::new();
            for piece in &hung.pieces {
                let points = piece.outline();
                let low = points.iter().fold(V2::repeat(f64::MAX), |low, p| low.inf(p));
                let high = points.iter().fold(V2::repeat(f64::MIN), |high, p| high.sup(p));
                let is_apart = |(l, h): &(V2, V2)| (0..2).any(|k| l[k] > high[k] - 1e-9 || low[k] > h[k] - 1e-9);
                assert!(boxes.iter().all(is_apart), "{model:?} {}", piece.id);
                boxes.push((low, high));
                let hem = piece.edges.iter().find(|edge| edge.name.as_deref().is_some_and(|name| name == "hem"));
                if let Some(hem) = hem {
                    assert!(hem.line.at(0.5 * hem.line.length()).y < low.y + 0.1 * (high.y - low.y), "{}", piece.id);
                }
            }
        }
    }

    #[test]
    fn necks_face_the_head_and_hems_lie_outside() {
        for degrees in [0.0_f64, 90.0, 180.0] {
            let style = style(Model::Tshirt, degrees.to_radians());
            let placed = arrange(&style);
            for (piece, placed) in style.pieces.iter().zip(&placed) {
                let middle = |name: &str| {
                    let edge = piece.edges.iter().find(|edge| edge.name.as_deref() == Some(name));
                    edge.map(|edge| placed.at(edge.line.at(0.5 * edge.line.length())))
                };
                match (middle("hem"), middle("neck").or(middle("neck_left")), middle("cap"), middle("underarm_front")) {
                    (Some(hem), Some(neck), ..) => assert!(hem.y.abs() > 2.0 * neck.y.abs(), "{}", piece.id),
                    (_, _, Some(cap), Some(front)) => {
                        let opening = middle("opening").expect("a sleeve has one");
                        assert!(cap.x.abs() < opening.x.abs() && front.y > 0.0, "{} {degrees}", piece.id);
                    }
                    _ => panic!("{}", piece.id),
                }
            }
        }
    }
}
