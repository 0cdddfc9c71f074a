//! View on drapes, and their pictures.

use crate::messages::answered::Answered;
use crate::widgets::picture::{Drawn, FRONT, PictureRequest};
use results::{Look, Map};

/// View on drapes, and the pictures that were drawn.
pub struct Pictures {
    /// Direction and distance from which drapes are seen.
    pub look: Look,
    /// Map that colours the cloth.
    pub map: Map,
    /// True if the picture is enlarged to all the room.
    pub enlarged: bool,
    /// Requests made last.
    pub requests: Vec<PictureRequest>,
    /// Latest picture for each request.
    pub drawn: Vec<Answered<PictureRequest, Drawn>>,
}

impl Default for Pictures {
    fn default() -> Self {
        Self { look: FRONT, map: Map::Plain, enlarged: false, requests: vec![], drawn: vec![] }
    }
}
