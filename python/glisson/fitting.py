"""Fits of tissues to measured curves, with their results as arrays."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from ._core import Tissue
from .scenes import to_toml
from .tissues import tissue_from

Array = npt.NDArray[np.float64]
Interval = tuple[float | None, float | None]


@dataclass(frozen=True)
class Parameter:
    """A fitted parameter. Ends of intervals that the curves do not determine are None."""

    name: str
    unit: str
    value: float
    sd: float | None
    ci95: Interval | None  #: of the mean over specimens, with three curves or more
    further95: Interval | None  #: of a further specimen's own value; None: too few curves
    verdict: str  #: identified, negligible, weak, not identifiable, at bound, read off
    words: str


@dataclass(frozen=True)
class Curve:
    """A measured curve and the force of the fitted tissue at its times."""

    name: str
    group: str
    velocity: float | None  #: [m/s]
    held_out: bool
    time: Array  #: [s]
    displacement: Array  #: [m]
    measured: Array  #: [N]
    fitted: Array  #: [N]; NaN where the simulation failed
    further_low: Array  #: between these a further specimen's force lies in 95 % [N]; empty: not known
    further_high: Array
    rms: float | None  #: of fitted − measured [N]


class FitResult:
    """Result of a fit; `to_dict()` is fit.json."""

    def __init__(self, text: str, tissue: str) -> None:
        self.json = text  #: the text of fit.json
        self.tissue_toml = tissue  #: the text of tissue.toml
        self._data: dict[str, Any] = json.loads(text)

    def to_dict(self) -> dict[str, Any]:
        """The object of fit.json."""
        result: dict[str, Any] = json.loads(self.json)
        return result

    @property
    def parameters(self) -> dict[str, Parameter]:
        """By name."""
        rows = self._data["parameters"]
        kept = ("name", "unit", "value", "sd", "verdict", "words")
        return {
            r["name"]: Parameter(
                **{k: r[k] for k in kept}, ci95=_interval(r["ci95"]), further95=_interval(r["further95"])
            )
            for r in rows
        }

    @property
    def values(self) -> dict[str, float]:
        """Of the parameters, by name."""
        return {name: parameter.value for name, parameter in self.parameters.items()}

    @property
    def curves(self) -> list[Curve]:
        """Measured and fitted."""
        return [_curve(row) for row in self._data["curves"]]

    @property
    def conclusions(self) -> list[str]:
        """What the curves determine and what they do not, in sentences."""
        return list(self._data.get("conclusions", []))

    @property
    def tissue(self) -> Tissue:
        """The fitted tissue."""
        return tissue_from(self.tissue_toml)

    def write(self, folder: str | os.PathLike[str]) -> None:
        """Writes fit.json and tissue.toml, as `glisson fit` does."""
        place = Path(folder)
        place.mkdir(parents=True, exist_ok=True)
        (place / "fit.json").write_text(self.json, encoding="utf-8")
        (place / "tissue.toml").write_text(self.tissue_toml, encoding="utf-8")

    def __repr__(self) -> str:
        return "<FitResult " + ", ".join(f"{p.name} = {p.value:.5g} {p.unit}" for p in self.parameters.values()) + ">"


def fit(
    description: str | os.PathLike[str] | Mapping[str, Any],
    *,
    laws: Sequence[str] = (),
    data: str | os.PathLike[str] | None = None,
    base: str | os.PathLike[str] = ".",
    starts: int | None = None,
    bootstrap: int | None = None,
    progress: Callable[[str, int, int, float], object] | None = None,
    state: str | os.PathLike[str] | None = None,
) -> FitResult:
    """Fits a tissue to measured curves, with uncertainties.

    Ctrl-C, or an exception in `progress`, ends it. With `state` the same call resumes from there; fit.state.json in the folder
    of `glisson fit --out` is such a file.

    :param description: a FIT.toml, its text (with a line end), or a dict of its keys
    :param laws: laws to fit in addition to those of the description (known_laws)
    :param data: folder of the curves' files; none: that of the description
    :param base: folder that a text or dict stands for
    :param starts: largest number of descents, in place of the description's
    :param bootstrap: fits to curves drawn again, in place of the description's
    :param progress: called with stage, done, planned and the best rms so far [N]
    :param state: file that keeps what is known while the fit runs; gone when it is complete. Of another fit it is begun anew
    :raises SceneError: with every problem of the description
    :raises ValueError: naming a state that is not as it was written; delete it
    """
    from . import _fit

    if isinstance(description, Mapping):
        spec = _fit.parse_fit(to_toml(description), "fit", Path(base))
    elif isinstance(description, str) and "\n" in description:
        spec = _fit.parse_fit(description, "fit", Path(base))
    else:
        spec = _fit.load_fit(Path(description))
    folder = "" if data is None else os.fspath(data)
    kept = "" if state is None else os.fspath(state)
    return FitResult(*_fit.run(spec, list(laws), folder, starts, bootstrap, progress, kept))


def known_laws() -> dict[str, str]:
    """Laws that a fit can compare, by name.

    >>> sorted(known_laws())[:2]
    ['constant', 'exponential']
    """
    from . import _fit

    return dict(_fit.known_laws())


def _interval(ends: Sequence[float | None] | None) -> Interval | None:
    return (ends[0], ends[1]) if ends else None


def _curve(row: Mapping[str, Any]) -> Curve:
    def numbers(key: str) -> Array:
        return np.array([np.nan if x is None else x for x in row[key]], dtype=float)

    return Curve(
        name=row["name"],
        group=row["group"],
        velocity=row["velocity_m_s"],
        held_out=row["held_out"],
        time=numbers("time_s"),
        displacement=numbers("displacement_m"),
        measured=numbers("measured_N"),
        fitted=numbers("fitted_N"),
        further_low=numbers("further_low_N"),
        further_high=numbers("further_high_N"),
        rms=row["rms_N"],
    )
