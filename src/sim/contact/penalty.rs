//! How hard the body pushes cloth at some depth.

/// Parameters of body contact.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct ContactParams {
    /// Distance from the skin at which cloth begins to be pushed, m.
    pub offset_m: f64,
    /// Penalty, N/m3 (pressure per depth).
    pub stiffness_n_m3: f64,
    /// Depth over which the pressure of a light contact grows e-fold, m.
    pub softness_m: f64,
    /// Pressure at which that growth begins, N/m2: about the weight of cloth.
    pub light_n_m2: f64,
    /// Greatest displacement of a sticking contact, m: a light one is held no more stiffly than that takes.
    pub slip_m: f64,
    /// Greatest tangential stiffness of a sticking contact over the penalty.
    pub tangential_share: f64,
    /// Distance from the skin that a point found inside is given, m.
    pub clearance_m: f64,
}

impl Default for ContactParams {
    fn default() -> Self {
        Self {
            offset_m: 1e-3,
            stiffness_n_m3: 1e7,
            softness_m: 5e-5,
            light_n_m2: 2.0,
            slip_m: 2e-4,
            tangential_share: 0.03,
            clearance_m: 4e-4,
        }
    }
}

/// What a contact does at some depth.
#[derive(Clone, Copy, Debug)]
pub struct Push {
    /// Energy per area, N/m.
    pub energy_n_m: f64,
    /// Pressure, N/m2.
    pub pressure_n_m2: f64,
    /// Slope of the pressure, N/m3.
    pub stiffness_n_m3: f64,
}

impl ContactParams {
    /// What it does at some depth, m.
    #[must_use]
    pub fn push(&self, depth: f64) -> Push {
        let (l, p0, k) = (self.softness_m, self.light_n_m2, self.stiffness_n_m3);
        let knee = l * (k * l / p0).max(1.0).ln();
        let soft = depth.min(knee);
        let hard = depth - soft;
        let growth = (soft / l).exp();
        let pressure = p0 * (growth - 1.0);
        Push {
            energy_n_m: p0 * (l * (growth - 1.0) - soft) + hard * (pressure + 0.5 * k * hard),
            pressure_n_m2: pressure + k * hard,
            stiffness_n_m3: if hard > 0.0 { k } else { p0 / l * growth },
        }
    }
}
