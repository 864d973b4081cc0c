# %% [markdown]
# # From a measured crank motion to the slider force with its band
#
# A rig runs down: the record has the crank angle over the time, with the noise of its encoder. The equation of motion, read
# backwards, tells which force on the slider goes with that motion, and how far it may be off. The friction, the flywheel and
# the offset of the rig are not known well: the same record tells them, and the force is recovered once more.
#
# Run it as a script, or cell by cell in an editor that knows `# %%`.

# %%
from pathlib import Path

import numpy as np
import slider_crank as sc

data = Path(__file__).resolve().parents[2] / "data"
scene = sc.Scene.load(data / "run-down.toml")
record = sc.Measurement.load(data / "run-down.csv")
print(record)

# %% [markdown]
# ## The force, as the first guesses of the rig have it


# %%
def recovered(scene, record):
    found = sc.inverse(scene, record)
    force, (low, high) = found["slider_force_n"], found.band("slider_force")
    for i in range(0, len(force), 50):
        shown = f"{force[i]:6.1f} N, 95 % from {low[i]:6.1f} to {high[i]:6.1f} N"
        near = "near a dead centre: the motion does not determine it"
        print(f"  t = {found['t_s'][i]:.3f} s  {near if np.isnan(force[i]) else shown}")
    known = np.isfinite(force)
    outside = np.mean((low[known] > 0) | (high[known] < 0))
    print(f"  a force that is not zero is seen in {outside:.0%} of the rows")
    return found


first = recovered(scene, record)

# %% [markdown]
# ## What the record tells of the rig

# %%
keys = ["torque[1].coefficient", "torque[2].value", "crank.inertia", "geometry.offset", "sensor.zero"]
rig = sc.identify(scene, record, keys)
for value in rig["values"]:
    print(f"  {value['key']:22} {value['value']:10.5f} +- {value['standard_error']:.5f} {value['unit']}")

# %% [markdown]
# ## The force with what it told
#
# The mark of the encoder is off by `sensor.zero`; the record is moved by that. Nothing pushed the slider in this run: what
# the first guesses took for a force is gone.

# %%
told = {value["key"]: value for value in rig["values"]}
zero = told.pop("sensor.zero")["value"]
known = scene.replace({key: f"{value['value']} {value['unit']}" for key, value in told.items()})
second = recovered(known, sc.Measurement(record.t, theta=record.values - zero))

# %% [markdown]
# ## Shown
#
# In a notebook the last expression of a cell is shown: the report page, with the band and the mechanism in motion.

# %%
second
