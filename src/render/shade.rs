//! Shading: from scene and camera to pixels. Visibility, three soft lights with a shadow map, ambient occlusion,
//! relief, floor.

use super::RenderError;
use super::camera::{Camera, Projection};
use super::colour::{Encoder, Rgb, Scale};
use super::raster::{NOTHING, cover, weights};
use super::relief::relief;
use super::scene::{Paint, Scene, Values};
use super::visible::{Fine, SAMPLES, Visible, offset};
use image::RgbaImage;
use nalgebra::{Vector2, Vector3};

/// Samples along a side of the key light's shadow map.
const SHADOW: usize = 1280;
/// Number of samples of the shadow map for one point (percentage-closer filtering).
const TAPS: usize = 32;
/// Number of these samples, the outermost, that are evaluated first.
const RIM: usize = 8;
/// Radius of the disc of these samples, in samples of the map: half the width of a shadow's soft edge.
const SOFT: f32 = 9.0;
/// Brightness of the wrong side of printed cloth, relative to the print.
const WRONG_SIDE: f32 = 0.6;
const RAMP: usize = 1024;

/// Offset of a sample of the shadow map from a point, in map samples.
#[derive(Clone, Copy)]
struct Tap {
    dx: f32,
    dy: f32,
    distance: f32,
}

/// Offsets of the samples: a disc filled evenly by a golden-angle spiral [Vogel 1979].
fn taps() -> [Tap; TAPS] {
    let golden = std::f32::consts::PI * (3.0 - 5.0_f32.sqrt());
    std::array::from_fn(|k| {
        let radius = SOFT * ((k as f32 + 0.5) / TAPS as f32).sqrt();
        let (sin, cos) = (golden * k as f32).sin_cos();
        Tap { dx: radius * cos, dy: radius * sin, distance: radius }
    })
}

/// Takes a picture of the scene.
///
/// # Examples
/// ```
/// use geom::{TriMesh, V3};
/// use render::{Camera, Frame, Layer, Material, Scene, View};
///
/// let mut mesh = TriMesh::default();
/// mesh.positions = vec![V3::new(-0.5, 0.0, 0.0), V3::new(0.5, 0.0, 0.0), V3::new(0.0, 0.0, 1.0)];
/// mesh.triangles = vec![[0, 1, 2]];
///
/// // A scene is lit once; all cameras of one frame have one scale.
/// let scene = Scene::new(vec![Layer::new(&mesh, Material::fem())])?;
/// let frame = Frame::enclosing([&mesh], 0.5);
/// let picture = render::render(&scene, &Camera::new(View::Front, frame), 60, 120)?;
/// assert!(render::png(&picture)?.starts_with(b"\x89PNG"));
/// # Ok::<(), render::RenderError>(())
/// ```
pub fn render(scene: &Scene, camera: &Camera, width: u32, height: u32) -> Result<RgbaImage, RenderError> {
    shoot(scene, camera, (width, height), 255)
}

/// Takes a picture as [`render`] does, transparent where there is no mesh. Those pixels keep backdrop and floor
/// colours.
pub fn cutout(scene: &Scene, camera: &Camera, width: u32, height: u32) -> Result<RgbaImage, RenderError> {
    shoot(scene, camera, (width, height), 0)
}

/// Takes a picture; `backdrop` is the opacity of backdrop and floor.
fn shoot(scene: &Scene, camera: &Camera, (width, height): (u32, u32), backdrop: u8) -> Result<RgbaImage, RenderError> {
    if !(1..=8192).contains(&width) || !(1..=8192).contains(&height) {
        return Err(RenderError::Size { width, height });
    }
    let studio = Studio::new(scene, camera, width as usize, height as usize);
    let gain = relief(&studio.visible.depth, width as usize, studio.projection.per_m);
    let encoder = Encoder::new();
    let mut picture = RgbaImage::new(width, height);
    for (pixel, (out, gain)) in picture.pixels_mut().zip(gain).enumerate() {
        let [r, g, b] = encoder.encode(studio.pixel(pixel, gain).into());
        let alpha = if studio.visible.depth[pixel].is_finite() { 255 } else { backdrop };
        out.0 = [r, g, b, alpha];
    }
    Ok(picture)
}

