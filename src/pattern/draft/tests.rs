use super::curve::CURVE_SEGMENTS;
use super::*;
use crate::pattern::Style;
use crate::units::mm;

#[test]
fn the_nine_lengths_are_the_published_ones() {
    for size in TshirtSize::ALL {
        let style =
            Style::read(&tshirt(size).pieces, TSHIRT_SEAMS, "tshirt.seams.toml").expect("the drafted style is whole");
        for (measurement, expect) in style.measurements.iter().zip(size.published_mm()) {
            let found = mm(measurement.l2d_m);
            assert!((found - expect).abs() < 0.1, "{size:?} #{}: {found:.3} mm for {expect:.2}", measurement.no);
        }
        assert_eq!(style.measurements.len(), 9);
        assert!((mm(style.path_length_m(&style.fit_levels[0].1)) - size.published_mm()[0]).abs() < 0.1);
    }
}

#[test]
fn the_quickstart_study_holds_what_is_drafted() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/studies/quickstart/patterns");
    for (name, bytes) in tshirt_files() {
        let kept = std::fs::read(format!("{folder}/{name}")).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert!(kept == bytes, "{name} is not what is drafted now: run `toile pattern draft tshirt -o {folder}`");
    }
}

#[test]
fn the_drafted_files_sew_into_the_published_lengths() {
    for (size, (name, bytes)) in TshirtSize::ALL.into_iter().zip(tshirt_files()) {
        let file = dxf::read(&bytes, &name, None).expect("our own file reads");
        let style = Style::read(&file.pieces, TSHIRT_SEAMS, "tshirt.seams.toml").expect("it is a style");
        assert_eq!(style.size, size.as_str());
        for (measurement, expect) in style.measurements.iter().zip(size.published_mm()) {
            assert!((mm(measurement.l2d_m) - expect).abs() < 0.1, "{name} #{}", measurement.no);
        }
    }
}

#[test]
fn curves_meet_their_neighbours_as_a_pattern_maker_draws_them() {
    for size in TshirtSize::ALL {
        let body = Body::solve(&size.published_mm().map(from_mm));
        let along = |curve: &[V2], k: usize| (curve[k + 1] - curve[k]).normalize();
        let shoulder = (body.front_armhole[0] - body.front_neck[CURVE_SEGMENTS]).normalize();
        assert!((-shoulder.y).asin().to_degrees() - SHOULDER_SLOPE_DEG < 1e-6);
        for curve in [&body.front_armhole, &body.back_armhole] {
            assert!(along(curve, 0).dot(&shoulder).abs() < 0.05, "armhole square to the shoulder");
            assert!(along(curve, CURVE_SEGMENTS - 1).y.abs() < 0.05, "armhole square to the side");
        }
        for curve in [&body.front_neck, &body.back_neck] {
            assert!(along(curve, CURVE_SEGMENTS - 1).dot(&shoulder).abs() < 0.05, "neck square to the shoulder");
        }
        assert!(along(&body.back_neck, 0).y.abs() < 0.05, "back neck square to the centre");
        let width = mm(body.front_neck[CURVE_SEGMENTS].x);
        assert!((width - 80.0).abs() < 0.5, "{size:?}: half neck width {width}");
    }
}
