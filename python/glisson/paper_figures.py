"""The figures of Schwartz et al. 2002 that show forces, drawn from the shipped scenes."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from . import plot
from ._optional import need
from .fitting import FitResult, fit
from .running import run
from .scenes import load_scene, scenes_folder

#: Figures and what they are drawn from; 5 and 6 are one fit: five curves at 2 mm/s are fitted, all others are predicted.
SOURCES = {
    "2": "paper/figure2.toml",
    "3a": "paper/figure3a.toml",
    "3b": "paper/figure3b.toml",
    "5": "fit/liver_velocity.toml",
    "6": "fit/liver_velocity.toml",
}
#: The curves that the panels a and b of figures 5 and 6 show, by their table of the fit.
PANELS = {"5": ("2 mm/s", "2 mm/s, others"), "6": ("6 mm/s", "10 mm/s")}


def figures(
    names: str | Sequence[str] = tuple(SOURCES),
    out: str | os.PathLike[str] | None = None,
    result: FitResult | None = None,
    progress: Callable[[str], object] | None = print,
    state: str | os.PathLike[str] | None = None,
) -> dict[str, Any]:
    """Redraws the paper's figures 2, 3, 5 and 6: runs their scenes, and the fit of the last two.

    Figure 2 takes a second, figure 3 some ten, the fit of 5 and 6 many minutes: `names=["2", "3a", "3b"]` leaves it out. Its
    curves are simulated: the paper publishes no numbers of its measurements.

    :param names: of the figures: "2", "3a", "3b", "5", "6"
    :param out: folder for figure<name>.pdf, each written as soon as it is drawn
    :param result: of a fit of scenes/fit/liver_velocity.toml that was made before, for figures 5 and 6
    :param progress: called with a line when something is begun, how far it is and when it is done; None: quiet
    :param state: of the fit, as in fit(): a call that was interrupted goes on from there
    """
    which = [names] if isinstance(names, str) else list(names)
    unknown = [name for name in which if name not in SOURCES]
    if unknown:
        raise ValueError(f"there is no figure {unknown[0]!r}; there are: {', '.join(SOURCES)}")
    pyplot = need("matplotlib.pyplot", "matplotlib", "plot")
    tell: Callable[[str], object] = progress or (lambda _line: None)
    drawn: dict[str, Any] = {}

    def keep(name: str, figure: Any) -> None:
        drawn[name] = figure
        if out is not None:
            Path(out).mkdir(parents=True, exist_ok=True)
            figure.savefig(Path(out) / f"figure{name}.pdf")

    with plot.style():
        for name in (n for n in which if n not in PANELS):
            tell(f"figure {name}: running {SOURCES[name]}")
            keep(name, _of_scene(pyplot, scenes_folder() / SOURCES[name]))
        wanted = [name for name in which if name in PANELS]
        if wanted:
            found = result or fit(scenes_folder() / SOURCES["5"], progress=_fit_lines(tell, wanted), state=state)
            for name in wanted:
                keep(name, _of_fit(pyplot, found, PANELS[name]))
    return {name: drawn[name] for name in which}


def _fit_lines(tell: Callable[[str], object], wanted: Sequence[str]) -> Callable[[str, int, int, float], None]:
    """Progress lines of the fit, one for each tenth of a stage."""
    told: set[tuple[str, int]] = set()
    start = time.monotonic()

    def line(stage: str, done: int, planned: int, best: float) -> None:
        step = (stage, 10 * done // max(planned, 1))
        if step in told:
            return
        told.add(step)
        rms = f", rms {best:.3g} N so far" if best > 0 else ""
        tell(f"figure {', '.join(wanted)}: fit, {stage} {done} of {planned}{rms}, {time.monotonic() - start:.0f} s")

    return line


def _of_scene(pyplot: Any, file: Path) -> Any:
    scene = load_scene(file)
    figure, ax = pyplot.subplots()
    spec = scene.charts[0]
    plot.chart(spec, run(scene, variants=list(spec.variants) or None), ax=ax)
    return figure


def _of_fit(pyplot: Any, result: FitResult, groups: Sequence[str]) -> Any:
    width, height = plot.STYLE["figure.figsize"]
    figure, axes = pyplot.subplots(1, len(groups), figsize=(width * len(groups), height), squeeze=False)
    for ax, group in zip(axes[0], groups, strict=True):
        plot.repetitions(result, group=group, ax=ax)
        ax.set_title(group)
    return figure
