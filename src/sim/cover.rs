//! A garment worn over another, as a surface that the inner one keeps within.

use std::collections::BTreeMap;

use crate::{SimError, sewing};
use geom::mesh::free_edges;
use geom::{Surface, TriMesh, V3, triangle};
use pattern::{Garment, Role};

geom::constants! {
    "cover",
    /// Distance by which the inner cloth keeps below the cover.
    const WITHIN_M: f64 = 1.5e-3;
    /// Greatest distance outside the cover at which cloth is still drawn back. A hem hangs out that far from a garment
    /// into which it is tucked.
    const REACH_M: f64 = 0.25;
    /// Length by which the cover is continued straight beyond its free edges. Cloth that passes under an edge then
    /// passes below the continuation.
    const CONTINUES_M: f64 = 0.03;
    /// Barycentric weight of a corner below which a point counts as on the opposite side of the triangle.
    const ON_SIDE: f64 = 1e-6;
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Limb {
    /// Legs included.
    Trunk,
    ArmRight,
    ArmLeft,
}

impl Limb {
    fn of(role: Role) -> Self {
        match role {
            Role::SleeveRight => Self::ArmRight,
            Role::SleeveLeft => Self::ArmLeft,
            _ => Self::Trunk,
        }
    }
}

struct Sheet {
    surface: Surface,
    mesh: TriMesh,
    normals: Vec<V3>,
    rim: Vec<[usize; 2]>,
}

/// Draped garment as an outer bound for another.
pub struct Cover {
    sheets: BTreeMap<Limb, Sheet>,
    limbs: Vec<Limb>,
}

impl Cover {
    /// Covers a sewn garment. Fails where it has no triangle.
    pub fn new(garment: &Garment, positions: &[V3]) -> Result<Self, SimError> {
        let vertex_of = sewing::welded(garment);
        let x = sewing::merged(&vertex_of, positions);
        let mut triangles: BTreeMap<Limb, Vec<[usize; 3]>> = BTreeMap::new();
        for piece in &garment.pieces {
            let own = garment.triangles[piece.triangles.clone()].iter().map(|t| t.map(|v| vertex_of[v]));
            triangles.entry(Limb::of(piece.role)).or_default().extend(own);
        }
        let sheet = |(limb, triangles): (Limb, Vec<[usize; 3]>)| {
            let mesh = TriMesh { positions: x.clone(), triangles };
            let surface = Surface::new(&mesh).map_err(SimError::Solid)?;
            Ok((limb, Sheet { surface, normals: mesh.vertex_normals(), rim: free_edges(&mesh.triangles), mesh }))
        };
        Ok(Self { sheets: triangles.into_iter().map(sheet).collect::<Result<_, SimError>>()?, limbs: Vec::new() })
    }

    /// Sets the inner garment, whose vertices are merged as `vertex_of` says.
    pub fn over(mut self, garment: &Garment, vertex_of: &[usize]) -> Self {
        self.limbs = vec![Limb::Trunk; vertex_of.iter().max().map_or(0, |most| most + 1)];
        for piece in &garment.pieces {
            for v in piece.vertices.clone() {
                let limb = &mut self.limbs[vertex_of[v]];
                *limb = (*limb).max(Limb::of(piece.role));
            }
        }
        self
    }

    /// Depth by which a vertex at `p` violates the bound, m, and the unit direction back; `None` where it is within, or
    /// beyond the end of the cover.
    pub fn trespass(&self, vertex: usize, p: &V3) -> Option<(f64, V3)> {
        let sheet = self.sheets.get(self.limbs.get(vertex)?)?;
        let (distance_m, nearest) = sheet.surface.nearest_within(p, REACH_M);
        let corners = triangle::sorted(*sheet.mesh.triangles.get(nearest? as usize)?);
        let places = corners.map(|v| sheet.mesh.positions[v]);
        let weights = triangle::nearest(p, &places);
        let normal: V3 = (0..3).map(|k| sheet.normals[corners[k]] * weights[k]).sum();
        let way: V3 = (0..3).map(|k| (p - places[k]) * weights[k]).sum();
        if sheet.is_rim(corners, weights) {
            let normal = normal.try_normalize(0.0)?;
            let (height_m, along_m) = (way.dot(&normal), (way - normal * way.dot(&normal)).norm());
            return (along_m < CONTINUES_M && height_m + WITHIN_M > 0.0).then_some((height_m + WITHIN_M, -normal));
        }
        let is_beyond = way.dot(&normal) > 0.0;
        let outward = (way * if is_beyond { 1.0 } else { -1.0 }).try_normalize(1e-9).or(normal.try_normalize(0.0))?;
        let depth = if is_beyond { WITHIN_M + distance_m } else { WITHIN_M - distance_m };
        (depth > 0.0).then_some((depth, -outward))
    }

    pub fn is_pierced(&self, x: &[V3]) -> bool {
        x.iter().enumerate().any(|(v, p)| self.trespass(v, p).is_some_and(|(depth, _)| depth > WITHIN_M))
    }
}

impl Sheet {
    fn is_rim(&self, corners: [usize; 3], weights: [f64; 3]) -> bool {
        let on: Vec<usize> = (0..3).filter(|&k| weights[k] > ON_SIDE).map(|k| corners[k]).collect();
        match on[..] {
            [vertex] => self.rim.iter().flatten().any(|v| *v == vertex),
            [a, b] => self.rim.binary_search(&[a, b]).is_ok(),
            _ => false,
        }
    }
}
