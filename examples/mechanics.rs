//! The experiments of `docs/mechanics.md`: prints its tables and, given a folder, draws its pictures there.
//!
//! `cargo run --release -p examples --bin mechanics docs`

#![allow(clippy::print_stdout, reason = "an example speaks to whoever runs it")]

use std::error::Error;
use std::path::Path;

use plotters::prelude::*;
use plotters::style::register_font;
use toile::geom::{DistanceField, shapes};
use toile::sim::Fabric;
use toile::sim::fabric;
use toile::sim::laboratory::bench::measured_drape;
use toile::sim::laboratory::bending::{Mesh, cantilever, elastica, lateral_buckling};
use toile::sim::laboratory::drape::{cusick, over_sphere};
use toile::sim::laboratory::isotropic;

type Outcome = Result<(), Box<dyn Error>>;

/// A named series of points, and whether it is drawn as a line or as dots.
struct Series {
    name: String,
    points: Vec<(f64, f64)>,
    is_line: bool,
}

fn main() -> Outcome {
    let folder = std::env::args().nth(1);
    let folder = folder.as_deref().map(Path::new);
    register_font("sans-serif", FontStyle::Normal, dejavu::sans::regular()).map_err(|_| "the font cannot be read")?;
    bending(folder)?;
    refinement()?;
    buckling()?;
    knits(folder)?;
    drape(folder)?;
    sphere()
}

fn bending(folder: Option<&Path>) -> Outcome {
    let gammas: Vec<f64> = (-4..=6).map(|k| 10.0_f64.powf(f64::from(k) / 2.0)).collect();
    let meshes = [("squares", Mesh::Squares), ("hexagons", Mesh::Hexagons), ("irregular", Mesh::Irregular)];
    let exact: Vec<f64> = gammas.iter().map(|g| elastica(*g)).collect();
    let mut series = vec![Series {
        name: "elastica".to_owned(),
        points: gammas.iter().copied().zip(exact.iter().copied()).collect(),
        is_line: true,
    }];
    println!("cantilever, 96 rows: drop over reach, error in %\n gamma       elastica   squares  hexagons  irregular");
    let mut errors = vec![Vec::new(); gammas.len()];
    for (name, mesh) in meshes {
        let results = cantilever(mesh, 96, &gammas)?;
        for ((row, exact), (drop, _)) in errors.iter_mut().zip(&exact).zip(&results) {
            row.push(100.0 * (drop / exact - 1.0));
        }
        series.push(Series {
            name: name.to_owned(),
            points: gammas.iter().copied().zip(results.iter().map(|r| r.0)).collect(),
            is_line: false,
        });
    }
    for ((gamma, exact), row) in gammas.iter().zip(&exact).zip(&errors) {
        println!("{gamma:9.3} {exact:12.6} {:9.2} {:9.2} {:9.2}", row[0], row[1], row[2]);
    }
    draw(folder, "mechanics-cantilever.png", "gamma = w g L³ / B", "drop / reach", &series, true)
}

fn refinement() -> Outcome {
    println!("\ncantilever at gamma 10: error in % against rows, and order");
    let exact = elastica(10.0);
    let mut last: Option<f64> = None;
    for rows in [8, 16, 32, 64] {
        let drop = cantilever(Mesh::Hexagons, rows, &[10.0])?[0].0;
        let error = (drop / exact - 1.0).abs();
        let order = last.map_or(String::new(), |l| format!("{:.2}", (l / error).log2()));
        println!("{rows:4} {:9.4} {order}", 100.0 * error);
        last = Some(error);
    }
    Ok(())
}

fn buckling() -> Outcome {
    println!("\nlateral buckling, width L / 20: critical gamma by triangles across; beam theory 18.18");
    for columns in [1, 2, 3, 4] {
        println!("{columns:4} {:8.2}", lateral_buckling(columns)?);
    }
    Ok(())
}

fn knits(folder: Option<&Path>) -> Outcome {
    println!("\nknits: pull (N/m) of a strip along the warp at 5, 10, 17, 25 % stretch");
    let mut series = Vec::new();
    for fabric in fabric::library().into_iter().filter(|f| f.stretched.is_some()) {
        let pull = |stretch: f64| fabric.warp_law().stress(stretch * (1.0 + 0.5 * stretch)) * (1.0 + stretch);
        let at = [0.05, 0.10, 0.17, 0.25].map(pull);
        println!("{:20} {:7.1} {:7.1} {:7.1} {:7.1}", fabric.name, at[0], at[1], at[2], at[3]);
        let points = (0..=50).map(|k| f64::from(k) * 0.005).map(|s| (100.0 * s, pull(s))).collect();
        if fabric.membrane_warp_n_m < 1000.0 {
            series.push(Series { name: fabric.name.clone(), points, is_line: true });
        }
    }
    draw(folder, "mechanics-knits.png", "stretch along the warp, %", "pull, N/m", &series, false)
}

