//! From scene and camera to pixels: visibility, three soft lights with a shadow map, occlusion, relief, floor.

use super::RenderError;
use super::camera::{Camera, Projection};
use super::colour::{Encoder, Rgb};
use super::raster::{NOTHING, Visible, cover, weights};
use super::relief::relief;
use super::scene::{Paint, Scene, Values};
use image::RgbaImage;
use nalgebra::Vector3;

/// Samples along a side of each pixel.
const FINE: usize = 3;
/// Samples along a side of the key light's shadow map.
const SHADOW: usize = 1280;
/// How many places around a point the shadow map is asked at.
const TAPS: usize = 32;
/// The outermost of them, which are asked first.
const RIM: usize = 8;
/// How far around, in map samples: the width of a shadow's soft edge.
const SOFT: f32 = 9.0;

/// Offsets of the taps, in map samples, and their distances: a disc filled evenly by a golden-angle spiral [Vogel 1979].
fn taps() -> [(f32, f32, f32); TAPS] {
    let golden = std::f32::consts::PI * (3.0 - 5.0_f32.sqrt());
    std::array::from_fn(|k| {
        let radius = SOFT * ((k as f32 + 0.5) / TAPS as f32).sqrt();
        let (sin, cos) = (golden * k as f32).sin_cos();
        (radius * cos, radius * sin, radius)
    })
}

/// Takes a picture of the scene.
///
/// # Errors
/// [`RenderError::Size`] where a side has no pixels or more than 8192.
pub fn render(scene: &Scene, camera: &Camera, width: u32, height: u32) -> Result<RgbaImage, RenderError> {
    shoot(scene, camera, (width, height), 255)
}

/// [`render`], transparent where nothing stands: the colours there are those of backdrop and floor still.
///
/// # Errors
/// As there.
pub fn cutout(scene: &Scene, camera: &Camera, width: u32, height: u32) -> Result<RgbaImage, RenderError> {
    shoot(scene, camera, (width, height), 0)
}

/// A picture whose backdrop and floor are as opaque as asked.
fn shoot(scene: &Scene, camera: &Camera, (width, height): (u32, u32), backdrop: u8) -> Result<RgbaImage, RenderError> {
    if !(1..=8192).contains(&width) || !(1..=8192).contains(&height) {
        return Err(RenderError::Size { width, height });
    }
    let (columns, rows) = (width as usize, height as usize);
    let studio = Studio::new(scene, camera, columns, rows);
    let depths = studio.pixel_depths(columns, rows);
    let gain = relief(&depths, columns, studio.projection.per_m / FINE as f32);
    let encoder = Encoder::new();
    let mut picture = RgbaImage::new(width, height);
    for (pixel, (out, gain)) in picture.pixels_mut().zip(gain).enumerate() {
        let (x, y) = (pixel % columns, pixel / columns);
        let middle = |k: usize| ((k * FINE) as f32) + 0.5 * FINE as f32;
        let (light, alpha) = if depths[pixel].is_finite() {
            (studio.pixel(x, y, gain), 255)
        } else {
            (studio.ground(middle(x), middle(y)), backdrop)
        };
        let [r, g, b] = encoder.encode(light);
        out.0 = [r, g, b, alpha];
    }
    Ok(picture)
}

/// Depth along the key light.
struct ShadowMap {
    projection: Projection,
    depth: Vec<f32>,
    taps: [(f32, f32, f32); TAPS],
}

impl ShadowMap {
    fn new(scene: &Scene, towards: Vector3<f32>) -> Self {
        let projection = Projection::of_light(towards, scene.centre, scene.radius * 1.02, SHADOW);
        let projected: Vec<[f32; 3]> = scene.positions.iter().map(|p| projection.project(p)).collect();
        let mut depth = vec![f32::INFINITY; SHADOW * SHADOW];
        for (index, triangle) in scene.triangles.iter().enumerate() {
            let recede = scene.recede(index);
            cover(triangle.map(|v| projected[v]), SHADOW, SHADOW, |sample, d| {
                depth[sample] = depth[sample].min(d + recede);
            });
        }
        Self { projection, depth, taps: taps() }
    }

