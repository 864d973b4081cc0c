//! Narrow pulses over t, theta, omega, x and v, with friction at the guide and with a rocking rod or crank.

use slider_crank::plan::Method;
use slider_crank::scene::{Crank, Expression, Friction, Load, Scene, Slider};
use slider_crank::simulate::{Options, simulate};

/// Machine with crank inertia 0.02 kg m² and slider mass 0.6 kg.
struct Guided {
    /// Crank, rod and offset, m.
    lengths: [f64; 3],
    friction: f64,
    /// Start angle, rad, and start speed, rad/s.
    start: [f64; 2],
    /// Duration, s.
    duration: f64,
    /// Constant torque, N m.
    torque: f64,
    torques: &'static [&'static str],
    force: Option<&'static str>,
    /// Angle (rad) and speed (rad/s) at the end: crank and slider as two bodies and a massless rod, by DOP853 of SciPy
    /// at 3e-14 in pieces between all edges of pulses, dead centres and sign changes of the normal force.
    end: [f64; 2],
}

const GUIDED: [Guided; 6] = [
    Guided {
        lengths: [0.05, 0.15, 0.020665311091502887],
        friction: 0.13098682749008286,
        start: [2.6411895276177066, 32.88063387821109],
        duration: 0.339520555236244,
        torque: 0.1928421941529765,
        torques: &[
            "3.1885328951471448*max(0,1-abs((x-(0.19278773931499338)))/0.0005164533966787077)",
            "36.468043569695745*step((v-(-0.8451565128029348))+0.007029648899961343)*step(0.007029648899961343-(v-(-0.8451565128029348)))",
        ],
        force: None,
        end: [14.683247509814521, 39.03762977380925],
    },
    Guided {
        lengths: [0.05, 0.15, 0.007374101693382117],
        friction: 0.2344649993330834,
        start: [4.9938155917525755, 31.585853135752487],
        duration: 0.7613520689515566,
        torque: -0.0184276233141838,
        torques: &[
            "0.9728358485994433*step((theta-(8.353451598224867))+0.777528637815782)*step(0.777528637815782-(theta-(8.353451598224867)))",
            "8.683544400874371*max(0,1-((v-(1.3977624411605951))/0.0017694425773494842)^2)",
        ],
        force: None,
        end: [30.38575362313176, 32.34810970772967],
    },
    Guided {
        lengths: [0.05, 0.15, -0.0028572267894108813],
        friction: 0.1674769657699794,
        start: [5.804042467669021, 20.093975363426765],
        duration: 0.7495023792457431,
        torque: 0.0015565487178656925,
        torques: &[
            "-6.8377300576569064*step((x-(0.17071896932192884))+7.712788589396586e-05)*step(7.712788589396586e-05-(x-(0.17071896932192884)))",
            "244.35692970682467*step((t-(0.17989344858287817))+5.654527696960457e-05)*step(5.654527696960457e-05-(t-(0.17989344858287817)))",
        ],
        force: Some(
            "-8.39533022515704*step((t-(0.6300457522539766))+0.02937760340101209)*step(0.02937760340101209-(t-(0.6300457522539766)))",
        ),
        end: [21.383174548345167, 21.16041364282259],
    },
    Guided {
        lengths: [0.15, 0.05, 0.007374101693382117],
        friction: 0.2344649993330834,
        start: [0.16852542738788953, 8.109922382179349],
        duration: 0.7613520689515566,
        torque: 0.0,
        torques: &[
            "0.10180840276040687*step((theta-(-0.3036524672339582))+0.02156011401664209)*step(0.02156011401664209-(theta-(-0.3036524672339582)))",
            "1.8174860373923103*max(0,1-((v-(-1.0398483066642998))/0.0020455706947770033)^2)",
        ],
        force: None,
        end: [-0.39179233687837484, -0.1588180789616164],
    },
    Guided {
        lengths: [0.15, 0.05, -0.0028572267894108813],
        friction: 0.1674769657699794,
        start: [0.3075800581281647, 3.689457722353441],
        duration: 0.7495023792457431,
        torque: 0.0,
        torques: &[
            "-1.4311528027653986*step((x-(0.1695736607736585))+7.713642465882697e-05)*step(7.713642465882697e-05-(x-(0.1695736607736585)))",
            "51.14447365956795*step((t-(0.1795607146331449))+5.654527696960457e-05)*step(5.654527696960457e-05-(t-(0.1795607146331449)))",
        ],
        force: Some(
            "-0.5857207133830491*step((t-(0.6291929733974345))+0.02937760340101209)*step(0.02937760340101209-(t-(0.6291929733974345)))",
        ),
        end: [-0.11977421167349867, -2.4000949295463165],
    },
    Guided {
        lengths: [0.15, 0.05, 0.02433838057047124],
        friction: 0.0,
        start: [0.0367165049796057, 7.363469575533225],
        duration: 0.8480890505228961,
        torque: 0.0,
        torques: &[
            "1.0046729035857898*step((omega-(5.526921667384651))+0.009902379208401436)*step(0.009902379208401436-(omega-(5.526921667384651)))",
        ],
        force: None,
        end: [-0.3502468994586585, 6.920543172263182],
    },
];

fn scene(guided: &Guided) -> Scene {
    let formula = |text: &&str| Load::Expression(Expression::parse(text).expect("a formula"));
    let [crank, rod, offset] = guided.lengths;
    let [angle, speed] = guided.start;
    let mut scene = Scene::new(crank, rod)
        .offset(offset)
        .crank(Crank {
            inertia: 0.02,
            ..Crank::default()
        })
        .slider(Slider { mass: 0.6 })
        .start(angle, speed)
        .duration(guided.duration)
        .torque(Load::Constant(guided.torque));
    for load in guided.torques.iter().map(formula) {
        scene = scene.torque(load);
    }
    if guided.friction > 0.0 {
        scene.friction = Some(Friction {
            coefficient: guided.friction,
            static_coefficient: guided.friction,
        });
    }
    guided.force.iter().map(formula).fold(scene, Scene::force)
}

#[test]
fn pulses_are_met_under_friction_and_on_rockers() {
    for guided in &GUIDED {
        for method in [Method::Auto, Method::Time, Method::Dop853] {
            let options = Options {
                method,
                ..Options::default()
            };
            let summary = simulate(&scene(guided), &options).expect("a run").summary;
            let stated = summary.error_estimate.expect("an estimate");
            let [theta, omega] = guided.end;
            let last = &summary.last;
            let off = [last.theta_rad - theta, last.omega_rad_per_s - omega].map(f64::abs);
            // The reference is accurate to 1e-9.
            let allowed = [stated.theta_rad, stated.omega_rad_per_s].map(|most| 10.0 * most + 1e-9);
            let is_met = off[0] <= allowed[0] && off[1] <= allowed[1];
            assert!(is_met, "{method} {:?}: {off:?}, {stated:?}", guided.lengths);
        }
    }
}
