//! After how many turns all loads of a scene are the same again.

use std::fmt;

use serde::Serialize;

use super::terms::shown;
use crate::scene::{Load, Period, Repeats, Scene, Variable, Variables};

/// The cycle of a scene: the least common multiple of the periods of its loads, in whole turns.
#[derive(Clone, Debug, Serialize)]
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
#[derive(Clone, Debug, Serialize)]
pub struct LoadPeriod {
    /// As `torque[1]`, with what it is.
    #[serde(serialize_with = "shown")]
    pub name: LoadName,
    /// Its period, or why there is none.
    #[serde(serialize_with = "shown")]
    pub repeats: LoadRepeats,
    /// What is not known of it between the nodes of panels and steps, if anything.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub between_nodes: Option<&'static str>,
}

/// A load by its place in the scene, shown with what it is.
#[derive(Clone, Debug)]
pub struct LoadName {
    list: &'static str,
    /// From 1.
    number: usize,
    load: Load,
}

/// How a load repeats, in words when it is shown.
#[derive(Clone, Copy, Debug)]
pub struct LoadRepeats {
    over_angle: Repeats,
    reads_time: bool,
}

impl Cycle {
    /// The cycle of a scene; loads that depend on the time have none.
    pub fn of(scene: &Scene) -> Cycle {
        let named: Vec<Named> = named(scene).collect();
        let mut turns = over_angle(scene);
        for load in named.iter().filter(|load| load.reads_time()) {
            turns = turns.and(Err(format!("{load} {OF_TIME}")));
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
            return Err(format!("{load} does not repeat: {why}"));
        }
    }
    Ok(match cycle {
        Repeats::After(period) => period.whole_turns(),
        _ => 1,
    })
}

/// A load with what the plan needs of it.
pub(super) struct Named<'a> {
    list: &'static str,
    /// From 1.
    number: usize,
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
    let lists = [("torque", &scene.torques), ("force", &scene.forces)];
    let all = lists.into_iter().flat_map(|(list, loads)| {
        let numbered = loads.iter().enumerate();
        numbered.map(move |(i, load)| (list, i + 1, load))
    });
    all.filter(|(_, _, load)| !load.is_zero())
        .map(|(list, number, load)| {
            let on_slider = list == "force";
            Named {
                list,
                number,
                load,
                repeats: load.repeats(on_slider),
                on_slider,
            }
        })
}

impl fmt::Display for Named<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}[{}] ({})", self.list, self.number, self.load)
    }
}

impl fmt::Display for LoadName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}[{}] ({})", self.list, self.number, self.load)
    }
}

impl fmt::Display for LoadRepeats {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.over_angle {
            _ if self.reads_time => write!(f, "not: it {OF_TIME}"),
            Repeats::Always => f.write_str("at every angle"),
            Repeats::After(Period::TURN) => f.write_str("each turn"),
            Repeats::After(period) => write!(f, "after {period}"),
            Repeats::Never(why) => write!(f, "not: {why}"),
        }
    }
}

impl LoadPeriod {
    fn of(load: &Named<'_>) -> LoadPeriod {
        LoadPeriod {
            name: LoadName {
                list: load.list,
                number: load.number,
                load: load.load.clone(),
            },
            repeats: LoadRepeats {
                over_angle: load.repeats,
                reads_time: load.reads_time(),
            },
            between_nodes: load.load.is_only_sampled().then_some(SAMPLED),
        }
    }
}