    /// Share of the light that reaches a point, 0 to 1.
    fn reaches(&self, point: &Vector3<f32>) -> f32 {
        let [x, y, depth] = self.projection.project(point);
        let is_open = |&(dx, dy, distance): &(f32, f32, f32)| {
            let (x, y) = (x + dx, y + dy);
            let inside = x >= 0.0 && y >= 0.0 && x < SHADOW as f32 && y < SHADOW as f32;
            // A tilted surface would shadow itself: forgive what the tap's distance can explain.
            let bias = (1.5 + 0.8 * distance) / self.projection.per_m;
            !inside || depth - bias <= self.depth[y as usize * SHADOW + x as usize]
        };
        let (within, rim) = self.taps.split_at(TAPS - RIM);
        let open = rim.iter().filter(|tap| is_open(tap)).count();
        // Where centre and rim agree there is no edge of a shadow between them.
        match (open, is_open(&self.taps[0])) {
            (RIM, true) => 1.0,
            (0, false) => 0.0,
            _ => (open + within.iter().filter(|tap| is_open(tap)).count()) as f32 / TAPS as f32,
        }
    }
}

/// Everything needed to colour a pixel.
struct Studio<'a> {
    scene: &'a Scene,
    projection: Projection,
    /// Vertices in the picture.
    projected: Vec<[f32; 3]>,
    visible: Visible,
    /// Samples that a seam line passes.
    stitched: Vec<bool>,
    shadow: ShadowMap,
    /// Directions to the key, fill and rim light.
    lights: [Vector3<f32>; 3],
    /// Linear front and back colour of each layer.
    colours: Vec<[[f32; 3]; 2]>,
    backdrop: [[f32; 3]; 2],
}

impl<'a> Studio<'a> {
    fn new(scene: &'a Scene, camera: &Camera, columns: usize, rows: usize) -> Self {
        let (width, height) = (columns * FINE, rows * FINE);
        let projection = Projection::new(camera, width, height);
        let projected: Vec<[f32; 3]> = scene.positions.iter().map(|p| projection.project(p)).collect();
        let mut visible = Visible::new(width, height);
        for (index, triangle) in scene.triangles.iter().enumerate() {
            let recede = scene.recede(index);
            visible.draw(index, triangle.map(|v| projected[v]).map(|[x, y, d]| [x, y, d + recede]));
        }
        let stitched = stitches(scene, &projected, &visible);
        let [right, up, viewer] = projection.axes;
        let light = |r: f32, u: f32, v: f32| (right * r + up * u + viewer * v).normalize();
        let lights = [light(-0.72, 0.62, 0.62), light(0.85, 0.05, 0.6), light(0.75, 0.45, -0.65)];
        Self {
            scene,
            projection,
            projected,
            visible,
            stitched,
            shadow: ShadowMap::new(scene, lights[0]),
            lights,
            colours: scene.looks.iter().map(|l| [l.material.front.linear(), l.material.back.linear()]).collect(),
            backdrop: [Rgb(0xfa, 0xfa, 0xf9).linear(), Rgb(0xe9, 0xea, 0xec).linear()],
        }
    }

    /// Depth of the nearest sample of each pixel, infinite where it shows nothing.
    fn pixel_depths(&self, columns: usize, rows: usize) -> Vec<f32> {
        let nearest = |pixel| {
            let samples = self.samples(pixel % columns, pixel / columns);
            samples.map(|sample| self.visible.depth[sample]).into_iter().fold(f32::INFINITY, f32::min)
        };
        (0..columns * rows).map(nearest).collect()
    }

