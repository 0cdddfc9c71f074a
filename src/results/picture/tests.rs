//! The check of 20 mm on simulated drapes, measured along its lines in space and again in its picture.

use std::collections::BTreeMap;

use crate::picture::*;
use body::{self, Dimension, Measurements, Sex};
use geom::{DistanceField, V2, V3};
use pattern::Style;
use pattern::draft::Model;
use sim::cloth::element::Element;
use sim::{Silent, fabric, fem, hybrid};

/// Side of a square of the check, m, and in repeats.
const SQUARE_M: f64 = 0.02;
const SQUARE: f64 = 0.5;

/// The drafted T-shirt, meshed at 40 mm, on the largest man of the thesis: in size S by FEM-GS, where it is strained,
/// and in L by Hybrid-GS, which lets a garment that does not reach round the body lie inside it.
fn dressed(simulator: Simulator) -> Dressed {
    let size = if simulator == Simulator::Fem { 0 } else { 2 };
    let measurements = Measurements::of(Sex::Male, 1.85)
        .with(Dimension::ChestGirth, 1.02)
        .with(Dimension::WaistGirth, 0.873)
        .with(Dimension::HipGirth, 1.032);
    let body = body::build(&measurements).unwrap();
    let field = DistanceField::build(&body.mesh, 0.012).unwrap();
    let style = Style::read(&Model::Tshirt.drafts()[size].pieces, Model::Tshirt.seams(), "seams").unwrap();
    let garment = style.mesh(0.04).unwrap();
    let fabric = fabric::library()[0].clone();
    let drape = match simulator {
        Simulator::Fem => {
            let meshes = std::slice::from_ref(&garment);
            fem::simulate(&body, &field, meshes, &fabric, &fem::Params::default(), &mut Silent)
        }
        Simulator::Hybrid => hybrid::simulate(
            &body,
            &field,
            std::slice::from_ref(&garment),
            &fabric,
            &hybrid::Params::default(),
            &mut Silent,
        ),
    };
    let drape = drape.unwrap();
    let cloth = TriMesh { positions: drape.positions, triangles: garment.triangles.clone() };
    let (levels, body) = (BTreeMap::new(), body.mesh);
    Dressed {
        simulator,
        stage: drape.stage,
        garment,
        fabric,
        levels,
        body,
        cloth,
        under: vec![],
        earlier: drape.earlier,
        fields: OnceLock::new(),
    }
}

/// A side of a square: the cloth along a line of the check from one crossing line to the next.
#[derive(Clone, Default)]
struct Side {
    /// Part of the side that was found, in repeats: [`SQUARE`] where no border of a piece cuts it.
    met: f64,
    /// Length on the pattern; on the garment; and on the pattern times the stretch of the cloth, m.
    flat_m: f64,
    worn_m: f64,
    stretched_m: f64,
    ends: [V3; 2],
    normals: Vec<V3>,
}

/// Piece, line on it, and square along the line.
type Key = (usize, i64, i64);

/// Sides along weft (`along` 0) or warp (1). The other coordinate of their lines is a whole number of squares plus
/// `off`.
fn sides(worn: &Dressed, along: usize, off: f64) -> BTreeMap<Key, Side> {
    let print = cloth::print(&[Cloth::CHECK], &worn.garment, &worn.fabric, worn.material().front).unwrap();
    let mut sides: BTreeMap<Key, Side> = BTreeMap::new();
    for (number, piece) in worn.garment.pieces.iter().enumerate() {
        for triangle in &worn.garment.triangles[piece.triangles.clone()] {
            let Some(element) = Element::new(*triangle, triangle.map(|v| worn.garment.rest[v]), piece.grain) else {
                continue;
            };
            let across = triangle.map(|v| print.places[v][1 - along] / SQUARE - off);
            let (low, high) =
                (across.iter().copied().fold(f64::MAX, f64::min), across.iter().fold(f64::MIN, |a, b| a.max(*b)));
            for line in low.ceil() as i64..=high.floor() as i64 {
                cut(worn, &print.places, *triangle, &element, (along, line as f64 + off), |square, part| {
                    add(sides.entry((number, line, square)).or_default(), part);
                });
            }
        }
    }
    sides.retain(|_, side| (side.met - SQUARE).abs() < 1e-9);
    sides
}

