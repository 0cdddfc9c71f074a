//! Queries on results: pictures, sections, fit cards, records, audits, recommendations, reports.

pub mod audit;
pub mod doctor;
pub mod draped_fit;
pub mod dressed;
pub mod figure;
pub mod fit_card;
pub mod laboratory;
pub mod picture;
pub mod preview;
pub mod recommendation;
pub mod record;
pub mod reporting;
pub mod reports;
pub mod section;
pub mod size_map;

pub use audit::{Audit, Finding};
pub use doctor::{Check, checks};
pub use draped_fit::{Balance, DrawnOpening, FoldLine, GarmentWorn, LevelGap, RegionPressure, SizeWorn, WornPoint};
pub use dressed::{Dressed, Tally, tally};
pub use figure::Figure;
pub use fit_card::{FitCard, LevelSits, Sits, SizeSits};
pub use laboratory::laboratory;
pub use picture::{Cloth, Look, Map, Order, Shot, Zoom};
pub use record::{ChiPair, Comparison, ProvenanceRow, Record, Rerun};
pub use reports::{ReportRow, reports};
pub use section::{CrossSection, CutAt, CutCloth, CutLine};
