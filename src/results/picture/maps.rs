//! Maps: fields that colour the cloth, such as stretch, tension, pressure, gap and chi. Each has one fixed scale, so
//! that all pictures compare.

use geom::V3;
use pattern::Garment;
use render::Scale;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Map {
    /// No map: the simulator's own colour.
    Plain,
    /// A woven check of 4 cm in the simulator's colour: it shows the grain and every distortion.
    Check,
    /// Stretch: greatest principal stretch less 1, %.
    Stretch,
    /// Tension: greatest principal membrane force, N/m.
    Tension,
    /// Pressure of the cloth on the body, kPa; only for FEM-GS, which alone brings the two into equilibrium.
    Pressure,
    /// Gap between cloth and body, mm.
    Gap,
    /// chi of each measurement, along its path.
    Chi,
}

/// Stretch at the ends of its colour scale, %.
const STRETCH_REACH: f64 = 8.0;
/// Tension at the end of the colour scale, N/m. A strip 1 cm wide then carries about 100 g.
const TENSION_REACH: f64 = 100.0;
/// Pressure at the end of the colour scale. From there on clothes feel tight; compression stockings press with 2 to 4
/// kPa.
const PRESSURE_REACH_KPA: f64 = 2.0;
/// Departure of chi from 1 at the ends of the colour scale, as in the report's tables.
const CHI_REACH: f64 = 0.15;
/// Gap at the ends of the colour scale; below 0 the cloth lies inside the body.
const GAP_REACH_MM: f64 = 100.0;

impl Map {
    /// Order in which maps are offered.
    pub const ALL: [Self; 7] =
        [Self::Plain, Self::Check, Self::Stretch, Self::Tension, Self::Pressure, Self::Gap, Self::Chi];

    /// Name on screens and in the command line.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Plain => "plain",
            Self::Check => "check",
            Self::Stretch => "stretch",
            Self::Tension => "tension",
            Self::Pressure => "pressure",
            Self::Gap => "gap",
            Self::Chi => "chi",
        }
    }

    /// `None` for a map without values.
    pub fn scale(self) -> Option<Scale> {
        match self {
            Self::Plain | Self::Check => None,
            Self::Stretch => Some(Scale::diverging(0.0, STRETCH_REACH, "stretch", "%")),
            Self::Tension => Some(Scale::rising(TENSION_REACH, "tension", "N/m")),
            Self::Pressure => Some(Scale::rising(PRESSURE_REACH_KPA, "pressure", "kPa")),
            Self::Gap => Some(Scale::diverging(0.0, GAP_REACH_MM, "gap", "mm")),
            Self::Chi => Some(Scale::diverging(1.0, CHI_REACH, "chi", "")),
        }
    }
}

/// Chi of each measurement, at the vertices of the triangles that its path runs through; NaN elsewhere.
pub(super) fn chis(garment: &Garment, positions: &[V3]) -> Vec<f64> {
    let mut chis = vec![f64::NAN; positions.len()];
    for measurement in &garment.measurements {
        let chi = measurement.length_m(&garment.rest, positions) / measurement.l2d_m;
        for point in measurement.runs.iter().flat_map(|run| &run.points) {
            point.vertices.iter().for_each(|v| chis[*v] = chi);
        }
    }
    chis
}

#[cfg(test)]
mod tests {
    use super::*;
    use geom::V2;
    use pattern::garment::{MaterialLine, MaterialPoint, Measurement, MeasurementKind};
    use sim::laboratory;

    fn square() -> Garment {
        laboratory::garment(laboratory::sheets::sheet(1, 1, 1.0))
    }

    fn deformed(deform: &dyn Fn(V2) -> V3) -> Vec<V3> {
        square().rest.iter().map(|&p| deform(p)).collect()
    }

    #[test]
    fn chi_stands_where_it_is_measured_and_nowhere_else() {
        let mut garment = square();
        let corner =
            |v: usize| MaterialPoint { vertices: [0, 1, 2], weights: [0, 1, 2].map(|k| f64::from(u8::from(k == v))) };
        garment.measurements = vec![Measurement {
            no: 1,
            name: "width".into(),
            kind: MeasurementKind::OpenLength,
            is_free_edge: true,
            l2d_m: 1.0,
            runs: vec![MaterialLine { points: vec![corner(0), corner(1)], arc_m: vec![1.0] }],
        }];
        let found = chis(&garment, &deformed(&|p| V3::new(1.1 * p.x, 0.0, p.y)));
        assert!(found[..3].iter().all(|chi| (chi - 1.1).abs() < 1e-12) && found[3].is_nan(), "{found:?}");
    }
}
