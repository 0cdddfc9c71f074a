//! Textures of weaves and knits, drawn from their yarns at true scale.

use std::f32::consts::PI;

use image::RgbaImage;

use super::colour::{Encoder, Rgb};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Weave {
    /// Plain weave: one over, one under.
    Plain,
    /// Twill 3/1: three over, one under, shifted by one yarn with each pick, which makes the diagonals of denim.
    Twill,
    /// Face side of a single jersey: columns of V-shaped loops.
    Jersey,
    /// Rib 1x1: face and back columns in turn, the back ones sunken.
    Rib,
}

/// Density of a yarn, kg/m3: cotton with a specific volume of 1.1 cm3/g [Peirce 1937].
const YARN_DENSITY: f64 = 909.0;
/// Texels across a yarn of a weave.
const YARN: u32 = 16;
/// Texels across a loop of a knit.
const LOOP: u32 = 40;
/// Width and height of a loop divided by the diameter of its yarn, for a close jersey [Peirce 1947].
const LOOP_DIAMETERS: [f64; 2] = [4.0, 3.46];
/// Length of yarn in a loop divided by the diameter of the yarn [Peirce 1947].
const LOOP_YARN_DIAMETERS: f64 = 16.66;

impl Weave {
    pub const ALL: [Self; 4] = [Self::Plain, Self::Twill, Self::Jersey, Self::Rib];

    /// Name in the command line.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Plain => "plain",
            Self::Twill => "twill",
            Self::Jersey => "jersey",
            Self::Rib => "rib",
        }
    }

    /// Length of one repeat across and along the grain, m, for a cloth of an areal density and a thickness.
    ///
    /// In a weave two yarns lie on each other, so each has half the thickness as its diameter. Their spacing follows
    /// from the weight of both sets of yarns [Peirce 1937], and is at least a diameter. In a knit the loops are as
    /// close as the yarns allow, so their size follows from the weight alone [Peirce 1947].
    pub fn repeat_m(self, density_kg_m2: f64, thickness_m: f64) -> [f64; 2] {
        let yarn_kg_m = |diameter: f64| YARN_DENSITY * std::f64::consts::PI * diameter * diameter / 4.0;
        match self {
            Self::Plain | Self::Twill => {
                let diameter = thickness_m / 2.0;
                let apart = (2.0 * yarn_kg_m(diameter) / density_kg_m2).max(diameter);
                let yarns = f64::from(self.yarns());
                [yarns * apart, yarns * apart]
            }
            Self::Jersey | Self::Rib => {
                let [width, height] = LOOP_DIAMETERS;
                // Mass of a loop divided by its area, kg/m2, for a yarn of 1 m in diameter.
                let density_of_one = LOOP_YARN_DIAMETERS * yarn_kg_m(1.0) / (width * height);
                let diameter = density_kg_m2 / density_of_one;
                let columns = if self == Self::Rib { 2.0 } else { 1.0 };
                [columns * width * diameter, height * diameter]
            }
        }
    }

    /// Number of yarns in a repeat in each direction; for a knit, number of columns of loops.
    fn yarns(self) -> u32 {
        match self {
            Self::Plain | Self::Rib => 2,
            Self::Twill => 4,
            Self::Jersey => 1,
        }
    }

    /// Draws one repeat, `v` (up) along the grain. Its mean brightness is that of the yarns' colours.
    pub fn picture(self, warp: Rgb, weft: Rgb) -> RgbaImage {
        let (width, height) = match self {
            Self::Plain | Self::Twill => (self.yarns() * YARN, self.yarns() * YARN),
            Self::Jersey | Self::Rib => {
                (self.yarns() * LOOP, (f64::from(LOOP) * LOOP_DIAMETERS[1] / LOOP_DIAMETERS[0]).round() as u32)
            }
        };
        let colours = [warp.linear(), weft.linear()];
        let texel = |x: u32, y: u32| {
            let (u, v) = ((x as f32 + 0.5) / width as f32, 1.0 - (y as f32 + 0.5) / height as f32);
            match self {
                Self::Plain | Self::Twill => self.woven(u, v),
                Self::Jersey | Self::Rib => (0, self.knitted(u, v)),
            }
        };
        let texels: Vec<(usize, f32)> = (0..height).flat_map(|y| (0..width).map(move |x| texel(x, y))).collect();
        let mean = texels.iter().map(|(_, light)| light).sum::<f32>() / texels.len() as f32;
        let encoder = Encoder::new();
        RgbaImage::from_fn(width, height, |x, y| {
            let (yarn, light) = texels[(y * width + x) as usize];
            let [r, g, b] = encoder.encode(colours[yarn].map(|v| v * light / mean));
            image::Rgba([r, g, b, 255])
        })
    }

    /// Yarn on top at a point of the repeat (0 warp, 1 weft), and the share of light that it reflects.
    fn woven(self, u: f32, v: f32) -> (usize, f32) {
        let n = self.yarns() as f32;
        let (x, y) = (u * n, v * n);
        let (end, pick) = (x as u32, y as u32);
        let is_warp = |end: u32, pick: u32| match self {
            Self::Twill => !(pick + 4 - end % 4).is_multiple_of(4),
            _ => (end + pick).is_multiple_of(2),
        };
        let above = is_warp(end, pick);
        // True if the upper yarn is also on top at the next crossing along it, or the one before.
        let same = |step: u32| {
            let next = if above { is_warp(end, pick + step) } else { is_warp(end + step, pick) };
            next == above
        };
        let yarns = self.yarns();
        let (across, along) = if above { (x.fract(), y.fract()) } else { (y.fract(), x.fract()) };
        let dip = |distance: f32, goes_on: bool| if goes_on { 1.0 } else { (PI * distance.min(0.5)).sin() };
        let round = (1.0 - (2.2 * (across - 0.5)).powi(2)).max(0.0).sqrt();
        let arched = dip(along, same(yarns - 1)) * dip(1.0 - along, same(1));
        (usize::from(!above), (0.25 + 0.75 * round) * (0.35 + 0.65 * arched))
    }

    fn knitted(self, u: f32, v: f32) -> f32 {
        let columns = self.yarns() as f32;
        let x = u * columns;
        let is_back = self == Self::Rib && x >= 1.0;
        let (x, mut light) = (x.fract() - 0.5, 0.12_f32);
        // Loops of the rows below and above reach into this row.
        for row in [-1.0, 0.0, 1.0] {
            let t = v - row + 0.25;
            if (0.0..=1.5).contains(&t) {
                light = light.max(if is_back { purl(x, t) } else { leg(x, t) });
            }
        }
        if is_back { 0.5 * light } else { light }
    }
}