struct ShadowMap {
    projection: Projection,
    depth: Vec<f32>,
    taps: [Tap; TAPS],
}

impl ShadowMap {
    fn new(scene: &Scene, towards: Vector3<f32>) -> Self {
        let projection = Projection::of_light(towards, scene.centre, scene.radius * 1.02, SHADOW);
        let projected: Vec<[f32; 3]> = scene.positions.iter().map(|p| projection.project(p)).collect();
        let mut depth = vec![f32::INFINITY; SHADOW * SHADOW];
        for triangle in 0..scene.triangles.len() {
            let recede = scene.recede(triangle);
            cover(scene.corners(triangle, &projected), SHADOW, SHADOW, |sample, d| {
                depth[sample] = depth[sample].min(d + recede);
            });
        }
        Self { projection, depth, taps: taps() }
    }

    /// Share of the light that reaches a point, 0 to 1.
    fn reaches(&self, point: &Vector3<f32>) -> f32 {
        let [x, y, depth] = self.projection.project(point);
        let is_open = |&Tap { dx, dy, distance }: &Tap| {
            let (x, y) = (x + dx, y + dy);
            let inside = x >= 0.0 && y >= 0.0 && x < SHADOW as f32 && y < SHADOW as f32;
            // A tilted surface would shadow itself, so the bias grows with the distance of the sample.
            let bias = (1.5 + 0.8 * distance) / self.projection.per_m;
            !inside || depth - bias <= self.depth[y as usize * SHADOW + x as usize]
        };
        let (within, rim) = self.taps.split_at(TAPS - RIM);
        let open = rim.iter().filter(|tap| is_open(tap)).count();
        // Where centre and rim agree, no edge of a shadow lies between them.
        match (open, is_open(&self.taps[0])) {
            (RIM, true) => 1.0,
            (0, false) => 0.0,
            _ => (open + within.iter().filter(|tap| is_open(tap)).count()) as f32 / TAPS as f32,
        }
    }
}

/// Linear light: red, green, blue.
type Colour = Vector3<f32>;

struct Studio<'a> {
    scene: &'a Scene,
    projection: Projection,
    /// Pixels across and down.
    size: [usize; 2],
    projected: Vec<[f32; 3]>,
    visible: Visible,
    shadow: ShadowMap,
    /// Directions to the key, fill and rim light.
    lights: [Vector3<f32>; 3],
    /// Front and back colour of each layer.
    colours: Vec<[Colour; 2]>,
    /// Tabulated colour scale of each layer ([`ramp`]); empty for a layer without a scale.
    ramps: Vec<Vec<Colour>>,
    backdrop: [Colour; 2],
}

impl<'a> Studio<'a> {
    fn new(scene: &'a Scene, camera: &Camera, width: usize, height: usize) -> Self {
        let projection = Projection::new(camera, width, height);
        let projected: Vec<[f32; 3]> = scene.positions.iter().map(|p| projection.project(p)).collect();
        let visible = Visible::new(scene, &projected, width, height);
        let [right, up, viewer] = projection.axes;
        let light = |r: f32, u: f32, v: f32| (right * r + up * u + viewer * v).normalize();
        let lights = [light(-0.72, 0.62, 0.62), light(0.85, 0.05, 0.6), light(0.75, 0.45, -0.65)];
        Self {
            scene,
            projection,
            size: [width, height],
            projected,
            visible,
            shadow: ShadowMap::new(scene, lights[0]),
            lights,
            colours: scene.looks.iter().map(|l| [l.material.front, l.material.back].map(linear)).collect(),
            ramps: scene.looks.iter().map(|look| ramp(&look.paint)).collect(),
            backdrop: [Rgb(0xfa, 0xfa, 0xf9), Rgb(0xe9, 0xea, 0xec)].map(linear),
        }
    }

