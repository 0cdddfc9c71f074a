//! Pieces drawn outside all blocks: each closed boundary line with the entities inside it.

use dxf::entities::{Entity, EntityType};

use super::blocks::{Drawn, Library, Text, key_and_value};
use super::figures::Placement;
use super::outline::{Line, chains};
use super::{NO_BLOCK, Refused};
use crate::piece::Piece;
use geom::V2;
use geom::polyline::{boundary_distance, contains};

/// Distance below which a point counts as inside an outline.
const NEAR_M: f64 = 1e-3;
/// Every pair of outlines is tested for containment.
const MOST_OUTLINES: usize = 500;

#[derive(Clone, Debug, Default, PartialEq)]
pub struct Loose {
    /// Closed boundary lines, each with the entities inside it.
    pub pieces: Vec<Piece>,
    pub refused: Vec<Refused>,
    pub remarks: Vec<String>,
    /// Drawing without a boundary line. `None` if its lines are in `pieces` or `refused`.
    pub rest: Option<Drawn>,
}

/// Insertions of blocks are skipped, because every block is read as a piece.
pub fn read<'e>(entities: impl Iterator<Item = &'e Entity>, placement: &Placement, library: &Library<'_>) -> Loose {
    let entities: Vec<&Entity> = entities.filter(|e| !matches!(e.specific, EntityType::Insert(_))).collect();
    let drawn = Drawn::collect(entities.iter().copied(), placement, library);
    if drawn.boundary.is_empty() && drawn.unreadable.is_empty() {
        return Loose { rest: Some(drawn), ..Loose::default() };
    }
    let outlines = match drawn.boundary.len() {
        0..=MOST_OUTLINES => outer(chains(&drawn.boundary)),
        _ => Vec::new(),
    };
    let mut loose = Loose { remarks: drawn.remarks(NO_BLOCK), ..Loose::default() };
    if outlines.len() < 2 {
        loose.add(drawn);
        return loose;
    }
    let mut outside = 0;
    let mut parts: Vec<Vec<&Entity>> = vec![Vec::new(); outlines.len()];
    for entity in entities {
        let single = Drawn::collect([entity], placement, library);
        match single.place().and_then(|place| outlines.iter().position(|outline| is_of(outline, &place))) {
            Some(index) => parts[index].push(entity),
            None => outside += usize::from(!single.is_no_piece()),
        }
    }
    for part in parts {
        loose.add(Drawn::collect(part, placement, library));
    }
    if outside > 0 {
        loose.remarks.push(format!("{outside} entities lie outside all outlines and are not used"));
    }
    loose
}

/// Chains that do not lie inside another closed chain.
fn outer(chains: Vec<Line>) -> Vec<Line> {
    let is_inner = |index: usize| {
        let within = |(other, outline): (usize, &Line)| {
            other != index && outline.closes() && contains(&outline.points, &chains[index].points[0])
        };
        chains.iter().enumerate().any(within)
    };
    (0..chains.len()).filter(|&index| !is_inner(index)).map(|index| chains[index].clone()).collect()
}

fn is_of(outline: &Line, place: &V2) -> bool {
    (outline.closes() && contains(&outline.points, place)) || boundary_distance(&outline.points, place) < NEAR_M
}

impl Loose {
    /// Takes as name its `Piece Name`, or else its first text that is neither a `key: value` nor a rule number.
    fn add(&mut self, drawn: Drawn) {
        let keyless = |text: &Text| {
            let (key, value) = key_and_value(&text.value);
            (key.is_empty() && !value.is_empty() && !value.starts_with('#')).then_some(value)
        };
        let label = drawn.texts.iter().find_map(keyless);
        match drawn.into_piece(NO_BLOCK, &mut self.remarks) {
            Ok(mut piece) => {
                if let Some(label) = label.filter(|_| piece.name == NO_BLOCK) {
                    piece.texts.retain(|(key, value)| !(key.is_empty() && *value == label));
                    piece.name = label;
                }
                self.pieces.push(piece);
            }
            Err(reason) => self.refused.push(Refused { block: NO_BLOCK.to_owned(), line: None, size: None, reason }),
        }
    }
}
