//! Additional results of a run with a loose joint.

use serde::Serialize;

/// Loose joint in the summary of a run.
#[derive(Clone, Debug, Serialize)]
pub struct ClearanceSummary {
    /// `crank-pin` or `wrist-pin`.
    pub joint: &'static str,
    /// Name of the contact law.
    pub contact_law: &'static str,
    /// Radial clearance, m.
    pub radial_m: f64,
    /// Hertz stiffness, N/m^1.5; none for a massless link.
    pub stiffness_n_per_m_1_5: Option<f64>,
    /// Number of contacts that began.
    pub impacts: u64,
    /// Number of contacts that ended.
    pub separations: u64,
    /// Part of the time in contact.
    pub contact_share: f64,
    /// Part of the time in which a massless link is in tension, which no bearing allows.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub drawn_share: Option<f64>,
    /// Largest normal force, N.
    pub force_peak_n: f64,
    /// Mean normal force over time, N.
    pub force_mean_n: f64,
    /// Largest penetration, m.
    pub penetration_peak_m: f64,
    /// Energy lost in the contact and by friction at the guide, J.
    pub dissipated_j: f64,
    /// Work of the loads and of the drive of a crank at prescribed speed, J.
    pub work_j: f64,
    /// Slider and rod at the end.
    #[serde(rename = "final")]
    pub last: LooseFinal,
    /// Horizon of reproducible motion at this tolerance; none without a finished second run.
    pub horizon: Option<Horizon>,
}

/// State of slider and rod at the end, with errors.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct LooseFinal {
    /// Slider position, m.
    pub x_m: f64,
    /// Slider velocity, m/s.
    pub v_m_per_s: f64,
    /// Rod inclination, rad.
    pub phi_rad: f64,
    /// Error of x, m; none beyond the horizon or without a second run.
    pub error_x_m: Option<f64>,
    /// Error of phi, rad; none beyond the horizon or without a second run.
    pub error_phi_rad: Option<f64>,
}

/// Horizon of reproducible motion: the journal path agrees with a tighter run within a hundredth of the clearance.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Horizon {
    /// Last time of agreement, s.
    pub t_s: f64,
    /// Number of turns of the crank up to the horizon.
    pub revolutions: f64,
    /// Whether the horizon is the end of the run.
    pub whole_run: bool,
    /// Statistics beyond the horizon; none if the horizon is the end.
    pub beyond: Option<Beyond>,
}

/// Statistics beyond the horizon, of this run and of the tighter run: only what both share can be said of that time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Beyond {
    /// Statistics of this run.
    pub run: ContactStatistics,
    /// Statistics of the run at the tighter tolerance.
    pub tighter: ContactStatistics,
}

/// Contact statistics over a part of a run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ContactStatistics {
    /// First time, s.
    pub from_s: f64,
    /// Last time, s.
    pub to_s: f64,
    /// Number of contacts that began.
    pub impacts: u64,
    /// Part of the time in contact.
    pub contact_share: f64,
    /// Largest normal force, N.
    pub force_peak_n: f64,
    /// Mean normal force over time, N.
    pub force_mean_n: f64,
    /// Root mean square of the normal force over time, N.
    pub force_rms_n: f64,
}
