//! Numbers of a fabric in the units of laboratories and other programs: KES-F, FAST, a cantilever, CLO. Each is
//! converted, as it is read, to a number of [`FABRIC_NUMBERS`](crate::fields::FABRIC_NUMBERS).

use std::sync::LazyLock;

use crate::entry::{Field, Sheet};
use geom::units::{GRAVITY, from_mm};
use sim::Fabric;

const GRAM_FORCE_N: f64 = 1e-3 * GRAVITY;

/// Secant modulus, N/m: membrane stress divided by Green strain, for a strip that a force per width, N/m, stretches by
/// a percentage.
fn modulus_n_m(pull_n_m: f64, stretch_pct: f64) -> f64 {
    let stretch = stretch_pct / 100.0;
    pull_n_m / ((1.0 + stretch) * stretch * (1.0 + 0.5 * stretch))
}

/// Makes a sheet. The conversion takes the number and the fabric, whose areal density is set by then.
macro_rules! sheet {
    ($key:literal, $label:literal, $range:expr, $field:ident, $convert:expr) => {{
        let convert: fn(f64, &Fabric) -> f64 = $convert;
        Sheet {
            field: Field {
                key: $key,
                label: $label,
                is_required: false,
                range: $range,
                get: Box::new(|_: &Fabric| None),
                set: Box::new(move |fabric: &mut Fabric, value| {
                    fabric.$field = value.map_or(f64::NAN, |value| convert(value, fabric));
                }),
            },
            key: stringify!($field),
        }
    }};
}

/// All sheets. Those of the areal density come first, since later conversions use it.
pub static FABRIC_SHEETS: LazyLock<Vec<Sheet<Fabric>>> = LazyLock::new(|| {
    vec![
        sheet!("weight_g_m2", "areal density", 5.0..=5000.0, density_kg_m2, |w, _| 1e-3 * w),
        sheet!("weight_mg_cm2", "areal density, KES W", 0.5..=500.0, density_kg_m2, |w, _| 1e-2 * w),
        sheet!("bending_warp_gf_cm2_cm", "bending, KES B", 1e-5..=1e3, bending_warp_nm, |b, _| b * 1e-2 * GRAM_FORCE_N),
        sheet!("bending_weft_gf_cm2_cm", "bending, KES B", 1e-5..=1e3, bending_weft_nm, |b, _| b * 1e-2 * GRAM_FORCE_N),
        sheet!(
            "bending_length_warp_mm",
            "bending length, FAST-2 or a cantilever",
            1.0..=200.0,
            bending_warp_nm,
            rigidity_nm
        ),
        sheet!(
            "bending_length_weft_mm",
            "bending length, FAST-2 or a cantilever",
            1.0..=200.0,
            bending_weft_nm,
            rigidity_nm
        ),
        sheet!("bending_warp_g_mm2_s2", "bending, CLO", 1.0..=1e8, bending_warp_nm, |b, _| 1e-9 * b),
        sheet!("bending_weft_g_mm2_s2", "bending, CLO", 1.0..=1e8, bending_weft_nm, |b, _| 1e-9 * b),
        sheet!("emt_warp_pct", "stretch at 500 gf/cm, KES", 0.05..=200.0, membrane_warp_n_m, at_500),
        sheet!("emt_weft_pct", "stretch at 500 gf/cm, KES", 0.05..=200.0, membrane_weft_n_m, at_500),
        sheet!("e100_warp_pct", "stretch at 100 gf/cm, FAST-3", 0.05..=200.0, membrane_warp_n_m, at_100),
        sheet!("e100_weft_pct", "stretch at 100 gf/cm, FAST-3", 0.05..=200.0, membrane_weft_n_m, at_100),
        sheet!("stretch_warp_g_s2", "stretch, CLO", 1e3..=1e9, membrane_warp_n_m, |k, _| 1e-3 * k),
        sheet!("stretch_weft_g_s2", "stretch, CLO", 1e3..=1e9, membrane_weft_n_m, |k, _| 1e-3 * k),
        sheet!("shear_gf_cm_deg", "shear, KES G", 0.005..=1e3, shear_n_m, |g, _| {
            g * 1e2 * GRAM_FORCE_N / 1.0_f64.to_radians()
        }),
        sheet!("eb5_pct", "bias extension at 5 gf/cm, FAST-3", 0.01..=200.0, shear_n_m, |e, _| 123.0 / e),
        sheet!("shear_g_s2", "shear, CLO", 1e2..=1e9, shear_n_m, |k, _| 1e-3 * k),
    ]
});

