"""Figures for papers, with matplotlib: force–displacement with repetitions, laws, energies, profiles.

Each function draws into `ax`, or into a figure of its own, and returns the axes.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from ._charts import COLOURS, STYLE, from_zero, line_look, name_lines, style
from ._charts import plot_run as run
from ._core import ChartSpec, RunResult, Tissue, law_value
from ._optional import need

if TYPE_CHECKING:
    from .fitting import FitResult

#: Looks of figures and colours of lines, those of reports.
__all__ = ["COLOURS", "STYLE", "chart", "energies", "forces", "laws", "profiles", "repetitions", "run", "style"]


def _axes(ax: Any, x: str, y: str) -> Any:
    if ax is None:
        pyplot = need("matplotlib.pyplot", "matplotlib", "plot")
        with style():
            ax = pyplot.subplots()[1]
    ax.set_xlabel(x)
    ax.set_ylabel(y)
    return ax


def _legend(ax: Any) -> None:
    with style():
        ax.legend(fontsize=STYLE["font.size"])


def forces(results: Iterable[RunResult] | Mapping[str, RunResult], *, against: str = "depth", ax: Any = None) -> Any:
    """Force of the tool of every run.

    :param against: "depth" [mm] or "time" [s]
    """
    if against not in ("depth", "time"):
        raise ValueError(f'against is {against!r}; allowed: "depth", "time"')
    own = ax is None
    ax = _axes(ax, "depth [mm]" if against == "depth" else "time [s]", "force [N]")
    for i, result in enumerate(results.values() if isinstance(results, Mapping) else results):
        x = 1e3 * result["depth_m"] if against == "depth" else result["time_s"]
        ax.plot(x, result["force_N"], label=result.label, **line_look(i))
    _finish(ax, own)
    return ax


def _finish(ax: Any, own: bool) -> None:
    """Ranges and names as in reports; in a figure of the caller's a legend alone."""
    if not own:
        _legend(ax)
        return
    with style():
        from_zero(ax)
        name_lines(ax)


def chart(spec: ChartSpec, results: Mapping[str, RunResult], *, ax: Any = None) -> Any:
    """A chart of a scene, as in its report, with the measured points."""
    own = ax is None
    ax = _axes(ax, spec.x.label or spec.x.column, spec.y.label or spec.y.column)
    for i, name in enumerate(spec.variants or list(results)):
        if name in results:
            table, label = results[name].forces, results[name].label
            x, y = spec.x.scale * table[spec.x.column], spec.y.scale * table[spec.y.column]
            ax.plot(x, y, label=label, **line_look(i))
    for measured in spec.measured:
        ax.plot(measured.xs, measured.ys, "o", markersize=2.5, color="0.4", label=measured.label)
    _finish(ax, own)
    return ax


def repetitions(result: FitResult, *, velocity: float | None = None, group: str | None = None, ax: Any = None) -> Any:
    """Measured curves in grey and the fitted one in black, as in the paper's figures 5 and 6.

    :param velocity: only the curves of this one [m/s]
    :param group: only the curves of the `[[data]]` table of this name
    """
    ax = _axes(ax, "displacement [mm]", "force [N]")
    chosen = [c for c in result.curves if velocity is None or (c.velocity and np.isclose(c.velocity, velocity))]
    if not chosen:
        known = sorted({c.velocity for c in result.curves if c.velocity})
        raise ValueError(f"no curve was measured at {velocity} m/s; there are {known}")
    chosen = [c for c in chosen if group is None or c.group == group]
    if not chosen:
        raise ValueError(f"no such curve in a group {group!r}; there are {sorted({c.group for c in result.curves})}")
    for i, curve in enumerate(chosen):
        label = "measured" if i == 0 else None
        ax.plot(1e3 * curve.displacement, curve.measured, color="0.7", linewidth=0.8, label=label)
    drawn: set[str] = set()
    for curve in chosen:
        if curve.group not in drawn:
            label = ("predicted" if curve.held_out else "fitted") if not drawn else None
            ax.plot(1e3 * curve.displacement, curve.fitted, color="black", label=label)
            drawn.add(curve.group)
    _legend(ax)
    return ax


def laws(tissues: Iterable[Tissue] | Tissue, *, until: float = 0.5, ax: Any = None) -> Any:
    """Young's modulus of tissues against their measure of deformation."""
    ax = _axes(ax, "deformation s [-]", "modulus [kPa]")
    at: Any = np.linspace(0.0, until, 400)
    for tissue in [tissues] if isinstance(tissues, Tissue) else tissues:
        moduli: Any = law_value(tissue.law, tissue.youngs_modulus, at)
        ax.plot(at, 1e-3 * moduli, label=tissue.name)
    ax.set_ylim(bottom=0)
    _legend(ax)
    return ax


def energies(result: RunResult, *, ax: Any = None) -> Any:
    """The energies that the work of the tools is converted to."""
    ax = _axes(ax, "time [s]", "energy [mJ]")
    for column, label in (
        ("work_tools_J", "work of tools"),
        ("energy_elastic_J", "elastic"),
        ("energy_dissipated_J", "dissipated"),
        ("energy_kinetic_J", "kinetic"),
        ("dissipated_friction_J", "friction"),
        ("dissipated_contact_J", "contact"),
        ("dissipated_fracture_J", "cutting and tearing"),
        ("energy_instruments_J", "in instruments"),
    ):
        if column.startswith(("dissipated_", "energy_instruments")) and not np.any(result[column]):
            continue
        ax.plot(result["time_s"], 1e3 * result[column], label=label)
    _legend(ax)
    return ax


def profiles(result: FitResult, *, axes: Any = None) -> Any:
    """Rise of −2 ln L about the best value of every parameter; the dashed line bounds the interval of 95 %.

    :raises ValueError: for a fit without profiles
    """
    rows = result.to_dict()["profiles"]
    if not rows:
        raise ValueError("the fit has no profiles; enable them in [proof]")
    if axes is None:
        pyplot = need("matplotlib.pyplot", "matplotlib", "plot")
        with style():
            axes = pyplot.subplots(1, len(rows), figsize=(2.4 * len(rows), 2.2), squeeze=False)[1][0]
    units = {p.name: p.unit for p in result.parameters.values()}
    for ax, row in zip(axes, rows, strict=True):
        rise = np.array([np.nan if x is None else x for x in row["rise"]], dtype=float)
        ax.plot(row["values"], rise, ".-", markersize=4)
        ax.axhline(row["threshold"], linestyle="--", linewidth=0.8, color="0.5")
        ax.set_xlabel(f"{row['parameter']} [{units.get(row['parameter']) or '-'}]")
        ax.set_ylabel("rise of −2 ln L")
    return axes