    fn samples(&self, x: usize, y: usize) -> [usize; FINE * FINE] {
        let corner = y * FINE * self.visible.width + x * FINE;
        std::array::from_fn(|k| corner + k / FINE * self.visible.width + k % FINE)
    }

    /// Linear colour of a pixel: each triangle it shows is shaded once, at the middle of the samples it covers.
    fn pixel(&self, x: usize, y: usize, gain: f32) -> [f32; 3] {
        let samples = self.samples(x, y);
        let (left, top) = ((x * FINE) as f32 + 0.5, (y * FINE) as f32 + 0.5);
        let mut colour = [0.0; 3];
        let mut done = [false; FINE * FINE];
        for first in 0..samples.len() {
            if done[first] {
                continue;
            }
            let triangle = self.visible.triangle[samples[first]];
            let (mut sx, mut sy, mut share, mut stitched) = (0.0, 0.0, 0.0, 0.0);
            for (k, &sample) in samples.iter().enumerate().skip(first) {
                if self.visible.triangle[sample] == triangle {
                    done[k] = true;
                    sx += left + (k % FINE) as f32;
                    sy += top + (k / FINE) as f32;
                    share += 1.0;
                    stitched += f32::from(u8::from(self.stitched[sample]));
                }
            }
            let light = if triangle == NOTHING {
                self.ground(sx / share, sy / share)
            } else {
                let gain = gain * (1.0 - 0.38 * stitched / share);
                self.surface(triangle as usize, sx / share, sy / share).map(|v| v * gain)
            };
            for k in 0..3 {
                colour[k] += light[k] * share / samples.len() as f32;
            }
        }
        colour
    }

    /// Backdrop and floor: one seamless light sheet, darker where the subject stands.
    fn ground(&self, x: f32, y: f32) -> [f32; 3] {
        let rows = (self.visible.depth.len() / self.visible.width) as f32;
        let t = y / rows;
        let viewer = self.projection.axes[2];
        let mut light = 1.0;
        if viewer.z > 0.01 {
            let start = self.projection.unproject(x, y, 0.0);
            let point = start - viewer * ((start.z - self.scene.floor.z) / viewer.z);
            light = self.scene.floor.openness(point.x, point.y);
        }
        [0, 1, 2].map(|k| (self.backdrop[0][k] * (1.0 - t) + self.backdrop[1][k] * t) * light)
    }

    fn surface(&self, triangle: usize, x: f32, y: f32) -> [f32; 3] {
        let scene = self.scene;
        let vertices = scene.triangles[triangle];
        let corners = vertices.map(|v| self.projected[v]);
        let w = weights(corners, x, y);
        let [a, b, c] = vertices.map(|v| scene.positions[v]);
        let viewer = self.projection.axes[2];
        let back = (b - a).cross(&(c - a)).dot(&viewer) < 0.0;
        let sign = if back { -1.0 } else { 1.0 };
        let smooth = (0..3).fold(Vector3::zeros(), |sum, k| sum + scene.normals[vertices[k]] * w[k]);
        let normal = smooth.try_normalize(1e-12).unwrap_or(viewer) * sign;
        let point = a * w[0] + b * w[1] + c * w[2];
        let open = (0..3).map(|k| w[k] * scene.openness[vertices[k]][usize::from(back)]).sum();
        let (albedo, coded) = self.albedo(triangle, back, w);
        let lit = self.lit(albedo, &normal, open, self.shadow.reaches(&(point + normal * 0.004)));
        // Light from outside shines through cloth: a garment's inside is dark, never black.
        let through = if back { (0..3).map(|k| w[k] * scene.openness[vertices[k]][0]).sum::<f32>() } else { 0.0 };
        let lit = [0, 1, 2].map(|k| lit[k] + 0.16 * through * albedo[k]);
        // A colour that codes a value must stay readable in the shade: half of it shines by itself.
        if coded { [0, 1, 2].map(|k| 0.5 * lit[k] + 0.42 * albedo[k]) } else { lit }
    }

