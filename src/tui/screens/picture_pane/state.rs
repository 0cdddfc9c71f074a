//! View on drapes, and their pictures.

use crate::messages::answered::Answered;
use crate::widgets::picture::{Drawn, FRONT, PictureRequest};
use results::{Look, Map};

pub struct Pictures {
    /// Direction and distance from which drapes are seen.
    pub look: Look,
    pub map: Map,
    pub enlarged: bool,
    /// Requests made last.
    pub requests: Vec<PictureRequest>,
    pub drawn: Vec<Answered<PictureRequest, Drawn>>,
}

impl Default for Pictures {
    fn default() -> Self {
        Self { look: FRONT, map: Map::Plain, enlarged: false, requests: vec![], drawn: vec![] }
    }
}
