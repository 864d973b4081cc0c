"""Key figures of many designs."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from numbers import Real
from typing import Any

import numpy as np

from . import _native
from .rows import Rows
from .scene import Scene

__all__ = ["Designs", "sweep"]


class Designs(Rows):
    """One row of key figures for each design: its values, ``status``, the closed form of a turn, the motion, ``notes``."""


def sweep(
    scene: Scene,
    vary: Mapping[str, Any] | None = None,
    *,
    figures: Sequence[str] = (),
    least: Sequence[str] | str = (),
    most: Sequence[str] | str = (),
    sample: int | None = None,
    seed: int = 1,
    percentiles: bool = False,
    motion: bool = True,
    reactions: bool = False,
    steady_state: bool = False,
    fluctuation: float | None = None,
    estimate: bool = True,
    method: str = "auto",
    max_evaluations: int | None = None,
) -> Designs:
    """Key figures of all combinations of values, on all cores; the last key changes fastest.

    Args:
        vary: keys of the scene with their values: ``"0 mm:20 mm:41"`` for 41 evenly spread, with ``":log"`` in their
            logarithm; a list of texts; or numbers with their unit, as ``(np.linspace(0, 20, 41), "mm")``.
        figures: the key figures to compute, and nothing else, like ``["stroke", "guide_peak"]``.
        least: key figures whose least is looked for; of several goals the Pareto front is in the summary.
        most: key figures whose most is looked for.
        sample: draws so many designs at random, as a Latin hypercube: from ``"150 mm:160 mm"`` evenly, from
            ``"155.8 +- 0.1 mm"`` normally; without ``vary`` from all values of the scene that are written like this.
        seed: of the sample.
        percentiles: adds mean, deviation and percentiles of every figure to the summary.
        motion: whether the forward motion is computed.
        reactions: adds the largest joint, guide and shaking forces (N).
        steady_state: adds speeds, fluctuation and power of the periodic steady state.
        fluctuation: adds the flywheel (kg m²) for this coefficient of speed fluctuation.
        estimate: whether errors are estimated, by a second run.
        method: as of :func:`simulate`.
        max_evaluations: work limit of each design.
    """
    asked = {
        "vary": [f"{key}={_values(values)}" for key, values in (vary or {}).items()],
        "figures": names(figures),
        "least": names(least),
        "most": names(most),
        "sample": sample,
        "seed": seed,
        "percentiles": percentiles,
        "motion": motion,
        "reactions": reactions,
        "steady_state": steady_state,
        "fluctuation": fluctuation,
        "estimate": estimate,
        "method": method,
        "max_evaluations": max_evaluations,
    }
    columns, summary, native = _native.sweep(scene._native, asked)
    # Where all are empty, nothing tells words from numbers.
    for name in ("engine", "notes"):
        if isinstance(columns.get(name), np.ndarray):
            columns[name] = np.full(len(columns[name]), "")
    return Designs(columns, summary, native)


def names(given: Sequence[str] | str) -> list[str]:
    """One name or several as a list."""
    return [given] if isinstance(given, str) else list(given)


def _values(values: Any) -> str:
    if isinstance(values, (str, Real)):
        return str(values)
    if isinstance(values, tuple) and len(values) == 2 and isinstance(values[1], str) and _is_list(values[0]):
        return ",".join(f"{float(value)!r} {values[1]}" for value in values[0])
    return ",".join(value if isinstance(value, str) else repr(float(value)) for value in values)


def _is_list(values: Any) -> bool:
    return isinstance(values, Iterable) and not isinstance(values, str)
