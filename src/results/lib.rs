//! Queries on results: pictures, sections, fit cards, records, audits, recommendations, reports.

pub mod assessment;
pub mod audit;
pub mod cross_section;
mod doctor;
pub mod dressed;
mod error;
pub mod figure;
pub mod fit_card;

pub mod picture;
pub mod preview;
mod recommendation;
pub mod record;
pub mod reporting;
pub mod reports;
pub mod scatter;

pub mod size_map;

pub use assessment::{Balance, DrawnOpening, FoldLine, GarmentWorn, LevelGap, RegionPressure, SizeWorn, WornPoint};
pub use audit::{Audit, Finding};
pub use cross_section::{CrossSection, CutAt, CutCloth, CutLine};
pub use doctor::{Check, checks};
pub use dressed::{Dressed, Tally, tally};
pub use figure::Figure;
pub use fit_card::{FitCard, LevelSits, Sits, SizeSits};

pub use picture::{Cloth, Look, Map, Order, Shot, Zoom};
pub use record::{ChiPair, Comparison, ProvenanceRow, Record, Rerun};
pub use reports::{ReportRow, reports};
