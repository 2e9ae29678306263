"""Other people's programs, given the experiments of `glisson compare`: a file each, run by scripts/compare_programs.

A file has EFFORTS, the names of the runs that are tried, from the cheapest, version() and run(case, effort) -> Answer. This list needs
Python alone; the files need numpy, and of their program nothing before version() and run().
"""

from __future__ import annotations

from importlib.util import find_spec
from typing import NamedTuple


class Program(NamedTuple):
    name: str  # as in the table
    file: str  # of this folder
    module: str  # what is imported
    pip: str  # what installs it
    how: str  # what it is given, and how its force is read

    def installed(self) -> bool:
        return all(find_spec(name) is not None for name in ("numpy", self.module))


PROGRAMS = [
    Program(
        "scikit_fem",
        "scikit_fem",
        "skfem",
        "scikit-fem scipy",
        "the scene's law as a form, equilibria by Newton's method, spsolve of scipy; force from the residual",
    ),
    Program(
        "felupe",
        "felupe_solid",
        "felupe",
        "felupe",
        "its own neo-Hookean law, which is the scene's, equilibria by Newton's method, spsolve of scipy; force from "
        "the residual",
    ),
    Program(
        "ngsolve",
        "ngsolve_solid",
        "ngsolve",
        "ngsolve",
        "the scene's energy as a formula, equilibria by Newton's method, sparsecholesky; force from the residual",
    ),
    Program(
        "mujoco",
        "mujoco_flex",
        "mujoco",
        "mujoco",
        "flex with St Venant–Kirchhoff (StVK) or simplified stable neo-Hookean (SNH) tets, implicit steps; moved "
        "vertices have heavy slides with a given velocity; force: qfrc_passive",
    ),
    Program(
        "newton",
        "newton_vbd",
        "newton",
        "newton",
        "vertex block descent, stable neo-Hookean, float; moved vertices have no mass and are set each step; force: "
        "its own law on its shape, summed here",
    ),
    Program(
        "pybullet",
        "pybullet_deformable",
        "pybullet",
        "pybullet",
        "deformable world, stable neo-Hookean with a logarithm, explicit; moved vertices are anchored and set each "
        "step; force: its own law on its shape, summed here",
    ),
]
