//! One design of a sweep: computes its closed-form turn, diagrams, steady state and motion, as the options ask.

use std::sync::Arc;

use super::{Source, SweepOptions};
use crate::error::Error;
use crate::kinematics::{self, Diagrams, Kinematics, forces, left_out_of_forces};
use crate::mechanism::{Class, Linkage};
use crate::numeric::stop::Stop;
use crate::scene::{Scene, VariedValue};
use crate::simulate::{NoRows, Options, SteadyState, Summary, simulate_rows, steady_state};

named! {
    /// Extent to which a design could be computed.
    #[derive(Default)]
    pub enum Outcome {
        /// All results were computed.
        #[default]
        Done = "done",
        /// The motion ended before the end of the run, or the search for the steady state at its work limit.
        Stopped = "stopped",
        /// The scene is valid, but diagrams, steady state or motion cannot be computed.
        Refused = "refused",
        /// The values give no valid scene.
        Impossible = "impossible",
    }
}

/// Results of one design, from which its key figures are read.
#[derive(Clone, Debug, Default)]
pub struct Design {
    /// Index in the sweep, from 0.
    pub index: usize,
    /// Value of each varied key.
    pub values: Vec<VariedValue>,
    /// Extent to which the design could be computed.
    pub outcome: Outcome,
    /// Reason for any other outcome than done, then warnings.
    pub notes: Vec<String>,
    /// One turn in closed form, if figures of it are asked for; none for an impossible design.
    pub kinematics: Option<Arc<Kinematics>>,
    /// Diagrams of a cycle, if asked for and defined.
    pub diagrams: Option<Diagrams>,
    /// Forward motion, if asked for and computed; the list of events is empty.
    pub motion: Option<Summary>,
    /// Periodic steady state, if asked for and found.
    pub steady: Option<SteadyState>,
}

impl Design {
    pub(super) fn new(
        index: usize,
        values: Vec<VariedValue>,
        scene: Result<Scene, Error>,
        options: &SweepOptions,
        turn: Option<Arc<Kinematics>>,
    ) -> Design {
        let mut design = Design {
            index,
            values,
            ..Design::default()
        };
        match scene {
            Ok(scene) => design.compute(&scene, options, turn),
            Err(error) => design.fail(Outcome::Impossible, &error),
        }
        design
    }

    /// Computes all that is asked of a valid scene, whose turn may be known.
    fn compute(&mut self, scene: &Scene, options: &SweepOptions, turn: Option<Arc<Kinematics>>) {
        let class = Class::of(&Linkage::new(&scene.geometry));
        self.notes.extend(kinematics::warnings(class));
        let own = || Arc::new(kinematics::of_checked(scene));
        self.kinematics = turn.or_else(|| options.has(Source::Turn).then(own));
        if options.has(Source::Diagrams) {
            self.notes.extend(left_out_of_forces(scene));
            match forces(scene) {
                // Counterweight for half of the reciprocating mass, the usual part.
                Ok(analysis) => self.diagrams = analysis.diagrams(scene, 0.5),
                Err(error) => self.fail(Outcome::Refused, &error),
            }
        }
        let run = Options {
            stop: options.run.stop.as_ref().map(Stop::of_one),
            // Only the number of events is needed.
            events_kept: 0,
            ..options.run.clone()
        };
        if options.steady {
            match steady_state(scene, options.fluctuation, &run) {
                Ok(steady) => self.steady = Some(steady),
                Err(error) => self.fail(Outcome::Refused, &error),
            }
        }
        if !options.motion {
            return;
        }
        let summary = match simulate_rows(scene, &run, &mut NoRows) {
            Ok(run) => run.summary,
            Err(error) => return self.fail(Outcome::Refused, &error),
        };
        if let Some(stopped) = &summary.stopped {
            self.outcome = Outcome::Stopped;
            self.notes.insert(0, stopped.to_string());
        }
        let warnings = summary.warnings.iter().map(ToString::to_string);
        self.notes.extend(warnings);
        self.motion = Some(summary);
    }

    fn fail(&mut self, outcome: Outcome, error: &Error) {
        self.outcome = match error {
            Error::Incomplete(_) => Outcome::Stopped,
            _ => outcome,
        };
        let first = match error {
            Error::Scene(problems) => {
                let list = problems.list().iter();
                let what: Vec<&str> = list.map(|problem| problem.what.as_str()).collect();
                what.join("; ")
            }
            other => other.to_string().lines().take(1).collect(),
        };
        self.notes.insert(0, first);
    }
}
