use super::*;
use crate::Dimension;
use crate::testing::{Taken, in_mm, placed, png, silhouette};
use geom::V3;

fn reference() -> Option<std::path::PathBuf> {
    let folder = std::path::Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/bodies"));
    folder.is_dir().then(|| folder.to_path_buf())
}

#[test]
fn photographs_are_segmented_as_their_masks() {
    let Some(folder) = reference() else {
        eprintln!("skipped: no reference bodies beside the project");
        return;
    };
    let mut overlaps = Vec::new();
    for id in ["s01", "s02", "s03", "s04", "s05", "s06"] {
        for view in ["front", "side"] {
            let read = |end: &str| std::fs::read(folder.join(format!("photos/{id}_{view}{end}"))).expect("a picture");
            let found = person("front", &read(".jpg")).expect("a person");
            let truth = person("front", &read("_mask.png")).expect("a mask");
            let overlap = found.overlap(&truth);
            eprintln!("{id} {view}: {overlap:.4}");
            overlaps.push(overlap);
        }
    }
    let mean = overlaps.iter().sum::<f64>() / overlaps.len() as f64;
    let worst = overlaps.iter().copied().fold(1.0, f64::min);
    assert!(mean > 0.97 && worst > 0.93, "mean {mean:.4}, worst {worst:.4}");
}

#[test]
fn bad_pictures_are_refused_with_the_reason() {
    let png = |picture: &image::RgbImage| {
        let mut bytes = Cursor::new(Vec::new());
        picture.write_to(&mut bytes, image::ImageFormat::Png).expect("a PNG");
        bytes.into_inner()
    };
    let drawn = |boxes: &[[u32; 4]]| {
        let mut picture = image::RgbImage::from_pixel(600, 900, image::Rgb([90, 140, 200]));
        for &[x0, y0, x1, y1] in boxes {
            (y0..y1).flat_map(|y| (x0..x1).map(move |x| (x, y))).for_each(|(x, y)| {
                picture.put_pixel(x, y, image::Rgb([150, 90, 60]));
            });
        }
        png(&picture)
    };
    let check = |bytes: &[u8], needle: &str| {
        let error = from_pictures(bytes, bytes, None, Sex::Male, 1.75).expect_err(needle).to_string();
        assert!(error.contains(needle), "{error}");
    };
    check(b"", "the front picture is empty; accepted: JPEG or PNG");
    check(b"\0\0\0\x18ftypheic\0\0\0\0", "the front picture is HEIC; accepted: JPEG or PNG");
    check(b"RIFF\x10\0\0\0WEBPVP8 ", "the front picture is WebP");
    check(b"II*\0\x08\0\0\0", "the front picture is TIFF");
    check(b"GIF89a", "the front picture is GIF");
    check(b"hello", "the front picture is of no known picture format");
    check(b"\x89PNG\r\n\x1a\n", "cannot be read");
    check(&png(&image::RgbImage::new(1, 1)), "no person");
    check(&drawn(&[]), "no person");
    check(&drawn(&[[250, 500, 350, 900]]), "cut off");
    check(&drawn(&[[100, 100, 200, 800], [400, 100, 500, 800]]), "two figures");
    check(&drawn(&[[290, 300, 300, 330]]), "no person");
    check(&drawn(&[[280, 300, 380, 460]]), "only 160 pixels");
    check(&drawn(&[[100, 300, 500, 600]]), "no standing person");
    check(&drawn(&[[220, 100, 380, 800]]), "legs");
    // One block with a head and two legs: the arms cannot be told from it.
    check(
        &drawn(&[[270, 100, 330, 200], [200, 200, 400, 480], [200, 480, 280, 800], [320, 480, 400, 800]]),
        "arms touch",
    );
}

fn silhouettes(mesh: &geom::TriMesh, taken: Taken, size: [u32; 2]) -> [image::GrayImage; 2] {
    [false, true].map(|side| silhouette(mesh, side, taken, size))
}

#[test]
fn silhouettes_of_built_bodies_give_their_girths() {
    let people =
        [(Sex::Male, 1.70, 85.0), (Sex::Male, 1.84, 70.0), (Sex::Female, 1.56, 70.0), (Sex::Female, 1.68, 55.0)];
    let views = [
        (Taken::Orthographic(800.0), [1300, 1700], None, 20.0),
        (Taken::Perspective(2500.0, 3.2), [1200, 1800], Some(Camera::of_focal(2500.0, 1800, 3.2)), 20.0),
    ];
    for (taken, size, camera, limit) in views {
        let mut off: std::collections::BTreeMap<&str, Vec<f64>> = std::collections::BTreeMap::new();
        for (sex, stature_m, weight_kg) in people {
            let known = measured(sex, stature_m, weight_kg);
            let body = crate::build(&known).expect("an ordinary body");
            let [front, side] = silhouettes(&body.mesh, taken, size);
            let found = from_pictures(&png(&front), &png(&side), camera.as_ref(), sex, stature_m).expect("a person");
            let g = &body.girths;
            let truth = ["neck", "chest", "waist", "hip"].map(|level| in_mm(g, &format!("{level}_girth_mm")));
            for (level, truth) in found.levels.iter().zip(truth) {
                off.entry(level.name).or_default().push(level.girth_m * 1e3 - truth);
            }
        }
        for (name, errors) in off {
            let mean = errors.iter().map(|error| error.abs()).sum::<f64>() / errors.len() as f64;
            assert!(mean < limit, "{taken:?} {name}: {errors:.1?} mm, limit {limit}");
        }
    }
}