/// Light from the legs of a loop from height 0 to 1.5 rows, which part as they rise and dip at both ends.
fn leg(x: f32, t: f32) -> f32 {
    let middle = 0.06 + 0.26 * (PI / 2.0 * (t / 1.2).min(1.0)).sin();
    let off = (x.abs() - middle) / 0.17;
    let round = (1.0 - off * off).max(0.0).sqrt();
    round * (0.3 + 0.7 * (PI * t / 1.5).sin())
}

/// Light from the heads of loops seen from the back: an arc across the column.
fn purl(x: f32, t: f32) -> f32 {
    let off = (t - 0.75 - 0.2 * (2.0 * PI * x).cos()) / 0.3;
    (1.0 - off * off).max(0.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn yarns_lie_as_close_as_weight_and_thickness_say() {
        let check = |weave: Weave, density: f64, thickness: f64, across_mm: f64, along_mm: f64| {
            let found = weave.repeat_m(density, thickness).map(|m| 1e3 * m);
            let off = (found[0] - across_mm).abs().max((found[1] - along_mm).abs());
            assert!(off < 0.01, "{weave:?}: {found:?}");
        };
        // Denim of 400 g/m2 and 0.66 mm: 26 yarns a centimetre, four a repeat.
        check(Weave::Twill, 0.400, 0.66e-3, 1.556, 1.556);
        check(Weave::Plain, 0.1036, 0.18e-3, 0.223, 0.223);
        // A jersey of 187 g/m2: yarn of 0.218 mm, 11.5 columns and 13.3 rows a centimetre.
        check(Weave::Jersey, 0.187, 0.41e-3, 0.871, 0.754);
        check(Weave::Rib, 0.187, 0.41e-3, 1.743, 0.754);
        // So heavy for this thickness that the yarns would overlap; they touch instead.
        check(Weave::Plain, 2.0, 0.4e-3, 0.4, 0.4);
    }

    #[test]
    fn a_repeat_is_as_light_as_its_yarn_and_repeats() {
        for weave in Weave::ALL {
            let picture = weave.picture(Rgb(90, 110, 160), Rgb(90, 110, 160));
            let mean = |channel: usize| {
                let sum: f32 = picture.pixels().map(|p| Rgb(p[0], p[1], p[2]).linear()[channel]).sum();
                sum / (picture.width() * picture.height()) as f32
            };
            let wanted = Rgb(90, 110, 160).linear();
            for (channel, wanted) in wanted.iter().enumerate() {
                assert!((mean(channel) / wanted - 1.0).abs() < 0.02, "{weave:?}: {} {wanted}", mean(channel));
            }
        }
    }

    #[test]
    fn three_of_four_yarns_of_a_twill_are_warp() {
        let picture = Weave::Twill.picture(Rgb(0, 0, 200), Rgb(200, 0, 0));
        let weft = picture.pixels().filter(|p| p[0] > p[2]).count() as f64;
        assert!((weft / f64::from(picture.width() * picture.height()) - 0.25).abs() < 0.01, "{weft}");
        // The weft shows a step higher with each end: the diagonal rises to the right.
        let shows = |end: u32, pick: u32| {
            let p = picture.get_pixel(end * YARN + YARN / 2, picture.height() - 1 - (pick * YARN + YARN / 2));
            p[0] > p[2]
        };
        assert!((0..4).all(|end| (0..4).all(|pick| shows(end, pick) == (end == pick))));
    }
}
