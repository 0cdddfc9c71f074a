//! The tag reader of DXF, the guard and the pieces made of what they let through.
#![no_main]

use libfuzzer_sys::fuzz_target;
use toile::pattern::dxf::{self, Unit};

fuzz_target!(|bytes: &[u8]| {
    let Ok(file) = dxf::read(bytes, "a.dxf", Some(Unit::Mm)) else { return };
    for piece in &file.pieces {
        assert!(piece.area_m2() > 0.0 && piece.perimeter_m().is_finite());
        assert!(piece.unfolded().is_none_or(|whole| whole.area_m2() > 0.0));
    }
});
