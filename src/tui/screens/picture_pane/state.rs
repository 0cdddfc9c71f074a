//! How drapes are seen.

use crate::widgets::picture::{Drawn, FRONT, PictureRequest};
use results::{Look, Map};

/// How drapes are seen, and the pictures there are.
pub struct Pictures {
    /// From where drapes are seen.
    pub look: Look,
    /// In which colours.
    pub map: Map,
    /// Whether the picture has all the room.
    pub enlarged: bool,
    /// The pictures asked for.
    pub requests: Vec<PictureRequest>,
    /// The picture of each that came last.
    pub drawn: Vec<(PictureRequest, Result<Drawn, String>)>,
}

impl Default for Pictures {
    fn default() -> Self {
        Self { look: FRONT, map: Map::Plain, enlarged: false, requests: vec![], drawn: vec![] }
    }
}
