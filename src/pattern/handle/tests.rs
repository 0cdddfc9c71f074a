use super::{Handle, HandleError};
use crate::Style;
use crate::draft::Model;
use crate::pom::Point;
use crate::style::EdgeRef;
use geom::units::mm;

fn drafted(model: Model, size: usize) -> Style {
    let draft = model.drafts().swap_remove(size);
    Style::read(&draft.pieces, model.seams(), "seams").expect("our own draft")
}

fn points(style: &Style) -> Vec<(Point, f64)> {
    style.points_of_measure().iter().map(|one| (one.point, mm(one.length_m))).collect()
}

fn seam_gaps(style: &Style) -> Vec<f64> {
    let length = |side: &[EdgeRef]| side.iter().map(|edge| style.edge(*edge).line.length()).sum::<f64>();
    style.seams.iter().map(|seam| mm(length(&seam.a) - length(&seam.b))).collect()
}

/// Greatest distance of a vertex of one style from the outline of the other, m.
fn farthest_m(one: &Style, other: &Style) -> f64 {
    let pairs = one.pieces.iter().zip(&other.pieces).map(|(one, other)| (one.outline(), other.outline()));
    let off = |from: &[geom::V2], to: &[geom::V2]| from.iter().map(|p| geom::polyline::boundary_distance(to, p)).fold(0.0, f64::max);
    pairs.map(|(one, other)| off(&one, &other).max(off(&other, &one))).fold(0.0, f64::max)
}

#[test]
fn probe() {
    for (model, size) in [(Model::Tshirt, 0), (Model::Trousers, 0), (Model::Teetop, 0), (Model::Dress, 0)] {
        let style = drafted(model, size);
        let before = points(&style);
        for handle in style.handles() {
            for amount in [0.010, -0.010] {
                match style.moved(&[(handle, amount)]) {
                    Ok(moved) => {
                        let after = points(&moved);
                        let changes: Vec<String> = before
                            .iter()
                            .zip(&after)
                            .filter(|(b, a)| (a.1 - b.1).abs() > 0.15)
                            .map(|(b, a)| format!("{} {:+.2}", a.0.as_str(), a.1 - b.1))
                            .collect();
                        let back = moved.moved(&[(handle, -amount)]).map(|back| {
                            mm(farthest_m(&back, &style))
                        });
                        let mesh = moved.mesh(0.03).map(|_| "meshes");
                        println!("{} {} {:+}: {} | back {back:?} {mesh:?}", model.as_str(), handle.as_str(), mm(amount), changes.join(", "));
                    }
                    Err(error) => println!("{} {} {:+}: REFUSED {error}", model.as_str(), handle.as_str(), mm(amount)),
                }
            }
        }
    }
}

fn shared(file: &str) -> Option<std::path::PathBuf> {
    let path = std::path::PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../../shared/patterns").join(file);
    path.exists().then_some(path)
}

/// The style of a file of another program, sewn as proposed where it holds no seams.
fn foreign(path: &std::path::Path) -> Style {
    let bytes = std::fs::read(path).expect("readable");
    let name = path.display().to_string();
    if crate::source::kind(&bytes) == crate::source::Kind::GarmentCode {
        return crate::garmentcode::read(&bytes, &name).expect("a specification").style();
    }
    let unit = name.contains("valentina").then_some(crate::dxf::Unit::Mm);
    let pieces = crate::source::read(&bytes, &name, unit).expect("a pattern").to_sew(None).expect("a size");
    Style::read(&pieces, crate::propose::propose(&pieces).toml("foreign").as_bytes(), "foreign").expect("it holds")
}

#[test]
fn probe_foreign() {
    for file in ["garmentcode/tshirt_mean_female_specification.json","garmentcode/longsleeve_shirt_mean_all_specification.json","garmentcode/fitted_shirt_sleeves_mean_male_specification.json","garmentcode/fitted_bodice_darts_mean_female_specification.json","garmentcode/dress_sheath_mean_female_specification.json","garmentcode/pencil_skirt_mean_female_specification.json","garmentcode/pants_mean_all_specification.json","freesewing/teagan_cisFemaleAdult36_aama.dxf","freesewing/titan_cisFemaleAdult36_aama.dxf","freesewing/bella_cisFemaleAdult36_aama-net.dxf","freesewing/brian_cisMaleAdult40_aama.dxf","freesewing/paco_cisFemaleAdult36_aama.dxf","freesewing/sandy_cisFemaleAdult36_aama.dxf","valentina/pantsM1_52-176.v1.1.1.astm-r12.dxf"] {
        let Some(path) = shared(file) else { continue };
        let style = foreign(&path);
        println!("== {file}: {:?}", style.pieces.iter().map(|p| (p.id.as_str(), p.role)).collect::<Vec<_>>());
        let missing: Vec<_> = Handle::ALL.iter().filter(|h| !style.handles().contains(h)).map(|h| h.as_str()).collect();
        println!("   without {missing:?}");
        if file.contains("pencil") { for seam in &style.seams { println!("   {} {:?} {:?}", seam.name, seam.a.iter().map(|e| style.edge_name(*e)).collect::<Vec<_>>(), seam.b.iter().map(|e| style.edge_name(*e)).collect::<Vec<_>>()); }
            for p in &style.pieces { for e in &p.edges { println!("  {} {:?} {:?} -> {:?}", p.id, e.name, e.line.points()[0], e.line.points().last()); } } }
        let before = points(&style);
        for handle in style.handles() {
            for amount in [0.005, -0.005] {
                match style.moved(&[(handle, amount)]) {
                    Ok(moved) => {
                        let after = points(&moved);
                        let changes: Vec<String> = before.iter()
                            .filter_map(|b| Some((b, after.iter().find(|a| a.0 == b.0)?)))
                            .filter(|(b, a)| (a.1 - b.1).abs() > 0.15)
                            .map(|(b, a)| format!("{} {:+.2}", a.0.as_str(), a.1 - b.1)).collect();
                        let mesh = moved.mesh(0.03).map(|_| "meshes");
                        println!("{} {:+}: {} {mesh:?}", handle.as_str(), mm(amount), changes.join(", "));
                    }
                    Err(error) => println!("{} {:+}: REFUSED {error}", handle.as_str(), mm(amount)),
                }
            }
        }
    }
}
