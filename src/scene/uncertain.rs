//! Values of a scene that are known to a standard error.

use super::Scene;

/// A value of a scene with its standard error.
#[derive(Clone, Debug)]
pub struct UncertainValue {
    /// Name, as `geometry.rod`.
    pub key: String,
    /// The scene with the value a standard error higher, or lower where it cannot be higher.
    pub moved: Scene,
}
