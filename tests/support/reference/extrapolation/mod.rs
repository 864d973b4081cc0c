//! Motions whose equations change at events, in double-double arithmetic: Gragg's modified midpoint rule with
//! extrapolation (Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, II.9). It is independent of the
//! methods under test.

mod run;

use run::Run;
use slider_crank::numeric::double_double::DoubleDouble;

/// Largest number of consecutive events without motion between them.
const STALLED: usize = 20;

/// State; its first number is the time, s.
pub(super) type State<const N: usize> = [DoubleDouble; N];

/// Motion made of smooth pieces.
pub(super) trait Pieces<const N: usize, const M: usize> {
    /// Set of equations of one piece.
    type Mode: Copy;

    /// Returns the rates of a state, not finite where they do not exist.
    fn rates(&self, mode: Self::Mode, y: &State<N>) -> State<N>;

    /// Returns quantities that are positive while the mode lasts.
    fn margins(&self, mode: Self::Mode, y: &State<N>) -> [DoubleDouble; M];

    /// Returns the continuation where a margin has become zero.
    fn change(&self, mode: Self::Mode, which: usize, y: &State<N>) -> Change<Self::Mode>;

    /// Returns the state at rest.
    fn resting(&self, y: &State<N>) -> State<N> {
        *y
    }

    /// Returns the first time after `t` (s) at which the rates are not smooth.
    fn next_time(&self, t: f64) -> f64;

    /// Returns the sizes of the numbers, the scale of the error of a step.
    fn sizes(&self, y: &State<N>) -> [f64; N];
}

/// Continuation after an event.
#[derive(Clone, Copy, Debug)]
pub(super) enum Change<T> {
    /// Another mode.
    Mode(T),
    /// Rest in this position until this time (s), then another mode; none: rest for good.
    Rest(Option<(f64, T)>),
    /// The equations end here.
    Ends,
    /// The continuation is unknown.
    Unknown,
}

/// Resolution and work limit.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fineness {
    /// Error of a step relative to the sizes.
    pub tolerance: f64,
    /// Largest number of evaluations.
    pub evaluations: u64,
}

/// Returns the state at `t_end` (s) or where the equations end, and whether they end; none if it is not found.
pub(super) fn follow<const N: usize, const M: usize, P: Pieces<N, M>>(
    pieces: &P,
    start: State<N>,
    first: Change<P::Mode>,
    t_end: f64,
    fineness: Fineness,
) -> Option<(State<N>, bool)> {
    let mut run = Run {
        pieces,
        fineness,
        evaluations: 0,
    };
    let (mut y, mut change) = (start, first);
    let mut stalled = 0;
    let mut h = (t_end - start[0].value()) * 1e-4;
    loop {
        let mode = match change {
            Change::Mode(mode) => mode,
            Change::Rest(Some((t, mode))) if t < t_end => {
                y = pieces.resting(&y);
                y[0] = DoubleDouble::from(t);
                mode
            }
            Change::Rest(_) => {
                y = pieces.resting(&y);
                y[0] = DoubleDouble::from(t_end);
                return Some((y, false));
            }
            Change::Ends => return Some((y, true)),
            Change::Unknown => return None,
        };
        let before = y[0];
        match run.piece(mode, &mut y, &mut h, t_end)? {
            Some(which) => change = pieces.change(mode, which, &y),
            None => return Some((y, false)),
        }
        let moved = (y[0] - before).value() > 1e-20 * t_end;
        stalled = if moved { 0 } else { stalled + 1 };
        if stalled > STALLED {
            return None;
        }
        h *= 0.1;
    }
}
