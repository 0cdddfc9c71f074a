//! Fidelity of a drape to its pattern [T 3.5, 6.2.5].

use geom::V3;
use pattern::{Garment, Measurement};

#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Chi {
    /// Number of the measurement in the style.
    pub no: u32,
    /// Pattern length.
    pub l2d_m: f64,
    /// Garment length.
    pub l3d_m: f64,
}

impl Chi {
    /// Evaluation ratio chi = L3D / L2D [T 3.11].
    pub fn chi(&self) -> f64 {
        self.l3d_m / self.l2d_m
    }
}

#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Metrics {
    pub n: usize,
    /// E: mean chi.
    pub e_chi: f64,
    /// SD: sample standard deviation of chi (n-1).
    pub sd_chi: f64,
    /// EI: mean |chi - 1|.
    pub ei: f64,
    /// Greatest |chi - 1|.
    pub max_abs_error: f64,
}

/// Measures a garment whose vertices are at `positions`.
///
/// # Examples
/// Laid out flat nothing is stretched, and every chi is 1:
///
/// ```
/// use fit::measure;
/// use geom::V3;
/// use pattern::{Style, draft::Model};
///
/// let medium = &Model::Tshirt.drafts()[1];
/// let garment = Style::read(&medium.pieces, Model::Tshirt.seams(), "tshirt.seams.toml")?.mesh(0.03)?;
/// let flat: Vec<V3> = garment.rest.iter().map(|p| V3::new(p.x, p.y, 0.0)).collect();
///
/// let metrics = measure::metrics(&measure::measure(&garment, &flat)).ok_or("no measurements")?;
/// assert!(metrics.max_abs_error < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn measure(garment: &Garment, positions: &[V3]) -> Vec<Chi> {
    let chi = |m: &Measurement| Chi { no: m.no, l2d_m: m.l2d_m, l3d_m: m.length_m(&garment.rest, positions) };
    garment.measurements.iter().map(chi).collect()
}

/// `None` without measurements.
pub fn metrics(chis: &[Chi]) -> Option<Metrics> {
    if chis.is_empty() {
        return None;
    }
    let n = chis.len() as f64;
    let mean = chis.iter().map(Chi::chi).sum::<f64>() / n;
    let squares: f64 = chis.iter().map(|c| (c.chi() - mean).powi(2)).sum();
    let error = |c: &Chi| (c.chi() - 1.0).abs();
    Some(Metrics {
        n: chis.len(),
        e_chi: mean,
        sd_chi: if chis.len() > 1 { (squares / (n - 1.0)).sqrt() } else { 0.0 },
        ei: chis.iter().map(error).sum::<f64>() / n,
        max_abs_error: chis.iter().map(error).fold(0.0, f64::max),
    })
}
