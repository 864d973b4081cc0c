"""Scenes from files, text or keywords, and loads from functions."""

from __future__ import annotations

import inspect
import json
import os
import re
import tomllib
from collections.abc import Callable, Iterable, Mapping, Sequence
from fractions import Fraction
from numbers import Real
from pathlib import Path
from typing import Any

from . import _native

__all__ = ["Load", "Scene"]

_VARIABLES = ("t", "theta", "omega", "x", "v")
_BARE = re.compile(r"[A-Za-z0-9_-]+")


class Load:
    """A torque on the crank (N m) or a force on the slider (N) that a function gives.

    Args:
        function: called with the values of what its parameters name: ``t`` (s), ``theta`` (rad, unwrapped), ``omega``
            (rad/s), ``x`` (m), ``v`` (m/s). What it does not name, the load does not depend on: the fewer, the faster the
            method that can serve.
        reads: the names, for a function whose parameters have others.
        period: turns of the crank after which it is the same again, as ``2`` or ``Fraction(1, 3)``. A function of theta that
            states none is not taken to repeat.
        finest_scale: the narrowest width of what it does over a variable, SI, as ``{"t": 1e-4}``: no step goes further.
            Without it a pulse between the nodes of a step is not seen.
    """

    def __init__(
        self,
        function: Callable[..., float],
        *,
        reads: Sequence[str] | None = None,
        period: int | Fraction | None = None,
        finest_scale: Mapping[str, float] | None = None,
    ) -> None:
        self.function = function
        self.reads = tuple(_parameters(function) if reads is None else reads)
        self.period = None if period is None else Fraction(period)
        self.finest_scale = dict(finest_scale or {})

    def _handed(self, on_crank: bool) -> tuple[Any, ...]:
        period = self.period and (self.period.numerator, self.period.denominator)
        scales = [(name, float(scale)) for name, scale in self.finest_scale.items()]
        return (self.function, list(self.reads), on_crank, period, scales)

    def __repr__(self) -> str:
        return f"Load({self.function!r}, reads={self.reads})"


class Scene:
    """A mechanism with its loads and its motion.

    Each keyword is a table of a scene file, or a list of them for ``torque`` and ``force``; values are texts with their unit,
    or ``(50, "mm")``. A torque or force may also be a formula, as ``"2 - 0.01*omega"`` in SI, or a function of ``t``,
    ``theta``, ``omega``, ``x``, ``v``: see :class:`Load`.

    >>> scene = Scene(
    ...     geometry={"crank": "50 mm", "rod": (150, "mm")},
    ...     crank={"inertia": "0.02 kg m^2"},
    ...     torque=[{"kind": "motor", "stall": "6 N m", "no_load_speed": "1500 rpm"}],
    ...     force=["-8*v*abs(v)"],
    ...     motion={"speed": "10 rad/s"},
    ...     run={"duration": "2 s"},
    ... )

    Raises:
        SceneError: all that is wrong with it, with line, value and cure; the lines are those of :attr:`text`.
    """

    def __init__(
        self,
        *,
        title: str | None = None,
        geometry: Mapping[str, Any] | None = None,
        torque: Iterable[Any] | Any = (),
        force: Iterable[Any] | Any = (),
        folder: str | os.PathLike[str] = ".",
        **tables: Any,
    ) -> None:
        loads: list[tuple[Any, ...]] = []
        lists = {
            name: [one for one in map(_table_or_load, _listed(given)) if not _called(one, name, loads)]
            for name, given in (("torque", torque), ("force", force))
        }
        tables = {"title": title, "geometry": geometry, **tables, **{k: v for k, v in lists.items() if v}}
        text = _toml({key: value for key, value in tables.items() if value is not None})
        self._set(_native.Scene(Path(folder) / "scene.toml", text, loads), Path(folder) / "scene.toml", loads)

    def _set(self, native: _native.Scene, file: Path, loads: list[tuple[Any, ...]]) -> None:
        self._native, self._file, self._loads = native, file, loads

    @classmethod
    def _made(cls, native: _native.Scene, file: Path, loads: list[tuple[Any, ...]]) -> Scene:
        scene = cls.__new__(cls)
        scene._set(native, file, loads)
        return scene

    @classmethod
    def load(cls, file: str | os.PathLike[str]) -> Scene:
        """Reads a scene file (TOML)."""
        return cls._made(_native.Scene.load(Path(file)), Path(file), [])

    @classmethod
    def parse(cls, text: str, folder: str | os.PathLike[str] = ".") -> Scene:
        """Reads the text of a scene file; the tables that it names are looked for in ``folder``."""
        file = Path(folder) / "scene.toml"
        return cls._made(_native.Scene(file, text, []), file, [])

    @classmethod
    def duarte(cls) -> Scene:
        """The built-in scene: the Diesel engine of Duarte, Valencia and Obregon (2018)."""
        return cls._made(_native.Scene.duarte(), Path("duarte-engine.toml"), [])

    @property
    def text(self) -> str:
        """The text of the scene file; loads that are functions are not in it."""
        return self._native.text

    @property
    def title(self) -> str | None:
        """What the scene is, in a line."""
        return self._native.title

    @property
    def folder(self) -> Path:
        """Where the tables that the scene names are looked for."""
        return self._file.parent

    def replace(self, values: Mapping[str, Any]) -> Scene:
        """The scene with other values, by the keys of sweeps: ``{"geometry.rod": "155 mm", "torque[2].value": "5 N m"}``."""
        tables = tomllib.loads(self.text)
        for key, value in values.items():
            _put(tables, key, value)
        return self._made(_native.Scene(self._file, _toml(tables), self._loads), self._file, self._loads)

    def with_torque(self, load: Load | Callable[..., float]) -> Scene:
        """The scene with one more torque on the crank, a function (N m)."""
        return self._with(load, "torque")

    def with_force(self, load: Load | Callable[..., float]) -> Scene:
        """The scene with one more force on the slider, a function (N)."""
        return self._with(load, "force")

    def _with(self, load: Load | Callable[..., float], where: str) -> Scene:
        loads = list(self._loads)
        _called(load if isinstance(load, Load) else Load(load), where, loads)
        return self._made(_native.Scene(self._file, self.text, loads), self._file, loads)

    def explain(self, *, method: str = "auto", at: str | None = None) -> str:
        """The equation, what is modelled and why, and what will compute it; every term at an angle like ``"30 deg"``."""
        return self._native.explain(method, at)

    def __repr__(self) -> str:
        loads = f" and {len(self._loads)} loads from functions" if self._loads else ""
        return f"<Scene {self.title or ''}{loads}>"


