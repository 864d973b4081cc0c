//! What a run with a loose joint gives beside other runs.

use serde::Serialize;

/// The loose joint in the summary of a run.
#[derive(Clone, Debug, Serialize)]
pub struct ClearanceSummary {
    /// `crank-pin` or `wrist-pin`.
    pub joint: &'static str,
    /// Law of the contact.
    pub contact_law: &'static str,
    /// Radial clearance, m.
    pub radial_m: f64,
    /// Hertz stiffness, N/m^1.5; none for a massless link.
    pub stiffness_n_per_m_1_5: Option<f64>,
    /// Contacts that began.
    pub impacts: u64,
    /// Contacts that ended.
    pub separations: u64,
    /// Part of the time in contact.
    pub contact_share: f64,
    /// Part of the time in which a massless link was drawn, which no bearing does.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub drawn_share: Option<f64>,
    /// Largest normal force, N.
    pub force_peak_n: f64,
    /// Normal force, mean over time, N.
    pub force_mean_n: f64,
    /// Largest penetration, m.
    pub penetration_peak_m: f64,
    /// Energy lost in the contact and by friction at the guide, J.
    pub dissipated_j: f64,
    /// Work of the loads and of what drives a crank of prescribed speed, J.
    pub work_j: f64,
    /// Slider and rod at the end.
    #[serde(rename = "final")]
    pub last: LooseFinal,
    /// Up to when the motion is reproducible at this tolerance; none if it was not asked for.
    pub horizon: Option<Horizon>,
}

/// Slider and rod at the end, and how far they may be off.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct LooseFinal {
    /// m
    pub x_m: f64,
    /// m/s
    pub v_m_per_s: f64,
    /// rad
    pub phi_rad: f64,
    /// Error of x, m; none beyond the horizon.
    pub error_x_m: Option<f64>,
    /// Error of phi, rad; none beyond the horizon.
    pub error_phi_rad: Option<f64>,
}

/// Up to when the journal's path is the same at a tighter tolerance, to a hundredth of the clearance.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Horizon {
    /// s
    pub t_s: f64,
    /// Turns of the crank until then.
    pub revolutions: f64,
    /// Whether that is the end of the run.
    pub whole_run: bool,
    /// Statistics after it; none if it is the end.
    pub beyond: Option<Beyond>,
}

/// Statistics beyond the horizon, of this run and of the one at the tighter tolerance: what they share is what
/// can be said of that time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Beyond {
    /// This run.
    pub run: ContactStatistics,
    /// The run at the tighter tolerance.
    pub tighter: ContactStatistics,
}

/// Statistics of the contact over a part of a run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ContactStatistics {
    /// s
    pub from_s: f64,
    /// s
    pub to_s: f64,
    /// Contacts that began.
    pub impacts: u64,
    /// Part of the time in contact.
    pub contact_share: f64,
    /// Largest normal force, N.
    pub force_peak_n: f64,
    /// Normal force, mean over time, N.
    pub force_mean_n: f64,
    /// Normal force, root of the mean square over time, N.
    pub force_rms_n: f64,
}
