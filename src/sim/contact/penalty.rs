//! Penalty law of contact: pressure as a function of depth.

#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct ContactParams {
    /// Distance from the skin below which cloth is repelled.
    pub offset_m: f64,
    /// Penalty stiffness `k` (pressure per depth).
    pub stiffness_n_m3: f64,
    /// Depth `l` over which the pressure of a light contact grows by a factor e.
    pub softness_m: f64,
    /// Scale `p0` of the pressure of a light contact: about the weight of cloth.
    pub light_n_m2: f64,
    /// Greatest slip of a sticking contact. It limits the tangential stiffness of light contacts.
    pub slip_m: f64,
    /// Greatest tangential stiffness of a sticking contact over the penalty stiffness.
    pub tangential_share: f64,
    /// Distance from the skin to which a point found inside is moved.
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

#[derive(Clone, Copy, Debug)]
pub struct Push {
    pub energy_n_m: f64,
    pub pressure_n_m2: f64,
    /// Slope of the pressure.
    pub stiffness_n_m3: f64,
}

impl ContactParams {
    pub fn push(&self, depth: f64) -> Push {
        push(depth, self.softness_m, self.light_n_m2, self.stiffness_n_m3)
    }
}

/// At the depth `d`, m, the pressure is `p0 (exp(d / l) - 1)` until its slope is `k`, and then rises with that slope.
///
/// Light contacts are soft thereby: a hard contact of a few pascals would be lost by a motion of a micrometre, and
/// found again by the next.
pub fn push(depth: f64, l: f64, p0: f64, k: f64) -> Push {
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
