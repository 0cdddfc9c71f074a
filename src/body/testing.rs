//! Helpers of tests: bodies degraded as by scanners, written in every format, and their silhouettes.

use crate::Girths;
use geom::{TriMesh, V3};
use std::fmt::Write as _;

pub fn in_mm(girths: &Girths, key: &str) -> f64 {
    girths.written(key).unwrap_or_else(|| panic!("{key} is not read"))
}

/// Pseudo-random numbers, uniform between -0.5 and 0.5.
pub struct Noise(pub u64);

impl Noise {
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as f64 / (1_u64 << 31) as f64 - 0.5
    }

    /// Standard normal number (sum of twelve uniform ones).
    pub fn normal(&mut self) -> f64 {
        (0..12).map(|_| self.next()).sum()
    }
}

pub fn roughen(mesh: &mut TriMesh, sigma: f64, noise: &mut Noise) {
    for p in &mut mesh.positions {
        *p += V3::new(noise.normal(), noise.normal(), noise.normal()) * (sigma / 3.0_f64.sqrt());
    }
}

pub fn pierce(mesh: &mut TriMesh, places: &[V3], radius: f64) {
    let near = |i: usize| places.iter().any(|place| (mesh.positions[i] - place).norm() < radius);
    let kept = mesh.triangles.iter().copied().filter(|triangle| !triangle.iter().any(|&i| near(i))).collect();
    mesh.triangles = kept;
}

pub fn placed(mesh: &TriMesh, rule: impl Fn(V3) -> V3) -> TriMesh {
    TriMesh { positions: mesh.positions.iter().map(|p| rule(*p)).collect(), triangles: mesh.triangles.clone() }
}

pub fn ascii_ply(mesh: &TriMesh) -> Vec<u8> {
    let mut text = ply_head(mesh, "ascii");
    for p in &mesh.positions {
        let _ = writeln!(text, "{} {} {}", p.x, p.y, p.z);
    }
    for [a, b, c] in &mesh.triangles {
        let _ = writeln!(text, "3 {a} {b} {c}");
    }
    text.into_bytes()
}

pub fn binary_ply(mesh: &TriMesh) -> Vec<u8> {
    let mut bytes = ply_head(mesh, "binary_little_endian").into_bytes();
    bytes.extend(mesh.positions.iter().flat_map(|p| [p.x, p.y, p.z]).flat_map(|c| (c as f32).to_le_bytes()));
    for triangle in &mesh.triangles {
        bytes.push(3);
        bytes.extend(triangle.iter().flat_map(|&i| (i as i32).to_le_bytes()));
    }
    bytes
}

fn ply_head(mesh: &TriMesh, format: &str) -> String {
    format!(
        "ply\nformat {format} 1.0\ncomment made by a test\nelement vertex {}\nproperty float x\nproperty float y\n\
         property float z\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
        mesh.positions.len(),
        mesh.triangles.len()
    )
}

pub fn ascii_stl(mesh: &TriMesh) -> Vec<u8> {
    let mut text = "solid body\n".to_owned();
    for triangle in &mesh.triangles {
        text.push_str("facet normal 0 0 0\nouter loop\n");
        for &corner in triangle {
            let p = mesh.positions[corner];
            let _ = writeln!(text, "vertex {} {} {}", p.x, p.y, p.z);
        }
        text.push_str("endloop\nendfacet\n");
    }
    text.push_str("endsolid\n");
    text.into_bytes()
}

pub fn binary_stl(mesh: &TriMesh) -> Vec<u8> {
    let mut bytes = vec![0_u8; 80];
    bytes.extend((mesh.triangles.len() as u32).to_le_bytes());
    for triangle in &mesh.triangles {
        bytes.extend([0_u8; 12]);
        for &corner in triangle {
            bytes.extend(mesh.positions[corner].iter().flat_map(|&c| (c as f32).to_le_bytes()));
        }
        bytes.extend([0_u8; 2]);
    }
    bytes
}

/// Camera of a silhouette, 0.9 m above the floor, or orthographic.
#[derive(Clone, Copy, Debug)]
pub enum Taken {
    /// Pixels per metre.
    Orthographic(f64),
    /// Focal length in pixels, distance in metres.
    Perspective(f64, f64),
}

/// Silhouette of a body in the world frame from the front, or from its right.
pub fn silhouette(mesh: &TriMesh, side: bool, taken: Taken, [width, height]: [u32; 2]) -> image::GrayImage {
    let (middle, half) = (f64::from(width) / 2.0, f64::from(height) / 2.0);
    let project = |p: &V3| {
        // Across the picture to the right, and towards the camera.
        let (across, nearer) = if side { (p.y, p.x) } else { (-p.x, p.y) };
        match taken {
            Taken::Orthographic(scale) => [middle + across * scale, f64::from(height) - 40.0 - p.z * scale],
            Taken::Perspective(focal, distance) => {
                let scale = focal / (distance - nearer);
                [middle + across * scale, half - (p.z - 0.9) * scale]
            }
        }
    };
    let points: Vec<[f64; 2]> = mesh.positions.iter().map(project).collect();
    let mut picture = image::GrayImage::new(width, height);
    for triangle in &mesh.triangles {
        fill(&mut picture, triangle.map(|i| points[i]));
    }
    picture
}

fn fill(picture: &mut image::GrayImage, corners: [[f64; 2]; 3]) {
    let turned = |a: [f64; 2], b: [f64; 2], p: [f64; 2]| (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
    let range = |axis: usize, size: u32| {
        let coordinates = corners.map(|corner| corner[axis]);
        let (low, high) = (
            coordinates.iter().copied().fold(f64::MAX, f64::min),
            coordinates.iter().copied().fold(f64::MIN, f64::max),
        );
        (low - 0.5).ceil().max(0.0) as u32..((high - 0.5).floor() + 1.0).clamp(0.0, f64::from(size)) as u32
    };
    for y in range(1, picture.height()) {
        for x in range(0, picture.width()) {
            let p = [f64::from(x) + 0.5, f64::from(y) + 0.5];
            let sides = [0, 1, 2].map(|i| turned(corners[i], corners[(i + 1) % 3], p));
            if sides.iter().all(|s| *s >= 0.0) || sides.iter().all(|s| *s <= 0.0) {
                picture.put_pixel(x, y, image::Luma([255]));
            }
        }
    }
}

pub fn png(picture: &image::GrayImage) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    picture.write_to(&mut bytes, image::ImageFormat::Png).expect("a picture in memory");
    bytes.into_inner()
}

pub fn reference_bodies() -> Option<std::path::PathBuf> {
    let folder = std::path::Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/bodies"));
    folder.is_dir().then(|| folder.to_path_buf())
}
