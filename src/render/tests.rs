use super::*;
use geom::{TriMesh, V2, V3};

/// A closed surface of revolution about `z` through (radius, z) profile points, bottom to top, bent by `shape`.
fn lathe(profile: &[(f64, f64)], around: usize, shape: impl Fn(V3) -> V3) -> TriMesh {
    let mut mesh = TriMesh::default();
    for &(r, z) in profile {
        for k in 0..around {
            let (s, c) = (std::f64::consts::TAU * k as f64 / around as f64).sin_cos();
            mesh.positions.push(shape(V3::new(r * c, r * s, z)));
        }
    }
    for ring in 0..profile.len() - 1 {
        for k in 0..around {
            let (a, b) = (ring * around + k, ring * around + (k + 1) % around);
            mesh.triangles.push([a, b, b + around]);
            mesh.triangles.push([a, b + around, a + around]);
        }
    }
    mesh
}

fn sphere(radius: f64, centre: V3) -> TriMesh {
    let profile: Vec<_> = (0..=32)
        .map(|i| (std::f64::consts::PI * (f64::from(i) / 32.0 - 0.5)).sin_cos())
        .map(|(s, c)| (radius * c, radius * s))
        .collect();
    lathe(&profile, 64, |p| p + centre)
}

fn dressed_capsule() -> (TriMesh, TriMesh) {
    let profile: Vec<_> = (0..=60)
        .map(|i| {
            let z = 1.7 * f64::from(i) / 60.0;
            let end = (z.min(1.7 - z) / 0.14).min(1.0);
            (0.14 * (1.0 - (1.0 - end).powi(2)).sqrt(), z)
        })
        .collect();
    let body = lathe(&profile, 60, |p| p);
    let tube: Vec<_> =
        (0..=60).map(|i| (0.145 + 0.09 * (1.0 - f64::from(i) / 60.0), 0.6 + 0.75 * f64::from(i) / 60.0)).collect();
    let flute = |p: V3| {
        let depth = 0.16 * ((1.35 - p.z) / 0.75);
        let factor = 1.0 + depth * (9.0 * p.y.atan2(p.x)).sin();
        V3::new(p.x * factor, p.y * factor, p.z)
    };
    (body, lathe(&tube, 160, flute))
}

fn rgb(picture: &RgbaImage, x: u32, y: u32) -> [i32; 3] {
    let p = picture.get_pixel(x, y).0;
    [i32::from(p[0]), i32::from(p[1]), i32::from(p[2])]
}

#[test]
fn the_subjects_right_is_at_the_pictures_left_from_the_front() {
    let right = sphere(0.2, V3::new(0.5, 0.0, 0.5));
    let left = sphere(0.2, V3::new(-0.5, 0.0, 0.5));
    let scene = Scene::new(vec![Layer::new(&right, Material::fem()), Layer::new(&left, Material::hybrid())]).unwrap();
    let frame = Frame::enclosing([&right, &left], 1.0);
    let check = |view: View, green_x: u32, blue_x: u32| {
        let picture = render(&scene, &Camera::new(view, frame), 120, 120).unwrap();
        let (green, blue) = (rgb(&picture, green_x, 60), rgb(&picture, blue_x, 60));
        assert!(green[1] > green[2] && blue[2] > blue[1], "{view:?}: {green:?} {blue:?}");
    };
    check(View::Front, 22, 98);
    check(View::Back, 98, 22);
}

#[test]
fn cloth_a_millimetre_over_skin_hides_it() {
    let body = sphere(0.300, V3::zeros());
    let cloth = sphere(0.301, V3::zeros());
    let scene = Scene::new(vec![
        Layer::new(&body, Material::skin(Rgb(0xdc, 0xb0, 0x94))),
        Layer::new(&cloth, Material::hybrid()),
    ])
    .unwrap();
    let picture = render(&scene, &Camera::new(View::Quarter, Frame::enclosing([&cloth], 1.0)), 200, 200).unwrap();
    let skin = picture.enumerate_pixels().filter(|(x, y, p)| {
        let inside = (f64::from(*x) - 99.5).hypot(f64::from(*y) - 99.5) < 82.0;
        inside && p[0] > p[2]
    });
    assert_eq!(skin.count(), 0);
}

