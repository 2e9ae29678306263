"""Fits of tissues to measured curves, with their results as arrays."""

from __future__ import annotations

import json
import os
import tempfile
import tomllib
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
    further_batch95: Interval | None  #: of a further batch's optimum; None: no three batches are named
    verdict: str  #: identified, negligible, weak, not identifiable, at bound, read off
    words: str


@dataclass(frozen=True)
class Curve:
    """A measured curve and what the fitted tissue answers at its points.

    A press has displacements [m] and forces [N]. Other tests have what `test` drives and measures, in SI: of a point strains and
    stresses, of a torsion angles and torques, of an oscillation frequencies and moduli.
    """

    name: str
    group: str
    test: str  #: as in FIT.toml: compression, tension, relaxation …
    velocity: float | None  #: [m/s]
    held_out: bool
    time: Array  #: [s]; empty where the test has none
    displacement: Array  #: what was driven, in `drive_unit`
    measured: Array  #: in `unit`
    fitted: Array  #: in `unit`; NaN where the simulation failed
    further_low: Array  #: between these a further specimen lies in 95 %; empty: not known
    further_high: Array
    rms: float | None  #: of fitted − measured, in `unit`
    drive_unit: str = "m"
    unit: str = "N"


@dataclass(frozen=True)
class TestFit:
    """How well a fit meets one of several tests."""

    name: str
    test: str
    r2: float | None  #: 1 − Σ (fitted − measured)² / Σ (measured − mean)²
    rms: float | None  #: in `unit`
    unit: str
    points: int
    held_out: bool
    r2_of_alone: dict[str, float | None]  #: by fits to one test alone, by its name; empty: there is one kind of test


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
                **{k: r[k] for k in kept},
                ci95=_interval(r["ci95"]),
                further95=_interval(r["further95"]),
                further_batch95=_interval(r["further_batch95"]),
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
    def tests(self) -> list[TestFit]:
        """Of each test how well the fit meets it."""
        return [TestFit(**row) for row in self._data["tests"]]

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
    discover: int = 0,
) -> FitResult:
    """Fits a tissue to measured curves, with uncertainties.

    Ctrl-C, or an exception in `progress`, ends it. With `state` the same call resumes from there; fit.state.json in the folder
    of `glisson fit --out` is such a file.

    Workbooks (.xlsx) among the files are read where one of their sheets holds numbers; `python -m glisson.workbook` writes
    others as .csv.

    :param description: a FIT.toml, its text (with a line end), or a dict of its keys, whose `files` may be data frames
    :param laws: laws to fit in addition to those of the description (known_laws)
    :param data: folder of the curves' files; none: that of the description
    :param base: folder that a text or dict stands for
    :param starts: largest number of descents, in place of the description's
    :param bootstrap: fits to curves drawn again, in place of the description's
    :param progress: called with stage, done, planned and the best rms so far [N]
    :param state: file that keeps what is known while the fit runs; gone when it is complete. Of another fit it is begun anew
    :param discover: looks for a law of at most so many terms among all subsets of a library, 1 to 4; 0: does not
    :raises SceneError: with every problem of the description
    :raises ValueError: naming a state that is not as it was written; delete it
    """
    from . import _fit

    folder = "" if data is None else os.fspath(data)
    kept = "" if state is None else os.fspath(state)
    with tempfile.TemporaryDirectory(prefix="glisson_") as frames:
        keys, place = _keys_of(description, Path(base))
        if keys is not None:
            files = _with_files(keys, Path(frames), Path(data) if data is not None else place)
            spec = _fit.parse_fit(to_toml(files), "fit", place)
        elif isinstance(description, str) and "\n" in description:
            spec = _fit.parse_fit(description, "fit", Path(base))
        else:
            assert not isinstance(description, Mapping)
            spec = _fit.load_fit(Path(description))
        return FitResult(*_fit.run(spec, list(laws), folder, starts, bootstrap, progress, kept, discover))


def known_laws() -> dict[str, str]:
    """Laws that a fit can compare, by name.

    >>> sorted(known_laws())[:2]
    ['constant', 'exponential']
    """
    from . import _fit

    return dict(_fit.known_laws())


def _is_workbook(file: Any) -> bool:
    return isinstance(file, str | os.PathLike) and Path(os.fspath(file)).suffix.lower() in (".xlsx", ".xlsm")


def _keys_of(
    description: str | os.PathLike[str] | Mapping[str, Any], base: Path
) -> tuple[Mapping[str, Any] | None, Path]:
    """The keys of a description whose files have to be written anew, and the folder it stands in; none of another."""
    if isinstance(description, Mapping):
        return description, base
    name = os.fspath(description)
    is_text = "\n" in name
    place = base if is_text else Path(name).parent
    try:
        text = name if is_text else Path(name).read_text(encoding="utf-8")
        keys = tomllib.loads(text)
        found = any(_is_workbook(file) for one in keys.get("data", []) for file in one.get("files", []))
    except (OSError, ValueError, AttributeError, TypeError):  # the reader of descriptions says what is wrong
        return None, place
    return (keys if found else None), place


def _with_files(description: Mapping[str, Any], folder: Path, base: Path) -> dict[str, Any]:
    """The same description with text in place of data frames and workbooks."""

    def file_of(number: int, place: int, file: Any) -> Any:
        if _is_workbook(file):
            from . import workbook  # here, so that `python -m glisson.workbook` is not imported twice

            own = folder / f"{number + 1}_{place + 1}"
            own.mkdir()
            return str(workbook.to_csv(base / file, own / Path(file).with_suffix(".csv").name))
        if not hasattr(file, "to_csv"):
            return file
        written = folder / f"frame_{number + 1}_{place + 1}.csv"
        file.to_csv(written, index=False)
        return str(written)

    data = [
        {**one, "files": [file_of(n, i, f) for i, f in enumerate(one.get("files", []))]}
        for n, one in enumerate(description.get("data", []))
    ]
    return {**description, **({"data": data} if data else {})}


def _interval(ends: Sequence[float | None] | None) -> Interval | None:
    return (ends[0], ends[1]) if ends else None


def _curve(row: Mapping[str, Any]) -> Curve:
    newtons = "_N" if "measured_N" in row else ""

    def numbers(key: str) -> Array:
        return np.array([np.nan if x is None else x for x in row[key]], dtype=float)

    return Curve(
        name=row["name"],
        group=row["group"],
        test=row["test"],
        velocity=row["velocity_m_s"],
        held_out=row["held_out"],
        time=numbers("time_s"),
        displacement=numbers("displacement_m" if newtons else "drive"),
        measured=numbers("measured" + newtons),
        fitted=numbers("fitted" + newtons),
        further_low=numbers("further_low" + newtons),
        further_high=numbers("further_high" + newtons),
        rms=row["rms" + newtons],
        drive_unit=row["drive_unit"],
        unit=row["unit"],
    )
