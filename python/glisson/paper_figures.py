"""The figures of Schwartz et al. 2002 that show forces, drawn from the shipped scenes."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from . import plot
from ._optional import need
from .fitting import FitResult, fit
from .running import run
from .scenes import load_scene, scenes_folder

#: Figures and what they are drawn from; 5 and 6 are one fit: 2 mm/s is fitted, 6 and 10 mm/s are predicted.
SOURCES = {
    "2": "paper/figure2.toml",
    "3a": "paper/figure3a.toml",
    "3b": "paper/figure3b.toml",
    "5": "fit/liver_velocity.toml",
    "6": "fit/liver_velocity.toml",
}


def figures(
    which: Sequence[str] = ("2", "3a", "3b", "5", "6"),
    out: str | os.PathLike[str] | None = None,
    result: FitResult | None = None,
) -> dict[str, Any]:
    """Redraws the paper's figures 2, 3, 5 and 6: runs their scenes, and the fit of the last two.

    Figure 2 takes a second, figure 3 some ten, the fit of 5 and 6 many minutes. Its curves are simulated: the paper
    publishes no numbers of its measurements.

    :param out: folder for figure<name>.pdf
    :param result: of a fit of scenes/fit/liver_velocity.toml that was made before, for figures 5 and 6
    """
    unknown = [name for name in which if name not in SOURCES]
    if unknown:
        raise ValueError(f"there is no figure {unknown[0]!r}; there are: {', '.join(SOURCES)}")
    pyplot = need("matplotlib.pyplot", "matplotlib", "plot")
    drawn: dict[str, Any] = {}
    with plot.style():
        for name in which:
            if name in ("2", "3a", "3b"):
                drawn[name] = _of_scene(pyplot, scenes_folder() / SOURCES[name])
        velocities = {"5": (0.002,), "6": (0.006, 0.010)}
        wanted = [name for name in which if name in velocities]
        if wanted:
            found = result or fit(scenes_folder() / SOURCES["5"])
            drawn |= {name: _of_fit(pyplot, found, velocities[name]) for name in wanted}
    if out is not None:
        Path(out).mkdir(parents=True, exist_ok=True)
        for name, figure in drawn.items():
            figure.savefig(Path(out) / f"figure{name}.pdf")
    return drawn


def _of_scene(pyplot: Any, file: Path) -> Any:
    scene = load_scene(file)
    figure, ax = pyplot.subplots()
    spec = scene.charts[0]
    plot.chart(spec, run(scene, variants=list(spec.variants) or None), ax=ax)
    return figure


def _of_fit(pyplot: Any, result: FitResult, velocities: Sequence[float]) -> Any:
    width, height = plot.STYLE["figure.figsize"]
    figure, axes = pyplot.subplots(1, len(velocities), figsize=(width * len(velocities), height), squeeze=False)
    for ax, velocity in zip(axes[0], velocities, strict=True):
        plot.repetitions(result, velocity=velocity, ax=ax)
        ax.set_title(f"{1e3 * velocity:g} mm/s")
    return figure
