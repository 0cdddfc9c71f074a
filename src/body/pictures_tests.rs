use super::*;

/// The reference bodies beside the project, where they are.
fn reference() -> Option<std::path::PathBuf> {
    let folder = std::path::Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/bodies"));
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
    check(b"", "cannot be read");
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
