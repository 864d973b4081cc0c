//! Symmetries, balances and reversal of random motions under switching loads.

use std::f64::consts::TAU;
use std::ops::Range;

use crate::support::alike::{
    Kind, bodies, branch, image_moves_alike, runs_back, scaling, tolerances_agree,
};
use crate::support::image::{Act, Image, Setting};
use crate::support::random::{cases, magnitude};
use proptest::prelude::*;
use slider_crank::plan::Method;
use slider_crank::scene::{Interpolation, Variable};

/// Kind with the engine chosen by the plan.
const CHOSEN: Kind = Kind {
    method: Method::Auto,
    limits: false,
    slack: 0.0,
};
/// Kind with formulas whose jumps are found only by step control; two runs may locate a jump alike by chance.
const STEPPED: Kind = Kind {
    method: Method::Time,
    limits: false,
    slack: 1.0,
};

/// Switching load on a rotating crank: tables over time and angle with corners and steep flanks, or formulas with
/// jumps.
#[derive(Clone, Copy, Debug)]
struct Switch {
    kind: usize,
    at: f64,
    width: f64,
    low: f64,
    high: f64,
}

fn switch(kinds: Range<usize>) -> impl Strategy<Value = Switch> {
    (
        kinds,
        0.05..0.5f64,
        0.1..0.45f64,
        -0.3..0.3f64,
        -0.3..0.3f64,
    )
        .prop_map(|(kind, at, width, low, high)| Switch {
            kind,
            at,
            width,
            low,
            high,
        })
}

/// Kinds of switches that are tables, and below those that are formulas.
const TABLES: Range<usize> = 0..5;
const FORMULAS: Range<usize> = 5..8;
const OVER_ANGLE: Range<usize> = 5..6;
const IN_TIME: Range<usize> = 6..8;

impl Switch {
    /// Returns the switch as a load of this size, in a run of this duration.
    fn act(&self, unit: f64, duration: f64, omega: f64) -> Act {
        let (low, high) = (self.low * unit, self.high * unit);
        let over = |of, whole: f64, flank: f64, period| {
            let [from, to] = [self.at, self.at + self.width].map(|part| part * whole);
            let mut rows = vec![
                (from - flank * whole, low),
                (from, high),
                (to, high),
                (to + flank * whole, low),
            ];
            match period {
                Some(period) => rows.push((from - flank * whole + period, low)),
                None => {
                    rows.insert(0, (-0.2 * whole, low));
                    rows.push((1.2 * whole, low));
                }
            }
            Act::Table {
                of,
                rows,
                interpolation: Interpolation::Linear,
                period,
            }
        };
        let [from, to] = [self.at, self.at + self.width].map(|part| part * duration);
        let during = format!("(step(T - {from}) - step(T - {to}))");
        match self.kind {
            0 => over(Variable::T, duration, 0.02, None),
            1 => over(Variable::T, duration, 1e-6, None),
            2 => over(Variable::T, 0.3 * duration, 0.02, Some(0.3 * duration)),
            3 => over(Variable::Theta, TAU, 0.02, Some(TAU)),
            4 => over(Variable::Theta, TAU, 1e-5, Some(TAU)),
            5 => Act::Formula(format!(
                "({high})*step(sin((THETA) - {}) - {})",
                TAU * self.at,
                2.0 * self.width - 0.5
            )),
            6 => Act::Formula(format!("({low}) + ({})*{during}", high - low)),
            _ => Act::Formula(format!(
                "({})*(1 - (OMEGA)/({}))*{during}",
                high.abs() * omega.signum(),
                1.5 * omega
            )),
        }
    }

    fn keeps_energy(&self) -> bool {
        self.kind < 7
    }
}

fn switched(kinds: Range<usize>, lossless: bool) -> impl Strategy<Value = Setting> {
    let lengths = (
        magnitude(0.02, 0.3),
        1.2..5.0f64,
        -0.9..0.9f64,
        any::<bool>(),
    );
    let start = (
        0.0..TAU,
        magnitude(3.0, 100.0),
        any::<bool>(),
        4.0..40.0f64,
        0.0..0.05f64,
    );
    let switches = (switch(kinds.clone()), switch(kinds), any::<bool>());
    (lengths, bodies(), start, switches, 0.0..0.1f64)
        .prop_filter("loses energy", move |(.., (a, b, _), _)| {
            !lossless || a.keeps_energy() && b.keeps_energy()
        })
        .prop_map(
            move |((r, ratio, e, left), bodies, start, (first, second, pushes), gravity)| {
                let (theta, speed, back, way, loss) = start;
                let omega = if back { -speed } else { speed };
                let unit = r * omega * omega;
                let lengths = [r, r * (ratio + e.abs()), r * e];
                let mut setting = Setting::new(lengths, branch(left), bodies);
                setting.gravity = gravity * unit;
                setting.start = (theta, omega);
                setting.duration = way / speed;
                setting.torques = vec![first.act(r * unit, setting.duration, omega)];
                if !lossless {
                    setting.torques.push(Act::Viscous(loss * r * r * speed));
                }
                if pushes {
                    setting.forces = vec![second.act(unit, setting.duration, omega)];
                }
                setting
            },
        )
}

proptest! {
    #![proptest_config(cases(64))]

    #[test]
    fn tables_balance_their_energy_and_tolerances_agree(setting in switched(TABLES, false)) {
        tolerances_agree(&setting, CHOSEN, Method::Time)?;
    }

    #[test]
    fn tables_in_the_mirror_move_alike(setting in switched(TABLES, false)) {
        image_moves_alike(&setting, &Image::MIRRORED, CHOSEN)?;
    }

    #[test]
    fn tables_turned_half_round_move_alike(setting in switched(TABLES, false)) {
        image_moves_alike(&setting, &Image::TURNED, CHOSEN)?;
    }

    #[test]
    fn tables_in_other_units_move_alike(setting in switched(TABLES, false), image in scaling()) {
        image_moves_alike(&setting, &image, CHOSEN)?;
    }

    #[test]
    fn tables_without_losses_run_back(setting in switched(TABLES, true)) {
        runs_back(&setting, CHOSEN)?;
    }

    #[test]
    fn jumping_formulas_balance_their_energy_and_tolerances_agree(setting in switched(FORMULAS, false)) {
        tolerances_agree(&setting, STEPPED, Method::Time)?;
    }

    #[test]
    fn jumping_formulas_in_the_mirror_move_alike(setting in switched(FORMULAS, false)) {
        image_moves_alike(&setting, &Image::MIRRORED, STEPPED)?;
    }

    #[test]
    fn jumping_formulas_turned_half_round_move_alike(setting in switched(FORMULAS, false)) {
        image_moves_alike(&setting, &Image::TURNED, STEPPED)?;
    }

    #[test]
    fn jumping_formulas_in_other_units_move_alike(setting in switched(FORMULAS, false), image in scaling()) {
        image_moves_alike(&setting, &image, STEPPED)?;
    }

    #[test]
    fn jumping_formulas_without_losses_run_back(setting in switched(FORMULAS, true)) {
        runs_back(&setting, STEPPED)?;
    }
}

proptest! {
    #![proptest_config(cases(64))]

    #[test]
    fn the_energy_engine_knows_its_error_at_jumps_over_the_angle(setting in switched(OVER_ANGLE, true)) {
        tolerances_agree(&setting, CHOSEN, Method::Time)?;
    }

    #[test]
    fn the_angle_engine_knows_its_error_at_jumps_in_time(setting in switched(IN_TIME, false)) {
        tolerances_agree(&setting, CHOSEN, Method::Time)?;
    }
}