#[test]
fn light_comes_from_above_left_and_hollows_are_darker() {
    let (body, cloth) = dressed_capsule();
    let ball = sphere(0.3, V3::zeros());
    let scene = Scene::new(vec![Layer::new(&ball, Material::form())]).unwrap();
    let picture = render(&scene, &Camera::new(View::Front, Frame::enclosing([&ball], 1.0)), 100, 100).unwrap();
    let grey = |x, y| rgb(&picture, x, y).iter().sum::<i32>();
    assert!(grey(32, 30) > grey(66, 68) + 60, "{} {}", grey(32, 30), grey(66, 68));

    let scene = Scene::new(vec![Layer::new(&body, Material::form()), Layer::new(&cloth, Material::fem())]).unwrap();
    let under_the_skirt =
        scene.openness[..body.positions.len()][60 * 24..60 * 25].iter().map(|o| o[0]).sum::<f32>() / 60.0;
    let bare = scene.openness[60 * 55..60 * 56].iter().map(|o| o[0]).sum::<f32>() / 60.0;
    assert!(bare > 0.9 && under_the_skirt < 0.5, "{bare} {under_the_skirt}");
}

#[test]
fn pictures_of_one_frame_share_their_scale() {
    let ball = sphere(0.25, V3::new(0.0, 0.0, 0.9));
    let frame = Frame { centre: V3::new(0.0, 0.0, 0.9), height_m: 1.0 };
    let scene = Scene::new(vec![Layer::new(&ball, Material::fem())]).unwrap();
    for view in View::ALL {
        let picture = render(&scene, &Camera::new(view, frame), 200, 200).unwrap();
        let green = (0..200).filter(|&x| rgb(&picture, x, 100)[1] > rgb(&picture, x, 100)[0] + 12).count();
        assert!((98..=102).contains(&green), "{view:?}: a ball of half a frame covers {green} of 200 pixels");
    }
}

#[test]
fn fields_colour_the_cloth_and_must_fit_it() {
    let ball = sphere(0.25, V3::zeros());
    let scale = Scale::diverging(1.0, 0.2, "stretch", "");
    let layer = |n: usize, value: f64| {
        Layer::new(&ball, Material::fem()).painted(Paint::Field(Values::Triangles(vec![value; n]), scale.clone()))
    };
    let camera = Camera::new(View::Front, Frame::enclosing([&ball], 1.0));
    let centre = |value| {
        let scene = Scene::new(vec![layer(ball.triangles.len(), value)]).unwrap();
        rgb(&render(&scene, &camera, 80, 80).unwrap(), 40, 40)
    };
    let (short, long) = (centre(0.8), centre(1.2));
    assert!(short[2] > short[0] && long[0] > long[2], "{short:?} {long:?}");
    assert!(matches!(Scene::new(vec![layer(3, 1.0)]), Err(RenderError::PaintLength { layer: 0, found: 3, .. })));
}

#[test]
fn a_scene_painted_anew_is_a_new_scene() {
    let (ball, cloth) = (sphere(0.25, V3::zeros()), sphere(0.251, V3::zeros()));
    let values =
        |value: f64| Paint::Field(Values::Vertices(vec![value; cloth.positions.len()]), Scale::rising(1.0, "", ""));
    let far = Material { recede_m: 0.02, ..Material::form() };
    let made = |form: Material, paint: Paint| {
        Scene::new(vec![Layer::new(&ball, form), Layer::new(&cloth, Material::fem()).painted(paint)]).unwrap()
    };
    let shot =
        |scene: &Scene| render(scene, &Camera::new(View::Front, Frame::enclosing([&ball], 1.0)), 60, 60).unwrap();
    let mut scene = made(Material::form(), Paint::Plain);
    scene.paint(0, far, Paint::Plain).unwrap();
    scene.paint(1, Material::fem(), values(0.7)).unwrap();
    assert_eq!(shot(&scene), shot(&made(far, values(0.7))));
    assert_ne!(shot(&scene), shot(&made(far, Paint::Plain)));
    let short = Paint::Field(Values::Vertices(vec![0.0; 3]), Scale::rising(1.0, "", ""));
    assert!(matches!(scene.paint(1, far, short), Err(RenderError::PaintLength { layer: 1, found: 3, .. })));
    assert!(matches!(scene.paint(2, far, Paint::Plain), Err(RenderError::NoSuchLayer { layer: 2, layers: 2 })));
}

