"""The example runs, and finds what is known of its record."""

import runpy
from pathlib import Path

import numpy as np

EXAMPLE = Path(__file__).resolve().parents[1] / "examples" / "force.py"


def test_the_force_that_is_not_there_is_not_found():
    found = runpy.run_path(str(EXAMPLE))
    (first, second), told = (found["first"], found["second"]), found["told"]
    # data/run-down.toml says from which values the record was made.
    for key, true in [("crank.inertia", 0.0277), ("geometry.offset", 0.008), ("torque[2].value", 0.14)]:
        assert abs(told[key]["value"] - true) < 3 * told[key]["standard_error"], key
    low, high = second.band("slider_force")
    assert np.all((low <= 0) & (0 <= high))
    assert np.nanmax(np.abs(second["slider_force_n"])) < 0.1 * np.nanmax(np.abs(first["slider_force_n"]))
