//! Handles applied to a mesh of a style.

use super::{Handle, HandleError};
use crate::garment::Garment;
use crate::style::Style;

impl Style {
    /// Changes a mesh by a handle, m. Vertices, triangles and seams stay the same. Amounts should be small, because
    /// triangles are stretched and not made anew.
    pub fn moved_mesh(&self, garment: &Garment, handle: Handle, amount_m: f64) -> Result<Garment, HandleError> {
        let fields = self.moved_by(handle, amount_m)?.fields;
        let mut rest = garment.rest.clone();
        for (piece, field) in fields {
            for place in &mut rest[garment.pieces[piece].vertices.clone()] {
                *place = field.carried(*place);
            }
        }
        Ok(garment.with_rest(rest))
    }
}