/// A sheet of cloth in front of the camera, stretched by 5 % across its grain and compressed by 3 % along it.
#[test]
fn a_check_of_20_mm_measures_20_mm_along_warp_and_weft() {
    const SIDE: usize = 41;
    let rest: Vec<V2> = (0..SIDE * SIDE).map(|k| 0.01 * V2::new((k % SIDE) as f64, (k / SIDE) as f64)).collect();
    let positions = rest.iter().map(|p| V3::new(-1.05 * p.x, 0.0, 0.97 * p.y)).collect();
    let mut sheet = TriMesh { positions, triangles: vec![] };
    for corner in (0..SIDE - 1).flat_map(|row| (0..SIDE - 1).map(move |column| row * SIDE + column)) {
        sheet.triangles.push([corner, corner + 1, corner + SIDE + 1]);
        sheet.triangles.push([corner, corner + SIDE + 1, corner + SIDE]);
    }
    let woven = Mapping::Fabric { repeat_m: [0.04, 0.04] };
    let places = texture_coordinates(&rest, &[(0..rest.len(), V2::y(), woven)]);
    let of = vec![0; sheet.triangles.len()];
    let check = Paint::Printed(Print { textures: vec![Texture::gingham(Rgb(0, 60, 120))], of, places });
    let scene = Scene::new(vec![Layer::new(&sheet, Material::fem()).painted(check)]).unwrap();
    let frame = Frame { centre: V3::new(-0.21, 0.0, 0.194), height_m: 0.3 };
    let picture = render(&scene, &Camera { frame, azimuth_deg: 0.0, elevation_deg: 0.0 }, 600, 600).unwrap();
    // Half a millimetre to a pixel. Finds the places along a line of the picture where the check changes between light
    // and dark.
    let squares = |at: &dyn Fn(u32) -> [i32; 3]| {
        let values: Vec<i32> = (60..540).map(|k| at(k)[0]).collect();
        let middle = (values.iter().max().unwrap() + values.iter().min().unwrap()) / 2;
        let turns: Vec<f64> = values
            .windows(2)
            .enumerate()
            .filter(|(_, pair)| (pair[0] < middle) != (pair[1] < middle))
            .map(|(k, pair)| k as f64 + f64::from(middle - pair[0]) / f64::from(pair[1] - pair[0]))
            .collect();
        assert!(turns.len() > 8, "{turns:?}");
        turns.windows(2).map(|pair| 0.5 * (pair[1] - pair[0])).collect::<Vec<f64>>()
    };
    // Lines through the middle of a row and of a column of squares: 10 mm of cloth off the pattern's origin.
    let (across, down) = (300 + ((0.194 - 0.97 * 0.19) * 2000.0) as u32, 300 - ((0.21 - 1.05 * 0.19) * 2000.0) as u32);
    for (squares, mm) in [(squares(&|x| rgb(&picture, x, across)), 21.0), (squares(&|y| rgb(&picture, down, y)), 19.4)]
    {
        let mean = squares.iter().sum::<f64>() / squares.len() as f64;
        assert!((mean - mm).abs() < 0.1 && squares.iter().all(|s| (s - mm).abs() < 0.6), "{mm} mm: {squares:?}");
    }
}

