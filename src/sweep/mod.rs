//! Key figures of many designs: one scene with some of its values varied.

mod design;

use std::hash::{DefaultHasher, Hash, Hasher};
use std::ops::Range;
use std::time::{Duration, Instant};

use crate::error::Error;
use crate::numeric::parallel;
use crate::numeric::stop::Stop;
use crate::plan::Method;
use crate::scene::{Draft, Scene, Varied};

use crate::simulate::{Options, SteadyOptions};
pub use design::{Design, Outcome};

/// What is asked of every design beside what the scene says.
#[derive(Clone, Debug, PartialEq)]
pub struct SweepOptions {
    /// Whether the forward motion is computed, if the scene has a run; else one turn in closed form only.
    pub motion: bool,
    /// Whether the largest joint forces of the motion are looked for.
    pub reactions: bool,
    /// Whether the periodic steady state is looked for, and with which flywheel.
    pub steady: Option<SteadyOptions>,
    /// The method of the forward motion.
    pub method: Method,
    /// Whether its global error is estimated, by a second run.
    pub estimate: bool,
    /// Most evaluations of the equation in one design.
    pub max_evaluations: u64,
    /// A request to stop; designs that are not complete by then are not handed on.
    pub stop: Option<Stop>,
}

impl Default for SweepOptions {
    fn default() -> SweepOptions {
        let one = Options::default();
        SweepOptions {
            motion: true,
            reactions: false,
            steady: None,
            method: one.method,
            estimate: one.estimate,
            max_evaluations: one.max_evaluations,
            stop: None,
        }
    }
}

/// A scene with values varied: every combination of them is a design. The last of the varied keys changes
/// from one design to the next, the first one slowest.
///
/// ```
/// use slider_crank::scene::{Draft, Varied};
/// use slider_crank::sweep::{Sweep, SweepOptions};
///
/// let rods: Varied = "geometry.rod=100mm:160mm:4".parse().unwrap();
/// let sweep = Sweep::new(Draft::duarte(), vec![rods], SweepOptions::default())?;
/// let design = sweep.design(2);
/// assert_eq!(design.values, [2]);
/// assert_eq!(design.kinematics.unwrap().stroke_m, 0.094);
/// assert!(design.motion.unwrap().last.omega_rad_per_s > 90.0);
/// assert_eq!(sweep.part(2, 3)?, 1..2);
/// assert!(sweep.part(4, 3).is_err());
/// # Ok::<(), slider_crank::error::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Sweep {
    draft: Draft,
    varied: Vec<Varied>,
    options: SweepOptions,
    title: String,
}

impl Sweep {
    /// Most designs of a sweep.
    pub const MOST: usize = 1_000_000_000;

    /// Every combination of these values.
    ///
    /// # Errors
    /// [`Error::Refused`] if nothing is varied, a key twice, or there are more than [`Sweep::MOST`] designs;
    /// or if forces are asked for without a motion;
    /// [`Error::Scene`] if neither the scene as it is written nor the first design can be read, or if a load that
    /// is to be varied is not there.
    pub fn new(
        draft: Draft,
        varied: Vec<Varied>,
        mut options: SweepOptions,
    ) -> Result<Sweep, Error> {
        for (i, one) in varied.iter().enumerate() {
            if varied[..i].iter().any(|other| other.key() == one.key()) {
                return Err(Error::refused(
                    format!("`{}` is varied twice", one.key()),
                    "give all its values at once, like geometry.rod=100mm,120mm,125mm",
                ));
            }
        }
        let designs = varied
            .iter()
            .try_fold(1usize, |product, one| product.checked_mul(one.len()))
            .filter(|product| *product <= Sweep::MOST);
        if varied.is_empty() || designs.is_none() {
            return Err(Error::refused(
                match designs {
                    Some(_) => "no key is varied".to_owned(),
                    None => format!("the sweep has more than {} designs", Sweep::MOST),
                },
                "say which key takes which values, like --vary geometry.offset=0mm:20mm:41",
            ));
        }
        let mut sweep = Sweep {
            draft,
            varied,
            options: SweepOptions::default(),
            title: String::new(),
        };
        // What is wrong with the file shows here once, not in every design.
        sweep
            .varied
            .iter()
            .try_for_each(|one| sweep.draft.takes(one))?;
        let scene = sweep
            .draft
            .scene()
            .or_else(|_| sweep.scene(&sweep.values(0)))?;
        let runs = ["run.duration", "run.revolutions"];
        options.motion &= scene.run.extent.is_some()
            || sweep
                .varied
                .iter()
                .any(|one| runs.contains(&one.key().as_str()));
        if options.reactions && !options.motion {
            return Err(Error::refused(
                "the largest joint forces are those of a motion, and none is computed",
                "give the scene a [run], and do without --no-motion",
            ));
        }
        sweep.options = options;
        sweep.title = scene.title.unwrap_or_default();
        Ok(sweep)
    }