def _parameters(function: Callable[..., float]) -> list[str]:
    try:
        names = list(inspect.signature(function).parameters)
    except (TypeError, ValueError):
        names = []
    if not names or not set(names) <= set(_VARIABLES):
        raise _native.Refused(
            f"the parameters of {function!r} do not say what the load depends on\n"
            f"help: name them {', '.join(_VARIABLES)}, or give Load(function, reads=...)"
        )
    return names


def _listed(given: Any) -> list[Any]:
    alone = isinstance(given, (str, Mapping, Load)) or callable(given)
    return [given] if alone else list(given)


def _table_or_load(given: Any) -> Any:
    if isinstance(given, str):
        return {"kind": "expression", "value": given}
    if callable(given):
        return Load(given)
    return given


def _called(one: Any, where: str, loads: list[tuple[Any, ...]]) -> bool:
    """Puts a load that is a function with the others."""
    if isinstance(one, Load):
        loads.append(one._handed(where == "torque"))
    return isinstance(one, Load)


def _put(tables: dict[str, Any], key: str, value: Any) -> None:
    match = re.fullmatch(r"(\w+)(?:\[(\d+)\])?\.(\w+)", key.strip())
    if match is None:
        raise _native.Refused(f"`{key}` names no key\nhelp: write it like geometry.rod or torque[2].value")
    table, number, name = match.groups()
    here = tables.setdefault(table, {})
    if isinstance(here, list):
        index = int(number or 1) - 1
        if not 0 <= index < len(here):
            raise _native.Refused(f"`{key}` cannot be set: tables [[{table}]] in the scene: {len(here)}\nhelp: add it")
        here = here[index]
    here[name] = value


def _toml(tables: Mapping[str, Any]) -> str:
    lines = [f"{_key(key)} = {_value(value)}" for key, value in tables.items() if not _is_table(value)]
    for key, value in tables.items():
        if isinstance(value, Mapping):
            lines += [f"[{_key(key)}]", *_entries(value)]
        elif _is_table(value):
            for one in value:
                lines += [f"[[{_key(key)}]]", *_entries(one)]
    return "\n".join(lines) + "\n"


def _is_table(value: Any) -> bool:
    is_list = isinstance(value, (list, tuple)) and all(isinstance(one, Mapping) for one in value)
    return isinstance(value, Mapping) or is_list


def _entries(table: Mapping[str, Any]) -> list[str]:
    return [f"{_key(key)} = {_value(value)}" for key, value in table.items() if value is not None]


def _key(key: str) -> str:
    return key if _BARE.fullmatch(key) else _quoted(key)


def _quoted(text: str) -> str:
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def _value(value: Any) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, Real):
        return _number(value)
    if isinstance(value, tuple) and len(value) == 2 and isinstance(value[0], Real):
        return _quoted(f"{_number(value[0])} {value[1]}")
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(map(_value, value))}]"
    if isinstance(value, os.PathLike):
        return _quoted(os.fspath(value))
    return _quoted(str(value))


def _number(value: Real) -> str:
    return repr(int(value)) if hasattr(value, "__index__") else repr(float(value))
