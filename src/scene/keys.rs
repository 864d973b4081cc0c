//! Every table and key a scene file may have: read by the reader, printed by `schema`.

use super::unit::Quantity;

/// What a key's value may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// A quantity with its unit.
    Quantity(Quantity),
    /// A time or a crank angle.
    TimeOrAngle,
    /// One of these words.
    Choice(&'static [&'static str]),
    /// A text: title, file name.
    Text,
    /// A quantity or, in loads of kind `expression`, a formula.
    QuantityOrFormula(Quantity),
}

/// One key.
#[derive(Clone, Copy, Debug)]
pub struct Key {
    /// As written in the file.
    pub name: &'static str,
    /// What it holds.
    pub kind: Kind,
    /// What it means, for the schema.
    pub meaning: &'static str,
}

impl Key {
    /// The key with a value it may have, as written in the file.
    pub fn example(&self) -> String {
        let value = match self.kind {
            Kind::Quantity(quantity) => quantity.examples().split(", ").next(),
            Kind::TimeOrAngle => Some("\"1 deg\""),
            Kind::Choice(words) => return format!("{} = \"{}\"", self.name, words[0]),
            Kind::Text | Kind::QuantityOrFormula(_) => None,
        };
        format!("{} = {}", self.name, value.unwrap_or("\"...\""))
    }
}

/// One table of the file.
#[derive(Clone, Copy, Debug)]
pub struct Section {
    /// As written in the file.
    pub name: &'static str,
    /// `[[name]]`, any number of times.
    pub repeated: bool,
    /// Keys of the table.
    pub keys: &'static [Key],
    /// Keys that must be there.
    pub required: &'static [&'static str],
    /// What it means, for the schema.
    pub meaning: &'static str,
}

const fn key(name: &'static str, kind: Kind, meaning: &'static str) -> Key {
    Key {
        name,
        kind,
        meaning,
    }
}

const fn quantity(name: &'static str, quantity: Quantity, meaning: &'static str) -> Key {
    key(name, Kind::Quantity(quantity), meaning)
}

/// Keys that a table of this kind takes beside `kind`; the first `required` must be there.
#[derive(Clone, Copy, Debug)]
pub struct KindKeys {
    /// As written in the file.
    pub name: &'static str,
    /// Keys it takes.
    pub keys: &'static [&'static str],
    /// How many of them, from the first, must be there.
    pub required: usize,
}