    /// Sky, key, fill and rim light on a matt surface.
    fn lit(&self, albedo: [f32; 3], normal: &Vector3<f32>, open: f32, shadow: f32) -> [f32; 3] {
        let [key, fill, rim] = self.lights.map(|l| normal.dot(&l).max(0.0));
        let facing = normal.dot(&self.projection.axes[2]).clamp(0.0, 1.0);
        let sky = 0.35 + 0.12 * normal.z;
        let edge = (1.0 - facing).powi(3) * (0.25 + 0.75 * rim);
        // Cloth and skin pass light on: a hollow keeps a fifth of the sky.
        let occlusion = 0.2 + 0.8 * open * open * (1.4 - 0.4 * open);
        let warm = [1.04, 1.0, 0.95];
        let cool = [0.97, 1.0, 1.05];
        [0, 1, 2].map(|k| {
            let matt = cool[k] * (sky * occlusion + 0.16 * fill * open) + warm[k] * 0.73 * key * shadow;
            albedo[k] * (matt + 0.26 * edge * open) + 0.04 * edge * open
        })
    }

    /// Linear colour of a surface point, and whether it stands for a value.
    fn albedo(&self, triangle: usize, back: bool, w: [f32; 3]) -> ([f32; 3], bool) {
        let layer = self.scene.layer_of[triangle];
        let look = &self.scene.looks[layer];
        let vertices = self.scene.triangles[triangle];
        let own = vertices.map(|v| v - look.first_vertex);
        match &look.paint {
            Paint::Field(values, scale) if !back => {
                let value = match values {
                    Values::Vertices(values) => (0..3).map(|k| f64::from(w[k]) * values[own[k]]).sum(),
                    Values::Triangles(values) => values[triangle - look.first_triangle],
                };
                (scale.colour(value).linear(), true)
            }
            Paint::Texture(texture, coordinates) if !back => {
                let corners = own.map(|v| coordinates[v]);
                let place = corners[0] * f64::from(w[0]) + corners[1] * f64::from(w[1]) + corners[2] * f64::from(w[2]);
                // How much of the texture a pixel spans: the ratio of the triangle's two areas.
                let drawn = (corners[1] - corners[0]).perp(&(corners[2] - corners[0])).abs() as f32;
                let [a, b, c] = vertices.map(|v| self.scene.positions[v]);
                let real = (b - a).cross(&(c - a)).norm().max(1e-12);
                let span = (drawn / real).sqrt() * FINE as f32 / self.projection.per_m;
                (texture.at(place.x as f32, place.y as f32, span), false)
            }
            _ => (self.colours[layer][usize::from(back)], false),
        }
    }
}

/// Samples along seam lines that are not hidden.
fn stitches(scene: &Scene, projected: &[[f32; 3]], visible: &Visible) -> Vec<bool> {
    let height = visible.depth.len() / visible.width;
    let mut stitched = vec![false; visible.depth.len()];
    for &[a, b] in &scene.seams {
        let (a, b) = (projected[a], projected[b]);
        let steps = ((b[0] - a[0]).abs().max((b[1] - a[1]).abs()).ceil() as usize).clamp(1, 4096);
        for step in 0..=steps {
            let t = step as f32 / steps as f32;
            let [x, y, depth] = [0, 1, 2].map(|k| a[k] + t * (b[k] - a[k]));
            for (dx, dy) in [(0.0, 0.0), (-1.0, 0.0), (0.0, -1.0), (-1.0, -1.0)] {
                let (x, y) = (x + dx + 0.5, y + dy + 0.5);
                if x >= 0.0 && y >= 0.0 && x < visible.width as f32 && y < height as f32 {
                    let sample = y as usize * visible.width + x as usize;
                    stitched[sample] |= depth < visible.depth[sample] + 0.006;
                }
            }
        }
    }
    stitched
}
