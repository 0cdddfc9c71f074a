//! Drafting of the four styles of the thesis, so that their measurements are the published ones.
//!
//! The pieces are **net**: layer 1 is the sew line, without allowances. The published numbers leave some choices open,
//! which are the constants of the module of each style.

mod dress;
mod marks;
mod teetop;
mod trousers;
mod trunk;
mod tshirt;

use self::marks::finished;
use super::dxf::{Standard, write_pieces};
use super::piece::Piece;

pub use self::tshirt::{TSHIRT_SEAMS, TshirtSize, tshirt};

#[derive(Clone, Debug, PartialEq)]
pub struct Draft {
    /// Prefix of the files: `tshirt`.
    pub style: String,
    pub size: String,
    /// The outline is the sew line, without allowances.
    pub pieces: Vec<Piece>,
}

impl Draft {
    fn new(style: &str, size: &str, material: &str, pieces: Vec<Piece>) -> Self {
        let pieces = pieces.into_iter().map(|piece| finished(piece, size, material)).collect();
        Self { style: style.to_owned(), size: size.to_owned(), pieces }
    }
}

impl Draft {
    /// Writes AAMA DXF in millimetres. The bytes depend on the draft only: no date is written.
    pub fn dxf(&self) -> Vec<u8> {
        let texts = [("Author", "Toile"), ("Style Name", &self.style), ("Sample Size", &self.size)];
        let texts = texts.map(|(key, value)| (key.to_owned(), value.to_owned()));
        write_pieces(&self.pieces, &texts, Standard::Aama)
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Model {
    /// Men's V-neck T-shirt, sizes S, M and L.
    Tshirt,
    /// Men's trousers, sizes S, M and L.
    Trousers,
    /// Women's tee-top, sizes M and L.
    Teetop,
    /// Women's dress, one size.
    Dress,
}

impl Model {
    pub const ALL: [Self; 4] = [Self::Tshirt, Self::Trousers, Self::Teetop, Self::Dress];

    /// Prefix of the files.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Tshirt => "tshirt",
            Self::Trousers => "trousers",
            Self::Teetop => "teetop",
            Self::Dress => "dress",
        }
    }

    pub fn seams(self) -> &'static [u8] {
        match self {
            Self::Tshirt => TSHIRT_SEAMS,
            Self::Trousers => include_bytes!("trousers.seams.toml"),
            Self::Teetop => include_bytes!("teetop.seams.toml"),
            Self::Dress => include_bytes!("dress.seams.toml"),
        }
    }

    /// Sizes, smallest first, with their published lengths `#1`, `#2` ...
    pub fn published_mm(self) -> Vec<(&'static str, Vec<f64>)> {
        match self {
            Self::Tshirt => TshirtSize::ALL.map(|size| (size.as_str(), size.published_mm().to_vec())).to_vec(),
            Self::Trousers => listed(&trousers::SIZES),
            Self::Teetop => listed(&teetop::SIZES),
            Self::Dress => listed(&dress::SIZES),
        }
    }

    /// Smallest size first.
    pub fn drafts(self) -> Vec<Draft> {
        match self {
            Self::Tshirt => TshirtSize::ALL.map(tshirt).to_vec(),
            Self::Trousers => trousers::SIZES.map(|(size, lengths)| trousers::draft(size, lengths)).to_vec(),
            Self::Teetop => teetop::SIZES.map(|(size, lengths)| teetop::draft(size, lengths)).to_vec(),
            Self::Dress => dress::SIZES.map(|(size, lengths)| dress::draft(size, lengths)).to_vec(),
        }
    }

    /// One DXF per size, and the seam file.
    pub fn files(self) -> Vec<(String, Vec<u8>)> {
        let drawing = |draft: &Draft| {
            let name = format!("{}-{}.dxf", self.as_str(), draft.size.to_lowercase());
            (name, draft.dxf())
        };
        let seams = (format!("{}.seams.toml", self.as_str()), self.seams().to_vec());
        self.drafts().iter().map(drawing).chain([seams]).collect()
    }
}

fn listed<const N: usize>(sizes: &[(&'static str, [f64; N])]) -> Vec<(&'static str, Vec<f64>)> {
    sizes.iter().map(|(size, lengths)| (*size, lengths.to_vec())).collect()
}

#[cfg(test)]
mod tests;
