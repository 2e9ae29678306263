# %% [markdown]
# # Drive a needle and read the force
#
# A needle goes into a cylinder of tissue, pierces its surface, rests and comes out. Every millisecond its force is read, as
# a haptic device or a controller would.

# %%
import sys

import glisson
import numpy as np

mesh = glisson.cylinder_mesh(radius=0.02, height=0.025, radial_cells=4, axial_cells=6)
tissue = glisson.Tissue(youngs_modulus=5000, poisson_ratio=0.45, density=1060, law=glisson.LinearLaw(slope=4e4))
body = glisson.Simulation(mesh, tissue, glisson.SimulationOptions(damping_rate=20))
body.fix("bottom")

# %% [markdown]
# The way is a motion of the engine, or any function of time. What the needle meets is in its options.

# %%


def way(time: float) -> tuple[float, float, float]:
    """In at 20 mm/s for half a second, a rest, and out again."""
    depth = 0.02 * (min(time, 0.5) - max(0.0, time - 0.7))
    return 0.0, 0.0, -depth


needle = glisson.Needle(
    glisson.NeedleOptions(
        rupture=glisson.Rupture(force=0.3),
        tip=glisson.TipResistance(cutting=0.1),
        friction=glisson.ShaftFriction(static_in=18, static_out=18, dynamic_in=10, dynamic_out=12),
    ),
    glisson.PathDriver(glisson.Pose(position=[0, 0, 0.0255]), way, end=1.2),
)
body.attach(needle)

# %%
rows = []


def read() -> None:
    forces = needle.forces
    parts = (forces.normal, forces.friction, forces.cutting)
    rows.append([body.time, needle.depth, *(-part[2] for part in parts), -forces.total[2]])


body.advance(1.2, observer=read, every=0.001)
table = np.array(rows)
for event in needle.events:
    print(f"{event.event:12s} at {event.time:.3f} s, {1e3 * event.depth:.2f} mm")
print(f"largest force {table[:, -1].max():.3f} N going in, {table[:, -1].min():.3f} N coming out")

# %%
if len(sys.argv) > 1:
    from matplotlib import pyplot

    with glisson.plot.style():
        figure, axes = pyplot.subplots()
        axes.plot(1e3 * table[:, 1], table[:, -1])
        axes.set_xlabel("depth [mm]")
        axes.set_ylabel("force [N]")
        figure.savefig(sys.argv[1] + "/needle.pdf")
