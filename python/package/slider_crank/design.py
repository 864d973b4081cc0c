"""Designs that are looked for."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from . import _native
from .designs import names
from .scene import Scene

__all__ = ["Design", "optimise", "synthesis"]


@dataclass(frozen=True)
class Design:
    """A scene that was looked for and found.

    Attributes:
        scene: the mechanism, ready for every other function.
        summary: how it was found, as ``--json`` of the program prints it; SI and radians.
    """

    scene: Scene
    summary: dict[str, Any] = field(repr=False)


def optimise(
    scene: Scene,
    vary: Mapping[str, str],
    *,
    least: str | None = None,
    most: str | None = None,
    subject: Sequence[str] | str = (),
    seed: int = 1,
    fluctuation: float | None = None,
    method: str = "auto",
    max_evaluations: int | None = None,
) -> Design:
    """The best design between bounds, subject to limits, on all cores.

    >>> found = optimise(Scene.duarte(), {"geometry.rod": "100 mm:200 mm"}, most="transmission_min", subject="stroke <= 100 mm")
    >>> found.summary["values"][0]["value"]
    0.2

    Args:
        vary: keys of the scene with their bounds, like ``{"geometry.rod": "100 mm:200 mm"}``.
        least: the key figure whose least is looked for; or
        most: the key figure whose most is.
        subject: limits of key figures, like ``["transmission_min >= 40 deg", "stroke <= 95 mm"]``.
        seed: of the sample from which the local searches set out.
        fluctuation: coefficient of speed fluctuation of the flywheel, for its figure.
        method: as of :func:`simulate`.
        max_evaluations: work limit of each design.

    The summary says whether the limits are kept (``meets_subjects``), how many of the local searches agree (``starts``), and
    whether sweeps round the design found none that is better (``proof``).
    """
    wanted = {
        "vary": [f"{key}={bounds}" for key, bounds in vary.items()],
        "least": names(least or ()),
        "most": names(most or ()),
        "subject": names(subject),
        "seed": seed,
        "fluctuation": fluctuation,
        "method": method,
        "max_evaluations": max_evaluations,
    }
    text, summary = _native.optimise(scene._native, wanted)
    return Design(Scene.parse(text, scene.folder), json.loads(summary))


def synthesis(
    stroke: str,
    time_ratio: float,
    *,
    crank: str | None = None,
    rod: str | None = None,
    offset: str | None = None,
    rod_ratio: float | None = None,
) -> Design:
    """Crank, rod and offset for a stroke and a time ratio.

    >>> synthesis("90 mm", 1.2).summary["crank_m"]
    0.04234...

    Args:
        stroke: wanted stroke, like ``"90 mm"``.
        time_ratio: wanted crank angle of the outward stroke over that of the inward stroke, between 1/3 and 3.
        crank: with this crank; without this and the next three the best least transmission angle.
        rod: with this rod.
        offset: with this size of the offset.
        rod_ratio: with a rod of so many cranks.
    """
    given = {"crank": crank, "rod": rod, "offset": offset, "rod_ratio": rod_ratio}
    named = [(name, str(value)) for name, value in given.items() if value is not None]
    if len(named) > 1:
        both = " and ".join(name for name, _ in named)
        raise _native.Refused(f"{both} are given\nhelp: give one of them, the others follow from it")
    text, summary = _native.synthesis(stroke, time_ratio, named[0] if named else None)
    return Design(Scene.parse(text), json.loads(summary))
