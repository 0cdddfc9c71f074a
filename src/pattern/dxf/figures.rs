//! Geometry of one entity: lines with flattened curves, points, texts, and the placement of inserted blocks.

use dxf::entities::{Entity, EntityType, Insert};
use dxf::{Point, Vector};

use super::curves::{self, CHORD_ERROR_M, Spline};
use super::mtext;
use geom::V2;

/// Flags of a polyline and of its vertices [DXF reference, POLYLINE, VERTEX].
const CLOSED: i32 = 1;
const MESH: i32 = 16 | 64;
const FRAME_OF_SPLINE: i32 = 16;

/// Affine map from the drawing of a block into the piece, in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// Image of the unit vector.
    x: V2,
    /// Image of the unit vector.
    y: V2,
    origin: V2,
}

impl Placement {
    pub fn scaled(scale: f64) -> Self {
        Self { x: V2::new(scale, 0.0), y: V2::new(0.0, scale), origin: V2::zeros() }
    }

    fn at(&self, point: V2) -> V2 {
        self.origin + self.vector(point)
    }

    fn vector(&self, step: V2) -> V2 {
        self.x * step.x + self.y * step.y
    }

    /// Longer image of the two unit vectors.
    fn scale(&self) -> f64 {
        self.x.norm().max(self.y.norm())
    }

    /// Placement of an entity with this normal. If it points down, the x axis is reversed [DXF reference, OCS]. Fails
    /// where it is tilted.
    fn seen_along(&self, normal: &Vector) -> Result<Self, String> {
        let tilt = normal.x.abs().max(normal.y.abs());
        if tilt > 1e-6 * normal.z.abs() {
            return Err("a drawing in a tilted plane; accepted: one in the plane of the sheet".to_owned());
        }
        Ok(if normal.z < 0.0 { Self { x: -self.x, ..*self } } else { *self })
    }

