//! Grade rule tables, and piece information as CSV and XLSX.
#![no_main]

use libfuzzer_sys::fuzz_target;
use toile::pattern::{grade, info};

fuzz_target!(|bytes: &[u8]| {
    if let Ok(table) = grade::read(bytes, "a.rul") {
        assert!(table.rules.values().all(|steps| steps.len() == table.sizes.len()));
    }
    let _ = info::read(bytes, "a.csv");
});