fn add(side: &mut Side, part: Side) {
    if side.met == 0.0 {
        *side = part;
        return;
    }
    // Parts come in any order, so the ends are the two points that are farthest apart.
    let points = [side.ends[0], side.ends[1], part.ends[0], part.ends[1]];
    let pairs = (0..4).flat_map(|i| (i + 1..4).map(move |j| (i, j)));
    let farthest = pairs.max_by(|a, b| {
        let apart = |(i, j): &(usize, usize)| (points[*i] - points[*j]).norm();
        apart(a).total_cmp(&apart(b))
    });
    let (first, last) = farthest.unwrap();
    side.ends = [points[first], points[last]];
    side.met += part.met;
    side.flat_m += part.flat_m;
    side.worn_m += part.worn_m;
    side.stretched_m += part.stretched_m;
    side.normals.extend(part.normals);
}

/// Calls `found` with each part of a check line that lies in a triangle, square by square.
fn cut(
    worn: &Dressed,
    places: &[V2],
    triangle: [usize; 3],
    element: &Element,
    (along, line): (usize, f64),
    mut found: impl FnMut(i64, Side),
) {
    let at = |v: usize| V2::new(places[v][along], places[v][1 - along]) / SQUARE;
    // Crossings of the line and the triangle's border: position along the line, and weights of the corners.
    let mut passes: Vec<(f64, [f64; 3])> = Vec::new();
    for k in 0..3 {
        let (a, b) = (at(triangle[k]), at(triangle[(k + 1) % 3]));
        if (a.y < line) != (b.y < line) {
            let t = (line - a.y) / (b.y - a.y);
            let mut weights = [0.0; 3];
            (weights[k], weights[(k + 1) % 3]) = (1.0 - t, t);
            passes.push((a.x + t * (b.x - a.x), weights));
        }
    }
    passes.sort_by(|a, b| a.0.total_cmp(&b.0));
    let [(from, first), (to, last)] = passes.as_slice() else { return };
    let f = element.deformation_gradient(&worn.cloth.positions);
    let stretch = f.column(along).norm();
    let normal = f.column(0).cross(&f.column(1)).normalize();
    let weights = |s: f64| [0, 1, 2].map(|k| first[k] + (last[k] - first[k]) * (s - from) / (to - from));
    let flat = |s: f64| (0..3).map(|k| worn.garment.rest[triangle[k]] * weights(s)[k]).sum::<V2>();
    let space = |s: f64| (0..3).map(|k| worn.cloth.positions[triangle[k]] * weights(s)[k]).sum::<V3>();
    for square in from.floor() as i64..to.ceil() as i64 {
        let (low, high) = (from.max(square as f64), to.min(square as f64 + 1.0));
        if high > low {
            let flat_m = (flat(high) - flat(low)).norm();
            let ends = [space(low), space(high)];
            let (met, worn_m) = ((high - low) * SQUARE, (ends[1] - ends[0]).norm());
            found(square, Side { met, flat_m, worn_m, stretched_m: flat_m * stretch, ends, normals: vec![normal] });
        }
    }
}

