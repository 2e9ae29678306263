"""Simulation of non-linear, viscoelastic soft tissue touched by instruments.

Five lines to a force curve:

>>> import glisson
>>> body = glisson.Simulation(glisson.box_mesh(), glisson.Tissue(youngs_modulus=3600))
>>> held, tool = body.fix("z_min"), body.drive([207, 211, 212], glisson.PressMotion(velocity=0.01, depth=0.008))
>>> body.advance(until=0.5)
'ok'
>>> round(float(-body.force(tool).total[2]), 2)
0.25

Everything is in SI. Setters and constructors raise ValueError with the name, the value and the allowed range; a step that
cannot be made raises StepError with the way out.
"""

from __future__ import annotations

from ._core import *  # all that is bound
from . import image, plot
from ._version import VERSION
from .driving import FunctionDriver
from .fitting import FitResult, TestFit, fit, known_laws
from .meshes import convert, format_report, from_meshio, from_pyvista, read_mesh, to_pyvista, write_vtu
from .paper_figures import figures
from .pictures import picture
from .running import check, run, simulation
from .scenes import load_scene, parse_scene, scenes_folder, to_toml
from .sweeping import SweepError, sweep
from .tissues import MaterialCurve, TorsionCurve, material_test, oscillation, tabulated, tissue_from, torsion

__version__ = VERSION
# What the functions above are made of.
_INNER = {"annotations", "HeldFolder", "check_variants", "read_scene", "read_scene_text", "run_material_test", "run_oscillation", "run_torsion", "run_variant", "TorsionOptions"}
__all__ = [name for name in dir() if not name.startswith("_") and name not in _INNER]
