//! Tables and keys that a scene file may have: the list that the reader reads and `schema` prints.

use crate::scene::unit::Quantity::{self, *};
use crate::scene::{Branch, ContactLaw, InertiaAbout, Interpolation, Joint, MotionKind, RodModel};
use Kind::{Choice, Formula, Kinds, Of, Text, TimeOrAngle};

/// Kind of values that a key may have.
#[derive(Clone, Copy, Debug)]
pub enum Kind {
    Of(Quantity),
    TimeOrAngle,
    Choice(&'static [&'static str]),
    /// One of these kinds of load or motion, each with its keys.
    Kinds(&'static [KindKeys]),
    /// Text: title, file name.
    Text,
    /// Quantity or, in loads of kind `expression`, a formula.
    Formula(Quantity),
}

impl Kind {
    /// Returns the quantity of the values, if they are one.
    pub fn quantity(self) -> Option<Quantity> {
        match self {
            Of(quantity) | Formula(quantity) => Some(quantity),
            _ => None,
        }
    }

    /// Returns the words that a value may be; empty for values of other kinds.
    pub fn words(self) -> Vec<&'static str> {
        match self {
            Choice(words) => words.to_vec(),
            Kinds(kinds) => kinds.iter().map(|kind| kind.name).collect(),
            _ => Vec::new(),
        }
    }
}

#[derive(Clone, Copy, Debug)]
pub struct Key {
    pub name: &'static str,
    pub kind: Kind,
    /// Meaning, for the schema.
    pub meaning: &'static str,
}

impl Key {
    /// Returns the key with a possible value, as written in the file.
    pub fn example(&self) -> String {
        let value = match self.kind {
            Of(quantity) => quantity.examples().split(", ").next(),
            TimeOrAngle => Some("\"1 deg\""),
            Choice(_) | Kinds(_) => {
                return format!("{} = \"{}\"", self.name, self.kind.words()[0]);
            }
            Text | Formula(_) => None,
        };
        format!("{} = {}", self.name, value.unwrap_or("\"...\""))
    }
}

/// Number of tables that a section may have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tables {
    One,
    /// Any number, written `[[name]]`.
    Many,
}

#[derive(Clone, Copy, Debug)]
pub struct Section {
    pub name: &'static str,
    pub tables: Tables,
    pub keys: &'static [Key],
    /// Names of the keys that must be present.
    pub required: &'static [&'static str],
    /// Meaning, for the schema.
    pub meaning: &'static str,
}

impl Section {
    pub fn key(&self, name: &str) -> Option<&'static Key> {
        self.keys.iter().find(|key| key.name == name)
    }

    /// Returns the kinds of tables of this section; empty if there is only one.
    pub fn kinds(&self) -> &'static [KindKeys] {
        match self.key("kind").map(|key| key.kind) {
            Some(Kinds(kinds)) => kinds,
            _ => &[],
        }
    }
}

/// Keys that a table of one kind takes beside `kind`; the first `required` must be present.
#[derive(Clone, Copy, Debug)]
pub struct KindKeys {
    pub name: &'static str,
    pub keys: &'static [&'static str],
    /// Number of keys, from the first, that must be present.
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

/// Keys of a dry load: a constant magnitude or a table of it.
const DRY_KEYS: &[&str] = &["value", "file", "of", "period", "interpolation"];

/// Kinds of `[[torque]]`.
const TORQUES: &[KindKeys] = &[
    kind("constant", &["value"], 1),
    kind("viscous", &["coefficient"], 1),
    kind("motor", &["stall", "no_load_speed"], 2),
    kind("table", TABLE_KEYS, 2),
    kind("dry", DRY_KEYS, 0),
    kind("expression", &["value"], 1),
];

