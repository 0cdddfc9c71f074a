//! A mesh of a style taken along by a handle.

use super::{Handle, HandleError};
use crate::garment::Garment;
use crate::style::Style;

impl Style {
    /// A mesh of the style as a handle changes it by an amount, m: the same vertices, triangles and seams on the changed outlines. For small
    /// amounts: triangles are stretched and not made anew.
    ///
    /// # Errors
    /// As of [`Style::moved`].
    pub fn moved_mesh(&self, garment: &Garment, handle: Handle, amount_m: f64) -> Result<Garment, HandleError> {
        let (_, fields) = self.moved_by(handle, amount_m)?;
        let mut rest = garment.rest.clone();
        for (piece, field) in fields {
            for place in &mut rest[garment.pieces[piece].vertices.clone()] {
                *place = field.carried(*place);
            }
        }
        Ok(garment.with_rest(rest))
    }
}
