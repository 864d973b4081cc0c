//! Text output of `explain`: equation, conventions, modelled terms and plan of computation.

use std::fmt::Write;

use super::key_values::{Facts, degrees, fact, given, six};
use super::text::NAME_WIDTH;
use crate::explain::{Explanation, FrictionAt, TermsAt};
use crate::scene::counted;

/// Returns the explanation as text.
pub fn explanation(result: &Explanation) -> String {
    let mut text = String::new();
    if !result.scene.is_empty() {
        let _ = writeln!(text, "{}\n", result.scene);
    }
    let equation = result.equation.join("\n  ");
    let conventions = result.conventions.join("\n  ");
    let _ = writeln!(text, "equation (SI, radians)\n  {equation}");
    let _ = writeln!(text, "conventions\n  {conventions}");
    for (title, terms) in [
        ("modelled", &result.plan.kept),
        ("left out", &result.plan.left_out),
    ] {
        let mut facts = Facts::of("");
        for term in terms {
            facts.add(format_args!("  {}", term.name), term.reason.to_string());
        }
        let _ = write!(text, "{title}\n{}", facts.lines(NAME_WIDTH));
    }
    let computation = computation(result).lines(NAME_WIDTH);
    let _ = write!(text, "computation\n{computation}");
    if let Some(at) = &result.at {
        text.push_str(&terms_at(at));
    }
    text
}

fn computation(result: &Explanation) -> Facts {
    let plan = &result.plan;
    let mut facts = Facts::of("");
    let (engine, reason) = (plan.engine.name(), &plan.reason);
    fact!(facts, "  engine" => "{engine}: {reason}");
    for then in &plan.then {
        fact!(facts, "  then" => "{}: {}", then.engine.name(), then.reason);
    }
    if let Some(stepper) = plan.stepper {
        facts.add("  stepper", stepper.name());
    }
    facts.add("  coordinate", plan.coordinate);
    let state = match plan.state.len() {
        0 => "none".to_owned(),
        size => format!("{size}: {}", plan.state.join(", ")),
    };
    facts.add("  state", state);
    facts.add("  events", plan.events.join(", "));
    let cycle = match (&plan.cycle.turns, &plan.cycle.why_not) {
        (Some(turns), _) => counted(*turns as usize, "turn"),
        (None, why) => format!("none: {}", why.as_deref().unwrap_or_default()),
    };
    facts.add("  cycle of the loads", cycle);
    for load in &plan.cycle.loads {
        fact!(facts, "" => "{} repeats {}", load.name, load.repeats);
        if let Some(what) = load.between_nodes {
            facts.add("", what);
        }
    }
    facts
}

fn terms_at(at: &TermsAt) -> String {
    let (theta, omega) = (degrees(at.theta_rad), given(at.omega_rad_per_s));
    let mut text = format!("at theta = {theta} deg, omega = {omega} rad/s, t = 0\n");
    let mut facts = Facts::of("");
    for (name, value, unit) in [
        ("M", at.m_kg_m2, "kg m2"),
        ("1/2 M'", at.half_dm_kg_m2_per_rad, "kg m2/rad"),
        ("V'", at.dv_nm, "N m"),
        ("x", at.x_m, "m"),
        ("x'", at.dx_m_per_rad, "m/rad"),
    ] {
        let value = six(value);
        facts.add(format_args!("  {name}"), format_args!("{value} {unit}"));
    }
    text.push_str(&facts.lines(NAME_WIDTH));
    for load in &at.loads {
        let _ = writeln!(text, "  Q of {} = {} N m", load.name, six(load.q_nm));
    }
    let mut facts = Facts::of("");
    fact!(facts, "  Q" => "{} N m", six(at.q_nm));
    let alpha = match at.alpha_rad_per_s2 {
        Some(alpha) => format!("{} rad/s2", six(alpha)),
        None => "not determined: no inertia here, or the guide jams".to_owned(),
    };
    facts.add("  theta..", alpha);
    let without = at.friction.map_or("", |_| ", without friction");
    let torque = six(at.holding_torque_nm);
    fact!(facts, "  holding torque" => "{torque} N m (torque that keeps this speed{without})");
    if let Some(friction) = &at.friction {
        facts.add("  with friction", holding(friction));
    }
    text.push_str(&facts.lines(NAME_WIDTH));
    text
}

fn holding(friction: &FrictionAt) -> String {
    match (friction.holding_min_nm, friction.holding_max_nm) {
        (Some(min), Some(max)) if min == max => format!("{} N m", six(min)),
        (Some(min), Some(max)) => format!("any torque from {} to {} N m", six(min), six(max)),
        _ => "the guide locks itself".to_owned(),
    }
}
