//! Defects of ode_solvers 0.6.2 for which `src/engine/runge_kutta.rs` has workarounds. A failure here means that they
//! are repaired, and that the workarounds can go.

use ode_solvers::{Dop853, Dopri5, OutputType, SVector, System};

struct Forced;

impl System<f64, SVector<f64, 1>> for Forced {
    fn system(&self, t: f64, y: &SVector<f64, 1>, dy: &mut SVector<f64, 1>) {
        dy[0] = -y[0] + t.sin();
    }
}

struct Oscillator;

impl System<f64, SVector<f64, 2>> for Oscillator {
    fn system(&self, _: f64, y: &SVector<f64, 2>, dy: &mut SVector<f64, 2>) {
        dy[0] = y[1];
        dy[1] = -y[0];
    }
}

/// Two stage times of Dop853 are wrong: it loses its order if the equation depends on time.
#[test]
fn dop853_loses_its_order_where_time_occurs() {
    let mut solver = Dop853::from_param(
        Forced,
        0.0,
        10.0,
        10.0,
        SVector::from([1.0]),
        1e-8,
        1e-8,
        0.9,
        0.0,
        0.333,
        6.0,
        10.0,
        0.0,
        1_000_000,
        u32::MAX,
        OutputType::Sparse,
    );
    let evaluations = solver.integrate().unwrap().num_eval;
    assert!(evaluations > 10_000, "{evaluations} evaluations only");
}

/// The last point of dense output is extrapolated from a step that ended before it.
#[test]
fn dense_output_extrapolates_its_last_point() {
    let start = SVector::from([1.0, 0.0]);
    let mut solver = Dopri5::new(Oscillator, 0.0, 10.0, 1.0, start, 1e-12, 1e-12);
    solver.integrate().unwrap();
    let last = solver.y_out().last().unwrap();
    let error = (last[0] - 10f64.cos()).abs();
    assert!(error > 1e-6, "the last point is right to {error:e}");
}