    /// Colour of a pixel; `gain` is the factor of its relief.
    fn pixel(&self, pixel: usize, gain: f32) -> Colour {
        let (x, y) = ((pixel % self.size[0]) as f32, (pixel / self.size[0]) as f32);
        match self.visible.closer(pixel) {
            Some(fine) => self.blend(fine, [x, y], gain),
            None => self.seen(self.visible.triangle[pixel], x + 0.5, y + 0.5, gain),
        }
    }

    /// Colour of a supersampled pixel. Each of its triangles is shaded once, at the mean of the samples that it covers.
    fn blend(&self, fine: &Fine, [left, top]: [f32; 2], gain: f32) -> Colour {
        let mut colour = Colour::zeros();
        let mut done = [false; SAMPLES];
        for first in 0..SAMPLES {
            if done[first] {
                continue;
            }
            let triangle = fine.triangle[first];
            let (mut x, mut y, mut share, mut stitched) = (0.0, 0.0, 0.0, 0.0);
            for k in (first..SAMPLES).filter(|&k| fine.triangle[k] == triangle) {
                done[k] = true;
                let [dx, dy] = offset(k);
                (x, y, share) = (x + left + dx, y + top + dy, share + 1.0);
                stitched += f32::from(u8::from(fine.stitched[k]));
            }
            let light = self.seen(triangle, x / share, y / share, gain * (1.0 - 0.38 * stitched / share));
            colour += light * (share / SAMPLES as f32);
        }
        colour
    }

    /// Colour at a point of the picture: of a triangle, or of the ground where there is none.
    fn seen(&self, triangle: u32, x: f32, y: f32, gain: f32) -> Colour {
        if triangle == NOTHING { self.ground(x, y) } else { self.surface(triangle as usize, x, y) * gain }
    }

    /// Colour of backdrop and floor, which are one seamless light sheet with the shadow of the subject.
    fn ground(&self, x: f32, y: f32) -> Colour {
        let t = y / self.size[1] as f32;
        let viewer = self.projection.axes[2];
        let mut light = 1.0;
        if viewer.z > 0.01 {
            let start = self.projection.unproject(x, y, 0.0);
            let point = start - viewer * ((start.z - self.scene.floor.z) / viewer.z);
            light = self.scene.floor.openness(point.x, point.y);
        }
        (self.backdrop[0] * (1.0 - t) + self.backdrop[1] * t) * light
    }

    fn surface(&self, triangle: usize, x: f32, y: f32) -> Colour {
        let scene = self.scene;
        let [i, j, k] = scene.triangles[triangle];
        let w = weights(scene.corners(triangle, &self.projected), x, y);
        let (a, b, c) = (scene.positions[i], scene.positions[j], scene.positions[k]);
        let viewer = self.projection.axes[2];
        let back = (b - a).cross(&(c - a)).dot(&viewer) < 0.0;
        let smooth = scene.normals[i] * w[0] + scene.normals[j] * w[1] + scene.normals[k] * w[2];
        let normal = smooth.try_normalize(1e-12).unwrap_or(viewer) * if back { -1.0 } else { 1.0 };
        let point = a * w[0] + b * w[1] + c * w[2];
        let openness = |side: usize| {
            w[0] * scene.openness[i][side] + w[1] * scene.openness[j][side] + w[2] * scene.openness[k][side]
        };
        let (albedo, coded) = self.albedo(triangle, back, w);
        let reaches = self.shadow.reaches(&(point + normal * 0.004));
        let mut lit = self.lit(&albedo, &normal, openness(usize::from(back)), reaches);
        if back {
            // Light from outside shines through cloth, so the inside of a garment is dark, but not black.
            lit += albedo * (0.16 * openness(0));
        }
        // A colour that encodes a value must stay readable in shade, so half of it does not depend on light.
        if coded { lit * 0.5 + albedo * 0.42 } else { lit }
    }

