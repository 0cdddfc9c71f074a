//! Cloths of a garment in a picture: weaves at true scale, a check, image files, for each piece.

use std::path::PathBuf;

use image::{Rgba, RgbaImage};

use crate::error::ResultsError;
use geom::units::from_mm;
use pattern::Garment;
use render::{self, Mapping, Print, Rgb, Texture, Weave};
use sim::Fabric;
use store::{Result, StudyError};

/// Two squares of 20 mm.
const CHECK_M: f64 = 0.04;
/// Greatest repeat that is accepted.
const LONGEST_MM: f64 = 5000.0;
const UNDYED: Rgb = Rgb(0xe9, 0xe4, 0xd8);

#[derive(Clone, Debug, PartialEq)]
enum Kind {
    /// The weave or knit of the garment's own fabric.
    Own,
    Weave(Weave),
    Check,
    Image(PathBuf),
}

/// A cloth of some or all pieces of a garment, written `[PIECE=]WHAT[#RRGGBB][@MM]`.
#[derive(Clone, Debug, PartialEq)]
pub struct Cloth {
    /// `None` for all pieces that no other cloth names.
    piece: Option<String>,
    kind: Kind,
    colour: Option<Rgb>,
    repeat_mm: Option<f64>,
}

impl Cloth {
    /// Check in the simulator's colour.
    pub(super) const CHECK: Self = Self { piece: None, kind: Kind::Check, colour: None, repeat_mm: None };

    /// Parses `[PIECE=]WHAT[#RRGGBB][@MM]`. WHAT is `fabric` (the weave of the garment's own fabric), `plain`, `twill`,
    /// `jersey`, `rib`, `check` or an image file; MM is the length of one repeat. Without MM yarns have their true
    /// size, and an image is shown once on each piece.
    pub fn parse(text: &str) -> Result<Self> {
        let refused =
            |problem: String| StudyError::Refused { what: "cloth", name: text.to_owned(), problems: vec![problem] };
        let is_piece = |name: &str| !name.is_empty() && !name.contains(['/', '\\', '.', '#', '@']);
        let (piece, rest) = match text.split_once('=') {
            Some((piece, rest)) if is_piece(piece) => (Some(piece.to_owned()), rest),
            _ => (None, text),
        };
        let (rest, repeat_mm) = match rest.rsplit_once('@').map(|(before, mm)| (before, mm.parse::<f64>())) {
            Some((before, Ok(mm))) => (before, Some(mm)),
            _ => (rest, None),
        };
        if let Some(mm) = repeat_mm.filter(|mm| !(*mm > 0.0 && *mm <= LONGEST_MM)) {
            return Err(refused(format!("a repeat of {mm} mm; accepted: more than 0, at most {LONGEST_MM}")));
        }
        let (what, colour) = match rest.rsplit_once('#').map(|(before, hex)| (before, Rgb::from_hex(hex))) {
            Some((before, Some(colour))) => (before, Some(colour)),
            _ => (rest, None),
        };
        let kind = match what {
            "" => return Err(refused("names no cloth; like twill, check or stripes.png".into())),
            "fabric" => Kind::Own,
            "check" => Kind::Check,
            other => match Weave::ALL.into_iter().find(|weave| weave.as_str() == other) {
                Some(weave) => Kind::Weave(weave),
                None => Kind::Image(PathBuf::from(other)),
            },
        };
        Ok(Self { piece, kind, colour, repeat_mm })
    }

    fn texture(&self, fabric: &Fabric, own: Rgb) -> Result<(Texture, Mapping)> {
        let colour = self.colour.unwrap_or(own);
        let woven = |weave: Weave| {
            let weft = if weave == Weave::Twill { UNDYED } else { colour };
            let [across, along] = weave.repeat_m(fabric.density_kg_m2, fabric.thickness_m);
            let repeat_m = self.repeat_mm.map_or([across, along], |mm| [from_mm(mm), from_mm(mm) * along / across]);
            (Texture::new(&weave.picture(colour, weft)), Mapping::Fabric { repeat_m })
        };
        Ok(match &self.kind {
            Kind::Own => woven(weave(fabric)),
            Kind::Weave(weave) => woven(*weave),
            Kind::Check => {
                let repeat_m = [self.repeat_mm.map_or(CHECK_M, from_mm); 2];
                (Texture::gingham(colour), Mapping::Fabric { repeat_m })
            }
            Kind::Image(path) => {
                let bytes = std::fs::read(path).map_err(|source| StudyError::Io { path: path.clone(), source })?;
                let picture = image::load_from_memory(&bytes)
                    .map_err(|reason| ResultsError::NoImage { file: path.clone(), reason })?;
                let texture = Texture::new(&picture.to_rgba8());
                let repeat = self.repeat_mm.map(|mm| [from_mm(mm), from_mm(mm) * texture.aspect()]);
                let mapping = repeat.map_or(Mapping::Piece, |repeat_m| Mapping::Fabric { repeat_m });
                (texture, mapping)
            }
        })
    }
}

