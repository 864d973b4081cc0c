//! Takes a scene of possible values, returns all that keeps its motion from being modelled, started or ended.

mod model;
mod run;
mod start;

pub(super) use model::problems as not_modelled;

use crate::mechanism::Linkage;
use crate::scene::{Problems, Scene};

/// Refuses a scene that no method can simulate.
///
/// # Errors
/// [`Problems`] of the values, else those that keep the motion from being modelled, started or ended.
pub fn refuse(scene: &Scene) -> Result<(), Problems> {
    modelled(scene).map(drop)
}

/// Returns the scene without parts of zero strength, unless the scene is refused.
pub(super) fn modelled(scene: &Scene) -> Result<Scene, Problems> {
    scene.check()?;
    let reduced = scene.reduced();
    let linkage = Linkage::new(&scene.geometry);
    let mut list = model::problems(&reduced, &linkage);
    // Only a scene with a model has a start to check.
    if list.is_empty() {
        start::problems(scene, &reduced, &mut list);
    }
    let starts = list.is_empty();
    run::problems(&reduced, &linkage, starts, &mut list);
    scene.places.reject_any(list)?;
    Ok(reduced)
}
