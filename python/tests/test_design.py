"""Designs that are looked for: equal to the program's, and ready to be computed."""

import json
import subprocess

import pytest
import slider_crank as sc
from conftest import binary


def test_the_best_design_is_that_of_the_program(program, data):
    bounds = {"geometry.crank": "100 mm:200 mm", "geometry.offset": "0 mm:120 mm"}
    vary = [f"--vary={key}={values}" for key, values in bounds.items()]
    limits = ["time_ratio >= 1.05", "stroke <= 350 mm"]
    subjects = [f"--subject={limit}" for limit in limits]
    _, summary = program("optimise", data / "gupta.toml", *vary, "--most", "transmission_min", *subjects)
    scene = sc.Scene.load(data / "gupta.toml")
    found = sc.optimise(scene, bounds, most="transmission_min", subject=limits)
    assert found.summary == summary
    # Its scene has these values, and keeps the limits.
    turn = sc.kinematics(found.scene).summary
    assert turn["time_ratio"] >= 1.05 and turn["stroke_m"] <= 0.35
    assert turn["transmission_min_rad"] == summary["value"]


def test_a_search_says_what_it_cannot():
    scene = sc.Scene.duarte()
    bounds = {"geometry.rod": "100 mm:200 mm"}
    for goals in ({}, {"least": "stroke", "most": "stroke"}):
        with pytest.raises(sc.Refused, match="give least or most"):
            sc.optimise(scene, bounds, **goals)
    with pytest.raises(sc.Refused, match="are no bounds"):
        sc.optimise(scene, {"geometry.rod": "100 mm"}, least="stroke")
    with pytest.raises(sc.Refused, match="strok"):
        sc.optimise(scene, bounds, least="strok")
    with pytest.raises(sc.Refused, match="Python functions"):
        sc.optimise(scene.with_torque(lambda t: t), bounds, least="stroke")


@pytest.mark.parametrize("named", [{}, {"crank": "44 mm"}, {"rod": "150 mm"}, {"offset": "10 mm"}, {"rod_ratio": 4}])
def test_lengths_are_those_of_the_program(named):
    options = [f"--{name.replace('_', '-')}={value}" for name, value in named.items()]
    command = [binary(), "synthesis", "--stroke", "90 mm", "--time-ratio", "1.05", "--json", *options]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode == 2:
        with pytest.raises(sc.Refused):
            sc.synthesis("90 mm", 1.05, **named)
        return
    found = sc.synthesis("90 mm", 1.05, **named)
    assert found.summary == json.loads(done.stdout)
    turn = sc.kinematics(found.scene).summary
    assert turn["stroke_m"] == pytest.approx(0.09, rel=1e-14)
    assert turn["time_ratio"] == pytest.approx(1.05, rel=1e-13)


def test_one_length_is_named_at_most():
    with pytest.raises(sc.Refused, match="crank and rod"):
        sc.synthesis("90 mm", 1.2, crank="40 mm", rod="100 mm")
    with pytest.raises(sc.Refused, match="time ratio"):
        sc.synthesis("90 mm", 4)
