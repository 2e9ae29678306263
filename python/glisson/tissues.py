"""Tissues from scenes' tables, and laws tried out in Python."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from ._core import TableLaw, Tissue, TorsionOptions, run_material_test, run_oscillation, run_torsion
from .scenes import parse_scene, to_toml


def tissue_from(table: Mapping[str, Any] | str) -> Tissue:
    """A tissue from the keys of a scene's [tissue], or from the text of a tissue.toml, such as a fit gives.

    >>> tissue_from({"youngs_modulus_Pa": 5000, "law": {"kind": "linear", "slope_Pa": 2e4}}).law
    LinearLaw(slope=20000.0)
    """
    text = table if isinstance(table, str) else "[tissue]\n" + to_toml(table)
    rest = '\n[mesh]\nkind = "box"\n[motion]\nmax_steps = 1\n'
    return parse_scene(text + rest, name="tissue").variants[0].tissue


def tabulated(
    law: Callable[[float], float], until: float = 1.0, points: int = 257, arguments: Any | None = None
) -> TableLaw:
    """A stiffness law written in Python: called once for each point, linear in between.

    The engine asks for the modulus of every tet in every step; a call into Python each time would take some hundred
    times as long as the step, so the law is tabulated. Beyond the last point it is constant.

    :param law: modulus [Pa] at the tissue's measure
    :param until: the largest measure of the table
    :param arguments: the measures themselves, ascending, where they are not to be evenly spaced

    >>> law = tabulated(lambda s: 3600 * (1 + 5 * s**2), until=0.5, points=101)
    >>> import glisson
    >>> round(glisson.law_value(law, 3600, 0.2))
    4320
    """
    at = np.linspace(0.0, until, points) if arguments is None else np.asarray(arguments, dtype=float)
    return TableLaw(arguments=at.tolist(), moduli=[float(law(float(x))) for x in at])


@dataclass(frozen=True)
class MaterialCurve:
    """What a homogeneous test of a tissue measures, a row a time."""

    time: np.ndarray  #: [s], (n,)
    deformation: np.ndarray  #: F [-], (n, 3, 3)
    nominal: np.ndarray  #: P, force over area at rest [Pa], (n, 3, 3)
    cauchy: np.ndarray  #: σ = P Fᵀ/J [Pa], (n, 3, 3)


def material_test(
    tissue: Tissue,
    test: Literal["uniaxial", "equibiaxial", "planar", "simple_shear", "volumetric"],
    times: Any,
    *,
    stretch: Any = None,
    stress: Any = None,
    between: int = 1,
) -> MaterialCurve:
    """A homogeneous specimen of a tissue, driven by stretch or by stress; z is its axis.

    uniaxial: z is driven, the sides are free; equibiaxial: x and y, z is free; planar: z, y is held, x is free; simple_shear: x
    moves with z, by the amount given as `stretch`; volumetric: all three axes alike. Between two times the driven value changes
    linearly; a first time of 0 applies the first value at once. A test that ends early keeps what it has, and a RuntimeWarning says
    why.

    :param times: [s], ascending
    :param stretch: the driven stretch [-], one a time; of simple_shear its amount
    :param stress: the driven nominal stress [Pa] in its place: a creep test
    :param between: steps from one time to the next; more of them for a tissue with viscosity or branches
    :raises ValueError: naming the argument, its value and the allowed range

    >>> curve = material_test(Tissue(youngs_modulus=3600), "uniaxial", [1, 2], stretch=[1.1, 1.2])
    >>> curve.nominal[:, 2, 2].round(6).tolist()
    [360.0, 720.0]
    """
    driven = {
        name: np.asarray(values, dtype=float).ravel().tolist()
        for name, values in (("stretch", stretch), ("stress", stress))
        if values is not None
    }
    states = run_material_test(tissue, test, np.asarray(times, dtype=float).ravel().tolist(), between=between, **driven)
    if not states[-1].converged:
        warnings.warn(states.pop().message, RuntimeWarning, stacklevel=2)
    rows = {name: np.array([getattr(s, name) for s in states]).reshape(-1, 3, 3) for name in ("deformation", "nominal", "cauchy")}
    return MaterialCurve(time=np.array([s.time for s in states]), **rows)


def oscillation(
    tissue: Tissue,
    frequencies: Any,
    *,
    stretch: float = 1.0,
    mode: Literal["simple_shear", "uniaxial"] = "simple_shear",
) -> np.ndarray:
    """Complex modulus of a small oscillation about a static stretch along z, with free sides and all branches relaxed.

    The stress is linearised exactly: there is no amplitude and no step to choose. The real part is the storage modulus, the imaginary
    part the loss modulus, both on the lengths and areas at the static stretch.

    :param frequencies: [Hz], 0 or above; 0 gives the relaxed modulus
    :param stretch: the static stretch, above 0
    :param mode: simple_shear gives G*: x moves with z, all else is held. uniaxial gives E*: z moves, the sides are free
    :return: modulus [Pa], complex, one a frequency
    :raises ValueError: naming the argument, its value and the allowed range

    >>> tissue = Tissue(youngs_modulus=2800, viscosity=10)
    >>> modulus = oscillation(tissue, [0, 1])
    >>> modulus.real.round(6).tolist(), modulus.imag.round(3).tolist()
    ([1000.0, 1000.0], [0.0, 62.832])
    """
    rows = run_oscillation(tissue, np.asarray(frequencies, dtype=float).ravel().tolist(), stretch, mode)
    moduli = np.array(rows, dtype=float).reshape(-1, 2)
    return moduli[:, 0] + 1j * moduli[:, 1]


@dataclass(frozen=True)
class TorsionCurve:
    """What a torsion test of a cylinder measures, a row a time."""

    time: np.ndarray  #: [s], (n,)
    twist: np.ndarray  #: angle over length at rest [rad/m], (n,)
    torque: np.ndarray  #: [N m], (n,)
    axial_force: np.ndarray  #: [N], (n,); below 0 the specimen pushes the plates apart


_TORSION = TorsionOptions()


def torsion(
    tissue: Tissue,
    radius: float,
    times: Any,
    twist: Any,
    *,
    stretch: float = _TORSION.stretch,
    between: int = _TORSION.between,
    radii: int = _TORSION.radii,
) -> TorsionCurve:
    """A cylinder of tissue between bonded plates that turn against each other at a fixed distance; its side is free.

    Each shell is in simple shear, with a history of its own. The volume change that the twist brings is neglected: the torque errs by
    a share of the order γ² μ/κ, with γ the shear at the rim, and the part of the axial force that grows with γ² by one of the order
    μ/κ: of a compressible neo-Hookean cylinder that part is 3κ/(3κ + μ) of what is returned. Between two times the twist changes linearly; a first time of 0 applies the first twist at once.

    :param radius: at rest [m], above 0
    :param times: [s], ascending
    :param twist: angle over length at rest [rad/m], one a time
    :param stretch: static axial stretch before the twist, with free sides and all branches relaxed
    :param between: steps from one time to the next; more of them for a tissue with viscosity or branches
    :param radii: Gauss points along the radius; more of them for a law with a kink
    :raises ValueError: naming the argument, its value and the allowed range

    >>> curve = torsion(Tissue(youngs_modulus=2800), 0.01, [1, 2], [5, 10])  # G J φ
    >>> curve.torque.round(8).tolist()
    [7.854e-05, 0.00015708]
    """
    t, twists = (np.asarray(values, dtype=float).ravel() for values in (times, twist))
    options = TorsionOptions(stretch=stretch, between=between, radii=radii)
    rows = run_torsion(tissue, radius, t.tolist(), twists.tolist(), options)
    forces = np.array(rows, dtype=float).reshape(-1, 2)
    return TorsionCurve(time=t, twist=twists, torque=forces[:, 0], axial_force=forces[:, 1])
