//! Picture for a customer.

use super::class::Simulator;

/// Drape to show to a customer [T 6.4.2].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shown {
    /// FEM-GS: the garment is large enough, and hanging cloth is what the customer would see.
    FemDrape,
    /// Hybrid-GS: keeps the pattern's size.
    HybridDrape,
    /// Hybrid-GS with its gap map: the garment does not reach round the body, and the customer must see where.
    HybridGap,
}

impl Shown {
    /// Name in tables and reports, such as `FEM-GS drape`.
    pub fn words(self) -> &'static str {
        match self {
            Self::FemDrape => "FEM-GS drape",
            Self::HybridDrape => "Hybrid-GS drape",
            Self::HybridGap => "Hybrid-GS and its gap map",
        }
    }
}

/// Chooses the gap map for a garment smaller than the body, otherwise the drape of the recommended simulator.
pub fn shown(recommended: Simulator, is_undersized: bool) -> Shown {
    match (is_undersized, recommended) {
        (true, _) => Shown::HybridGap,
        (false, Simulator::Fem) => Shown::FemDrape,
        (false, Simulator::Hybrid) => Shown::HybridDrape,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_picture_follows_the_fit() {
        assert_eq!(shown(Simulator::Fem, false), Shown::FemDrape);
        assert_eq!(shown(Simulator::Hybrid, false), Shown::HybridDrape);
        assert_eq!(shown(Simulator::Fem, true), Shown::HybridGap);
    }
}
