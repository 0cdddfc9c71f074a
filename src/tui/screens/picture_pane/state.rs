//! View and pictures of drapes.

use crate::messages::answered::Answered;
use crate::widgets::picture::{Drawn, FRONT, PictureRequest};
use results::{Look, Map};

/// View of drapes, and the pictures there are.
pub struct Pictures {
    /// Direction and distance from which drapes are seen.
    pub look: Look,
    /// Quantity that the colours show.
    pub map: Map,
    /// True where the picture has all the room.
    pub enlarged: bool,
    /// The pictures asked for.
    pub requests: Vec<PictureRequest>,
    /// The picture of each that came last.
    pub drawn: Vec<Answered<PictureRequest, Drawn>>,
}

impl Default for Pictures {
    fn default() -> Self {
        Self { look: FRONT, map: Map::Plain, enlarged: false, requests: vec![], drawn: vec![] }
    }
}