    /// Number of designs, at least one.
    #[allow(clippy::len_without_is_empty)]
    pub fn len(&self) -> usize {
        self.varied.iter().map(Varied::len).product()
    }

    /// The keys that are varied.
    pub fn varied(&self) -> &[Varied] {
        &self.varied
    }

    /// Whether the forward motion is computed.
    pub fn has_motion(&self) -> bool {
        self.options.motion
    }

    /// Whether the largest joint forces are looked for.
    pub fn has_reactions(&self) -> bool {
        self.options.reactions
    }

    /// Whether the steady state is looked for, and with which flywheel.
    pub fn steady(&self) -> Option<&SteadyOptions> {
        self.options.steady.as_ref()
    }

    /// Title of the scene.
    pub fn title(&self) -> &str {
        &self.title
    }

    /// The designs of part `part` of `parts`, counted from 1: parts of nearly the same size that follow each
    /// other.
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

    /// A number that is another one for a sweep of another scene file, other values or other options.
    pub fn identity(&self) -> u64 {
        let mut hasher = DefaultHasher::new();
        let version = env!("CARGO_PKG_VERSION");
        (version, self.draft.text()).hash(&mut hasher);
        let options = SweepOptions {
            stop: None,
            ..self.options.clone()
        };
        format!("{options:?}").hash(&mut hasher);
        for one in &self.varied {
            one.key().hash(&mut hasher);
            (0..one.len()).for_each(|i| one.text(i).hash(&mut hasher));
        }
        hasher.finish()
    }

    /// Which value each varied key has in a design.
    fn values(&self, design: usize) -> Vec<usize> {
        let mut rest = design;
        let mut values: Vec<usize> = Vec::with_capacity(self.varied.len());
        for one in self.varied.iter().rev() {
            values.push(rest % one.len());
            rest /= one.len();
        }
        values.reverse();
        values
    }

    fn scene(&self, values: &[usize]) -> Result<Scene, Error> {
        let values = self.varied.iter().zip(values.iter().copied());
        Ok(self.draft.with(values)?)
    }

    /// Computes one design, counted from 0 and below [`Sweep::len`].
    pub fn design(&self, index: usize) -> Design {
        let values = self.values(index);
        let scene = self.scene(&values);
        Design::new(index, values, scene, &self.options)
    }

    /// Computes designs on all cores and hands them on in their order, some at a time.
    ///
    /// # Errors
    /// Those of `take`; [`Error::Interrupted`].
    pub fn designs(
        &self,
        range: Range<usize>,
        mut take: impl FnMut(Vec<Design>) -> Result<(), Error>,
    ) -> Result<(), Error> {
        /// Time after which designs are handed on, so that little is lost when the sweep is cut off.
        const PAUSE: Duration = Duration::from_millis(500);
        let (mut start, mut count) = (range.start, 16);
        while start < range.end {
            let end = range.end.min(start + count);
            let begun = Instant::now();
            let designs = parallel::map(start..end, |index| self.design(index));
            if begun.elapsed() < PAUSE / 2 {
                count = (2 * count).min(1 << 14);
            } else if begun.elapsed() > PAUSE {
                count = (count / 2).max(16);
            }
            if self.options.stop.as_ref().is_some_and(Stop::is_requested) {
                return Err(Error::Interrupted);
            }
            take(designs)?;
            start = end;
        }
        Ok(())
    }
}
