//! What is asked of results: reports, records, pictures, audits, advice.

pub mod advice;
pub mod audit;
pub mod doctor;
pub mod dressed;
pub mod figure;
pub mod fit_card;
pub mod laboratory;
pub mod picture;
pub mod population;
pub mod record;
pub mod reporting;
pub mod reports;
pub mod section;
pub mod size_map;
pub mod worn;
