//! State of the screen of fabrics.

use crate::screens::order::Order;

/// Numbers in the list of fabrics, by their places in [`spec::FABRIC_NUMBERS`].
pub const FABRIC_SHOWN: [usize; 7] = [0, 1, 2, 3, 5, 6, 7];

/// Order of fabrics.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum FabricOrder {
    /// By name, alphabetically.
    #[default]
    Name,
    /// By a number of [`FABRIC_SHOWN`], the smallest first.
    Number(usize),
}

impl FabricOrder {
    /// The order that `sort` comes to next.
    #[must_use]
    pub fn next(self) -> Self {
        match self {
            Self::Name => Self::Number(0),
            Self::Number(k) if k + 1 < FABRIC_SHOWN.len() => Self::Number(k + 1),
            Self::Number(_) => Self::Name,
        }
    }
}

/// The screen of fabrics.
#[derive(Default)]
pub struct FabricsScreen {
    /// Name of the fabric chosen.
    pub chosen: Option<String>,
    /// Order of fabrics.
    pub order: Order<FabricOrder>,
}
