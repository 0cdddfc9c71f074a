//! GarmentCode specifications and pattern features.
#![no_main]

use libfuzzer_sys::fuzz_target;
use toile::pattern::{features, garmentcode};

fuzz_target!(|bytes: &[u8]| {
    let _ = features::read(bytes, "a.json");
    if let Ok(specification) = garmentcode::read(bytes, "a.json") {
        assert_eq!(specification.style().pieces.len(), specification.pieces.len());
    }
});