/// Cloth wound around a cylinder without strain: squares look narrower at its sides, but are 20 mm along the cloth.
#[test]
fn a_check_on_a_cylinder_measures_20_mm_along_the_cloth() {
    const RADIUS: f64 = 0.15;
    const SIDE: usize = 61;
    // Places on the cloth, m, from its middle; the grain runs up.
    let rest: Vec<V2> =
        (0..SIDE * SIDE).map(|k| 0.006 * V2::new((k % SIDE) as f64 - 30.0, (k / SIDE) as f64)).collect();
    let wound = |p: &V2| V3::new(-RADIUS * (p.x / RADIUS).sin(), RADIUS * (p.x / RADIUS).cos(), p.y);
    let mut tube = TriMesh { positions: rest.iter().map(wound).collect(), triangles: vec![] };
    for corner in (0..SIDE - 1).flat_map(|row| (0..SIDE - 1).map(move |column| row * SIDE + column)) {
        tube.triangles.push([corner, corner + 1, corner + SIDE + 1]);
        tube.triangles.push([corner, corner + SIDE + 1, corner + SIDE]);
    }
    let woven = Mapping::Fabric { repeat_m: [0.04, 0.04] };
    let places = texture_coordinates(&rest, &[(0..rest.len(), V2::y(), woven)]);
    let of = vec![0; tube.triangles.len()];
    let check = Paint::Printed(Print { textures: vec![Texture::gingham(Rgb(0, 60, 120))], of, places });
    let scene = Scene::new(vec![Layer::new(&tube, Material::fem()).painted(check)]).unwrap();
    let frame = Frame { centre: V3::new(0.0, 0.0, 0.19), height_m: 0.3 };
    let picture = render(&scene, &Camera { frame, azimuth_deg: 0.0, elevation_deg: 0.0 }, 600, 600).unwrap();
    // A line through the middle of a row of squares, half a millimetre a pixel, as far as 50 degrees to both sides.
    let reach = (0.15 * 50f64.to_radians().sin() * 2000.0) as u32;
    let values: Vec<(f64, i32)> =
        (300 - reach..300 + reach).map(|x| ((f64::from(x) + 0.5 - 300.0) / 2000.0, rgb(&picture, x, 300)[2])).collect();
    let turns: Vec<f64> = values
        .windows(9)
        .filter_map(|near| {
            // Light decreases around the cylinder, so a turn is where the colour changes fast, and not where it passes
            // a level.
            let steps: Vec<i32> = near.windows(2).map(|pair| (pair[1].1 - pair[0].1).abs()).collect();
            let greatest = *steps.iter().max()?;
            (greatest > 8 && steps[3] == greatest && steps[..3].iter().all(|s| *s < greatest))
                .then(|| RADIUS * (0.5 * (near[3].0 + near[4].0) / RADIUS).asin())
        })
        .collect();
    assert!(turns.len() >= 11, "{turns:?}");
    let squares: Vec<f64> = turns.windows(2).map(|pair| 1e3 * (pair[1] - pair[0])).collect();
    let mean = squares.iter().sum::<f64>() / squares.len() as f64;
    assert!((mean - 20.0).abs() < 0.15 && squares.iter().all(|s| (s - 20.0).abs() < 1.2), "{squares:?}");
}

#[test]
fn broken_meshes_and_sizes_are_refused() {
    let mesh = TriMesh { positions: vec![V3::zeros(); 3], triangles: vec![[0, 1, 7]] };
    assert!(matches!(
        Scene::new(vec![Layer::new(&mesh, Material::fem())]),
        Err(RenderError::NoSuchVertex { vertex: 7, .. })
    ));
    let mesh = TriMesh { positions: vec![V3::new(f64::NAN, 0.0, 0.0)], triangles: vec![] };
    assert!(matches!(
        Scene::new(vec![Layer::new(&mesh, Material::fem())]),
        Err(RenderError::NotFinite { vertex: 0, .. })
    ));
    let empty = Scene::new(vec![]).unwrap();
    let camera = Camera::new(View::Front, Frame::enclosing([], 1.0));
    assert!(matches!(render(&empty, &camera, 0, 5), Err(RenderError::Size { .. })));
    assert_eq!(render(&empty, &camera, 5, 7).unwrap().dimensions(), (5, 7));
    assert!(contact_sheet("none", &[], 4).is_err());
    assert!(rasterise_svg("<p>", 1.0).is_err());
    // What the embedded fonts lack is told.
    let letters = "<svg xmlns='http://www.w3.org/2000/svg' width='40' height='20'><text y='15'>a\u{e9}\u{439}\u{7532}</text></svg>";
    rasterise_svg(letters, 1.0).expect("a drawing");
    let lacking = lacking_letters();
    assert_eq!(
        ['a', '\u{e9}', '\u{439}', '\u{7532}'].map(|letter| lacking.contains(&letter)),
        [false, false, false, true]
    );
}

