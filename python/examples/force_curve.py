# %% [markdown]
# # Five lines to a force curve
#
# A box of tissue is pressed by 8 mm. Cells are marked by `# %%`: open this file as a notebook in VS Code, PyCharm or
# Jupyter (jupytext), or run it as it is. With a folder as its argument it writes its figure there.

# %%
import sys

import glisson

tissue = glisson.Tissue(youngs_modulus=3600, law=glisson.LinearLaw(slope=18000))
body = glisson.Simulation(glisson.box_mesh(), tissue, glisson.SimulationOptions(damping_rate=20))
body.fix("z_min")
tool = body.drive([207, 211, 212], glisson.PressMotion(velocity=0.01, depth=0.008))

# %% [markdown]
# An observer is called as often as it asks for, and reads whatever it likes.

# %%
depth, force = [], []


def read() -> None:
    depth.append(1e3 * 0.01 * body.force_time)
    force.append(-body.force(tool).total[2])


body.advance(until=0.8, observer=read, every=0.01)
print(f"{force[-1]:.3f} N at {depth[-1]:.2f} mm, after {body.steps} steps")

# %% [markdown]
# The same from a scene is one line, and gives the columns of `forces.csv`.

# %%
results = glisson.run(
    {
        "mesh": {"kind": "box"},
        "tissue": {"youngs_modulus_Pa": 3600, "law": {"kind": "linear", "slope_Pa": 18000}},
        "motion": {"damping_rate_per_s": 20},
        "fixed": [{"set": "z_min"}],
        "tool": [{"set": "z_max", "velocity_mm_s": 10, "depth_mm": 4}],
    }
)
if len(sys.argv) > 1:
    axes = glisson.plot.forces(results)
    axes.figure.savefig(sys.argv[1] + "/force_curve.pdf")
