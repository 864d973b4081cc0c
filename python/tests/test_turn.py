"""Kinematics, statics and sweeps: equal to the program's."""

import numpy as np
import pytest
import slider_crank as sc
from conftest import same


@pytest.mark.parametrize("forces", [False, True])
def test_a_turn_is_that_of_the_program(program, data, forces):
    options = ["--forces", "--sensitivity"] if forces else []
    cells, summary = program("kinematics", data / "gupta.toml", "--every", "0.5 deg", *options)
    turn = sc.kinematics(sc.Scene.load(data / "gupta.toml"), every="0.5 deg", forces=forces, sensitivity=forces)
    same(turn, cells)
    assert turn.summary == summary


def test_changed_lengths_stand_beside(program, data):
    cells, summary = program("kinematics", data / "gupta.toml", "--change", "rod=200 mm")
    turn = sc.kinematics(sc.Scene.load(data / "gupta.toml"), change={"rod": "200 mm"})
    same(turn, cells)
    with pytest.raises(sc.Refused, match="`rodd` is no length"):
        sc.kinematics(sc.Scene.duarte(), change={"rodd": "1 m"})
    with pytest.raises(sc.Refused):
        sc.kinematics(sc.Scene.duarte(), every="1 mm")


def test_statics_are_those_of_the_program(program, data):
    cells, summary = program("statics", data / "ng.toml", "--every", "5 deg", "--details")
    found = sc.statics(sc.Scene.load(data / "ng.toml"), every="5 deg")
    same(found, cells)
    assert found.summary == summary
    cells, _ = program("statics", data / "ng.toml", "--force", "100 N", "--friction", "0.2")
    same(sc.statics(sc.Scene.load(data / "ng.toml"), force="100 N", friction=0.2), cells)


def test_designs_are_those_of_the_program(program, data):
    vary = ["--vary", "geometry.offset=0mm:120mm:13", "--vary", "rod.model=rigid,two-mass"]
    cells, _ = program("sweep", data / "gupta.toml", *vary, "--reactions")
    scene = sc.Scene.load(data / "gupta.toml")
    models = ["rigid", "two-mass"]
    found = sc.sweep(scene, {"geometry.offset": "0mm:120mm:13", "rod.model": models}, reactions=True)
    numbers = {name: texts for name, texts in cells.items() if name in found and found[name].dtype.kind == "f"}
    same(found, numbers)
    for name in ("status", "class", "rod_model", "notes"):
        assert list(found[name]) == cells[name]
    listed = sc.sweep(scene, {"geometry.offset": (np.linspace(0, 120, 13), "mm")}, motion=False)
    assert np.array_equal(listed["stroke_m"], found["stroke_m"][::2], equal_nan=True)
    assert listed.summary["designs"] == 13


def test_a_sweep_says_what_it_cannot():
    with pytest.raises(sc.Refused, match="Python functions"):
        sc.sweep(sc.Scene.duarte().with_torque(lambda t: t), {"geometry.rod": "150mm:160mm:3"})
    with pytest.raises(sc.Refused, match="`rodd` is not a key of geometry"):
        sc.sweep(sc.Scene.duarte(), {"geometry.rodd": "150mm:160mm:3"})


def test_samples_and_fronts_are_those_of_the_program(program, data):
    options = ["--vary", "geometry.rod=150mm:160mm", "--sample", 20, "--seed", 3]
    goals = ["--figures", "stroke", "--least", "transmission_min", "--most", "time_ratio"]
    cells, summary = program("sweep", data / "gupta.toml", *options, *goals)
    found = sc.sweep(
        sc.Scene.load(data / "gupta.toml"),
        {"geometry.rod": "150mm:160mm"},
        sample=20,
        seed=3,
        figures=["stroke"],
        least="transmission_min",
        most="time_ratio",
    )
    same(found, {name: texts for name, texts in cells.items() if found[name].dtype.kind == "f"})
    del found.summary["wall_s"], summary["wall_s"]
    assert found.summary == summary
