//! After how many turns all loads of a scene are the same again.

use serde::Serialize;

use crate::scene::{Load, Period, Repeats, Scene, Variable, Variables};

/// The cycle of a scene: the least common multiple of the periods of its loads, in whole turns.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Cycle {
    /// Whole turns; none if the loads do not repeat.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub turns: Option<u32>,
    /// Why they do not.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub why_not: Option<String>,
    /// Each load.
    pub loads: Vec<LoadPeriod>,
}

/// One load over the crank angle.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LoadPeriod {
    /// As `torque[1]`, with what it is.
    pub name: String,
    /// Period in words, or why there is none.
    pub repeats: String,
    /// What is not known of it between the nodes of panels and steps, if anything.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub between_nodes: Option<&'static str>,
}

impl Cycle {
    /// The cycle of a scene; loads that depend on the time have none.
    pub fn of(scene: &Scene) -> Cycle {
        let named: Vec<Named> = named(scene).collect();
        let mut turns = over_angle(scene);
        for load in named.iter().filter(|load| load.reads_time()) {
            turns = turns.and(Err(format!("{} {OF_TIME}", load.name)));
        }
        Cycle {
            turns: turns.as_ref().ok().copied(),
            why_not: turns.err(),
            loads: named.iter().map(LoadPeriod::of).collect(),
        }
    }
}

/// The cycle of a scene as far as its loads depend on the crank angle, at equal times, or which load has none and why.
pub(crate) fn over_angle(scene: &Scene) -> Result<u32, String> {
    let mut cycle = Repeats::Always;
    for load in named(scene) {
        cycle = cycle.with(load.repeats);
        if let Repeats::Never(why) = cycle {
            return Err(format!("{} does not repeat: {why}", load.name));
        }
    }
    Ok(match cycle {
        Repeats::After(period) => period.whole_turns(),
        _ => 1,
    })
}

/// A load with what the plan needs of it.
pub(super) struct Named<'a> {
    pub name: String,
    pub load: &'a Load,
    repeats: Repeats,
    on_slider: bool,
}

impl Named<'_> {
    /// The variables it depends on.
    pub fn reads(&self) -> Variables {
        self.load.reads(self.on_slider)
    }

    fn reads_time(&self) -> bool {
        self.reads().has(Variable::T)
    }
}

const OF_TIME: &str = "depends on the time t";
const SAMPLED: &str = "a closure is seen at the nodes of panels and steps alone, which is no guarantee: state its finest scale";

/// The loads of a scene that are not zero, numbered as they stand there.
pub(super) fn named(scene: &Scene) -> impl Iterator<Item = Named<'_>> {
    let loads = scene.loads().filter(|of| !of.load.is_zero());
    loads.map(|of| Named {
        name: format!("{} ({})", of.key(), of.load),
        load: of.load,
        repeats: of.load.repeats(of.on_slider),
        on_slider: of.on_slider,
    })
}

impl LoadPeriod {
    fn of(load: &Named<'_>) -> LoadPeriod {
        let repeats = match load.repeats {
            _ if load.reads_time() => format!("not: it {OF_TIME}"),
            Repeats::Always => "at every angle".to_owned(),
            Repeats::After(period) if period == Period::TURN => "each turn".to_owned(),
            Repeats::After(period) => format!("after {period}"),
            Repeats::Never(why) => format!("not: {why}"),
        };
        LoadPeriod {
            name: load.name.clone(),
            repeats,
            between_nodes: load.load.is_only_sampled().then_some(SAMPLED),
        }
    }
}
