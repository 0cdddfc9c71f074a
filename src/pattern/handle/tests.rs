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
                            let all = |s: &Style| s.pieces.iter().flat_map(|p| p.outline()).collect::<Vec<_>>();
                            all(&back).iter().zip(all(&style)).map(|(p, q)| mm((p - q).norm())).fold(0.0, f64::max)
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
