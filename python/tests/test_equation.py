"""The equation of motion in SciPy's hands."""

import numpy as np
import pytest
import slider_crank as sc

R, L, E, MASS, INERTIA = 0.05, 0.15, 0.01, 0.6, 0.02


def scene(**given):
    return sc.Scene(
        geometry={"crank": "50 mm", "rod": "150 mm", "offset": "10 mm"},
        crank={"inertia": "0.02 kg m^2"},
        slider={"mass": "600 g"},
        gravity={"acceleration": "9.81 m/s^2", "direction": "180 deg"},
        torque=lambda t, omega: 1 - 0.05 * omega + np.sin(5 * t),
        force="-4*v",
        run={"duration": "2 s"},
        **given,
    )


def slider(theta):
    """x, x' and x'' by complex steps of the closed form."""
    h = 1e-30

    def x(theta):
        return R * np.cos(theta) + np.sqrt(L**2 - (E + R * np.sin(theta)) ** 2)

    def dx(theta):
        root = np.sqrt(L**2 - (E + R * np.sin(theta)) ** 2)
        return -R * np.sin(theta) - (E + R * np.sin(theta)) * R * np.cos(theta) / root

    return x(theta), x(theta + 1j * h).imag / h, dx(theta + 1j * h).imag / h


def test_terms_are_those_of_the_closed_form():
    theta = np.linspace(0, 7, 29).reshape(1, 29)
    terms = sc.Equation(scene()).terms(theta)
    x, dx, d2x = slider(theta)
    assert terms.M.shape == (1, 29)
    for found, expected in [
        (terms.x, x),
        (terms.dx, dx),
        (terms.d2x, d2x),
        (terms.M, INERTIA + MASS * dx**2),
        (terms.half_dM, MASS * dx * d2x),
        (terms.dV, MASS * 9.81 * dx),
        (terms.phi, np.arcsin((E + R * np.sin(theta)) / L)),
    ]:
        assert np.abs(found - expected).max() < 1e-14


def test_forces_and_accelerations_are_broadcast():
    equation = sc.Equation(scene())
    theta = np.linspace(0, 6, 7)[:, None]
    t, omega = 0.3, np.array([1.0, -20.0])
    _, dx, _ = slider(theta)
    expected = 1 - 0.05 * omega + np.sin(5 * t) - 4 * dx**2 * omega
    Q, terms = equation.Q(t, theta, omega), equation.terms(theta)
    assert Q.shape == (7, 2) and np.abs(Q - expected).max() < 1e-13
    alpha = (Q - terms.half_dM * omega**2 - terms.dV) / terms.M
    assert np.abs(equation.alpha(t, theta, omega) - alpha).max() < 1e-11 * np.abs(alpha).max()
    assert equation(t, [0.5, 2.0]).shape == (2,)


def test_solvers_of_scipy_find_the_same_motion():
    integrate = pytest.importorskip("scipy.integrate")
    equation, run = sc.Equation(scene()), sc.simulate(scene())
    found = integrate.solve_ivp(equation, (0, 2), [0.0, 0.0], method="DOP853", rtol=1e-12, atol=1e-12)
    theta, omega = found.y[:, -1]
    assert abs(theta - run.summary["final"]["theta_rad"]) < 1e-8
    assert abs(omega - run.summary["final"]["omega_rad_per_s"]) < 1e-8


def test_what_is_no_term_is_refused():
    with pytest.raises(sc.Refused, match="friction at the guide"):
        sc.Equation(scene(friction={"coefficient": 0.1}))
    with pytest.raises(ZeroDivisionError):
        sc.Equation(scene().with_torque(lambda t: 1 / 0)).Q(0.0, 0.0, 0.0)