    /// Light of sky, key, fill and rim light that a matt surface reflects.
    fn lit(&self, albedo: &Colour, normal: &Vector3<f32>, open: f32, shadow: f32) -> Colour {
        let cosine = |light: usize| normal.dot(&self.lights[light]).max(0.0);
        let facing = normal.dot(&self.projection.axes[2]).clamp(0.0, 1.0);
        let sky = 0.35 + 0.12 * normal.z;
        let edge = (1.0 - facing).powi(3) * (0.25 + 0.75 * cosine(2)) * open;
        // Cloth and skin scatter light, so a hollow keeps a fifth of the sky.
        let occlusion = 0.2 + 0.8 * open * open * (1.4 - 0.4 * open);
        let (warm, cool) = (Colour::new(1.04, 1.0, 0.95), Colour::new(0.97, 1.0, 1.05));
        let matt = cool * (sky * occlusion + 0.16 * cosine(1) * open) + warm * (0.73 * cosine(0) * shadow);
        albedo.component_mul(&matt.add_scalar(0.26 * edge)).add_scalar(0.04 * edge)
    }

    /// Root mean square change of the texture coordinates from one pixel to the next.
    fn texture_span(&self, triangle: usize, places: &[Vector2<f32>; 3]) -> f32 {
        let [a, b, c] = self.scene.corners(triangle, &self.projected);
        let (x1, y1, x2, y2) = (b[0] - a[0], b[1] - a[1], c[0] - a[0], c[1] - a[1]);
        let (first, second) = (places[1] - places[0], places[2] - places[0]);
        let area = x1 * y2 - x2 * y1;
        let (right, down) = (first * y2 - second * y1, second * x1 - first * x2);
        (0.5 * (right.norm_squared() + down.norm_squared())).sqrt() / area.abs().max(1e-6)
    }

    /// Colour of a point of the surface, and `true` if it encodes a value.
    fn albedo(&self, triangle: usize, back: bool, w: [f32; 3]) -> (Colour, bool) {
        let layer = self.scene.layer_of[triangle];
        let look = &self.scene.looks[layer];
        let own = || self.scene.triangles[triangle].map(|v| v - look.first_vertex);
        match &look.paint {
            Paint::Field(values, scale) if !back => {
                let value = match values {
                    Values::Vertices(values) => own().iter().zip(w).map(|(v, w)| f64::from(w) * values[*v]).sum(),
                    Values::Triangles(values) => values[triangle - look.first_triangle],
                };
                (look_up(&self.ramps[layer], scale, value), true)
            }
            Paint::Printed(print) => {
                let corners = own().map(|v| print.places[v]);
                let place = corners[0] * f64::from(w[0]) + corners[1] * f64::from(w[1]) + corners[2] * f64::from(w[2]);
                let span = self.texture_span(triangle, &corners.map(|c| c.cast()));
                let texture = &print.textures[print.of[triangle - look.first_triangle]];
                let seen = texture.at(place.x as f32, place.y as f32, span);
                (seen * if back { WRONG_SIDE } else { 1.0 }, false)
            }
            _ => (self.colours[layer][usize::from(back)], false),
        }
    }
}

fn linear(colour: Rgb) -> Colour {
    Colour::from(colour.linear())
}

/// Tabulated colours of a scale: the one of NaN, then those from the low end to the high end.
fn ramp(paint: &Paint) -> Vec<Colour> {
    let Paint::Field(_, scale) = paint else { return vec![] };
    let step = |k: usize| linear(scale.map.at(k as f64 / RAMP as f64));
    [linear(scale.colour(f64::NAN))].into_iter().chain((0..=RAMP).map(step)).collect()
}

fn look_up(ramp: &[Colour], scale: &Scale, value: f64) -> Colour {
    let t = (value - scale.low) / (scale.high - scale.low);
    if t.is_finite() { ramp[1 + (t.clamp(0.0, 1.0) * RAMP as f64).round() as usize] } else { ramp[0] }
}
