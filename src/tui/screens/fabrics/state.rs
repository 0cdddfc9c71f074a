//! State of the Fabrics screen.

use crate::screens::marks::Marks;
use crate::screens::order::Order;

/// Indices into [`spec::FABRIC_NUMBERS`] of the numbers in the list.
pub const FABRIC_SHOWN: [usize; 7] = [0, 1, 2, 3, 5, 6, 7];

/// Factors by which these numbers are multiplied for reading: g/m², mm, N/m, µN m.
pub const FACTORS: [f64; FABRIC_SHOWN.len()] = [1e3, 1.0, 1.0, 1.0, 1.0, 1e6, 1e6];

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum FabricOrder {
    #[default]
    Name,
    /// By the number at an index of [`FABRIC_SHOWN`], the smallest first.
    Number(usize),
}

impl FabricOrder {
    pub fn next(self) -> Self {
        match self {
            Self::Name => Self::Number(0),
            Self::Number(k) if k + 1 < FABRIC_SHOWN.len() => Self::Number(k + 1),
            Self::Number(_) => Self::Name,
        }
    }
}

#[derive(Default)]
pub struct FabricsScreen {
    pub chosen: Option<String>,
    /// True once the user has gone to the chosen fabric.
    pub is_picked: bool,
    pub marks: Marks<String>,
    pub order: Order<FabricOrder>,
}
