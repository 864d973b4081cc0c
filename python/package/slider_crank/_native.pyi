"""The native part of the package: columns, and summaries as JSON."""

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

_Array = NDArray[np.float64]
_Columns = dict[str, Any]
_Load = tuple[Any, ...]

class Error(ValueError):
    """What cannot be computed as it is asked for: the message has the value, its place and what would be right."""

class SceneError(Error):
    """A scene or data that cannot be."""

    problems: list[dict[str, Any]]
    """Field, line, column, what is wrong and what would be right, one by one."""

class Refused(Error):
    """What the scene cannot be computed for, with the reason and what to do instead."""

class Scene:
    def __new__(cls, file: Path, text: str, loads: list[_Load]) -> Scene: ...
    @staticmethod
    def load(file: Path) -> Scene: ...
    @staticmethod
    def duarte() -> Scene: ...
    @property
    def text(self) -> str: ...
    @property
    def title(self) -> str | None: ...
    def explain(self, method: str, at: str | None) -> str: ...

class Equation:
    def __new__(cls, scene: Scene) -> Equation: ...
    def terms(self, theta: _Array) -> dict[str, _Array]: ...
    def force(self, t: _Array, theta: _Array, omega: _Array) -> _Array: ...
    def acceleration(self, t: _Array, theta: _Array, omega: _Array) -> _Array: ...

class Run:
    def at(self, t: _Array) -> tuple[_Array, _Array]: ...
    def rows_at(self, t: _Array) -> _Columns: ...
    def page(self) -> str: ...

class Turn:
    def page(self) -> str: ...

class Balanced:
    def page(self) -> str: ...

class Designs:
    def page(self) -> str: ...

class Recovered:
    def page(self) -> str: ...

class Measurement:
    def __new__(cls, t: _Array, columns: list[tuple[str, _Array]]) -> Measurement: ...
    @staticmethod
    def load(
        file: Path,
        column: str | None,
        columns: str | None,
        time: str | None,
        motion: str | None,
        known: list[str],
        counts_per_turn: int | None,
        x_zero: str | None,
        skip: int,
        decimal_comma: bool,
        missing: list[str],
    ) -> Measurement: ...
    @property
    def measured(self) -> str: ...
    @property
    def t(self) -> _Array: ...
    @property
    def values(self) -> _Array: ...
    @property
    def notes(self) -> list[str]: ...

def simulate(
    scene: Scene,
    method: str,
    tolerance: float | None,
    reactions: bool,
    driving_torque: bool,
    estimate: bool,
    steady: bool,
    limits: tuple[int | None, int | None],
) -> tuple[_Columns, str, Run]: ...
def steady_state(scene: Scene, fluctuation: float | None, max_evaluations: int | None) -> str: ...
def kinematics(
    scene: Scene, every: str, forces: bool, sensitivity: bool, change: list[tuple[str, str]]
) -> tuple[_Columns, str, Turn]: ...
def statics(
    scene: Scene, every: str, torque: str | None, force: str | None, friction: float | None
) -> tuple[_Columns, str, Balanced]: ...
def sweep(scene: Scene, asked: dict[str, Any]) -> tuple[_Columns, str, Designs]: ...
def optimise(scene: Scene, wanted: dict[str, Any]) -> tuple[str, str]: ...
def synthesis(stroke: str, time_ratio: float, named: tuple[str, str] | None) -> tuple[str, str]: ...
def inverse(
    scene: Scene, measurement: Measurement, fit: str, degree: int | None, reactions: bool, beside_forces: bool
) -> tuple[_Columns, _Columns, str, Recovered]: ...
def identify(scene: Scene, measurement: Measurement, free: list[str]) -> str: ...
