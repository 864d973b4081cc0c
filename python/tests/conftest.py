"""The program beside the package: what it writes, the package gives to the bit."""

import csv
import json
import os
import subprocess
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]


def _found():
    given = os.environ.get("SLIDER_CRANK_PROGRAM")
    places = [Path(given)] if given else [ROOT / "target" / kind / "slider-crank" for kind in ("release", "debug")]
    return next((place for place in places if place.exists()), None)


def binary():
    """The program."""
    found = _found()
    if found is None:
        pytest.skip("the program is not built: cargo build --release")
    return found


@pytest.fixture
def data():
    """Example scenes and records."""
    return ROOT / "data"


@pytest.fixture
def program(tmp_path):
    """Runs the program: its rows by columns, and its summary."""
    found = binary()

    def run(*arguments):
        rows = tmp_path / "rows.csv"
        command = [found, *map(str, arguments), "--out", rows, "--json"]
        done = subprocess.run(command, capture_output=True, text=True)
        assert done.returncode in (0, 1), done.stderr
        with rows.open(newline="") as file:
            header, *lines = csv.reader(file)
        cells = {name: [line[i] for line in lines] for i, name in enumerate(header)}
        return cells, json.loads(done.stdout)

    return run


def same(columns, cells):
    """Whether columns are those of a CSV file, to the bit; empty cells are what is not finite."""
    assert set(cells) <= set(columns)
    for name, texts in cells.items():
        values = columns[name]
        if values.dtype.kind != "f":
            assert list(values) == texts, name
            continue
        read = np.array([float(text or "nan") for text in texts])
        assert np.array_equal(np.where(np.isfinite(values), values, np.nan), read, equal_nan=True), name