/// Weave or knit of a fabric, inferred from words of its name and from the stretch of a knit.
fn weave(fabric: &Fabric) -> Weave {
    let name = fabric.name.to_lowercase();
    let has = |wanted: &[&str]| name.split(|c: char| !c.is_alphanumeric()).any(|word| wanted.contains(&word));
    if has(&["rib", "ribbing"]) {
        Weave::Rib
    } else if has(&["denim", "twill", "drill", "gabardine", "chino"]) {
        Weave::Twill
    } else if fabric.stretched.is_some() || has(&["jersey", "knit", "interlock"]) {
        Weave::Jersey
    } else {
        Weave::Plain
    }
}

/// A piece that no cloth names keeps its simulator's colour.
pub(super) fn print(cloths: &[Cloth], garment: &Garment, fabric: &Fabric, own: Rgb) -> Result<Print> {
    let bare = RgbaImage::from_pixel(1, 1, Rgba([own.0, own.1, own.2, 255]));
    let mut drawn = vec![(Texture::new(&bare), Mapping::Piece)];
    for cloth in cloths {
        if let Some(name) = &cloth.piece
            && !garment.pieces.iter().any(|piece| piece.id.eq_ignore_ascii_case(name))
        {
            let known = garment.pieces.iter().map(|piece| piece.id.clone()).collect();
            return Err(StudyError::NotFound { what: "piece", name: name.clone(), known });
        }
        drawn.push(cloth.texture(fabric, own)?);
    }
    let mut texture_of = vec![0; garment.triangles.len()];
    let mut mapped = Vec::new();
    for piece in &garment.pieces {
        let is_of = |cloth: &Cloth| cloth.piece.as_ref().is_some_and(|name| piece.id.eq_ignore_ascii_case(name));
        let named = cloths.iter().rposition(is_of);
        let chosen = named.or_else(|| cloths.iter().rposition(|cloth| cloth.piece.is_none())).map_or(0, |k| k + 1);
        texture_of[piece.triangles.clone()].fill(chosen);
        mapped.push((piece.vertices.clone(), piece.grain, drawn[chosen].1));
    }
    let places = render::texture_coordinates(&garment.rest, &mapped);
    Ok(Print { textures: drawn.into_iter().map(|(texture, _)| texture).collect(), of: texture_of, places })
}

#[cfg(test)]
mod tests {
    use super::*;
    use sim::fabric;

    #[test]
    fn cloths_are_read_as_written() {
        let check = |text: &str, piece: Option<&str>, kind: Kind, colour: Option<Rgb>, repeat_mm: Option<f64>| {
            let wanted = Cloth { piece: piece.map(str::to_owned), kind, colour, repeat_mm };
            assert_eq!(Cloth::parse(text).expect(text), wanted, "{text}");
        };
        let navy = Some(Rgb(0x2d, 0x4a, 0x7c));
        let image = |path: &str| Kind::Image(path.into());
        check("twill", None, Kind::Weave(Weave::Twill), None, None);
        check("front=twill#2d4a7c@3.5", Some("front"), Kind::Weave(Weave::Twill), navy, Some(3.5));
        check("fabric#2d4a7c", None, Kind::Own, navy, None);
        check("check@10", None, Kind::Check, None, Some(10.0));
        check("sleeve_left=a/b.png@80", Some("sleeve_left"), image("a/b.png"), None, Some(80.0));
        check("./x=1/print#2.png", None, image("./x=1/print#2.png"), None, None);
        check("logo@2x.png", None, image("logo@2x.png"), None, None);
        for (text, says) in
            [("", "names no cloth"), ("front=", "names no cloth"), ("check@0", "0 mm"), ("rib@1e9", "5000")]
        {
            let error = Cloth::parse(text).expect_err(text).to_string();
            assert!(error.contains(says), "{text}: {error}");
        }
    }

    #[test]
    fn a_fabric_is_woven_as_its_name_and_its_stretch_say() {
        let stretched = fabric::library().iter().find_map(|known| known.stretched);
        let check = |name: &str, is_knit: bool, expect: Weave| {
            let like = fabric::library()[0].clone();
            let fabric = Fabric { name: name.into(), stretched: stretched.filter(|_| is_knit), ..like };
            assert_eq!(weave(&fabric), expect, "{name}");
        };
        check("cotton_shirting_light", false, Weave::Plain);
        check("denim_rigid", false, Weave::Twill);
        check("stretch_denim_11oz", true, Weave::Twill);
        check("ponte_roma", true, Weave::Jersey);
        check("rib_knit", true, Weave::Rib);
        check("describes", false, Weave::Plain);
    }
}