const fn kind(name: &'static str, keys: &'static [&'static str], required: usize) -> KindKeys {
    KindKeys {
        name,
        keys,
        required,
    }
}

const TABLE_KEYS: &[&str] = &["file", "of", "period", "interpolation"];

/// A load that opposes motion: a constant magnitude or a table of it.
const DRY_KEYS: &[&str] = &["value", "file", "of", "period", "interpolation"];

/// Kinds of `[[torque]]`.
pub const TORQUES: &[KindKeys] = &[
    kind("constant", &["value"], 1),
    kind("viscous", &["coefficient"], 1),
    kind("motor", &["stall", "no_load_speed"], 2),
    kind("table", TABLE_KEYS, 2),
    kind("dry", DRY_KEYS, 0),
    kind("expression", &["value"], 1),
];

/// Kinds of `[[force]]`.
pub const FORCES: &[KindKeys] = &[
    kind("constant", &["value"], 1),
    kind("viscous", &["coefficient"], 1),
    kind("spring", &["stiffness", "rest"], 2),
    kind("table", TABLE_KEYS, 2),
    kind("dry", DRY_KEYS, 0),
    kind("expression", &["value"], 1),
    kind(
        "gas",
        &["file", "bore", "ambient", "period", "interpolation"],
        2,
    ),
];

/// Kinds of `[motion]`.
pub const MOTIONS: &[KindKeys] = &[
    kind("free", &["angle", "speed"], 0),
    kind("constant-speed", &["speed", "angle"], 1),
];

const VARIABLES: &[&str] = &["theta", "t", "omega", "x", "v"];
const INTERPOLATIONS: &[&str] = &["pchip", "linear"];

const BOX: [Key; 4] = [
    quantity(
        "density",
        Quantity::Density,
        "density of a box-shaped body; with length, width and depth it gives mass and inertia",
    ),
    quantity("length", Quantity::Length, "box size along the body"),
    quantity(
        "width",
        Quantity::Length,
        "box size across the body, in the plane of motion",
    ),
    quantity(
        "depth",
        Quantity::Length,
        "box size normal to the plane of motion",
    ),
];

/// Every table of a scene file.
pub const SECTIONS: &[Section] = &[
    Section {
        name: "geometry",
        repeated: false,
        required: &["crank", "rod"],
        meaning: "lengths of the mechanism",
        keys: &[
            quantity("crank", Quantity::Length, "crank length r"),
            quantity("rod", Quantity::Length, "connecting rod length l"),
            quantity(
                "offset",
                Quantity::Length,
                "offset e: the slider moves along y = -e; default 0",
            ),
            key(
                "branch",
                Kind::Choice(&["right", "left"]),
                "side of the crank pin on which the slider is assembled; default right",
            ),
        ],
    },
    Section {
        name: "crank",
        repeated: false,
        required: &[],
        meaning: "mass properties of the crank; absent: massless",
        keys: &[
            quantity("mass", Quantity::Mass, "mass"),
            quantity(
                "cg",
                Quantity::Length,
                "centre of gravity from O along the crank; default 0",
            ),
            quantity(
                "cg_lateral",
                Quantity::Length,
                "centre of gravity to the left of O->A; default 0",
            ),
            quantity("inertia", Quantity::Inertia, "moment of inertia about O"),
            BOX[0],
            BOX[1],
            BOX[2],
            BOX[3],
        ],
    },
    Section {
        name: "rod",
        repeated: false,
        required: &[],
        meaning: "mass properties of the connecting rod; absent: massless",
        keys: &[
            key(
                "model",
                Kind::Choice(&["rigid", "two-mass", "spin-only", "massless"]),
                "how its mass is modelled; default rigid",
            ),
            quantity("mass", Quantity::Mass, "mass"),
            quantity(
                "cg",
                Quantity::Length,
                "centre of gravity from the crank pin along the rod; default the middle of a box",
            ),
            quantity(
                "cg_lateral",
                Quantity::Length,
                "centre of gravity to the left of A->P; default 0",
            ),
            quantity(
                "inertia",
                Quantity::Inertia,
                "moment of inertia about the point named by inertia_about",
            ),
            key(
                "inertia_about",
                Kind::Choice(&["cg", "crank-pin"]),
                "reference point of the inertia; default cg",
            ),
            BOX[0],
            BOX[1],
            BOX[2],
            BOX[3],
        ],
    },
    Section {
        name: "slider",
        repeated: false,
        required: &[],
        meaning: "mass of the slider; absent: massless",
        keys: &[
            quantity("mass", Quantity::Mass, "mass"),
            BOX[0],
            BOX[1],
            BOX[2],
            BOX[3],
        ],
    },
    Section {
        name: "gravity",
        repeated: false,
        required: &["acceleration"],
        meaning: "uniform gravity; absent: none",
        keys: &[
            quantity("acceleration", Quantity::Acceleration, "strength"),
            quantity(
                "direction",
                Quantity::Angle,
                "angle of the gravity vector from +x; default -90 deg, that is -y",
            ),
        ],
    },
    Section {
        name: "torque",
        repeated: true,
        required: &["kind"],
        meaning: "a torque on the crank, counter-clockwise positive; all add up",
        keys: &[
            key(
                "kind",
                Kind::Choice(&["constant", "viscous", "motor", "table", "dry", "expression"]),
                "kind of load",
            ),
            key(
                "value",
                Kind::QuantityOrFormula(Quantity::Torque),
                "the torque; for kind dry its magnitude against motion, for kind expression a formula in SI of t, theta, omega, x, v",
            ),
            quantity(
                "coefficient",
                Quantity::RotaryDamping,
                "viscous: torque = -coefficient*omega",
            ),
            quantity("stall", Quantity::Torque, "motor: torque at rest"),
            quantity(
                "no_load_speed",
                Quantity::AngularSpeed,
                "motor: speed of zero torque",
            ),
            key(
                "file",
                Kind::Text,
                "table: CSV file with two columns, units in the header",
            ),
            key(
                "of",
                Kind::Choice(VARIABLES),
                "table: the variable of the first column",
            ),
            key(
                "period",
                Kind::TimeOrAngle,
                "table over theta or t: the angle or time after which it repeats",
            ),
            key(
                "interpolation",
                Kind::Choice(INTERPOLATIONS),
                "table: default pchip",
            ),
        ],
    },
    Section {
        name: "force",
        repeated: true,
        required: &["kind"],
        meaning: "a force on the slider, along +x; all add up",
        keys: &[
            key(
                "kind",
                Kind::Choice(&[
                    "constant",
                    "viscous",
                    "spring",
                    "table",
                    "dry",
                    "expression",
                    "gas",
                ]),
                "kind of load",
            ),
            key(
                "value",
                Kind::QuantityOrFormula(Quantity::Force),
                "the force; for kind dry its magnitude against motion, for kind expression a formula in SI of t, theta, omega, x, v",
            ),
            quantity(
                "coefficient",
                Quantity::LinearDamping,
                "viscous: force = -coefficient*v",
            ),
            quantity(
                "stiffness",
                Quantity::Stiffness,
                "spring: force = -stiffness*(x - rest)",
            ),
            quantity(
                "rest",
                Quantity::Length,
                "spring: slider position x of zero force",
            ),
            key(
                "file",
                Kind::Text,
                "table, gas: CSV file with two columns, units in the header",
            ),
            key(
                "of",
                Kind::Choice(VARIABLES),
                "table: the variable of the first column",
            ),
            key(
                "period",
                Kind::TimeOrAngle,
                "table over theta or t, gas: the angle or time after which it repeats",
            ),
            key(
                "interpolation",
                Kind::Choice(INTERPOLATIONS),
                "table, gas: default pchip",
            ),
            quantity("bore", Quantity::Length, "gas: cylinder bore"),
            quantity(
                "ambient",
                Quantity::Pressure,
                "gas: pressure on the other side; default 1 atm",
            ),
        ],
    },
    Section {
        name: "friction",
        repeated: false,
        required: &["coefficient"],
        meaning: "Coulomb friction at the slider guide; absent: none",
        keys: &[
            quantity("coefficient", Quantity::Number, "kinetic coefficient"),
            quantity(
                "static_coefficient",
                Quantity::Number,
                "static coefficient; default the kinetic one",
            ),
        ],
    },
    Section {
        name: "clearance",
        repeated: false,
        required: &["joint", "radial"],
        meaning: "clearance at one revolute joint; absent: ideal joints",
        keys: &[
            key(
                "joint",
                Kind::Choice(&["crank-pin", "wrist-pin"]),
                "the joint",
            ),
            quantity("radial", Quantity::Length, "radial clearance"),
            quantity("bearing_radius", Quantity::Length, "radius of the bearing"),
            quantity(
                "young_modulus",
                Quantity::Pressure,
                "Young's modulus of journal and bearing",
            ),
            quantity(
                "poisson_ratio",
                Quantity::Number,
                "Poisson's ratio of journal and bearing",
            ),
            quantity(
                "restitution",
                Quantity::Number,
                "coefficient of restitution, 0 to 1",
            ),
            quantity(
                "friction",
                Quantity::Number,
                "coefficient of friction in the contact; default 0",
            ),
            key(
                "contact_law",
                Kind::Choice(&[
                    "lankarani-nikravesh",
                    "hunt-crossley",
                    "flores",
                    "gonthier",
                    "hertz",
                    "massless-link",
                ]),
                "law of the normal force; default lankarani-nikravesh",
            ),
            quantity(
                "friction_threshold",
                Quantity::Velocity,
                "sliding speed up to which friction grows linearly; default 0.01 m/s",
            ),
            quantity(
                "least_approach_speed",
                Quantity::Velocity,
                "contacts that begin slower are damped as if they began with this speed; default 0.001 m/s",
            ),
            quantity(
                "eccentricity",
                Quantity::Length,
                "distance of the journal's centre from the bearing's at the start; default 0",
            ),
            quantity(
                "eccentricity_angle",
                Quantity::Angle,
                "direction from the bearing's centre to the journal's at the start, from +x; default: as the ideal joint is loaded",
            ),
        ],
    },
    Section {
        name: "motion",
        repeated: false,
        required: &[],
        meaning: "initial or prescribed motion of the crank; absent: free, at rest at 0",
        keys: &[
            key(
                "kind",
                Kind::Choice(&["free", "constant-speed"]),
                "default free",
            ),
            quantity("angle", Quantity::Angle, "initial crank angle; default 0"),
            quantity(
                "speed",
                Quantity::AngularSpeed,
                "initial crank speed, default 0, or the constant one",
            ),
        ],
    },
    Section {
        name: "run",
        repeated: false,
        required: &[],
        meaning: "extent, output and accuracy of a run",
        keys: &[
            quantity("duration", Quantity::Time, "the run ends after this time"),
            quantity(
                "revolutions",
                Quantity::Number,
                "or after this many turns of the crank",
            ),
            key(
                "output_every",
                Kind::TimeOrAngle,
                "distance of the output rows; default 500 rows over the run",
            ),
            quantity(
                "tolerance",
                Quantity::Number,
                "local error target, relative and absolute; default 1e-10",
            ),
        ],
    },
];

/// The section with this name.
pub fn section(name: &str) -> Option<&'static Section> {
    SECTIONS.iter().find(|section| section.name == name)
}

/// What would be right instead of `name`: the known name most like it, or all that `owner` has.
pub fn did_you_mean<'a>(
    name: &str,
    owner: &str,
    known: impl Iterator<Item = &'a str> + Clone,
) -> String {
    match nearest(name, known.clone()) {
        Some(near) => format!("did you mean `{near}`?"),
        None => format!("{owner} has {}", known.collect::<Vec<_>>().join(", ")),
    }
}

/// The candidate most like `name`, if any is like it at all.
pub fn nearest<'a>(name: &str, candidates: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    candidates
        .map(|candidate| (strsim::jaro_winkler(name, candidate), candidate))
        .filter(|(likeness, _)| *likeness > 0.75)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, candidate)| candidate)
}
