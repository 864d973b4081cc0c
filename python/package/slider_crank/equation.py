"""The equation of motion for other solvers."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from . import _native
from .scene import Scene

__all__ = ["Equation", "Terms"]


class Terms(NamedTuple):
    """What depends on the crank angle alone, at some angles."""

    M: np.ndarray
    """Inertia, kg m²."""
    half_dM: np.ndarray
    """M'/2, kg m²/rad."""
    dV: np.ndarray
    """V', the slope of the potential energy of the weights, N m."""
    x: np.ndarray
    """Slider position, m."""
    dx: np.ndarray
    """x', m/rad."""
    d2x: np.ndarray
    """x'', m/rad²."""
    phi: np.ndarray
    """Rod inclination, rad."""


class Equation:
    """M alpha + M'/2 omega² + V' = Q of a scene, at arrays of states.

    An equation is a function of time and state ``(theta, omega)`` as SciPy's solvers take it:

    >>> from scipy.integrate import solve_ivp
    >>> equation = Equation(scene)
    >>> solve_ivp(equation, (0, 1), [0.0, 10.0], method="DOP853", rtol=1e-12)

    Arguments are broadcast against each other. Where the mechanism has no position, the values are nan. Friction at the guide
    and clearance are no terms of this equation: scenes with them raise :class:`Refused`.
    """

    def __init__(self, scene: Scene) -> None:
        self._native = _native.Equation(scene._native)

    def terms(self, theta: ArrayLike) -> Terms:
        """M, M'/2, V' and the slider's position at crank angles (rad)."""
        angles = np.asarray(theta, dtype=float)
        found = self._native.terms(angles.ravel())
        return Terms(**{name: values.reshape(angles.shape) for name, values in found.items()})

    def Q(self, t: ArrayLike, theta: ArrayLike, omega: ArrayLike) -> np.ndarray:
        """Generalized force of the loads (N m) at times (s), crank angles (rad) and speeds (rad/s)."""
        return self._at(self._native.force, t, theta, omega)

    def alpha(self, t: ArrayLike, theta: ArrayLike, omega: ArrayLike) -> np.ndarray:
        """Acceleration of the crank (rad/s²) at times (s), crank angles (rad) and speeds (rad/s)."""
        return self._at(self._native.acceleration, t, theta, omega)

    def __call__(self, t: ArrayLike, state: ArrayLike) -> np.ndarray:
        """Time derivative ``(omega, alpha)`` of states ``(theta, omega)``."""
        theta, omega = np.asarray(state, dtype=float)
        return np.stack([omega, self.alpha(t, theta, omega)])

    @staticmethod
    def _at(
        function: Callable[..., np.ndarray], t: ArrayLike, theta: ArrayLike, omega: ArrayLike
    ) -> np.ndarray:
        states = np.broadcast_arrays(*(np.asarray(one, dtype=float) for one in (t, theta, omega)))
        return function(*(state.ravel() for state in states)).reshape(states[0].shape)