fn drape(folder: Option<&Path>) -> Outcome {
    println!("\nCusick, 30 cm over 18 cm: bending length mm, coefficient % (measured), nodes, residual");
    let library = fabric::library();
    let length_mm = |f: &Fabric| {
        let [warp, weft] = f.bending_lengths_m();
        1e3 * (warp * weft).sqrt()
    };
    let mut points = Vec::new();
    let mut published = Vec::new();
    for f in &library {
        let draped = cusick(f, 24, 0)?;
        let known = measured_drape(&f.name);
        let known_text = known.map_or(String::new(), |k| format!("({k})"));
        let (length, percent) = (length_mm(f), 100.0 * draped.coefficient);
        println!("{:22} {length:6.1} {percent:6.1} {known_text:7} {:3} {:.3}", f.name, draped.nodes, draped.residual);
        if f.name != "thesis_10" {
            points.push((length, percent));
            published.extend(known.map(|k| (length, k)));
        }
    }
    let series = [
        Series { name: "simulated, library".to_owned(), points, is_line: false },
        Series { name: "measured".to_owned(), points: published, is_line: false },
    ];
    draw(folder, "mechanics-cusick.png", "bending length, mm", "drape coefficient, %", &series, false)
}

fn sphere() -> Outcome {
    let field = DistanceField::build(&shapes::sphere(0.3, 64), 0.01)?;
    let fabric = isotropic(0.2, 500.0, 1e-5);
    let start = cpu_s();
    let done = over_sphere(&fabric, &field)?;
    let spent = cpu_s() - start;
    println!("\nsheet over sphere: {} steps, residual {:.4}, {spent:.2} s CPU", done.steps, done.residual);
    Ok(())
}

/// User time of this process, s; 0 where the system does not tell.
fn cpu_s() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let ticks = stat.rsplit(')').next().and_then(|rest| rest.split_whitespace().nth(11)).map(str::parse::<f64>);
    ticks.and_then(Result::ok).unwrap_or(0.0) / 100.0
}

/// Draws series on linear or logarithmic axes.
fn draw(folder: Option<&Path>, file: &str, x_name: &str, y_name: &str, series: &[Series], is_log: bool) -> Outcome {
    let Some(folder) = folder else { return Ok(()) };
    let mut pixels = vec![0; 3 * 900 * 560];
    let area = BitMapBackend::with_buffer(&mut pixels, (900, 560)).into_drawing_area();
    area.fill(&WHITE)?;
    let all = || series.iter().flat_map(|s| &s.points);
    let range = |value: fn(&(f64, f64)) -> f64| {
        let (low, high) = all().map(value).fold((f64::MAX, f64::MIN), |(l, h), v| (l.min(v), h.max(v)));
        if is_log { low / 1.5..high * 1.5 } else { (low - 0.05 * (high - low)).min(0.0)..high + 0.05 * (high - low) }
    };
    let (x, y) = (range(|p| p.0), range(|p| p.1));
    let mut builder = ChartBuilder::on(&area);
    builder.margin(16).x_label_area_size(52).y_label_area_size(74);
    macro_rules! paint {
        ($chart:expr) => {{
            let mut chart = $chart;
            chart.configure_mesh().x_desc(x_name).y_desc(y_name).label_style(("sans-serif", 17)).draw()?;
            for (index, s) in series.iter().enumerate() {
                let ink = Palette99::pick(index).to_rgba();
                let points = s.points.iter().copied();
                if s.is_line {
                    let legend = move |(x, y)| PathElement::new([(x, y), (x + 18, y)], ink.stroke_width(2));
                    chart.draw_series(LineSeries::new(points, ink.stroke_width(2)))?.label(&s.name).legend(legend);
                } else {
                    let radius = 4 + 2 * index as i32;
                    let dot = |at| Circle::new(at, radius, ink.stroke_width(2));
                    let legend = move |(x, y)| Circle::new((x + 9, y), 5, ink.stroke_width(2));
                    chart.draw_series(points.map(dot))?.label(&s.name).legend(legend);
                }
            }
            let mut labels = chart.configure_series_labels();
            labels
                .position(SeriesLabelPosition::UpperLeft)
                .background_style(WHITE)
                .border_style(BLACK.mix(0.3))
                .label_font(("sans-serif", 17))
                .draw()?;
        }};
    }
    if is_log {
        paint!(builder.build_cartesian_2d(x.log_scale(), y.log_scale())?);
    } else {
        paint!(builder.build_cartesian_2d(x, y)?);
    }
    area.present()?;
    drop(area);
    let picture = image::RgbImage::from_raw(900, 560, pixels).ok_or("the picture has another size")?;
    Ok(picture.save(folder.join(file))?)
}
