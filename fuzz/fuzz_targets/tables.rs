//! Grade rule tables, and piece information and specification sheets as CSV and XLSX.
#![no_main]

use libfuzzer_sys::fuzz_target;
use toile::pattern::spec_sheet::{self, SheetAsked};
use toile::pattern::{grade, info};

fuzz_target!(|bytes: &[u8]| {
    if let Ok(table) = grade::read(bytes, "a.rul") {
        assert!(table.rules.values().all(|steps| steps.len() == table.sizes.len()));
    }
    let _ = info::read(bytes, "a.csv");
    let _ = spec_sheet::read(bytes, "a.csv", &[], SheetAsked::default());
});