/// Kinds of `[[force]]`.
const FORCES: &[KindKeys] = &[
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
const MOTIONS: &[KindKeys] = &[
    kind(MotionKind::Free.name(), &["angle", "speed"], 0),
    kind(MotionKind::ConstantSpeed.name(), &["speed", "angle"], 1),
];

const VARIABLES: &[&str] = &["theta", "t", "omega", "x", "v"];

macro_rules! keys {
    ($($name:ident: $kind:expr, $meaning:literal;)*) => {
        [$(Key { name: stringify!($name), kind: $kind, meaning: $meaning }),*]
    };
}

/// Sections as the number of tables, the name, the required keys, the meaning, the keys, and `+ BOX`
/// for a body that may be a box.
macro_rules! sections {
    ($($tables:ident $section:ident($($required:literal),*) $meaning:literal {
        $($name:ident: $kind:expr, $what:literal;)*
    } $(+ $box:ident)?)*) => {
        &[$(Section {
            name: stringify!($section),
            tables: Tables::$tables,
            required: &[$($required),*],
            meaning: $meaning,
            keys: &[
                $(Key { name: stringify!($name), kind: $kind, meaning: $what },)*
                $($box[0], $box[1], $box[2], $box[3],)?
            ],
        }),*]
    };
}

const BOX: [Key; 4] = keys! {
    density: Of(Density), "density of a box-shaped body; with length, width and depth it gives mass and inertia";
    length: Of(Length), "box size along the body";
    width: Of(Length), "box size across the body, in the plane of motion";
    depth: Of(Length), "box size normal to the plane of motion";
};

/// Sections of a scene file.
pub const SECTIONS: &[Section] = sections! {
    One geometry("crank", "rod") "lengths of the mechanism" {
        crank: Of(Length), "crank length r";
        rod: Of(Length), "connecting rod length l";
        offset: Of(Length), "offset e: the slider moves along y = -e; default 0";
        branch: Choice(Branch::NAMES), "side of the crank pin on which the slider is assembled; default right";
    }
    One crank() "mass properties of the crank; absent: massless" {
        mass: Of(Mass), "mass";
        cg: Of(Length), "centre of gravity from O along the crank; default 0";
        cg_lateral: Of(Length), "centre of gravity to the left of O->A; default 0";
        inertia: Of(Inertia), "moment of inertia about O";
    } + BOX
    One rod() "mass properties of the connecting rod; absent: massless" {
        model: Choice(RodModel::NAMES), "how its mass is modelled; default rigid";
        mass: Of(Mass), "mass";
        cg: Of(Length), "centre of gravity from the crank pin along the rod; default the middle of a box";
        cg_lateral: Of(Length), "centre of gravity to the left of A->P; default 0";
        inertia: Of(Inertia), "moment of inertia about the point named by inertia_about";
        inertia_about: Choice(InertiaAbout::NAMES), "reference point of the inertia; default cg";
    } + BOX
    One slider() "mass of the slider; absent: massless" {
        mass: Of(Mass), "mass";
    } + BOX
    One gravity("acceleration") "uniform gravity; absent: none" {
        acceleration: Of(Acceleration), "strength";
        direction: Of(Angle), "angle of the gravity vector from +x; default -90 deg, that is -y";
    }
    Many torque("kind") "a torque on the crank, counter-clockwise positive; all add up" {
        kind: Kinds(TORQUES), "kind of load";
        value: Formula(Torque),
            "the torque; for kind dry its magnitude against motion, for kind expression a formula in SI of t, theta, omega, x, v";
        coefficient: Of(RotaryDamping), "viscous: torque = -coefficient*omega";
        stall: Of(Torque), "motor: torque at rest";
        no_load_speed: Of(AngularSpeed), "motor: speed of zero torque";
        file: Text, "table: CSV file with two columns, units in the header";
        of: Choice(VARIABLES), "table: the variable of the first column";
        period: TimeOrAngle, "table over theta or t: the angle or time after which it repeats";
        interpolation: Choice(Interpolation::NAMES), "table: default pchip";
    }
    Many force("kind") "a force on the slider, along +x; all add up" {
        kind: Kinds(FORCES), "kind of load";
        value: Formula(Force),
            "the force; for kind dry its magnitude against motion, for kind expression a formula in SI of t, theta, omega, x, v";
        coefficient: Of(LinearDamping), "viscous: force = -coefficient*v";
        stiffness: Of(Stiffness), "spring: force = -stiffness*(x - rest)";
        rest: Of(Length), "spring: slider position x of zero force";
        file: Text, "table, gas: CSV file with two columns, units in the header";
        of: Choice(VARIABLES), "table: the variable of the first column";
        period: TimeOrAngle, "table over theta or t, gas: the angle or time after which it repeats";
        interpolation: Choice(Interpolation::NAMES), "table, gas: default pchip";
        bore: Of(Length), "gas: cylinder bore";
        ambient: Of(Pressure), "gas: pressure on the other side; default 1 atm";
    }
    One friction("coefficient") "Coulomb friction at the slider guide; absent: none" {
        coefficient: Of(Number), "kinetic coefficient";
        static_coefficient: Of(Number), "static coefficient; default the kinetic one";
    }
    One clearance("joint", "radial") "clearance at one revolute joint; absent: ideal joints" {
        joint: Choice(Joint::NAMES), "the joint";
        radial: Of(Length), "radial clearance";
        bearing_radius: Of(Length), "radius of the bearing";
        young_modulus: Of(Pressure), "Young's modulus of journal and bearing";
        poisson_ratio: Of(Number), "Poisson's ratio of journal and bearing";
        restitution: Of(Number), "coefficient of restitution, 0 to 1";
        friction: Of(Number), "coefficient of friction in the contact; default 0";
        contact_law: Choice(ContactLaw::NAMES), "law of the normal force; default lankarani-nikravesh";
        friction_threshold: Of(Velocity), "sliding speed up to which friction grows linearly; default 0.01 m/s";
        least_approach_speed: Of(Velocity),
            "contacts that begin slower are damped as if they began with this speed; default 0.001 m/s";
        eccentricity: Of(Length), "distance of the journal's centre from the bearing's at the start; default 0";
        eccentricity_angle: Of(Angle),
            "direction from the bearing's centre to the journal's at the start, from +x; default: as the ideal joint is loaded";
    }
    One motion() "initial or prescribed motion of the crank; absent: free, at rest at 0" {
        kind: Kinds(MOTIONS), "default free";
        angle: Of(Angle), "initial crank angle; default 0";
        speed: Of(AngularSpeed), "initial crank speed, default 0, or the constant one";
    }
    One run() "extent, output and accuracy of a run" {
        duration: Of(Time), "the run ends after this time";
        revolutions: Of(Number), "or after this many turns of the crank";
        output_every: TimeOrAngle, "distance of the output rows; default 500 rows over the run";
        tolerance: Of(Number), "local error target, relative and absolute; default 1e-10";
    }
};

pub fn section(name: &str) -> Option<&'static Section> {
    SECTIONS.iter().find(|section| section.name == name)
}
