//! Base of the neck, where the skin bends from trunk and shoulder into the neck.

use super::landmarks::{Side, median_point, shoulder_top};
use super::sites::Sites;
use super::slices::steps;
use super::tape;
use geom::{TriMesh, V3};

/// Heights between which the front neck point is sought, as shares of stature. Judgement.
const FRONT_NECK: [f64; 2] = [0.775, 0.855];

/// Front neck point: the point farthest behind the chord from the chest to the neck.
pub(crate) fn front_neck(mesh: &TriMesh, sites: &Sites) -> Option<V3> {
    let height_at = |share: f64| sites.floor + share * (sites.crown - sites.floor);
    let upper = tape::above(mesh, height_at(FRONT_NECK[0] - 0.05));
    let heights = steps(height_at(FRONT_NECK[0]), height_at(FRONT_NECK[1]).min(sites.neck.height), 32);
    let line: Vec<V3> = heights.filter_map(|z| median_point(&upper, z, sites.middle, Side::Front)).collect();
    let (first, last) = (line.first()?, line.last()?);
    let slope = (last.y - first.y) / (last.z - first.z);
    let behind = |p: &V3| first.y + slope * (p.z - first.z) - p.y;
    line.iter().max_by(|a, b| behind(a).total_cmp(&behind(b))).copied()
}

/// Side neck point: the point of the line over the shoulder farthest below the chord from the side of the neck to the
/// shoulder point.
pub(crate) fn side_neck(mesh: &TriMesh, sites: &Sites, shoulder: V3) -> Option<V3> {
    let stature = sites.crown - sites.floor;
    let neck = tape::trunk_outline(mesh, sites.neck.height, sites.middle)?;
    let inner = neck.bounds().1.x - sites.middle;
    let upper = tape::above(mesh, shoulder.z - 0.05 * stature);
    let ceiling = sites.neck.height;
    let line: Vec<V3> =
        steps(sites.middle + inner * 0.97, shoulder.x, 40).filter_map(|x| shoulder_top(&upper, x, ceiling)).collect();
    let (first, last) = (line.first()?, line.last()?);
    let slope = (last.z - first.z) / (last.x - first.x);
    let below = |p: &V3| first.z + slope * (p.x - first.x) - p.z;
    line.iter().max_by(|a, b| below(a).total_cmp(&below(b))).copied()
}
