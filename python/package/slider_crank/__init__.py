"""Dynamics of the offset slider-crank from its Lagrange equation, forward and inverse, with NumPy arrays in and out.

>>> import slider_crank as sc
>>> scene = sc.Scene(
...     geometry={"crank": "50 mm", "rod": "150 mm"},
...     crank={"inertia": "0.02 kg m^2"},
...     slider={"mass": "600 g"},
...     torque=[lambda omega: 3 - 0.1 * omega],
...     run={"duration": "2 s"},
... )
>>> run = sc.simulate(scene)
>>> t, omega = run["t_s"], run["omega_rad_per_s"]

What goes in has its unit, as in scene files: ``"50 mm"``, ``"1500 rpm"``. What comes out is SI and radians, with the unit in
the name of each column, and equal to the bit to what the program ``slider-crank`` writes. The crank angle theta counts
counter-clockwise from +x, forces on the slider along +x.

Errors are :class:`Error`, a ``ValueError``, with value, place and cure: :class:`SceneError` for scenes and data,
:class:`Refused` for what cannot be computed. Long calls let other threads run and end on Ctrl-C.
"""

from ._native import Error, Refused, SceneError
from .design import Design, optimise, synthesis
from .designs import Designs, sweep
from .dynamics import IncompleteWarning, Simulation, simulate, steady_state
from .equation import Equation, Terms
from .measured import Measurement, Recovered, identify, inverse
from .rows import Rows
from .scene import Load, Scene
from .turn import kinematics, statics

__all__ = [
    "Design",
    "Designs",
    "Equation",
    "Error",
    "IncompleteWarning",
    "Load",
    "Measurement",
    "Recovered",
    "Refused",
    "Rows",
    "Scene",
    "SceneError",
    "Simulation",
    "Terms",
    "identify",
    "inverse",
    "kinematics",
    "optimise",
    "simulate",
    "statics",
    "steady_state",
    "sweep",
    "synthesis",
]
