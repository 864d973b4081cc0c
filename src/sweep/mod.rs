//! Parameter sweep: scene and values of keys in, key figures of a full factorial or Latin hypercube sample out.

mod design;
mod figure;
mod options;
mod pareto;

use std::ops::Range;
use std::sync::Arc;
use std::time::{Duration, Instant};

use crate::error::Error;
use crate::kinematics::{self, Kinematics};
pub use crate::numeric::latin_hypercube::LatinHypercube;
use crate::numeric::parallel;
use crate::numeric::stop::Stop;
use crate::scene::{Draft, Scene, Varied, VariedValue};

pub use design::{Design, Outcome};
pub use figure::{Figure, FigureValue, Source};
pub use options::SweepOptions;
pub use pareto::{Goal, Member, ParetoFront};

const VARY_EXAMPLE: &str =
    "say which key takes which values, like --vary geometry.offset=0mm:20mm:41";

/// Checks that each key is varied once, distributions are sampled, and the number of designs is within [`Sweep::MOST_DESIGNS`].
fn check_count(varied: &[Varied], sample: Option<LatinHypercube>) -> Result<(), Error> {
    let refused = |what, help: &str| Err(Error::refused(what, help));
    for (i, one) in varied.iter().enumerate() {
        if varied[..i].iter().any(|other| other.key() == one.key()) {
            return refused(
                format!("`{}` is varied twice", one.key()),
                "give all its values at once, like geometry.rod=100mm,120mm,125mm",
            );
        }
        if one.is_distribution() && sample.is_none() {
            return refused(
                format!("`{} = {one}` is a distribution", one.key()),
                "say how many designs are drawn from it, like --sample 1000; or how many values there are, like 0mm:20mm:41",
            );
        }
    }
    let designs = match sample {
        Some(sample) => usize::try_from(sample.count).ok(),
        None => varied
            .iter()
            .try_fold(1usize, |product, one| product.checked_mul(one.len())),
    };
    match designs {
        _ if varied.is_empty() => refused("no key is varied".to_owned(), VARY_EXAMPLE),
        Some(designs) if designs <= Sweep::MOST_DESIGNS => Ok(()),
        _ => {
            let what = format!("the sweep has more than {} designs", Sweep::MOST_DESIGNS);
            refused(what, VARY_EXAMPLE)
        }
    }
}

/// Scene with varied values: each combination is a design, the last key varying fastest, the first one slowest; or each
/// point of a Latin hypercube sample is.
///
/// ```
/// use slider_crank::scene::{Draft, Varied};
/// use slider_crank::sweep::{Sweep, SweepOptions};
///
/// let rods: Varied = "geometry.rod=100mm:160mm:4".parse().unwrap();
/// let sweep = Sweep::new(Draft::duarte(), vec![rods], SweepOptions::default())?;
/// let design = sweep.design(2);
/// assert_eq!(design.values[0].text, "140 mm");
/// assert_eq!(design.kinematics.unwrap().stroke_m, 0.094);
/// assert!(design.motion.unwrap().last.omega_rad_per_s > 90.0);
/// assert_eq!(sweep.part(2, 3)?, 1..2);
/// assert!(sweep.part(4, 3).is_err());
/// # Ok::<(), slider_crank::error::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Sweep {
    draft: Draft,
    /// Varied keys.
    pub(crate) varied: Vec<Varied>,
    /// Options, with the figures and computations derived from each other.
    pub(crate) options: SweepOptions,
    /// Title of the scene.
    pub(crate) title: String,
    /// The turn of all designs, if figures of it are asked for and no varied key changes it.
    turn: Option<Arc<Kinematics>>,
}

impl Sweep {
    /// Maximum number of designs of a sweep; more come from a typing error.
    pub const MOST_DESIGNS: usize = 1_000_000_000;

    /// Prepares a sweep over all combinations of the values, or over a sample.
    ///
    /// # Errors
    /// [`Error::Refused`] if no key is varied, one key is varied twice, there are more than [`Sweep::MOST_DESIGNS`] designs,
    /// a distribution is not sampled, forces or named figures of a motion have no motion, or a figure of the flywheel
    /// no coefficient of fluctuation; [`Error::Scene`] if neither the scene as written nor the first design can be
    /// read, or a varied load does not exist.
    pub fn new(draft: Draft, varied: Vec<Varied>, options: SweepOptions) -> Result<Sweep, Error> {
        check_count(&varied, options.sample)?;
        let mut sweep = Sweep {
            draft,
            varied,
            options,
            title: String::new(),
            turn: None,
        };
        // Errors of the file are reported here once, not in every design.
        for one in &sweep.varied {
            sweep.draft.takes(one)?;
        }
        let first = || sweep.scene(&sweep.values(0));
        let scene = sweep.draft.scene().or_else(|_| first())?;
        let runs = |one: &Varied| ["run.duration", "run.revolutions"].contains(&&*one.key());
        let has_run = scene.run.extent.is_some() || sweep.varied.iter().any(runs);
        sweep.options.derive_computations(has_run)?;
        let changes_turn =
            |one: &Varied| one.key().starts_with("geometry.") || one.key() == "motion.speed";
        let is_shared = sweep.options.has(Source::Turn) && !sweep.varied.iter().any(changes_turn);
        sweep.turn = is_shared.then(|| Arc::new(kinematics::of_checked(&scene)));
        sweep.title = scene.title.unwrap_or_default();
        Ok(sweep)
    }

