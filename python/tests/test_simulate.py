"""Forward motion: equal to the program's, loads from functions, interruption."""

import signal
import threading
import time

import numpy as np
import pytest
import slider_crank as sc
from conftest import same

SCENES = [
    "duarte-engine.toml",
    "four-stroke.toml",
    "gupta.toml",
    "motor-and-losses.toml",
    "brake.toml",
    "spring-press.toml",
    "clearance-5000rpm.toml",
    "hard/03-double-rocker.toml",
]


@pytest.mark.parametrize("name", SCENES)
def test_rows_are_those_of_the_program(program, data, name):
    cells, summary = program("simulate", data / name, *(["--reactions"] if "hard" not in name else []))
    run = sc.simulate(sc.Scene.load(data / name), reactions="hard" not in name)
    same(run, cells)
    for key in ("wall_s", "estimate_cost"):
        summary.pop(key), run.summary.pop(key)
    assert run.summary == summary


@pytest.mark.parametrize("method", ["time", "dop853", "angle"])
def test_methods_and_tolerances_are_those_of_the_program(program, data, method):
    options = ["--method", method, "--tolerance", "1e-7", "--no-estimate"]
    cells, _ = program("simulate", data / "duarte-cycle.toml", *options)
    scene = sc.Scene.load(data / "duarte-cycle.toml")
    same(sc.simulate(scene, method=method, tolerance=1e-7, estimate=False), cells)


def test_a_run_may_begin_in_its_steady_state(program, data):
    cells, summary = program("simulate", data / "four-stroke.toml", "--steady-state")
    scene = sc.Scene.load(data / "four-stroke.toml")
    run = sc.simulate(scene, steady_state=True)
    same(run, cells)
    assert run.summary["steady_state"] == summary["steady_state"] == sc.steady_state(scene)


def test_columns_are_arrays_that_own_what_was_computed():
    run = sc.simulate(sc.Scene.duarte())
    for name, values in run.items():
        assert values.dtype == np.float64 and values.flags.c_contiguous and values.flags.writeable, name
        assert values is run[name]
    with pytest.raises(KeyError, match="no column 'x'; there are t_s, theta_rad"):
        run["x"]


def test_the_motion_is_known_between_its_rows():
    run = sc.simulate(sc.Scene.duarte())
    theta, omega = run.at(run["t_s"])
    assert np.abs(theta - run["theta_rad"]).max() < 1e-12 and np.abs(omega - run["omega_rad_per_s"]).max() < 1e-11
    assert run.at(0.25)[0].shape == () and run.at([[0.1, 0.2]])[0].shape == (1, 2)
    assert np.isnan(run.at(2.0)[0])
    assert run.rows_at(0.25)["x_m"] == run.rows_at([0.25, 0.5])["x_m"][0]
    with pytest.raises(sc.Refused, match="no row at t = 2 s"):
        run.rows_at(2.0)


def crank(**given):
    run = {"duration": "2 s", "output_every": "0.1 s"}
    return sc.Scene(
        geometry={"crank": "50 mm", "rod": (150, "mm")},
        **{"crank": {"inertia": "0.02 kg m^2"}, "slider": {"mass": "0.6 kg"}, "run": run, **given},
    )


def test_functions_do_what_formulas_do():
    formulas = sc.simulate(crank(torque="3 - 0.1*omega + 0.5*sin(2*theta)", force="-8*v*abs(v)"))
    period = sc.Load(lambda theta: 0.5 * np.sin(2 * theta), period=1)
    functions = sc.simulate(crank(torque=[lambda omega: 3 - 0.1 * omega, period], force=lambda v: -8 * v * abs(v)))
    assert functions.summary["engine"] == formulas.summary["engine"]
    off = np.abs(functions["theta_rad"] - formulas["theta_rad"]).max()
    assert off <= 2 * (formulas.error_estimate["theta_rad"] + functions.error_estimate["theta_rad"])


def test_a_closed_form_under_a_function_of_time():
    """Inertia of the crank alone: I omega = integral of cos(3 t)."""
    scene = crank(slider=None, torque=lambda t: np.cos(3 * t))
    run = sc.simulate(scene)
    expected = np.sin(3 * run["t_s"]) / 3 / 0.02
    assert np.abs(run["omega_rad_per_s"] - expected).max() < 1e-9


def test_the_exception_of_a_function_comes_out():
    class Mine(Exception):
        pass

    calls = 0

    def failing(t):
        nonlocal calls
        calls += 1
        if t > 0.5:
            raise Mine("at 0.5 s")
        return 1.0

    with pytest.raises(Mine, match="at 0.5 s"):
        sc.simulate(crank(torque=failing))
    before = calls
    assert sc.simulate(crank(torque="1"))["t_s"][-1] == 2.0
    assert calls == before
    with pytest.raises(TypeError):
        sc.simulate(crank(torque=lambda t: "no number"))
    with pytest.raises(sc.Refused, match="do not say what the load depends on"):
        crank(torque=lambda speed: speed)
    with pytest.raises(sc.Refused, match="cannot repeat"):
        crank(torque=sc.Load(lambda theta: theta, period=1000))


def test_a_run_that_ends_early_warns_and_keeps_what_it_has(program, data):
    with pytest.warns(sc.IncompleteWarning, match="work limit"):
        run = sc.simulate(sc.Scene.load(data / "motor-and-losses.toml"), method="time", max_evaluations=2000)
    assert "work limit" in run.stopped and 0 < run.summary["final"]["t_s"] < 1.0
    cells, _ = program("simulate", data / "motor-and-losses.toml", "--method", "time", "--max-evaluations", 2000)
    same(run, cells)


LONG = {"motion": {"speed": "10 rad/s"}, "run": {"duration": "1e6 s", "output_every": "1e5 s"}}


@pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="no timers of signals")
@pytest.mark.parametrize("torque", ["sin(t)*sin(theta)", lambda t, theta: np.sin(t) * np.sin(theta)])
def test_a_signal_ends_a_long_call(torque):
    def handler(*_):
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGALRM, handler)
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.3)
        begun = time.monotonic()
        with pytest.raises(KeyboardInterrupt):
            sc.simulate(crank(torque=torque, **LONG), max_evaluations=10**12)
        assert time.monotonic() - begun < 3
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


def test_other_threads_run_meanwhile():
    ticks = []
    done = threading.Event()

    def tick():
        while not done.wait(0.01):
            ticks.append(time.monotonic())

    thread = threading.Thread(target=tick)
    thread.start()
    with pytest.warns(sc.IncompleteWarning):
        sc.simulate(crank(torque="sin(t)*sin(theta)", **LONG), max_evaluations=5_000_000, estimate=False)
    count = len(ticks)
    done.set()
    thread.join()
    assert count > 5
