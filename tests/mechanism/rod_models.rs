//! Simplified rod models: two masses, spin only, massless.

use std::f64::consts::FRAC_PI_2;

use crate::support::exact::Jet;
use crate::support::random::{case, cases, rotating_crank};
use crate::support::run::{Run, check_reactions};
use crate::support::{Exact, Sizes, close};
use proptest::prelude::*;
use slider_crank::mechanism::{Equation, Reactor};
use slider_crank::scene::{Crank, Gravity, InertiaAbout, Rod, RodModel, Scene};

proptest! {
    #![proptest_config(cases(10_000))]

    #[test]
    fn two_masses_at_the_pins_are_a_rod_of_inertia_m_times_the_distances(
        case in case(rotating_crank(1e-12)), part in 0.0..=1.0,
    ) {
        prop_assume!(case.scene.rod.is_some());
        let mut two_mass = case.scene.clone();
        let length = two_mass.geometry.rod;
        let cg = part * length;
        let rod = Rod { cg, cg_lateral: 0.0, inertia_about: InertiaAbout::Cg, ..two_mass.rod.unwrap() };
        two_mass.rod = Some(Rod { model: RodModel::TwoMass, inertia: 0.0, ..rod });
        let mut rigid = case.clone();
        rigid.scene.rod = Some(Rod { inertia: rod.mass * cg * (length - cg), ..rod });
        let run = Run::new(&rigid);
        let (alpha, forces) = run.parts.solve(rigid.omega, run.torque, run.force);

        let equation = Equation::new(&two_mass);
        let terms = equation.terms(rigid.theta);
        for (i, got) in [terms.m, terms.half_dm, terms.dv].into_iter().enumerate() {
            close("term", got, run.expected_terms()[i], run.parts.sizes()[i], 1e-14);
        }
        let reactor = Reactor::new(&two_mass).unwrap();
        let got = reactor.at(&equation, rigid.t, rigid.theta, rigid.omega, alpha);
        check_reactions(&got, &forces, run.joint_size(alpha), length, 1e-14);
    }

    #[test]
    fn the_spin_only_rod_has_the_terms_of_duarte(case in case(rotating_crank(1e-6))) {
        prop_assume!(case.scene.rod.is_some());
        let mut scene = case.scene.clone();
        let rod = Rod { model: RodModel::SpinOnly, cg_lateral: 0.0, ..scene.rod.unwrap() };
        scene.rod = Some(rod);
        scene.gravity = Some(Gravity { acceleration: 9.81, direction: -FRAC_PI_2 });
        let crank = Crank { cg_lateral: 0.0, ..scene.crank.unwrap_or_default() };
        scene.crank = Some(crank);
        let terms = Equation::new(&scene).terms(case.theta);
        let exact = Exact::new(&scene.geometry, case.theta);
        let sizes = Sizes::new(&scene.geometry, &exact);
        let (i2, i3) = (crank.inertia, rod.inertia);
        let m4 = scene.slider.map_or(0.0, |slider| slider.mass);
        // As printed: T = (I2 + I3 φ'² + m4 x'²) θ̇²/2, V = g (m2 r_O2c + m3 (L3 + r_B3c)) sin θ.
        let (dphi, dx) = (exact.dphi, exact.p[0].derivative());
        let m = Jet::from(i2) + Jet::from(i3) * dphi * dphi + Jet::from(m4) * dx * dx;
        let lever = crank.mass * crank.cg + rod.mass * (scene.geometry.rod + rod.cg);
        let lever_size = crank.mass * crank.cg.abs() + rod.mass * (scene.geometry.rod + rod.cg.abs());
        close("M", terms.m, m.d(0), i2 + i3 * sizes.dphi.powi(2) + m4 * sizes.dx.powi(2), 1e-14);
        let half_dm = i3 * sizes.dphi * sizes.d2phi + m4 * sizes.dx * sizes.d2x;
        close("M'/2", terms.half_dm, 0.5 * m.d(1), half_dm, 1e-14);
        close("V'", terms.dv, 9.81 * lever * case.theta.cos(), 9.81 * lever_size, 1e-14);
        prop_assert!(Reactor::new(&scene).is_err());
    }

    #[test]
    fn a_massless_rod_is_no_rod(case in case(rotating_crank(0.01)), alpha in -1e3..1e3) {
        let mut massless = case.scene.clone();
        if let Some(rod) = &mut massless.rod {
            rod.model = RodModel::Massless;
        }
        let none = Scene { rod: None, ..case.scene.clone() };
        let terms = |scene: &Scene| Equation::new(scene).terms(case.theta);
        prop_assert_eq!(terms(&massless), terms(&none));
        let forces = |scene: &Scene| {
            let equation = Equation::new(scene);
            Reactor::new(scene).unwrap().at(&equation, case.t, case.theta, case.omega, alpha)
        };
        prop_assert_eq!(forces(&massless), forces(&none));
    }
}
