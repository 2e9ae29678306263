"""The charts of a fit: measured against simulated curves and what is left of them, a pair for each group, as in its report.

The numbers are those of fit.json. Drawing is into axes that are given (`_charts.plot_run`).
"""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ._frames import RunError

_GREY, _BLACK, _BAND = "#8f98a2", "#1a1f26", "#ebedf0"
_ROOM = 1.08  # of the residuals' axis, beyond the largest


class _Curve(NamedTuple):
    """Numbers in the units of the axes."""

    x: Any
    measured: Any
    fitted: Any
    low: Any
    high: Any
    noise: float
    raw: dict[str, Any]


def read_fit(file: Path) -> dict[str, Any]:
    """The object of a fit.json."""
    try:
        fit = json.loads(file.read_text(encoding="utf-8"))
    except OSError as error:
        raise RunError(f"{file}: cannot be read: {error.strerror}; give the folder that `glisson fit … --out OUT` wrote") from error
    except ValueError:
        fit = None
    if not isinstance(fit, dict) or not isinstance(fit.get("curves"), list):
        raise RunError(f"{file}: not the fit.json of a fit; run the fit again")
    return fit


def fit_charts(fit: dict[str, Any]) -> list[tuple[str, Callable[[Any], None]]]:
    """Titles, and what draws each into axes: the curves of every group, fitted ones first, then their residuals."""
    groups = _groups(fit)
    size: dict[str, float] = {}  # of the residuals, by the label of their axis: one range for all that have it
    for curves in groups.values():
        label = curves[0].raw["y"]["label"]
        parts = [np.abs(c.measured - c.fitted) for c in curves] + [np.array([2.2 * c.noise]) for c in curves]
        known = np.concatenate(parts)
        known = known[np.isfinite(known)]
        size[label] = max(size.get(label, 0.0), float(known.max(initial=0.0)))
    charts: list[tuple[str, Callable[[Any], None]]] = []
    for title, curves in groups.items():
        charts.append((title, partial(_draw_curves, curves=curves)))
    for title, curves in groups.items():
        most = _ROOM * size[curves[0].raw["y"]["label"]]
        charts.append((f"Residuals of {title}", partial(_draw_residuals, curves=curves, most=most)))
    return charts


def _groups(fit: dict[str, Any]) -> dict[str, list[_Curve]]:
    """Curves by title; those of a group that is fitted and held out are two."""
    found: dict[tuple[bool, str], list[_Curve]] = {}
    for raw in fit["curves"]:
        found.setdefault((bool(raw.get("held_out")), raw.get("group") or raw.get("name") or "Curves"), []).append(_curve(raw))
    named: dict[str, list[_Curve]] = {}
    for (held_out, name), curves in sorted(found.items(), key=lambda item: item[0][0]):
        named[f"{name}, held out" if held_out and (False, name) in found else name] = curves
    return named


def _curve(raw: dict[str, Any]) -> _Curve:
    scale_y = float(raw["y"]["scale"])

    def of(*names: str) -> Any:
        values: list[float | None] = next((raw[name] for name in names if name in raw), [])
        return np.array([np.nan if v is None else v for v in values], dtype=float)

    x = of("time_s") if raw["x"].get("of") == "time" else of("drive", "displacement_m")
    low, high = (scale_y * of(name, f"{name}_N") for name in ("further_low", "further_high"))
    noise = next((raw[name] for name in ("noise", "noise_N") if raw.get(name) is not None), np.nan)
    measured, fitted = (scale_y * of(name, f"{name}_N") for name in ("measured", "fitted"))
    return _Curve(float(raw["x"]["scale"]) * x, measured, fitted, low, high, abs(scale_y) * float(noise), raw)


def _axes(ax: Any, curve: _Curve) -> None:
    x, y = curve.raw["x"], curve.raw["y"]
    if x.get("log"):
        ax.set_xscale("log")
    ax.set_xlabel(_capital(x["label"]))
    ax.set_ylabel(_capital(y["label"]))


def _draw_curves(ax: Any, curves: Sequence[_Curve]) -> None:
    """Repetitions in grey, the simulation in black, dashed where a further specimen is expected."""
    _axes(ax, curves[0])
    measured = f"measured, {len(curves)} repetitions" if len(curves) > 1 else "measured"
    fitted = "predicted" if curves[0].raw.get("held_out") else "simulated"
    for i, curve in enumerate(curves):
        ax.plot(curve.x, curve.measured, color=_GREY, linewidth=0.8, linestyle="-", label="_" if i else measured)
    for i, curve in enumerate(curves):
        ax.plot(curve.x, curve.fitted, color=_BLACK, linewidth=1.1, linestyle="-", label="_" if i else fitted)
    longest = max(curves, key=lambda c: len(c.low))
    for i, ends in enumerate((longest.low, longest.high)):
        if len(ends):
            label = "_" if i else "95 % of further specimens"
            ax.plot(longest.x, ends, color=_BLACK, linewidth=0.7, linestyle=(0, (4, 4)), label=label)


def _draw_residuals(ax: Any, curves: Sequence[_Curve], most: float) -> None:
    """Measured − simulated, over a band of twice the noise's standard deviation to both sides."""
    _axes(ax, curves[0])
    name, _, unit = curves[0].raw["y"]["label"].partition(" [")
    ax.set_ylabel(f"Residual [{unit}" if unit else f"Residual of {name}")
    noise = max((c.noise for c in curves if np.isfinite(c.noise)), default=0.0)
    if noise > 0:
        ax.axhspan(-2 * noise, 2 * noise, color=_BAND, linewidth=0)
        ax.plot([], [], color=_BAND, linewidth=5, linestyle="-", label="± 2 sd of the noise")
    ax.axhline(0.0, color=_GREY, linewidth=0.6, linestyle="-", label="_")
    for i, curve in enumerate(curves):
        label = "_" if i else "measured − " + ("predicted" if curve.raw.get("held_out") else "simulated")
        ax.plot(curve.x, curve.measured - curve.fitted, color=_BLACK, linewidth=0.7, linestyle="-", label=label)
    if most > 0:
        ax.set_ylim(-most, most)


def _capital(text: str) -> str:
    return text[:1].upper() + text[1:]
