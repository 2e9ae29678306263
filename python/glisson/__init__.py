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

from ._core import (
    Ball,
    Blade,
    BladeOptions,
    Block,
    BoxOptions,
    BoxVessel,
    Capsule,
    CapsuleOptions,
    ChartSpec,
    ConstantLaw,
    Constraint,
    ContactOptions,
    ContactTool,
    Container,
    ContainerLoads,
    ContainerOptions,
    CutOptions,
    CutReport,
    Cutter,
    CylinderOptions,
    CylinderVessel,
    CylinderWall,
    DrivenSet,
    EdgePiece,
    Energies,
    EngineInfo,
    ExponentialLaw,
    Fibres,
    FileError,
    FlatPunch,
    ForceParts,
    Fung,
    HandCoupling,
    HandDriver,
    ImplicitOptions,
    Instrument,
    InstrumentEvent,
    Interaction,
    InteractionStep,
    LimitingTet,
    LinearLaw,
    MassScaling,
    MaxwellBranch,
    MeshReport,
    MooneyRivlin,
    Needle,
    NeedleOptions,
    NeedleShape,
    NeoHookean,
    Ogden,
    OutputSpec,
    OwnDriver,
    OwnInteraction,
    PathDriver,
    Plate,
    PolynomialLaw,
    Pose,
    PressMotion,
    PushDriver,
    RecordedMotion,
    RemovalReport,
    RunResult,
    Rupture,
    Scene,
    SceneError,
    ShaftFriction,
    Simulation,
    SimulationOptions,
    SineMotion,
    SplitReport,
    SteadyMotion,
    StepError,
    StepLaw,
    StopFlag,
    Stroke,
    StrokeMotion,
    Table,
    TableLaw,
    TetMesh,
    TipResistance,
    Tissue,
    TissuePreset,
    ToolDriver,
    ToolForces,
    Variant,
    VerondaWestmann,
    Wrench,
    Yeoh,
    box_mesh,
    bulk_modulus,
    cylinder_mesh,
    distance_to,
    lame_from_young,
    largest_passive_stiffness,
    law_derivative,
    law_value,
    press_depth,
    press_end,
    scene_reference_markdown,
    shear_modulus,
    tissue_preset,
    tissue_presets,
)
from . import plot
from ._version import VERSION
from .driving import FunctionDriver
from .fitting import FitResult, fit, known_laws
from .meshes import format_report, from_meshio, from_pyvista, read_mesh, to_pyvista, write_vtu
from .paper_figures import figures
from .running import run, simulation
from .scenes import load_scene, parse_scene, scenes_folder, to_toml
from .sweeping import SweepError, sweep
from .tissues import tabulated, tissue_from

__version__ = VERSION
__all__ = [name for name in dir() if not name.startswith("_") and name not in {"annotations"}]
