"""Forward motion."""

from __future__ import annotations

import json
import warnings
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from . import _native
from .rows import Rows
from .scene import Scene

__all__ = ["IncompleteWarning", "Simulation", "simulate", "steady_state"]


class IncompleteWarning(UserWarning):
    """A run ended before its time; the message says where and why, and what was computed is kept."""


class Simulation(Rows):
    """The motion of a run: its rows by columns, its key figures, and its state at any time.

    Columns: ``t_s``, ``theta_rad`` (unwrapped), ``omega_rad_per_s``, ``alpha_rad_per_s2``, ``x_m``, ``v_m_per_s``,
    ``a_m_per_s2``, ``phi_rad``; the joint forces, the driving torque and the loose joint where there are any.
    """

    _source: _native.Run

    def __init__(self, columns: dict[str, Any], summary: str, native: _native.Run) -> None:
        super().__init__(columns, summary, native)

    @property
    def stopped(self) -> str | None:
        """Why the run ended before its time, if it did."""
        return self.summary.get("stopped")

    @property
    def events(self) -> list[dict[str, Any]]:
        """Dead centres, turning points, impacts and the like: kind, time (s), angle (rad), speed (rad/s)."""
        events: list[dict[str, Any]] = self.summary["events"]
        return events

    @property
    def error_estimate(self) -> dict[str, float] | None:
        """Estimate of the global error of the last state, rad and rad/s."""
        estimate: dict[str, float] | None = self.summary["error_estimate"]
        return estimate

    def at(self, t: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
        """Crank angle (rad, unwrapped) and speed (rad/s) at times (s), from the dense motion; nan outside the run."""
        times = np.asarray(t, dtype=float)
        theta, omega = self._source.at(times.ravel())
        return theta.reshape(times.shape), omega.reshape(times.shape)

    def rows_at(self, t: ArrayLike) -> dict[str, np.ndarray]:
        """All columns at times (s) inside the run, from the dense motion."""
        return self._source.rows_at(np.atleast_1d(np.asarray(t, dtype=float)).ravel())


def simulate(
    scene: Scene,
    *,
    method: str = "auto",
    tolerance: float | None = None,
    reactions: bool = False,
    driving_torque: bool = False,
    estimate: bool = True,
    steady_state: bool = False,
    max_evaluations: int | None = None,
    max_events: int | None = None,
) -> Simulation:
    """Integrates the equation of motion.

    Args:
        scene: the mechanism, with a ``run``.
        method: "auto", "closed-form", "energy", "angle", "time", "dop853" or "dopri5".
        tolerance: local error target in place of the scene's, relative and absolute.
        reactions: adds joint, guide and shaking forces (N, N m) to the columns, and the largest of them to the summary.
        driving_torque: adds the torque (N m) that drives a crank of prescribed speed.
        estimate: whether the global error is estimated, by a second run.
        steady_state: starts in the periodic steady state.
        max_evaluations: work limit; the run ends there with what it has.
        max_events: most events that are listed.

    Raises:
        Refused: what the scene cannot be computed for. An exception of a load that is a function comes out as it is.

    A run that ends before its time warns with :class:`IncompleteWarning` and has its reason as ``stopped``.
    """
    limits = (max_evaluations, max_events)
    columns, summary, native = _native.simulate(
        scene._native, method, tolerance, reactions, driving_torque, estimate, steady_state, limits
    )
    run = Simulation(columns, summary, native)
    if run.stopped is not None:
        warnings.warn(run.stopped, IncompleteWarning, stacklevel=2)
    return run


def steady_state(
    scene: Scene, *, fluctuation: float | None = None, max_evaluations: int | None = None
) -> dict[str, Any]:
    """The periodic steady state that the motion approaches: speeds (rad/s), period (s), power (W), stability, with errors.

    Args:
        fluctuation: coefficient of speed fluctuation for which the flywheel is wanted; its inertia (kg m²) is added.
        max_evaluations: work limit of each search.
    """
    found: dict[str, Any] = json.loads(_native.steady_state(scene._native, fluctuation, max_evaluations))
    return found
