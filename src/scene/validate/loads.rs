//! Checks the values of loads, and whether they can act on the crank or the slider.

use crate::scene::Load;
use crate::scene::check::Check;
use crate::scene::number::show;

pub(super) fn load(check: &mut Check, field: &str, on_slider: bool, load: &Load) {
    let key = |name: &str| format!("{field}.{name}");
    let wrong_place = matches!(load, Load::Motor { .. }) && on_slider
        || matches!(load, Load::Spring { .. } | Load::Gas { .. }) && !on_slider;
    if wrong_place {
        let what = format!("a load of kind \"{}\" cannot act here", load.kind());
        let help = "motor lines turn the crank; springs and gas push the slider";
        check.add(field, what, help);
    }
    match load {
        Load::Constant(value) => {
            check.finite(key("value"), *value);
        }
        Load::Viscous(coefficient) => {
            let unit = if on_slider { "N s/m" } else { "N m s/rad" };
            check.not_negative(key("coefficient"), *coefficient, unit);
        }
        Load::Motor {
            stall,
            no_load_speed,
        } => {
            if check.finite(key("stall"), *stall)
                && check.finite(key("no_load_speed"), *no_load_speed)
                && (*no_load_speed == 0.0 || *stall * *no_load_speed < 0.0)
            {
                let (speed, stall) = (show(*no_load_speed), show(*stall));
                check.add(
                    key("no_load_speed"),
                    format!("{speed} rad/s does not fit a stall torque of {stall} N m"),
                    "a motor's no-load speed is not zero and has the sign of its stall torque",
                );
            }
        }
        Load::Spring { stiffness, rest } => {
            check.not_negative(key("stiffness"), *stiffness, "N/m");
            check.finite(key("rest"), *rest);
        }
        Load::Gas {
            pressure,
            area,
            ambient,
            ..
        } => {
            check.finite(key("file"), pressure.farthest_from_zero());
            check.positive(key("area"), *area, "m2");
            check.not_negative(key("ambient"), *ambient, "Pa");
        }
        Load::Table(table) => {
            check.finite(key("file"), table.farthest_from_zero());
        }
        Load::Dry(magnitude) => dry(check, key, on_slider, magnitude),
        Load::Expression(_) | Load::Function { .. } => {}
    }
}

/// Rejects a magnitude that is negative, or neither a constant nor a table.
fn dry(check: &mut Check, key: impl Fn(&str) -> String, on_slider: bool, magnitude: &Load) {
    match magnitude {
        Load::Constant(value) => {
            check.not_negative(key("value"), *value, if on_slider { "N" } else { "N m" });
        }
        Load::Table(table) => {
            if check.finite(key("file"), table.farthest_from_zero()) && table.least() < 0.0 {
                check.add(
                    key("file"),
                    format!("a magnitude of {} is negative", show(table.least())),
                    "kind \"dry\" opposes motion by itself: give magnitudes, which are zero or positive",
                );
            }
        }
        other => {
            let kind = other.kind();
            let what = format!("a load of kind \"{kind}\" is no magnitude of a dry one");
            check.add(key("kind"), what, "give a constant magnitude, or a table");
        }
    }
}