fn read_girths(front: &[u8], side: &[u8], sex: Sex, stature_m: f64) -> ([f64; 4], bool) {
    let found = from_pictures(front, side, None, sex, stature_m).expect("a person");
    assert!(!found.notes.iter().any(|note| note.contains("do not tell")), "{:?}", found.notes);
    let turned = found.notes.iter().any(|note| note.contains("faces its left"));
    (std::array::from_fn(|i| found.levels[i].girth_m * 1e3), turned)
}

fn check_mirrored(front: &[u8], side: &DynamicImage, sex: Sex, stature_m: f64) {
    let png = |picture: DynamicImage| {
        let mut bytes = Cursor::new(Vec::new());
        picture.write_to(&mut bytes, image::ImageFormat::Png).expect("a picture in memory");
        bytes.into_inner()
    };
    let (straight, turned) = read_girths(front, &png(side.clone()), sex, stature_m);
    assert!(!turned, "{sex:?} of {stature_m} m faces right");
    let (mirrored, turned) = read_girths(front, &png(side.fliph()), sex, stature_m);
    assert!(turned, "{sex:?} of {stature_m} m faces left");
    let off = straight.iter().zip(mirrored).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(off < 1.0, "{sex:?} of {stature_m} m: {straight:.1?}, mirrored {mirrored:.1?}");
}

#[test]
fn a_side_picture_that_faces_left_is_turned_and_gives_the_same_girths() {
    let women = [(1.52, 46.0), (1.60, 85.0), (1.68, 62.0), (1.80, 70.0)].map(|(h, w)| (Sex::Female, h, w));
    let men = [(1.62, 62.0), (1.70, 110.0), (1.78, 76.0), (1.96, 90.0)].map(|(h, w)| (Sex::Male, h, w));
    for (sex, stature_m, weight_kg) in women.into_iter().chain(men) {
        let body = crate::build(&measured(sex, stature_m, weight_kg)).expect("an ordinary body");
        for taken in [Taken::Orthographic(700.0), Taken::Perspective(1900.0, 3.0)] {
            let [front, side] = silhouettes(&body.mesh, taken, [1100, 1700]);
            check_mirrored(&png(&front), &side.into(), sex, stature_m);
        }
    }
}

#[test]
fn photographs_that_face_left_give_the_same_girths() {
    let Some(folder) = reference() else {
        eprintln!("skipped: no reference bodies beside the project");
        return;
    };
    let people = [1.6735, 1.7552, 1.8612, 1.5870, 1.6400, 1.6744].into_iter().zip(1..);
    for (stature_m, i) in people {
        let sex = if i < 4 { Sex::Male } else { Sex::Female };
        let read = |name: &str| std::fs::read(folder.join(format!("photos/s0{i}_{name}.jpg"))).expect("a picture");
        let side = image::load_from_memory(&read("side")).expect("a picture");
        check_mirrored(&read("front"), &side, sex, stature_m);
    }
    let case = folder.join("../cases/34-side-picture-facing-left");
    if case.is_dir() {
        let read = |name: &str| std::fs::read(case.join(name)).expect("a picture");
        let side = image::load_from_memory(&read("side.jpg")).expect("a picture");
        check_mirrored(&read("front.jpg"), &side, Sex::Female, 1.65);
    }
}

#[test]
fn a_side_picture_without_direction_is_said_to_have_none() {
    // A block with a round head: it has neither toes nor a back.
    let mut mask = Mask::new(300, 1000, vec![false; 300_000]);
    (100..900).flat_map(|y| (100..200).map(move |x| y * 300 + x)).for_each(|i| mask.bits[i] = true);
    let (same, said) = facing::to_the_right(mask.clone(), Sex::Male);
    assert!(same == mask && said.is_some_and(|said| said.contains("do not tell")));
}

fn measured(sex: Sex, stature_m: f64, weight_kg: f64) -> Measurements {
    Measurements::of(sex, stature_m).with(Dimension::Weight, weight_kg)
}

