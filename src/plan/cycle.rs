//! Cycle of the loads: the least common multiple of their periods over the crank angle, in whole turns.

use serde::Serialize;

use crate::scene::{LoadOf, Period, Periodicity, Scene, Variable};

/// The cycle of a scene: the least common multiple of the periods of its loads, in whole turns.
#[derive(Clone, Debug, Serialize)]
pub struct Cycle {
    /// Length in whole turns; none if the loads do not repeat.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub turns: Option<u32>,
    /// Why the loads do not repeat; none if they do.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub why_not: Option<String>,
    /// Period of each load.
    pub loads: Vec<LoadPeriod>,
}

/// Period of one load over the crank angle.
#[derive(Clone, Debug, Serialize)]
pub struct LoadPeriod {
    /// Key, like `torque[1]`, and description of the load.
    pub name: String,
    /// Period of the load, or why there is none.
    pub repeats: String,
    /// Warning that the load is not known between the nodes of panels and steps, if it is not.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub between_nodes: Option<&'static str>,
}

impl Cycle {
    /// Computes the cycle of a scene; loads that depend on the time have none.
    pub fn of(scene: &Scene) -> Cycle {
        let mut turns = cycle_over_angle(scene);
        for of in non_zero(scene).filter(reads_time) {
            turns = turns.and(Err(format!("{of} {DEPENDS_ON_TIME}")));
        }
        Cycle {
            turns: turns.as_ref().ok().copied(),
            why_not: turns.err(),
            loads: non_zero(scene).map(LoadPeriod::of).collect(),
        }
    }
}

/// Computes the cycle of a scene at fixed time, in whole turns; else names the load that does not repeat, and why.
pub(crate) fn cycle_over_angle(scene: &Scene) -> Result<u32, String> {
    let mut cycle = Periodicity::Always;
    for of in non_zero(scene) {
        cycle = cycle.common(of.repeats());
        if let Periodicity::Never(why) = cycle {
            return Err(format!("{of} does not repeat: {why}"));
        }
    }
    Ok(match cycle {
        Periodicity::After(period) => period.whole_turns(),
        _ => 1,
    })
}

const DEPENDS_ON_TIME: &str = "depends on the time t";
const ONLY_SAMPLED: &str = "a closure is seen at the nodes of panels and steps alone, which is no guarantee: state its finest scale";

/// Iterates over the loads of a scene that are not zero.
pub(super) fn non_zero(scene: &Scene) -> impl Iterator<Item = LoadOf<'_>> {
    scene.loads().filter(|of| !of.load.is_zero())
}

fn reads_time(of: &LoadOf<'_>) -> bool {
    of.reads().has(Variable::T)
}

impl LoadPeriod {
    fn of(of: LoadOf<'_>) -> LoadPeriod {
        LoadPeriod {
            name: of.to_string(),
            repeats: match of.repeats() {
                _ if reads_time(&of) => format!("not: it {DEPENDS_ON_TIME}"),
                Periodicity::Always => "at every angle".to_owned(),
                Periodicity::After(Period::TURN) => "each turn".to_owned(),
                Periodicity::After(period) => format!("after {period}"),
                Periodicity::Never(why) => format!("not: {why}"),
            },
            between_nodes: of.load.is_only_sampled().then_some(ONLY_SAMPLED),
        }
    }
}