fn rigidity_nm(length_mm: f64, fabric: &Fabric) -> f64 {
    fabric.density_kg_m2 * GRAVITY * from_mm(length_mm).powi(3)
}

fn at_500(stretch_pct: f64, _: &Fabric) -> f64 {
    modulus_n_m(500.0 * 1e2 * GRAM_FORCE_N, stretch_pct)
}

fn at_100(stretch_pct: f64, _: &Fabric) -> f64 {
    modulus_n_m(100.0 * 1e2 * GRAM_FORCE_N, stretch_pct)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::entry::{Entry, Given, filled};
    use crate::fields::FABRIC_NUMBERS;

    fn given(pairs: &[(&str, &str)]) -> Vec<Given> {
        pairs.iter().map(|(key, text)| ((*key).to_owned(), (*text).to_owned())).collect()
    }

    const REST: [(&str, &str); 3] = [("thickness_mm", "0.4"), ("friction_body", "0.3"), ("friction_self", "0.5")];

    #[test]
    fn sheets_are_the_published_conversions() {
        let check = |key: &str, value: &str, of: &str, expect: f64| {
            let mut fabric = Fabric { density_kg_m2: 0.168, ..Fabric::blank("wool") };
            let sheet = FABRIC_SHEETS.iter().find(|sheet| sheet.field.key == key).expect("a sheet's");
            assert_eq!(sheet.key, of);
            sheet.field.set(&mut fabric, sheet.field.read(value).expect("a number"));
            let field = FABRIC_NUMBERS.iter().find(|field| field.key == of).expect("a fabric's");
            let found = field.get(&fabric).expect("set");
            assert!((found / expect - 1.0).abs() < 1e-3, "{key}: {found}, not {expect}");
        };
        check("bending_warp_gf_cm2_cm", "1", "bending_warp_nm", 9.80665e-5);
        check("shear_gf_cm_deg", "1", "shear_n_m", 56.19);
        check("bending_length_warp_mm", "15", "bending_warp_nm", 5.56e-6);
        check("eb5_pct", "4.7", "shear_n_m", 26.17);
        check("weight_mg_cm2", "12.4", "density_kg_m2", 0.124);
        check("weight_g_m2", "168", "density_kg_m2", 0.168);
        // At a small stretch the modulus is nearly the pull divided by the stretch.
        check("e100_weft_pct", "0.1", "membrane_weft_n_m", 98.0665 / 0.001 / 1.0015);
        check("emt_warp_pct", "0.1", "membrane_warp_n_m", 490.3325 / 0.001 / 1.0015);
        check("bending_weft_g_mm2_s2", "1000", "bending_weft_nm", 1e-6);
        check("stretch_warp_g_s2", "250000", "membrane_warp_n_m", 250.0);
    }

    #[test]
    fn a_sheet_stands_for_what_is_required_and_not_beside_it() {
        let sheet = [
            ("weight_g_m2", "168"),
            ("bending_length_warp_mm", "15"),
            ("bending_length_weft_mm", "14.5"),
            ("e100_warp_pct", "4.6"),
            ("e100_weft_pct", "5.9"),
            ("eb5_pct", "4.7"),
        ];
        let fabric = filled::<Fabric>(None, "wool", &given(&[&sheet[..], &REST].concat())).expect("complete");
        assert!((fabric.density_kg_m2 - 0.168).abs() < 1e-12 && (fabric.bending_warp_nm / 5.56e-6 - 1.0).abs() < 1e-2);
        let problems = |pairs: &[(&str, &str)]| {
            let found = filled::<Fabric>(None, "wool", &given(pairs)).expect_err("a problem");
            found.into_iter().map(|(_, problem)| problem).collect::<Vec<_>>().join("\n")
        };
        let twice = problems(&[&sheet[..], &REST, &[("density_kg_m2", "0.17")]].concat());
        assert!(twice.contains("`weight_g_m2`") && twice.contains("`density_kg_m2`"), "{twice}");
        let lacking = problems(&[&sheet[1..], &REST].concat());
        assert!(lacking.contains("`density_kg_m2` is missing"), "{lacking}");
        let absurd = problems(&[&sheet[..5], &REST, &[("eb5_pct", "none")]].concat());
        assert!(absurd.contains("eb5_pct"), "{absurd}");
    }
}
