//! Machines used by several tests.

use slider_crank::scene::{Crank, Friction, Gravity, InertiaAbout, Rod, Scene, Slider};

use super::alike::branch;

/// Mechanism with lengths r, l, e (m), left or right, with the masses (kg) of crank, rod and slider. The crank's
/// inertia is that of a flywheel with its mass at the crank pin; the rod's centre of gravity is at 0.4 of its length,
/// and `aside` of its length to the left.
pub fn machine(
    [r, l, e]: [f64; 3],
    left: bool,
    [crank, rod, slider]: [f64; 3],
    aside: f64,
) -> Scene {
    Scene::new(r, l)
        .offset(e)
        .branch(branch(left))
        .crank(Crank {
            inertia: crank * r * r,
            ..Crank::default()
        })
        .rod(Rod {
            mass: rod,
            cg: 0.4 * l,
            cg_lateral: aside * l,
            inertia: 0.1 * rod * l * l,
            inertia_about: InertiaAbout::Cg,
            ..Rod::default()
        })
        .slider(Slider { mass: slider })
}

/// Crank of this mass (kg) and length (m) with its centre of gravity beside the pivot.
pub fn weighted_crank(mass: f64, r: f64) -> Crank {
    Crank {
        mass,
        cg: 0.3 * r,
        cg_lateral: 0.1 * r,
        inertia: mass * r * r,
    }
}

/// Flywheel that pushes a slider (kg) by a light, steeply inclined rod: it jams with a coefficient of friction of 1.5.
pub fn leaning(slider: f64) -> Scene {
    Scene::new(0.1, 0.12)
        .crank(Crank {
            inertia: 0.05,
            ..Crank::default()
        })
        .rod(Rod {
            mass: 0.02,
            cg: 0.06,
            inertia: 2e-5,
            ..Rod::default()
        })
        .slider(Slider { mass: slider })
        .duration(1.0)
}

/// Returns the scene with friction at its guide.
pub fn rubbing(scene: Scene, coefficient: f64, static_coefficient: f64) -> Scene {
    Scene {
        friction: Some(Friction {
            coefficient,
            static_coefficient,
        }),
        ..scene
    }
}

/// Small engine under gravity, with this offset (m).
pub fn engine(offset: f64) -> Scene {
    Scene::new(0.05, 0.16)
        .offset(offset)
        .crank(Crank {
            inertia: 4e-3,
            ..Crank::default()
        })
        .rod(Rod {
            mass: 0.4,
            cg: 0.06,
            inertia: 9e-4,
            ..Rod::default()
        })
        .slider(Slider { mass: 0.3 })
        .gravity(Gravity::standard())
}
