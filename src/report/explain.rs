//! `explain` on paper.

use std::fmt::Write;

use crate::study::{Explanation, FrictionAt};

/// The explanation as text.
pub fn explanation(result: &Explanation) -> String {
    let mut text = String::new();
    let plan = &result.plan;
    let mut line = |content: String| {
        let _ = writeln!(text, "{content}");
    };
    if !result.scene.is_empty() {
        line(result.scene.clone());
        line(String::new());
    }
    line("equation (SI, radians)".to_owned());
    for part in &result.equation {
        line(format!("  {part}"));
    }
    line("conventions".to_owned());
    for part in &result.conventions {
        line(format!("  {part}"));
    }
    line("modelled".to_owned());
    for term in &plan.kept {
        line(format!("  {:<22} {}", term.name, term.reason));
    }
    line("left out".to_owned());
    for term in &plan.left_out {
        line(format!("  {:<22} {}", term.name, term.reason));
    }
    line("computation".to_owned());
    line(format!(
        "  {:<22} {}: {}",
        "engine",
        plan.engine.name(),
        plan.reason
    ));
    if let Some(stepper) = plan.stepper {
        line(format!("  {:<22} {}", "stepper", stepper.name()));
    }
    line(format!("  {:<22} {}", "coordinate", plan.coordinate));
    let state = match plan.state.len() {
        0 => "none".to_owned(),
        size => format!("{size}: {}", plan.state.join(", ")),
    };
    line(format!("  {:<22} {state}", "state"));
    line(format!("  {:<22} {}", "events", plan.events.join(", ")));
    line(format!(
        "  {:<22} {:.0} ns (measured now)",
        "one evaluation", result.evaluation_ns
    ));
    if let Some(at) = &result.at {
        line(format!(
            "at theta = {} deg, omega = {} rad/s, t = 0",
            degrees(at.theta_rad),
            at.omega_rad_per_s
        ));
        for (name, value, unit) in [
            ("M", at.m_kg_m2, "kg m2"),
            ("1/2 M'", at.half_dm_kg_m2_per_rad, "kg m2/rad"),
            ("V'", at.dv_nm, "N m"),
            ("x", at.x_m, "m"),
            ("x'", at.dx_m_per_rad, "m/rad"),
        ] {
            line(format!("  {name:<22} {value} {unit}"));
        }
        for load in &at.loads {
            line(format!("  Q of {} = {} N m", load.name, load.q_nm));
        }
        line(format!("  {:<22} {} N m", "Q", at.q_nm));
        match at.alpha_rad_per_s2 {
            Some(alpha) => line(format!("  {:<22} {alpha} rad/s2", "theta..")),
            None => line(format!(
                "  {:<22} not determined: no inertia here, or the guide jams",
                "theta.."
            )),
        }
        let without = at.friction.map_or("", |_| ", without friction");
        line(format!(
            "  {:<22} {} N m (torque that keeps this speed{without})",
            "holding torque", at.holding_torque_nm
        ));
        if let Some(friction) = &at.friction {
            line(format!("  {:<22} {}", "with friction", holding(friction)));
        }
    }
    text
}

fn holding(friction: &FrictionAt) -> String {
    match (friction.holding_min_nm, friction.holding_max_nm) {
        (Some(min), Some(max)) if min == max => format!("{min} N m"),
        (Some(min), Some(max)) => format!("any torque from {min} to {max} N m"),
        _ => "the guide locks itself".to_owned(),
    }
}

/// Degrees to 12 digits, so that an angle that was given in degrees is shown as it was given.
fn degrees(radians: f64) -> f64 {
    let degrees = radians.to_degrees();
    format!("{degrees:.11e}").parse().unwrap_or(degrees)
}
