//! Conversions at the edges: SI inside, millimetres, degrees and milliseconds in what users read and write.

/// Metres to millimetres.
#[must_use]
pub fn mm(metres: f64) -> f64 {
    metres * 1e3
}

/// Millimetres to metres.
#[must_use]
pub fn from_mm(millimetres: f64) -> f64 {
    millimetres * 1e-3
}
