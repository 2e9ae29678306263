"""Tissues from scenes' tables, and laws tried out in Python."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from ._core import TableLaw, Tissue
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
