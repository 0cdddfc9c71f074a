//! Faults of a drape.

/// Greatest penetration into the body that is no fault, mm.
const PENETRATION_MM: f64 = 0.5;

/// Kind of a fault of a drape.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// The drape did not come to rest.
    Moves,
    /// The cloth lies inside the body.
    Inside,
    /// The cloth intersects itself.
    Crosses,
}

/// Returns the faults of a drape, each in words and with its kind.
pub fn drape_faults(converged: bool, residual: f64, penetration_mm: f64, self_crossings: i64) -> Vec<(String, Fault)> {
    let mut faults = Vec::new();
    if !converged {
        faults.push((format!("not converged: residual {residual:.4}"), Fault::Moves));
    }
    if penetration_mm > PENETRATION_MM {
        faults.push((format!("{penetration_mm:.1} mm inside the body"), Fault::Inside));
    }
    if self_crossings > 0 {
        faults.push((format!("the cloth crosses itself at {self_crossings} edges"), Fault::Crosses));
    }
    faults
}
