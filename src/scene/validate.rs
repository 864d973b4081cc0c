//! Values that no mechanism can have, wherever the scene comes from.

use super::*;

/// Local error targets below this cannot be met in double precision.
const LEAST_TOLERANCE: f64 = 1e-14;

/// One problem for each impossible value.
pub(super) fn problems(scene: &Scene) -> Vec<Problem> {
    let mut list = Check(Vec::new());
    geometry(&mut list, &scene.geometry);
    if let Some(crank) = &scene.crank {
        bodies(
            &mut list,
            "crank",
            crank.mass,
            crank.inertia,
            [crank.cg, crank.cg_lateral],
        );
        let squared = crank.cg * crank.cg + crank.cg_lateral * crank.cg_lateral;
        list.inertia("crank.inertia", "O", crank.inertia, crank.mass * squared);
    }
    if let Some(rod) = &scene.rod {
        self::rod(&mut list, rod, scene.geometry.rod);
    }
    if let Some(slider) = &scene.slider {
        list.not_negative("slider.mass", slider.mass, "kg");
    }
    if let Some(gravity) = &scene.gravity {
        list.not_negative("gravity.acceleration", gravity.acceleration, "m/s2");
        list.finite("gravity.direction", gravity.direction);
    }
    for (name, loads) in [("torque", &scene.torques), ("force", &scene.forces)] {
        for (i, load) in loads.iter().enumerate() {
            self::load(
                &mut list,
                &format!("{name}[{}]", i + 1),
                name == "force",
                load,
            );
        }
    }
    if let Some(friction) = &scene.friction {
        list.not_negative("friction.coefficient", friction.coefficient, "");
        if friction.static_coefficient < friction.coefficient
            || friction.static_coefficient.is_nan()
        {
            list.add(
                "friction.static_coefficient",
                format!(
                    "the static coefficient {} is below the kinetic one {}",
                    friction.static_coefficient, friction.coefficient
                ),
                "give one at least as large, or leave it out",
            );
        }
    }
    if let Some(clearance) = &scene.clearance {
        self::clearance(&mut list, clearance);
    }
    list.finite("motion.angle", scene.motion.angle);
    list.finite("motion.speed", scene.motion.speed);
    run(&mut list, &scene.run);
    list.0
}

struct Check(Vec<Problem>);

impl Check {
    fn add(&mut self, field: &str, what: String, help: &str) {
        self.0.push(Problem::new(field, what, help));
    }

    fn finite(&mut self, field: &str, value: f64) -> bool {
        if !value.is_finite() {
            self.add(
                field,
                format!("{value} is not a finite number"),
                "give a finite value",
            );
        }
        value.is_finite()
    }

    fn positive(&mut self, field: &str, value: f64, unit: &str) {
        if self.finite(field, value) && value <= 0.0 {
            self.add(
                field,
                format!("{} is not positive", show(value, unit)),
                "give a value above zero",
            );
        }
    }

    fn not_negative(&mut self, field: &str, value: f64, unit: &str) {
        if self.finite(field, value) && value < 0.0 {
            self.add(
                field,
                format!("{} is negative", show(value, unit)),
                "give zero or a positive value",
            );
        }
    }

    fn inertia(&mut self, field: &str, about: &str, inertia: f64, least: f64) {
        if inertia < least * (1.0 - 1e-9) {
            self.add(
                field,
                format!(
                    "{inertia} kg m2 about {about} is less than mass times distance of the centre of gravity squared, {least} kg m2"
                ),
                "no body has that: check inertia, mass and cg, and the point the inertia is about",
            );
        }
    }
}

fn show(value: f64, unit: &str) -> String {
    format!("{value} {unit}").trim_end().to_owned()
}

fn geometry(list: &mut Check, geometry: &Geometry) {
    list.positive("geometry.crank", geometry.crank, "m");
    list.positive("geometry.rod", geometry.rod, "m");
    list.finite("geometry.offset", geometry.offset);
    let (r, l, e) = (geometry.crank, geometry.rod, geometry.offset);
    if e.abs() > r + l {
        list.add(
            "geometry.offset",
            format!("the mechanism cannot be assembled: the offset {e} m is larger than crank plus rod, {} m", r + l),
            "make the offset smaller or the rod longer",
        );
    }
}

fn bodies(list: &mut Check, name: &str, mass: f64, inertia: f64, cg: [f64; 2]) {
    list.not_negative(&format!("{name}.mass"), mass, "kg");
    list.not_negative(&format!("{name}.inertia"), inertia, "kg m2");
    list.finite(&format!("{name}.cg"), cg[0]);
    list.finite(&format!("{name}.cg_lateral"), cg[1]);
}

