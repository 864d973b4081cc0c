"""One turn of the crank in closed form."""

from __future__ import annotations

from collections.abc import Mapping

from . import _native
from .rows import Rows
from .scene import Scene

__all__ = ["kinematics", "statics"]


def kinematics(
    scene: Scene,
    *,
    every: str = "1 deg",
    forces: bool = False,
    sensitivity: bool = False,
    change: Mapping[str, str] | None = None,
) -> Rows:
    """One turn: positions and their derivatives over the crank angle; dead centres, stroke, time ratio and extremes in the summary.

    Args:
        every: crank angle between rows.
        forces: adds torque, inertia, joint and shaking forces (N, N m) at the scene's speed, taken as constant.
        sensitivity: adds the derivatives with respect to crank, rod and offset.
        change: compares with changed lengths, as ``{"crank": "150 mm"}``; keys crank, rod, offset.
    """
    changes = list((change or {}).items())
    return Rows(*_native.kinematics(scene._native, every, forces, sensitivity, changes))


def statics(
    scene: Scene,
    *,
    every: str = "1 deg",
    torque: str | None = None,
    force: str | None = None,
    friction: float | None = None,
) -> Rows:
    """Slider force (N) that balances the crank torque at rest, or the reverse, with the band that friction allows.

    Args:
        every: crank angle between rows.
        torque: crank torque in place of the scene's torques, like ``"2 N m"``.
        force: slider force in place of the scene's forces, like ``"100 N"``; the crank torque is sought.
        friction: coefficient at the guide in place of the scene's.
    """
    return Rows(*_native.statics(scene._native, every, torque, force, friction))
