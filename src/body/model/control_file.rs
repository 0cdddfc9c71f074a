//! Files of the control mesh: OBJ for other programs, and JSON with all properties of its vertices.

use crate::{Body, ControlMesh, Layer, RING, Skeleton};
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// Content of the JSON file. Lengths are in metres, vertices count from zero.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct ControlFile {
    pub mesh: ControlMesh,
    pub skeleton: Skeleton,
    pub feature_points: BTreeMap<String, usize>,
    /// Vertices from above.
    pub feature_lines: BTreeMap<String, Vec<usize>>,
    /// Each girth with the first vertex of its ring, which the others follow.
    pub girths: Vec<(Layer, usize)>,
}

pub fn write_control(body: &Body) -> Result<String, serde_json::Error> {
    let control = &body.control;
    let named = |(name, vertex): (&str, usize)| (name.to_owned(), vertex);
    serde_json::to_string(&ControlFile {
        mesh: control.clone(),
        skeleton: body.skeleton.clone(),
        feature_points: control.feature_points().into_iter().map(named).collect(),
        feature_lines: control.feature_lines().into_iter().map(|(name, line)| (name.to_owned(), line)).collect(),
        girths: Layer::ALL.iter().enumerate().map(|(i, layer)| (*layer, i * RING)).collect(),
    })
}

pub fn read_control(text: &str) -> Result<ControlFile, serde_json::Error> {
    let file: ControlFile = serde_json::from_str(text)?;
    let count = file.mesh.positions.len();
    match file.mesh.faces.iter().flatten().find(|&&vertex| vertex >= count) {
        Some(vertex) => Err(serde::de::Error::custom(format!("a face names vertex {vertex}, there are {count}"))),
        None if file.mesh.faces.len() != file.mesh.regions.len() => {
            Err(serde::de::Error::custom("every face needs one region"))
        }
        None => Ok(file),
    }
}

impl ControlMesh {
    /// Writes the mesh as Wavefront OBJ in metres, with faces grouped by region.
    pub fn write_obj(&self) -> String {
        let mut text = "# control mesh, metres; x to the subject's right, y to the front, z up\n".to_owned();
        for p in &self.positions {
            let _ = writeln!(text, "v {:.7} {:.7} {:.7}", p.x, p.y, p.z);
        }
        let mut group = None;
        for (face, region) in self.faces.iter().zip(&self.regions) {
            if group != Some(region) {
                let _ = writeln!(text, "g {region:?}");
                group = Some(region);
            }
            let corners: Vec<String> = face.iter().map(|vertex| (vertex + 1).to_string()).collect();
            let _ = writeln!(text, "f {}", corners.join(" "));
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Measurements, Sex, build};

    #[test]
    fn a_control_mesh_is_read_as_it_was_written() {
        let asked = Measurements::of(Sex::Female, 1.7);
        let body = build(&asked).expect("an ordinary woman");
        let text = write_control(&body).expect("JSON");
        let file = read_control(&text).expect("our own file");
        assert_eq!((&file.mesh, &file.skeleton), (&body.control, &body.skeleton));
        assert_eq!(file.feature_points["crown"], body.control.feature_points().last().expect("points").1);
        let obj = body.control.write_obj();
        assert_eq!(obj.lines().filter(|line| line.starts_with("f ")).count(), body.control.faces.len());
        assert!(read_control(&text.replacen("\"faces\":[[", "\"faces\":[[99999,", 1)).is_err());
        assert!(read_control("{}").is_err());
    }
}