    /// Placement of an inserted block. `base` is its base point. Fails for an array or a tilted insertion.
    pub fn of_insert(&self, insert: &Insert, base: &Point) -> Result<Self, String> {
        if insert.column_count > 1 || insert.row_count > 1 {
            return Err(format!(
                "an array of {} x {} insertions; accepted: one block inserted at a time",
                insert.column_count, insert.row_count
            ));
        }
        let outer = self.seen_along(&insert.extrusion_direction)?;
        let (sine, cosine) = insert.rotation.to_radians().sin_cos();
        let x = outer.vector(V2::new(cosine, sine) * insert.x_scale_factor);
        let y = outer.vector(V2::new(-sine, cosine) * insert.y_scale_factor);
        let origin = outer.at(V2::new(insert.location.x, insert.location.y)) - x * base.x - y * base.y;
        Ok(Self { x, y, origin })
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Curves {
    pub count: usize,
    pub kind: &'static str,
}

/// Geometry in metres.
#[derive(Clone, Debug, PartialEq)]
pub enum Figure {
    /// Polyline with its curves flattened.
    Line {
        /// The first is not repeated in a closed polyline.
        points: Vec<V2>,
        is_closed: bool,
        curves: Curves,
    },
    /// A drill hole, a cut-out or a round outline.
    Circle {
        centre: V2,
        /// The first is not repeated.
        points: Vec<V2>,
    },
    /// A turn point, a curve point, a notch or a drill hole.
    Point {
        at: V2,
        /// Depth of a notch: the z coordinate.
        depth_m: f64,
        /// Counter-clockwise from +u.
        angle_deg: f64,
    },
    /// TEXT or MTEXT, each line of which may be a `key: value`.
    Text { at: V2, lines: Vec<String> },
    /// Also kinds that [`super::guard`] counts as unsupported.
    Label,
}

/// From the origin of the sheet. A cutting table is some tens of metres long.
const FARTHEST_M: f64 = 1_000.0;

pub fn figure(entity: &Entity, placement: &Placement) -> Result<Figure, String> {
    let figure = figure_anywhere(entity, placement)?;
    let places: &[V2] = match &figure {
        Figure::Line { points, .. } | Figure::Circle { points, .. } => points,
        Figure::Point { at, .. } => std::slice::from_ref(at),
        Figure::Text { .. } | Figure::Label => &[],
    };
    match places.iter().find(|place| place.amax().is_nan() || place.amax() > FARTHEST_M) {
        Some(far) => {
            Err(format!("a point at ({:e}, {:e}) m; accepted: up to {FARTHEST_M} m from the origin", far.x, far.y))
        }
        None => Ok(figure),
    }
}

fn figure_anywhere(entity: &Entity, placement: &Placement) -> Result<Figure, String> {
    let tolerance = CHORD_ERROR_M / placement.scale();
    match &entity.specific {
        EntityType::Circle(drawn) => {
            let placement = placement.seen_along(&drawn.normal)?;
            let points = curves::circle(flat(&drawn.center), drawn.radius, tolerance);
            let points = points.into_iter().map(|p| placement.at(p)).collect();
            Ok(Figure::Circle { centre: placement.at(flat(&drawn.center)), points })
        }
        EntityType::ModelPoint(point) => {
            // The position of a POINT is in world coordinates, whatever its normal.
            let (sine, cosine) = point.angle.to_radians().sin_cos();
            let cut = placement.vector(V2::new(cosine, sine));
            let is_turned = placement.x.y != 0.0 || placement.x.x < 0.0 || placement.y.y < 0.0;
            let angle_deg = if is_turned { cut.y.atan2(cut.x).to_degrees().rem_euclid(360.0) } else { point.angle };
            let depth_m = point.location.z * placement.scale();
            Ok(Figure::Point { at: placement.at(flat(&point.location)), depth_m, angle_deg })
        }
        EntityType::Text(text) => {
            Ok(Figure::Text { at: placement.at(flat(&text.location)), lines: vec![text.value.clone()] })
        }
        EntityType::MText(text) => {
            Ok(Figure::Text { at: placement.at(flat(&text.insertion_point)), lines: mtext::lines_of(text) })
        }
        _ => match chain(entity, tolerance)? {
            None => Ok(Figure::Label),
            Some(Chain { points, is_closed, curves, normal }) => {
                let placement = normal.map_or(Ok(*placement), |normal| placement.seen_along(normal))?;
                let points = points.into_iter().map(|p| placement.at(p)).collect();
                Ok(Figure::Line { points, is_closed, curves })
            }
        },
    }
}

fn flat(point: &Point) -> V2 {
    V2::new(point.x, point.y)
}

/// Polyline in the coordinates of the entity.
struct Chain<'e> {
    points: Vec<V2>,
    is_closed: bool,
    curves: Curves,
    /// Of the plane of the points. `None` for world coordinates.
    normal: Option<&'e Vector>,
}

fn chain(entity: &Entity, tolerance: f64) -> Result<Option<Chain<'_>>, String> {
    let of_world = |points: Vec<V2>, curves| Chain { points, is_closed: false, curves, normal: None };
    Ok(Some(match &entity.specific {
        EntityType::Line(drawn) => of_world(vec![flat(&drawn.p1), flat(&drawn.p2)], Curves { count: 0, kind: "" }),
        EntityType::Polyline(drawn) => {
            if drawn.flags & MESH != 0 {
                return Err("a polygon mesh; accepted: polylines, lines and curves".to_owned());
            }
            let vertices = drawn.vertices().filter(|v| v.flags & FRAME_OF_SPLINE == 0);
            let vertices: Vec<(V2, f64)> = vertices.map(|v| (flat(&v.location), v.bulge)).collect();
            let is_closed = drawn.flags & CLOSED != 0;
            let (points, arcs) = with_bulges(&vertices, is_closed, tolerance);
            Chain { points, is_closed, curves: Curves { count: arcs, kind: "arc" }, normal: Some(&drawn.normal) }
        }
        EntityType::LwPolyline(drawn) => {
            let vertices: Vec<(V2, f64)> = drawn.vertices.iter().map(|v| (V2::new(v.x, v.y), v.bulge)).collect();
            let is_closed = drawn.is_closed();
            let (points, arcs) = with_bulges(&vertices, is_closed, tolerance);
            Chain {
                points,
                is_closed,
                curves: Curves { count: arcs, kind: "arc" },
                normal: Some(&drawn.extrusion_direction),
            }
        }
        EntityType::Arc(drawn) => {
            let degrees = [drawn.start_angle, drawn.end_angle];
            let points = curves::arc(flat(&drawn.center), drawn.radius, degrees, tolerance);
            Chain { normal: Some(&drawn.normal), ..of_world(points, Curves { count: 1, kind: "arc" }) }
        }
        EntityType::Ellipse(drawn) => {
            let major = V2::new(drawn.major_axis.x, drawn.major_axis.y);
            // Axes are in world coordinates. A normal that points down only reverses the parameter.
            let ratio = drawn.minor_axis_ratio * if drawn.normal.z < 0.0 { -1.0 } else { 1.0 };
            if !(1e-4..=1e4).contains(&ratio.abs()) {
                return Err(format!("an ellipse of ratio {}; accepted: 0.0001 to 10000", drawn.minor_axis_ratio));
            }
            let parameters = [drawn.start_parameter, drawn.end_parameter];
            of_world(
                curves::ellipse(flat(&drawn.center), major, ratio, parameters, tolerance),
                Curves { count: 1, kind: "ellipse" },
            )
        }
        EntityType::Spline(drawn) => {
            let control: Vec<V2> = drawn.control_points.iter().map(flat).collect();
            if control.is_empty() {
                return Err("a spline of fit points alone; accepted: one with control points and knots".to_owned());
            }
            let spline = Spline::new(drawn.degree_of_curve, &drawn.knot_values, &control, &drawn.weight_values)?;
            of_world(spline.flattened(tolerance), Curves { count: 1, kind: "spline" })
        }
        _ => return Ok(None),
    }))
}

/// Points, and the number of segments that are arcs.
fn with_bulges(vertices: &[(V2, f64)], is_closed: bool, tolerance: f64) -> (Vec<V2>, usize) {
    let n = vertices.len();
    let sides = if is_closed { n } else { n.saturating_sub(1) };
    let mut points: Vec<V2> = vertices.first().map(|&(first, _)| first).into_iter().collect();
    let mut arcs = 0;
    for k in 0..sides {
        let ((start, value), (end, _)) = (vertices[k], vertices[(k + 1) % n]);
        if value == 0.0 {
            // The segment back to the first vertex is implied by closing.
            if k + 1 < n {
                points.push(end);
            }
            continue;
        }
        arcs += 1;
        points.extend(curves::bulge(start, end, value, tolerance));
    }
    (points, arcs)
}
