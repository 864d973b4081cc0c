"""Measured motion: the force behind it, and values of the scene from it."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from . import _native
from .rows import Rows
from .scene import Scene

__all__ = ["Measurement", "Recovered", "identify", "inverse"]


class Measurement:
    """A record of a motion: times (s) and what was measured, SI.

    Args:
        t: times, s, in rising order.
        theta: crank angle, rad.
        gamma: angle at the crank pin between crank and rod, rad from 0 to pi.
        x: slider position, m.
        omega: crank speed, rad/s, from the crank angle of the scene's motion on; without the others.
        torque: known torque on the crank beside the scene's, N m.
        force: known force on the slider beside the scene's, N.

    Of several sensors each counts by its own noise; all but the first may be NaN where they have no value.
    """

    def __init__(
        self,
        t: ArrayLike,
        *,
        theta: ArrayLike | None = None,
        gamma: ArrayLike | None = None,
        x: ArrayLike | None = None,
        omega: ArrayLike | None = None,
        torque: ArrayLike | None = None,
        force: ArrayLike | None = None,
    ) -> None:
        given = {"theta": theta, "gamma": gamma, "x": x, "omega": omega}
        sensors = [(name, _array(values)) for name, values in given.items() if values is not None]
        if not sensors:
            raise _native.Refused("no motion is given\nhelp: give theta (rad), gamma (rad), x (m) or omega (rad/s)")
        known = [(name, _array(v)) for name, v in (("torque", torque), ("force", force)) if v is not None]
        self._native = _native.Measurement(_array(t), sensors + known)

    @classmethod
    def load(
        cls,
        file: str | os.PathLike[str],
        *,
        column: Literal["theta", "gamma", "x", "omega"] | None = None,
        columns: str | None = None,
        time: str | None = None,
        motion: str | None = None,
        known: Sequence[str] = (),
        counts_per_turn: int | None = None,
        x_zero: str | None = None,
        skip: int = 0,
        decimal_comma: bool = False,
        missing: Sequence[str] = (),
    ) -> Measurement:
        """Reads a CSV file with time and theta, gamma, x or omega, units in the header or named here.

        Args:
            column: the measured column, where the file has several.
            columns: what the columns of a file without header are, like ``"t [s],theta [deg]"``.
            time: the column of the time, by header or number, with its unit: ``"2[ms]"``.
            motion: the column of the motion: ``"Winkel[deg]"``, ``"3[counts]"``.
            known: columns of known torques or forces: ``["motor[N m]"]``.
            counts_per_turn: counts of an encoder in a turn of the crank.
            x_zero: what the sensor of x shows where the slider is at the crank pivot, like ``"12.5 mm"``.
            skip: lines above the header.
            decimal_comma: whether numbers have decimal commas.
            missing: what cells without a value contain, like ``"NaN"``; ``""`` for empty cells.
        """
        measurement = cls.__new__(cls)
        measurement._native = _native.Measurement.load(
            Path(file), column, columns, time, motion, list(known), counts_per_turn, x_zero, skip,
            decimal_comma, list(missing),
        )
        return measurement

    @property
    def measured(self) -> str:
        """"theta", "gamma", "x" or "omega"."""
        return self._native.measured

    @property
    def t(self) -> np.ndarray:
        """Times, s."""
        return self._native.t

    @property
    def values(self) -> np.ndarray:
        """Measured values, rad or m."""
        return self._native.values

    @property
    def notes(self) -> list[str]:
        """What the reader should know: columns not taken, gaps."""
        return self._native.notes

    def __repr__(self) -> str:
        return f"<Measurement of {self.measured}: {len(self.t)} samples>"


class Recovered(Rows):
    """Force and torque behind a motion.

    Columns: ``t_s``, ``theta_rad``, ``omega_rad_per_s``, ``alpha_rad_per_s2``, ``slider_force_n``, ``slider_force_se_n``,
    ``crank_torque_nm``, ``near_dead_centre``, ``crank_torque_se_nm``. The force is nan near dead centres, where the motion
    does not determine it.

    Attributes:
        residuals: columns of what was measured, what the fit gives, and the difference.
    """

    residuals: dict[str, np.ndarray]

    @property
    def band_factor(self) -> float:
        """Half of a 95 % band over the standard error."""
        factor: float = self.summary["band_factor"]
        return factor

    def band(self, name: str = "slider_force") -> tuple[np.ndarray, np.ndarray]:
        """Lower and upper end of the 95 % band of ``"slider_force"`` (N) or ``"crank_torque"`` (N m)."""
        unit = {"slider_force": "n", "crank_torque": "nm"}[name]
        middle, half = self[f"{name}_{unit}"], self.band_factor * self[f"{name}_se_{unit}"]
        return middle - half, middle + half


def inverse(
    scene: Scene,
    measurement: Measurement | str | os.PathLike[str],
    *,
    fit: Literal["auto", "polynomial", "smoother"] = "auto",
    degree: int | None = None,
    reactions: bool = False,
    beside_forces: bool = False,
) -> Recovered:
    """Slider force (N) and crank torque (N m) along a measured motion, with their standard errors.

    Args:
        measurement: the record, or a CSV file of one.
        fit: "smoother" goes through the equation of motion; "polynomial" is the way of Duarte et al.; "auto" takes a
            polynomial where it leaves nothing but noise within one turn.
        degree: degree of a polynomial.
        reactions: adds joint, guide and shaking forces.
        beside_forces: gives the force that acts beside the forces of the scene, not the whole one on the slider.
    """
    rows, residuals, summary, native = _native.inverse(
        scene._native, _record(measurement)._native, fit, degree, reactions, beside_forces
    )
    found = Recovered(rows, summary, native)
    found.residuals = residuals
    return found


def identify(
    scene: Scene, measurement: Measurement | str | os.PathLike[str], free: Iterable[str]
) -> dict[str, Any]:
    """Values of the scene from a measured motion, with standard errors and correlations.

    Args:
        measurement: the record, or a CSV file of one.
        free: keys, like ``["torque[1].coefficient", "crank.inertia", "sensor.zero"]``; their values in the scene are those
            from which the search sets out.
    """
    found: dict[str, Any] = json.loads(
        _native.identify(scene._native, _record(measurement)._native, list(free))
    )
    return found


def _record(measurement: Measurement | str | os.PathLike[str]) -> Measurement:
    return measurement if isinstance(measurement, Measurement) else Measurement.load(measurement)


def _array(values: ArrayLike) -> np.ndarray:
    return np.ascontiguousarray(values, dtype=float)
