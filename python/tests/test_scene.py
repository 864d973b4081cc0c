"""Scenes from files, texts and keywords; errors with value, place and cure."""

from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
import slider_crank as sc


def test_keywords_are_tables_of_a_scene_file(data):
    written = (data / "motor-and-losses.toml").read_text()
    import tomllib

    tables = tomllib.loads(written)
    made = sc.Scene(**tables, folder=data)
    parsed = sc.Scene.parse(written, folder=data)
    loaded = sc.Scene.load(data / "motor-and-losses.toml")
    assert parsed.text == loaded.text == written
    runs = [sc.simulate(scene) for scene in (made, parsed, loaded)]
    for name in runs[0]:
        assert np.array_equal(runs[0][name], runs[1][name]) and np.array_equal(runs[0][name], runs[2][name])
    assert made.title == tables["title"]


def test_tables_are_found_beside_the_scene(data):
    text = (data / "four-stroke.toml").read_text()
    assert sc.Scene.parse(text, folder=data).title
    with pytest.raises(sc.SceneError, match="four-stroke-pressure.csv"):
        sc.Scene.parse(text, folder=Path("/nowhere"))
    with pytest.raises(FileNotFoundError, match="`none.toml` cannot be read"):
        sc.Scene.load("none.toml")


def test_all_that_is_wrong_is_said_with_its_place():
    with pytest.raises(sc.SceneError) as raised:
        sc.Scene(geometry={"crank": 50, "rod": "150 mm"}, craank={"mass": "1 kg"}, slider={"mass": "1 m"})
    first, second, third = raised.value.problems
    assert (first["field"], first["line"], first["column"]) == ("geometry.crank", 2, 9)
    assert "`50` has no unit" in first["what"] and "47 mm" in first["help"]
    assert {"craank", "slider.mass"} == {second["field"], third["field"]}
    assert "did you mean `crank`" in str(raised.value)
    assert isinstance(raised.value, sc.Error) and isinstance(raised.value, ValueError)


def test_values_may_be_numbers_with_their_unit():
    scene = sc.Scene(
        title='a "quoted" \\ title\nof two lines',
        geometry={"crank": (np.float64(50), "mm"), "rod": (150, "mm")},
        slider={"mass": "1 kg"},
        friction={"coefficient": np.float64(0.1)},
    )
    assert scene.title == 'a "quoted" \\ title\nof two lines'
    assert 'crank = "50.0 mm"' in scene.text and "coefficient = 0.1" in scene.text


def test_values_are_replaced(data):
    scene = sc.Scene.load(data / "motor-and-losses.toml")
    longer = scene.replace({"geometry.rod": "200 mm"})
    direct = sc.Scene.parse(scene.text.replace('rod = "150 mm"', 'rod = "200 mm"'), folder=data)
    assert 'rod = "200 mm"' in longer.text
    assert sc.kinematics(longer).summary["stroke_m"] == sc.kinematics(direct).summary["stroke_m"]
    with pytest.raises(sc.Refused, match=r"torque\[9\]"):
        scene.replace({"torque[9].value": "1 N m"})
    with pytest.raises(sc.SceneError, match="rodd"):
        scene.replace({"geometry.rodd": "200 mm"})


def test_functions_stay_with_a_scene():
    base = sc.Scene(geometry={"crank": "50 mm", "rod": "150 mm"}, slider={"mass": "1 kg"}, run={"duration": "1 s"})
    scene = base.with_force(lambda v: -3 * v).with_torque(sc.Load(lambda a: 1.0, reads=["t"], period=Fraction(1, 2)))
    assert "2 loads from functions" in repr(scene) and "2 loads" in repr(scene.replace({"slider.mass": "2 kg"}))
    assert "function of v" in scene.explain()