    /// Returns the number of designs, at least one.
    #[allow(clippy::len_without_is_empty)]
    pub fn len(&self) -> usize {
        match self.options.sample {
            Some(sample) => sample.count as usize,
            None => self.varied.iter().map(Varied::len).product(),
        }
    }

    /// Returns a copy of the sweep that estimates the error of each motion.
    pub fn with_estimates(&self) -> Sweep {
        let mut sweep = self.clone();
        sweep.options.run.estimate = true;
        sweep
    }

    /// Returns the designs of part `part` of `parts`, counted from 1: consecutive parts of sizes equal to one design.
    ///
    /// # Errors
    /// [`Error::Refused`] if there is no such part.
    pub fn part(&self, part: usize, parts: usize) -> Result<Range<usize>, Error> {
        if part < 1 || part > parts {
            return Err(Error::refused(
                format!("there is no part {part} of {parts}"),
                "count the parts from 1",
            ));
        }
        let edge = |k: usize| (self.len() as u128 * k as u128 / parts as u128) as usize;
        Ok(edge(part - 1)..edge(part))
    }

    /// Returns a hash (64-bit FNV-1a) of program version, scene file, varied values and options, without requests to
    /// stop; one sweep has the same hash on all systems.
    pub fn identity(&self) -> u64 {
        let mut options = self.options.clone();
        options.run.stop = None;
        let (version, scene) = (env!("CARGO_PKG_VERSION"), self.draft.text());
        let mut text = format!("{version}\0{scene}\0{options:?}");
        for one in &self.varied {
            text += &format!("\0{}\0{one}", one.key());
        }
        text.bytes().fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
            (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
        })
    }

    /// Returns the value of each varied key in a design.
    fn values(&self, design: usize) -> Vec<VariedValue> {
        if let Some(sample) = self.options.sample {
            let keys = (0..).zip(&self.varied);
            let value = |(key, one): (u64, &Varied)| one.quantile(sample.at(key, design as u64));
            return keys.map(value).collect();
        }
        let mut rest = design;
        let mut values: Vec<VariedValue> = Vec::with_capacity(self.varied.len());
        for one in self.varied.iter().rev() {
            values.push(one.value(rest % one.len()));
            rest /= one.len();
        }
        values.reverse();
        values
    }

    fn scene(&self, values: &[VariedValue]) -> Result<Scene, Error> {
        Ok(self.draft.with_values(&self.varied, values)?)
    }

    /// Computes one design, counted from 0 and below [`Sweep::len`].
    pub fn design(&self, index: usize) -> Design {
        self.design_of(index, self.values(index))
    }

    /// Computes the design of `values`, with index `index`.
    pub fn design_of(&self, index: usize, values: Vec<VariedValue>) -> Design {
        let scene = self.scene(&values);
        Design::new(index, values, scene, &self.options, self.turn.clone())
    }

    /// Computes designs on all cores, keeps of each what `make` returns, and passes that to `take` in order, in batches.
    ///
    /// # Errors
    /// Errors of `take`; [`Error::Interrupted`].
    pub fn map_designs<R: Send>(
        &self,
        range: Range<usize>,
        make: impl Fn(Design) -> R + Sync,
        mut take: impl FnMut(Vec<R>) -> Result<(), Error>,
    ) -> Result<(), Error> {
        /// Target for the time of one batch, half to once this: long against the start of threads, and short enough for its
        /// designs to stay in the cache.
        const BATCH_TIME: Duration = Duration::from_millis(20);
        let (mut start, mut count) = (range.start, 16);
        while start < range.end {
            let end = range.end.min(start + count);
            let begun = Instant::now();
            let made = parallel::map(start..end, |index| make(self.design(index)));
            if begun.elapsed() < BATCH_TIME / 2 {
                count *= 2;
            } else if begun.elapsed() > BATCH_TIME {
                count = (count / 2).max(16);
            }
            let stop = self.options.run.stop.as_ref();
            if stop.is_some_and(Stop::is_requested) {
                return Err(Error::Interrupted);
            }
            take(made)?;
            start = end;
        }
        Ok(())
    }
}
