use super::*;
use crate::Sex;

#[test]
fn look() {
    let person = |sex| match sex {
        Sex::Male => Measurements::of(sex, 1.78)
            .with(Dimension::ChestGirth, 1.0)
            .with(Dimension::WaistGirth, 0.86)
            .with(Dimension::HipGirth, 1.0),
        Sex::Female => Measurements::of(sex, 1.67)
            .with(Dimension::ChestGirth, 0.92)
            .with(Dimension::WaistGirth, 0.74)
            .with(Dimension::HipGirth, 0.98),
    };
    for sex in [Sex::Female, Sex::Male] {
        let plain = build(&person(sex)).unwrap();
        std::fs::write(format!("/tmp/figs/{sex:?}-plain.obj"), crate::write_obj(&plain.mesh)).unwrap();
        for f in figures(&plain).unwrap() {
            eprintln!("plain {sex:?} {:?} {:.1}", f.of, f.amount_mm);
        }
        for of in Trait::ALL {
            for sign in [-1.0, 1.0] {
                let Some(name) = of.figure(sign) else { continue };
                for degree in ["slight", "medium", "strong"] {
                    let text = format!("{name}={degree}");
                    let figs = Figures::read([text.as_str()]).unwrap();
                    eprintln!("== {sex:?} {text}");
                    match build_figured(&person(sex), &figs) {
                        Err(error) => eprintln!("{error}"),
                        Ok(body) => {
                            if degree == "strong" {
                                std::fs::write(format!("/tmp/figs/{sex:?}-{name}.obj"), crate::write_obj(&body.mesh))
                                    .unwrap();
                            }
                            let cross = geom::crossing::self_crossings(&body.mesh).len();
                            let off: Vec<String> = person(sex)
                                .known()
                                .map(|(d, v)| format!("{:.1}", (body.girths.get(d).unwrap() - v) * 1e3))
                                .collect();
                            let found: Vec<String> =
                                figures(&body).unwrap().iter().map(|f| format!("{:.1}", f.amount_mm)).collect();
                            eprintln!(
                                "  asked {:.1}, crossings {cross}, girths off {off:?}, found {}",
                                figs.amount_mm(of),
                                found.join(" ")
                            );
                        }
                    }
                }
            }
        }
    }
}

#[test]
fn reference() {
    let Some(folder) = crate::testing::reference_bodies() else { return };
    for (id, ext, sex) in std::fs::read_to_string(folder.join("measurements.csv")).unwrap().lines().skip(1).map(|l| {
        let f: Vec<&str> = l.split(',').collect();
        let ext = if folder.join(format!("meshes/{}.obj", f[0])).exists() { "obj" } else { "ply" };
        (f[0].to_owned(), ext, if l.contains(",F,") { Sex::Female } else { Sex::Male })
    }) {
        let scan =
            crate::from_scan(&std::fs::read(folder.join(format!("meshes/{id}.{ext}"))).unwrap(), None, Some(sex))
                .unwrap();
        let body = scan.into_body().unwrap();
        match figures(&body) {
            Ok(found) => eprintln!(
                "{id} {sex:?} {}",
                found.iter().map(|f| format!("{:?} {:.0}", f.of, f.amount_mm)).collect::<Vec<_>>().join(", ")
            ),
            Err(e) => eprintln!("{id} {e}"),
        }
    }
}