#[test]
fn tilted_and_mistaken_views_are_refused() {
    let body = crate::build(&measured(Sex::Male, 1.76, 72.0)).expect("an ordinary man");
    let [front, side] = silhouettes(&body.mesh, Taken::Orthographic(400.0), [900, 900]);
    let turned = |picture: &image::GrayImage, degrees: f64| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        image::GrayImage::from_fn(900, 900, |x, y| {
            let (dx, dy) = (f64::from(x) - 450.0, f64::from(y) - 450.0);
            let [u, v] = [dx * cos + dy * sin + 450.0, dy * cos - dx * sin + 450.0];
            let inside = (0.0..900.0).contains(&u) && (0.0..900.0).contains(&v);
            if inside { *picture.get_pixel(u as u32, v as u32) } else { image::Luma([0]) }
        })
    };
    let check = |front: &image::GrayImage, side: &image::GrayImage, needle: &str| {
        let error = from_pictures(&png(front), &png(side), None, Sex::Male, 1.76).expect_err(needle).to_string();
        assert!(error.contains(needle), "{error}");
    };
    check(&turned(&front, 5.0), &side, "front picture cannot be used: the figure leans by 5");
    check(&front, &turned(&side, -9.0), "the camera was tilted");
    check(&front, &front, "two legs are seen apart");
    check(&side, &side, "the legs are not apart");
    check(&turned(&front, 180.0), &side, "front picture");
}

#[test]
fn a_camera_that_looks_down_or_stands_elsewhere_is_doubted() {
    let body = crate::build(&measured(Sex::Male, 1.76, 72.0)).expect("an ordinary man");
    let (focal, distance, size) = (1900.0, 3.0, [1200, 1800]);
    // The camera of the silhouettes is 0.9 m high. The body is turned about it in place of the camera, the other way.
    let notes = |pitch_deg: f64, higher: f64, said_distance: f64| {
        let seen = |side: bool| {
            let eye = if side { V3::new(distance, 0.0, 0.9) } else { V3::new(0.0, distance, 0.9) };
            let axis = if side { V3::y_axis() } else { -V3::x_axis() };
            let turn = nalgebra::Rotation3::from_axis_angle(&axis, pitch_deg.to_radians());
            let mesh = placed(&body.mesh, |p| turn * (p - V3::z() * higher - eye) + eye);
            png(&silhouette(&mesh, side, Taken::Perspective(focal, distance), size))
        };
        let camera = Camera::of_focal(focal, 1800, said_distance);
        from_pictures(&seen(false), &seen(true), Some(&camera), Sex::Male, 1.76).expect("a person").notes
    };
    let doubted = |notes: &[String]| notes.iter().filter(|note| note.contains("looked up or down")).count();
    assert_eq!(doubted(&notes(0.0, 0.0, distance)), 0);
    assert_eq!(doubted(&notes(0.0, 0.4, distance)), 0);
    assert_eq!(doubted(&notes(0.0, 0.0, 1.06 * distance)), 2);
    // From above the head down at the middle of the body.
    let down = notes(16.0, 0.9, distance);
    assert_eq!(doubted(&down), 2, "{down:?}");
}

#[test]
fn a_picture_stands_as_its_orientation_says() {
    // A figure stored lying down, as a phone held upright stores it: its head is on the left.
    let mut lying = image::RgbImage::from_pixel(90, 40, image::Rgb([90, 140, 200]));
    (0..10).flat_map(|x| (15..25).map(move |y| (x, y))).for_each(|(x, y)| lying.put_pixel(x, y, image::Rgb([9, 9, 9])));
    let mut plain = Cursor::new(Vec::new());
    lying.write_to(&mut plain, image::ImageFormat::Jpeg).expect("a JPEG");
    let plain = plain.into_inner();
    let check = |tag: u8, size_of: (u32, u32), dark: (u32, u32)| {
        let exif = [&b"Exif\0\0II*\0\x08\0\0\0\x01\0\x12\x01\x03\0\x01\0\0\0"[..], &[tag, 0, 0, 0], &[0; 4]].concat();
        let length = u16::try_from(exif.len() + 2).expect("short").to_be_bytes();
        let tagged = [&plain[..2], &[0xff, 0xe1], &length, &exif, &plain[2..]].concat();
        assert_eq!(size("front", &tagged).expect("a picture"), size_of, "{tag}");
        let (decoder, orientation) = decoder("front", &tagged).expect("a picture");
        let mut picture = DynamicImage::from_decoder(decoder).expect("a picture");
        picture.apply_orientation(orientation);
        assert!(picture.to_luma8().get_pixel(dark.0, dark.1).0[0] < 60, "{tag}");
    };
    check(1, (90, 40), (5, 20));
    check(6, (40, 90), (20, 5));
    check(8, (40, 90), (20, 85));
    check(3, (90, 40), (85, 20));
}
