//! Meshes of analytic shapes, as references for tests and benchmarks.

use std::f64::consts::{PI, TAU};

use super::{TriMesh, V3};

/// Sphere about the origin, with `rings` bands from pole to pole and twice as many sectors.
pub fn sphere(radius_m: f64, rings: usize) -> TriMesh {
    let profile: Vec<(f64, f64)> = (0..=rings)
        .map(|i| {
            let polar = PI * i as f64 / rings as f64;
            (radius_m * polar.sin(), -radius_m * polar.cos())
        })
        .collect();
    revolve(&profile, 2 * rings)
}

/// Surface of revolution about z. `profile` has (radius, height) from the bottom pole to the top pole, m. The first and
/// the last radius count as zero.
pub fn revolve(profile: &[(f64, f64)], sectors: usize) -> TriMesh {
    let last = profile.len() - 1;
    let mut mesh = TriMesh { positions: vec![V3::new(0.0, 0.0, profile[0].1)], triangles: Vec::new() };
    for &(radius, z) in &profile[1..last] {
        for s in 0..sectors {
            let angle = TAU * s as f64 / sectors as f64;
            mesh.positions.push(V3::new(radius * angle.cos(), radius * angle.sin(), z));
        }
    }
    mesh.positions.push(V3::new(0.0, 0.0, profile[last].1));
    let top = mesh.positions.len() - 1;
    let ring = |r: usize, s: usize| 1 + r * sectors + s % sectors;
    for s in 0..sectors {
        mesh.triangles.push([0, ring(0, s + 1), ring(0, s)]);
        mesh.triangles.push([top, ring(last - 2, s), ring(last - 2, s + 1)]);
        for r in 0..last - 2 {
            mesh.triangles.push([ring(r, s), ring(r, s + 1), ring(r + 1, s + 1)]);
            mesh.triangles.push([ring(r, s), ring(r + 1, s + 1), ring(r + 1, s)]);
        }
    }
    mesh
}
