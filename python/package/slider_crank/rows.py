"""Rows of a result by their columns."""

from __future__ import annotations

import html
import json
from collections.abc import Iterator, Mapping
from typing import Any, Protocol

import numpy as np

__all__ = ["Rows"]


class _HasPage(Protocol):
    def page(self) -> str: ...


class Rows(Mapping[str, np.ndarray]):
    """Columns of a result as arrays, by the names that they have in the program's CSV files.

    A mapping: ``rows["x_m"]``, ``list(rows)``, ``pandas.DataFrame(dict(rows))``. In a notebook it shows the report page.

    Attributes:
        summary: the key figures, as ``--json`` of the program prints them.
    """

    summary: dict[str, Any]

    def __init__(self, columns: dict[str, Any], summary: str, native: _HasPage) -> None:
        self._columns: dict[str, np.ndarray] = {
            # A list of words, and the place of each row's in it.
            name: np.array(values[0])[values[1]] if isinstance(values, tuple) else values
            for name, values in columns.items()
        }
        self._source = native
        self.summary = json.loads(summary)

    def __getitem__(self, name: str) -> np.ndarray:
        try:
            return self._columns[name]
        except KeyError:
            raise KeyError(f"no column {name!r}; there are {', '.join(self._columns)}") from None

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        """Number of columns."""
        return len(self._columns)

    def __repr__(self) -> str:
        count = len(next(iter(self._columns.values()), ()))
        return f"<{type(self).__name__}: {count} rows of {', '.join(self._columns)}>"

    def page(self) -> str:
        """The report page as HTML that opens offline: mechanism in motion, linked curves, key figures, scene."""
        return self._source.page()

    def _repr_html_(self) -> str:
        page = html.escape(self.page(), quote=True)
        frame = 'width="100%" height="720" style="border: 0" sandbox="allow-scripts"'
        return f'<iframe srcdoc="{page}" {frame}></iframe>'
