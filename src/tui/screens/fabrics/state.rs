//! State of the Fabrics screen.

use crate::screens::marks::Marks;
use crate::screens::order::Order;

/// Numbers in the list, as indices into [`spec::FABRIC_NUMBERS`].
pub const FABRIC_SHOWN: [usize; 7] = [0, 1, 2, 3, 5, 6, 7];

/// Factors by which these numbers are multiplied for reading: g/m², mm, N/m, µN m.
pub const FACTORS: [f64; FABRIC_SHOWN.len()] = [1e3, 1.0, 1.0, 1.0, 1.0, 1e6, 1e6];

/// Order of the list.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum FabricOrder {
    /// By name, alphabetically.
    #[default]
    Name,
    /// By the number at an index of [`FABRIC_SHOWN`], the smallest first.
    Number(usize),
}

impl FabricOrder {
    /// Order after this one, for the key that sorts.
    pub fn next(self) -> Self {
        match self {
            Self::Name => Self::Number(0),
            Self::Number(k) if k + 1 < FABRIC_SHOWN.len() => Self::Number(k + 1),
            Self::Number(_) => Self::Name,
        }
    }
}

/// The Fabrics screen.
#[derive(Default)]
pub struct FabricsScreen {
    /// Name of the chosen fabric.
    pub chosen: Option<String>,
    /// True once the user has gone to the chosen fabric.
    pub is_picked: bool,
    /// Names of the marked fabrics.
    pub marks: Marks<String>,
    /// Order of the list.
    pub order: Order<FabricOrder>,
}
