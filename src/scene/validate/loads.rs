//! Checks the values of loads, and whether they can act on the crank or the slider.

use crate::scene::Load;
use crate::scene::check::Check;
use crate::scene::number::show;

pub(super) fn load(list: &mut Check, field: &str, on_slider: bool, load: &Load) {
    let key = |name: &str| format!("{field}.{name}");
    let wrong_place = matches!(load, Load::Motor { .. }) && on_slider
        || matches!(load, Load::Spring { .. } | Load::Gas { .. }) && !on_slider;
    if wrong_place {
        list.add(
            field,
            format!("a load of kind \"{}\" cannot act here", load.kind()),
            "motor lines turn the crank; springs and gas push the slider",
        );
    }
    match load {
        Load::Constant(value) => {
            list.finite(key("value"), *value);
        }
        Load::Viscous(coefficient) => {
            let unit = if on_slider { "N s/m" } else { "N m s/rad" };
            list.not_negative(key("coefficient"), *coefficient, unit);
        }
        Load::Motor {
            stall,
            no_load_speed,
        } => {
            if list.finite(key("stall"), *stall)
                && list.finite(key("no_load_speed"), *no_load_speed)
                && (*no_load_speed == 0.0 || *stall * *no_load_speed < 0.0)
            {
                let (speed, stall) = (show(*no_load_speed), show(*stall));
                list.add(
                    key("no_load_speed"),
                    format!("{speed} rad/s does not fit a stall torque of {stall} N m"),
                    "a motor's no-load speed is not zero and has the sign of its stall torque",
                );
            }
        }
        Load::Spring { stiffness, rest } => {
            list.not_negative(key("stiffness"), *stiffness, "N/m");
            list.finite(key("rest"), *rest);
        }
        Load::Gas {
            pressure,
            area,
            ambient,
            ..
        } => {
            list.finite(key("file"), pressure.farthest_from_zero());
            list.positive(key("area"), *area, "m2");
            list.not_negative(key("ambient"), *ambient, "Pa");
        }
        Load::Table(table) => {
            list.finite(key("file"), table.farthest_from_zero());
        }
        Load::Dry(magnitude) => dry(list, field, on_slider, magnitude),
        Load::Expression(_) | Load::Function { .. } => {}
    }
}

/// Rejects a magnitude that is negative, or neither a constant nor a table.
fn dry(list: &mut Check, field: &str, on_slider: bool, magnitude: &Load) {
    let key = |name: &str| format!("{field}.{name}");
    match magnitude {
        Load::Constant(value) => {
            list.not_negative(key("value"), *value, if on_slider { "N" } else { "N m" });
        }
        Load::Table(table) => {
            if list.finite(key("file"), table.farthest_from_zero()) && table.least() < 0.0 {
                list.add(
                    key("file"),
                    format!("a magnitude of {} is negative", show(table.least())),
                    "kind \"dry\" opposes motion by itself: give magnitudes, which are zero or positive",
                );
            }
        }
        other => list.add(
            key("kind"),
            format!(
                "a load of kind \"{}\" is no magnitude of a dry one",
                other.kind()
            ),
            "give a constant magnitude, or a table",
        ),
    }
}
