"""Force from measured motion, and values from it: equal to the program's."""

import numpy as np
import pytest
import slider_crank as sc
from conftest import same


@pytest.mark.parametrize("fit", ["auto", "smoother"])
def test_the_force_is_that_of_the_program(program, data, fit):
    scene, record = data / "duarte-engine.toml", data / "duarte-motion.csv"
    cells, summary = program("inverse", scene, record, "--fit", fit, "--reactions")
    found = sc.inverse(sc.Scene.load(scene), record, fit=fit, reactions=True)
    same(found, cells)
    assert found.summary == summary
    low, high = found.band()
    here = np.isfinite(found["slider_force_n"])
    assert here.any() and np.all(low[here] < high[here])
    name, unit = summary["data"]["column"], summary["data"]["unit"]
    off = found.residuals[f"{name}_{unit}"] - found.residuals[f"fitted_{name}_{unit}"]
    assert np.abs(off - found.residuals[f"residual_{unit}"]).max() < 1e-12


def test_arrays_give_what_a_file_gives(data):
    scene = sc.Scene.load(data / "run-down.toml")
    record = sc.Measurement.load(data / "run-down.csv")
    again = sc.Measurement(record.t, **{record.measured: record.values})
    assert (again.measured, len(again.t)) == (record.measured, 301)
    one, other = (sc.inverse(scene, kind, fit="smoother") for kind in (record, again))
    # The digits of the file say how fine the values are.
    off = np.nanmax(np.abs(one["crank_torque_nm"] - other["crank_torque_nm"]))
    assert off < 0.1 * np.nanmax(one["crank_torque_se_nm"])


def test_the_slider_force_of_newton():
    """Slider of 2 kg alone: force = mass times acceleration."""
    t = np.linspace(0, 0.4, 60)
    scene = sc.Scene(geometry={"crank": "50 mm", "rod": "150 mm"}, slider={"mass": "2 kg"})
    found = sc.inverse(scene, sc.Measurement(t, theta=0.3 + 10 * t))
    terms = sc.Equation(scene).terms(found["theta_rad"])
    force = found["slider_force_n"]
    assert np.nanmax(np.abs(force - 2 * terms.d2x * 100)) < 1e-6


def test_a_speed_is_a_motion():
    """A flywheel alone: torque = inertia times acceleration."""
    t = np.linspace(0, 1, 200)
    scene = sc.Scene(geometry={"crank": "50 mm", "rod": "150 mm"}, crank={"inertia": "0.02 kg m^2"})
    found = sc.inverse(scene, sc.Measurement(t, omega=10 + 4 * t))
    assert np.nanmax(np.abs(found["crank_torque_nm"] - 0.08)) < 1e-6


def test_a_slow_sensor_has_few_values(data):
    record = sc.Measurement.load(data / "hard" / "14-nan.csv", missing=["NaN"])
    assert any("without time or theta" in note for note in record.notes)
    t = np.linspace(0, 0.4, 60)
    x = np.where(np.arange(60) % 5, np.nan, 0.05 * np.cos(10 * t) + np.sqrt(0.15**2 - (0.05 * np.sin(10 * t)) ** 2))
    scene = sc.Scene(geometry={"crank": "50 mm", "rod": "150 mm"}, slider={"mass": "2 kg"})
    found = sc.inverse(scene, sc.Measurement(t, theta=10 * t, x=x))
    assert len(found["t_s"]) == 60


def test_values_are_those_of_the_program(program, data):
    scene, record = data / "run-down.toml", data / "run-down.csv"
    free = ["torque[1].coefficient", "crank.inertia", "sensor.zero"]
    _, summary = program("identify", scene, record, "--free", ",".join(free))
    assert sc.identify(sc.Scene.load(scene), record, free) == summary


def test_what_is_wrong_with_a_record_is_said(data):
    with pytest.raises(sc.SceneError, match="14-nan.csv"):
        sc.Measurement.load(data / "hard" / "14-nan.csv")
    with pytest.raises(sc.SceneError):
        sc.Measurement([0.0, 1.0, 0.5], theta=[0.0, 1.0, 2.0])
    with pytest.raises(sc.Refused, match="no motion is given"):
        sc.Measurement([0.0, 1.0])
    with pytest.raises(sc.Refused):
        sc.identify(sc.Scene.load(data / "run-down.toml"), data / "run-down.csv", ["crank.inertai"])
