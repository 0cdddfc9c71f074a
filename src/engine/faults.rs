//! Faults of a drape.

/// Deepest penetration into the body that is no fault.
const PENETRATION_MM: f64 = 0.5;

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    pub kind: FaultKind,
    /// Description with the size of the fault.
    pub words: String,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FaultKind {
    /// The drape did not come to rest.
    Moves,
    Inside,
    /// The cloth intersects itself.
    Crosses,
}

pub fn drape_faults(converged: bool, residual: f64, penetration_mm: f64, self_crossings: i64) -> Vec<Fault> {
    let fault = |kind, words| Fault { kind, words };
    let mut faults = Vec::new();
    if !converged {
        faults.push(fault(FaultKind::Moves, format!("not converged: residual {residual:.4}")));
    }
    if penetration_mm > PENETRATION_MM {
        faults.push(fault(FaultKind::Inside, format!("{penetration_mm:.1} mm inside the body")));
    }
    if self_crossings > 0 {
        faults.push(fault(FaultKind::Crosses, format!("the cloth crosses itself at {self_crossings} edges")));
    }
    faults
}