/// Offset from a point, pixels, of the fastest change of brightness along a line of a picture; `None` where brightness
/// does not change.
fn turn(picture: &RgbaImage, place: V2, direction: V2) -> Option<f64> {
    const REACH: i32 = 5;
    const FINE: f64 = 0.25;
    let bright = |t: f64| {
        let (x, y) = (place.x + t * direction.x - 0.5, place.y + t * direction.y - 0.5);
        let pixel = |x: f64, y: f64| {
            let p = picture.get_pixel_checked(x as u32, y as u32)?.0;
            Some(f64::from(p[0]) + f64::from(p[1]) + f64::from(p[2]))
        };
        let (fx, fy) = (x - x.floor(), y - y.floor());
        let row = |y: f64| Some(pixel(x.floor(), y)? * (1.0 - fx) + pixel(x.floor() + 1.0, y)? * fx);
        Some(row(y.floor())? * (1.0 - fy) + row(y.floor() + 1.0)? * fy)
    };
    let plateau = |sign: f64| Some((bright(sign * 4.0)? + bright(sign * 5.0)? + bright(sign * 6.0)?) / 3.0);
    let (before, after) = (plateau(-1.0)?, plateau(1.0)?);
    let middle = (before + after) / 2.0;
    if (after - before).abs() < 40.0 {
        return None;
    }
    let steps = (f64::from(REACH) / FINE) as i32;
    (-steps..steps).find_map(|k| {
        let (t, next) = (f64::from(k) * FINE, f64::from(k + 1) * FINE);
        let (a, b) = (bright(t)?, bright(next)?);
        ((a < middle) != (b < middle)).then(|| t + FINE * (middle - a) / (b - a))
    })
}

/// Errors of squares on the part of the front that faces the viewer: side in the picture minus true side, mm.
fn errors_in_the_picture(worn: &Dressed, along: usize) -> Vec<f64> {
    const PIXELS_PER_M: f64 = 1500.0;
    let front = worn.garment.pieces.iter().position(|piece| piece.role == Role::Front).unwrap();
    let chest = worn.cloth.positions[worn.garment.pieces[front].vertices.clone()].iter().sum::<V3>()
        / worn.garment.pieces[front].vertices.len() as f64;
    let (width, height) = (450, 600);
    let camera = Camera::new(View::Front, Frame { centre: chest, height_m: f64::from(height) / PIXELS_PER_M });
    let picture = render::render(&worn.scene(Map::Check).unwrap(), &camera, width, height).unwrap();
    let [right, up, viewer] = camera.axes();
    let place = |p: V3| {
        let d = (p - chest) * PIXELS_PER_M;
        V2::new(f64::from(width) / 2.0 + d.dot(&right), f64::from(height) / 2.0 - d.dot(&up))
    };
    // The line runs through the middle of a row of squares, where only squares along the line change.
    let mut errors = Vec::new();
    for ((piece, ..), side) in sides(worn, along, 0.5) {
        let [a, b] = side.ends.map(place);
        let is_inside = |p: V2| p.x > 8.0 && p.y > 8.0 && p.x < f64::from(width) - 8.0 && p.y < f64::from(height) - 8.0;
        let faces = side.normals.iter().all(|normal| normal.dot(&viewer).abs() > 0.92);
        if piece != front || !faces || !is_inside(a) || !is_inside(b) {
            continue;
        }
        let direction = (b - a).normalize();
        if let (Some(first), Some(last)) = (turn(&picture, a, direction), turn(&picture, b, direction)) {
            let shown_m = side.worn_m * (1.0 + (last - first) / (b - a).norm());
            errors.push(1e3 * (shown_m - side.stretched_m));
        }
    }
    errors
}

#[test]
fn a_check_of_20_mm_on_a_drape_measures_20_mm_times_the_stretch_of_the_cloth() {
    for simulator in Simulator::ALL {
        let worn = dressed(simulator);
        for (along, name) in [(0, "weft"), (1, "warp")] {
            let sides = sides(&worn, along, 0.0);
            assert!(sides.len() > 500, "{simulator:?} {name}: {} sides", sides.len());
            for (key, side) in &sides {
                assert!((side.flat_m - SQUARE_M).abs() < 1e-9, "{key:?}: {} m on the pattern", side.flat_m);
                assert!((side.worn_m - side.stretched_m).abs() < 1e-9, "{key:?}: {} {}", side.worn_m, side.stretched_m);
            }
            let errors = errors_in_the_picture(&worn, along);
            let mean = errors.iter().sum::<f64>() / errors.len() as f64;
            let rms = (errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64).sqrt();
            assert!(errors.len() > 80, "{simulator:?} {name}: {} in the picture", errors.len());
            assert!(mean.abs() < 0.1 && rms < 0.5, "{simulator:?} {name}: {mean} {rms} mm");
        }
    }
}