fn rod(list: &mut Check, rod: &Rod, length: f64) {
    bodies(list, "rod", rod.mass, rod.inertia, [rod.cg, rod.cg_lateral]);
    if rod.inertia_about == InertiaAbout::CrankPin && rod.model == RodModel::Rigid {
        let squared = rod.cg * rod.cg + rod.cg_lateral * rod.cg_lateral;
        list.inertia(
            "rod.inertia",
            "the crank pin",
            rod.inertia,
            rod.mass * squared,
        );
    }
    if rod.model == RodModel::TwoMass && rod.mass != 0.0 {
        if rod.cg_lateral != 0.0 {
            list.add(
                "rod.cg_lateral",
                format!(
                    "two masses at the pins have no lateral centre of gravity, but it is {} m",
                    rod.cg_lateral
                ),
                "leave out cg_lateral or use model = \"rigid\"",
            );
        }
        if !(0.0..=length).contains(&rod.cg) {
            list.add(
                "rod.cg",
                format!(
                    "{} m is not between the pins, which are {length} m apart",
                    rod.cg
                ),
                "two masses at the pins need it between them; use model = \"rigid\" otherwise",
            );
        }
    }
}

fn load(list: &mut Check, field: &str, on_slider: bool, load: &Load) {
    let key = |name: &str| format!("{field}.{name}");
    let wrong_place = matches!(load, Load::Motor { .. }) && on_slider
        || matches!(load, Load::Spring { .. } | Load::Gas { .. }) && !on_slider;
    if wrong_place {
        let what = format!("a load of kind \"{}\" cannot act here", load.kind());
        list.add(
            field,
            what,
            "motor lines turn the crank; springs and gas push the slider",
        );
    }
    match load {
        Load::Constant(value) => {
            list.finite(&key("value"), *value);
        }
        Load::Viscous(coefficient) => list.not_negative(&key("coefficient"), *coefficient, ""),
        Load::Motor {
            stall,
            no_load_speed,
        } => {
            list.finite(&key("stall"), *stall);
            if list.finite(&key("no_load_speed"), *no_load_speed)
                && (*no_load_speed == 0.0 || *stall * *no_load_speed < 0.0)
            {
                list.add(
                    &key("no_load_speed"),
                    format!("{no_load_speed} rad/s does not fit a stall torque of {stall} N m"),
                    "a motor's no-load speed is not zero and has the sign of its stall torque",
                );
            }
        }
        Load::Spring { stiffness, rest } => {
            list.not_negative(&key("stiffness"), *stiffness, "N/m");
            list.finite(&key("rest"), *rest);
        }
        Load::Gas { area, ambient, .. } => {
            list.positive(&key("bore"), *area, "m2");
            list.not_negative(&key("ambient"), *ambient, "Pa");
        }
        Load::Table(_) | Load::Expression(_) | Load::Function { .. } => {}
    }
}

fn clearance(list: &mut Check, clearance: &Clearance) {
    list.not_negative("clearance.radial", clearance.radial, "m");
    for (name, value) in [
        ("bearing_radius", clearance.bearing_radius),
        ("young_modulus", clearance.young_modulus),
    ] {
        if let Some(value) = value {
            list.positive(&format!("clearance.{name}"), value, "");
        }
    }
    for (name, value, low, high) in [
        ("poisson_ratio", clearance.poisson_ratio, -1.0, 0.5),
        ("restitution", clearance.restitution, 0.0, 1.0),
        ("friction", clearance.friction, 0.0, f64::MAX),
    ] {
        if let Some(value) = value
            && !(low..=high).contains(&value)
        {
            list.add(
                &format!("clearance.{name}"),
                format!("{value} is not a possible {name}"),
                "poisson_ratio lies between -1 and 0.5, restitution between 0 and 1, friction is not negative",
            );
        }
    }
}

fn run(list: &mut Check, run: &Run) {
    match run.extent {
        Some(Extent::Duration(duration)) => list.not_negative("run.duration", duration, "s"),
        Some(Extent::Revolutions(turns)) => list.not_negative("run.revolutions", turns, ""),
        None => {}
    }
    match run.output_every {
        Some(Every::Time(step)) => list.positive("run.output_every", step, "s"),
        Some(Every::Angle(step)) => list.positive("run.output_every", step, "rad"),
        None => {}
    }
    if !(LEAST_TOLERANCE..=0.1).contains(&run.tolerance) {
        list.add(
            "run.tolerance",
            format!("a tolerance of {} cannot be used", run.tolerance),
            "give one from 1e-14 to 0.1; 1e-10 is the default",
        );
    }
}
