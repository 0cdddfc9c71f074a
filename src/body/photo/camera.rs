//! Camera of a pair of pictures.

/// A camera that looks horizontally at the subject, with its optical axis through the middle of the picture.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Camera {
    pub focal_over_height: f64,
    /// Distance from the vertical axis of the subject.
    pub distance_m: f64,
}

impl Camera {
    pub fn of_focal(focal_px: f64, height_px: u32, distance_m: f64) -> Self {
        Self { focal_over_height: focal_px / f64::from(height_px.max(1)), distance_m }
    }

    /// Takes the vertical field of view.
    pub fn of_field(field_deg: f64, distance_m: f64) -> Self {
        Self { focal_over_height: 0.5 / (field_deg.to_radians() / 2.0).tan(), distance_m }
    }
}
