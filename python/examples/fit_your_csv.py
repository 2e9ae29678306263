# %% [markdown]
# # Fit your CSV
#
# Measured curves in, a tissue out, with intervals that say how sure it is. Here the curve is made first, so that the answer
# is known: a cylinder of an Ogden material, compressed, with noise. Put your own file in its place.

# %%
import sys
import tempfile
from pathlib import Path

import glisson
import numpy as np

folder = Path(sys.argv[1] if len(sys.argv) > 1 else tempfile.mkdtemp())
MU, ALPHA = 2000.0, 4.0  # Pa, -
AREA, HEIGHT = np.pi * 0.025**2, 0.03  # m², m
strain = np.linspace(0.01, 0.35, 40)
stretch = 1 - strain
stress = 2 * MU / ALPHA * (stretch ** (-ALPHA / 2) - stretch**ALPHA) / stretch  # incompressible, nominal, compression +
noise = np.random.default_rng(1).normal(0, 0.01 * stress.max(), strain.size)
rows = np.column_stack([1e3 * HEIGHT * strain, AREA * (stress + noise)])
np.savetxt(folder / "press.csv", rows, delimiter=",", header="displacement,force", comments="")

# %% [markdown]
# The description of a fit: the specimen, the tissue with its free numbers, the file and what its columns mean.
# `docs/fit.md` explains, `docs/fit_file.md` lists every key.

# %%
description = {
    "specimen": {"kind": "cylinder", "diameter_mm": 50, "height_mm": 30},
    "tissue": {"hyperelastic": {"kind": "ogden", "mu_Pa": [1000], "alpha": [2], "bulk_modulus_Pa": 1e6}},
    "parameter": [
        {"key": "tissue.hyperelastic.mu_Pa[0]", "name": "mu", "low": 100, "high": 1e5},
        {"key": "tissue.hyperelastic.alpha[0]", "name": "alpha", "low": 0.5, "high": 20},
    ],
    "data": [
        {
            "files": ["press.csv"],
            "speed_mm_s": 1,
            "columns": {
                "displacement": {"name": "displacement", "unit": "mm"},
                "force": {"name": "force", "unit": "N"},
            },
        }
    ],
    "search": {"starts": 4},
    "proof": {"bootstrap": 0},
}
result = glisson.fit(description, base=folder)
for parameter in result.parameters.values():
    low, high = parameter.ci95 or (None, None)
    print(f"{parameter.name} = {parameter.value:.4g} {parameter.unit}, 95 %: {low:.4g} to {high:.4g}: {parameter.verdict}")

# %% [markdown]
# The tissue goes into a simulation as it is, or into a scene as `tissue.toml`.

# %%
tissue = result.tissue
result.write(folder)
if len(sys.argv) > 1:
    glisson.plot.repetitions(result).figure.savefig(folder / "fit.pdf")
