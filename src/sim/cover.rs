//! What is worn over a garment, as a surface that the garment keeps within.

use std::collections::BTreeMap;

use crate::{SimError, sewing};
use geom::mesh::free_edges;
use geom::{Surface, TriMesh, V3, triangle};
use pattern::{Garment, Role};

geom::constants! {
    "cover",
    /// Distance within the cover that is kept, m.
    const WITHIN_M: f64 = 1.5e-3;
    /// Farthest beyond the cover that cloth is drawn back into it, m: a hem hangs so far out from what it is tucked into.
    const REACH_M: f64 = 0.25;
    /// How far beyond its edges the cover continues straight, m: what goes under an edge does so from within.
    const CONTINUES_M: f64 = 0.03;
    /// Weight of a corner below which a point lies on the opposite side.
    const ON_SIDE: f64 = 1e-6;
}

/// The limb that cloth is worn on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Limb {
    /// Trunk and legs.
    Trunk,
    /// The right arm.
    ArmRight,
    /// The left arm.
    ArmLeft,
}

impl Limb {
    /// Where pieces of a role are worn.
    fn of(role: Role) -> Self {
        match role {
            Role::SleeveRight => Self::ArmRight,
            Role::SleeveLeft => Self::ArmLeft,
            _ => Self::Trunk,
        }
    }
}

/// Part of the cover about one limb.
struct Sheet {
    surface: Surface,
    mesh: TriMesh,
    normals: Vec<V3>,
    /// Sides of triangles that are free edges, lesser vertex first, sorted.
    rim: Vec<[usize; 2]>,
}

/// A draped garment that another keeps within.
pub struct Cover {
    sheets: BTreeMap<Limb, Sheet>,
    /// Limb of each vertex of the cloth within.
    limbs: Vec<Limb>,
}

impl Cover {
    /// A garment, sewn, with its vertices at `positions`.
    ///
    /// # Errors
    /// When it has no triangle.
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

    /// The cover of a garment that is sewn together as `vertex_of` says.
    #[must_use]
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

    /// By how much a vertex at `p` is beyond where it may be, m, and the unit direction back; `None` where it is
    /// within, or where the cover ends.
    #[must_use]
    pub fn trespass(&self, vertex: usize, p: &V3) -> Option<(f64, V3)> {
        let sheet = self.sheets.get(self.limbs.get(vertex)?)?;
        let (distance_m, nearest) = sheet.surface.nearest_within(p, REACH_M);
        let corners = triangle::sorted(*sheet.mesh.triangles.get(nearest? as usize)?);
        let at = corners.map(|v| sheet.mesh.positions[v]);
        let weights = triangle::nearest(p, &at);
        let normal: V3 = (0..3).map(|k| sheet.normals[corners[k]] * weights[k]).sum();
        let way: V3 = (0..3).map(|k| (p - at[k]) * weights[k]).sum();
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

    /// Whether any vertex of cloth at `x` is beyond the cover by more than it would be kept within.
    #[must_use]
    pub fn is_pierced(&self, x: &[V3]) -> bool {
        x.iter().enumerate().any(|(v, p)| self.trespass(v, p).is_some_and(|(depth, _)| depth > WITHIN_M))
    }
}

impl Sheet {
    /// Whether a point of a triangle lies on a free edge.
    fn is_rim(&self, corners: [usize; 3], weights: [f64; 3]) -> bool {
        let on: Vec<usize> = (0..3).filter(|&k| weights[k] > ON_SIDE).map(|k| corners[k]).collect();
        match on[..] {
            [vertex] => self.rim.iter().flatten().any(|v| *v == vertex),
            [a, b] => self.rim.binary_search(&[a, b]).is_ok(),
            _ => false,
        }
    }
}