#[test]
fn scales_are_monotonic_in_lightness_and_readable_without_colour() {
    let luminance = |map: ColourMap, i: i32| map.at(f64::from(i) / 20.0).luminance();
    assert!((1..=20).all(|i| luminance(ColourMap::Sequential, i) > luminance(ColourMap::Sequential, i - 1)));
    assert!((1..=10).all(|i| luminance(ColourMap::Diverging, i) > luminance(ColourMap::Diverging, i - 1)));
    assert!((11..=20).all(|i| luminance(ColourMap::Diverging, i) < luminance(ColourMap::Diverging, i - 1)));
    assert_eq!(Scale::sequential(0.0, 1.0, "", "").colour(f64::NAN), Rgb(0x9a, 0x9a, 0x9a));
}

#[test]
fn sheets_and_legends_draw_text() {
    let blank = RgbaImage::from_pixel(300, 400, image::Rgba([255; 4]));
    let cell = |label: &str| Cell { picture: blank.clone(), label: label.into() };
    let sheet = contact_sheet("A < B & C", &[cell("front"), cell("side"), cell("back")], 2).unwrap();
    assert!(sheet.width() > 600 && sheet.height() > 800);
    assert!(sheet.pixels().any(|p| p[0] < 80), "labels leave ink");
    let mut picture = blank;
    draw_legend(&mut picture, &Scale::sequential(0.0, 30.0, "gap", "mm")).unwrap();
    let ink = |picture: &RgbaImage| picture.pixels().filter(|p| p.0 != [255; 4]).count();
    assert!(ink(&picture) > 500);
    assert_eq!(image::load_from_memory(&png(&picture).unwrap()).unwrap().to_rgba8(), picture);
    assert_eq!(image::load_from_memory(&jpeg(&picture).unwrap()).unwrap().width(), 300);
}

#[test]
fn reference_bodies_render() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/bodies/meshes");
    let Ok(bytes) = std::fs::read(format!("{folder}/s01.obj")) else {
        eprintln!("skipped: {folder} is not here");
        return;
    };
    let options = tobj::LoadOptions { triangulate: true, single_index: true, ..Default::default() };
    let (models, _) = tobj::load_obj_buf(&mut bytes.as_slice(), &options, |_| Ok(Default::default())).unwrap();
    let mut body = TriMesh::default();
    for model in models {
        let first = body.positions.len();
        body.positions
            .extend(model.mesh.positions.chunks(3).map(|p| V3::new(p[0].into(), p[1].into(), p[2].into()) * 0.01));
        body.triangles.extend(model.mesh.indices.chunks(3).map(|t| [0, 1, 2].map(|k| t[k] as usize + first)));
    }
    let (low, high) = body.bounds().unwrap();
    assert!((1.4..2.1).contains(&(high.z - low.z)), "{low:?} to {high:?}");
    let scene = Scene::new(vec![Layer::new(&body, Material::form())]).unwrap();
    let picture = render(&scene, &Camera::new(View::Front, Frame::enclosing([&body], 0.5)), 100, 200).unwrap();
    let covered = picture.pixels().filter(|p| i32::from(p[0]) - i32::from(p[2]) > 8).count();
    assert!((2000..12000).contains(&covered), "{covered} of 20000 pixels show the body");
}
