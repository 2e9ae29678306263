"""The charts of a report with matplotlib: what `glisson plot` and `glisson.plot.run` draw, and the looks of all figures.

Lines, their names and the marks of events are those of report.html, whose numbers are read from the page itself.
"""

from __future__ import annotations

import json
import os
import re
import unicodedata
from collections.abc import Callable, Iterable, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from ._fit_charts import fit_charts, read_fit
from ._frames import RunError
from ._optional import need

STYLE: dict[str, Any] = {
    "figure.figsize": (3.5, 2.6),  # a column of a journal [in]
    "figure.dpi": 200,
    "figure.constrained_layout.use": True,
    "font.size": 8,
    "font.sans-serif": ["Source Sans 3", "Helvetica Neue", "Arial", "DejaVu Sans"],
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.linewidth": 0.6,
    "axes.edgecolor": "#8f98a2",
    "axes.labelcolor": "#1a1f26",
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": "#ebedf0",
    "grid.linewidth": 0.6,
    "xtick.color": "#8f98a2",
    "ytick.color": "#8f98a2",
    "xtick.labelcolor": "#4a535e",
    "ytick.labelcolor": "#4a535e",
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "lines.linewidth": 1.2,
    "legend.frameon": False,
    "legend.handlelength": 2.6,
    "savefig.dpi": 300,
    "svg.fonttype": "none",  # letters stay letters
    "pdf.fonttype": 42,
}
#: Of lines, as in reports (web/src/charts/line_style.ts): told apart without colour, too.
COLOURS = ["#0068a8", "#cf5200", "#008a64", "#b4558f", "#a87400", "#3a8fc4", "#5c6670"]
DASHES: list[tuple[float, ...]] = [(), (5, 2.5), (1.3, 1.9), (6, 2, 1.3, 2), (3.2, 1.3), (9, 2.5), (5, 2, 1.3, 2, 1.3, 2)]
FORMATS = ("svg", "png", "pdf")
_NAMED_AT_ENDS = 5  # lines from which on names stand at their ends
_MOST_FOR_NAMES = 0.33  # of a figure's width
_MOST_MARKS = 24


def line_look(index: int) -> dict[str, Any]:
    """Colour and dashes of the n-th line of a chart."""
    dash = DASHES[(index + index // len(COLOURS)) % len(DASHES)]
    return {"color": COLOURS[index % len(COLOURS)], "linestyle": (0, dash) if dash else "-"}


def style() -> Any:
    """A context in which figures look as those of reports do."""
    matplotlib = need("matplotlib", "matplotlib", "plot")
    cycler = need("cycler", "matplotlib", "plot").cycler
    known = {key: value for key, value in STYLE.items() if key in matplotlib.rcParams}
    looks = [line_look(i) for i in range(7)]
    cycle = cycler("color", [x["color"] for x in looks]) + cycler("linestyle", [x["linestyle"] for x in looks])
    return matplotlib.rc_context(known | {"axes.prop_cycle": cycle})


def from_zero(ax: Any) -> None:
    """Ranges as in reports: from zero where that is near, without air before the first point."""
    for axis, share, air in (("x", 0.15, 0.0), ("y", 0.5, 0.06)):
        values = [np.asarray(line.get_data()[axis == "y"], dtype=float) for line in ax.lines]
        known = np.concatenate([v[np.isfinite(v)] for v in values]) if values else np.zeros(0)
        given = not getattr(ax, f"get_autoscale{axis}_on")()
        if known.size == 0 or given or getattr(ax, f"get_{axis}scale")() == "log":
            continue
        low, high = float(known.min()), float(known.max())
        reach = share * (high - low)
        low, high = (0.0 if 0 < low <= reach else low), (0.0 if 0 < -high <= reach else high)
        if high > low:
            room = air * (high - low)
            getattr(ax, f"set_{axis}lim")(low - room if low else low, high + room if high else high)


def name_lines(ax: Any) -> None:
    """A legend; many lines have their names at their ends, each as near to its line as the others allow, or, long ones, below."""
    lines = [line for line in ax.lines if not str(line.get_label()).startswith("_")]
    if len(lines) < _NAMED_AT_ENDS:
        if lines:
            ax.legend(fontsize="medium")
        return
    letters = max(len(str(line.get_label())) for line in lines)
    width, height = ax.figure.get_size_inches()
    if letters * 0.5 * float(STYLE["font.size"]) / 72 > _MOST_FOR_NAMES * width:
        _legend_below(ax.figure, lines)
        return
    ax.figure.canvas.draw()
    low, high = ax.get_ylim()
    ends = []
    for line in lines:
        x, y = (np.asarray(v, dtype=float) for v in line.get_data())
        known = np.flatnonzero(np.isfinite(x) & np.isfinite(y))
        if known.size:
            at = known[-1] if x[known[-1]] >= 0.6 * np.nanmax(x) else known[np.argmax(x[known])]
            ends.append((line, float(x[at]), float(y[at])))
    box = ax.get_window_extent()
    places = ax.transData.transform([end for _, *end in ends])
    letter = ax.figure.dpi / 72 * float(STYLE["font.size"]) * 1.15
    heights = spread(places[:, 1], letter, box.y0, box.y1)
    to_axes = ax.transAxes.inverted()
    for (line, *end), height in zip(ends, heights, strict=True):
        ax.annotate(
            line.get_label(),
            xy=end,
            xytext=(1.04, float(to_axes.transform((0, height))[1])),
            textcoords="axes fraction",
            color=line.get_color(),
            va="center",
            annotation_clip=False,
            arrowprops={"arrowstyle": "-", "color": line.get_color(), "linewidth": 0.5, "alpha": 0.5, "shrinkA": 0, "shrinkB": 0},
        )
    ax.set_ylim(low, high)


def _legend_below(figure: Any, lines: Sequence[Any]) -> None:
    """Names in rows below the axes; the figure grows by them."""
    width, height = figure.get_size_inches()
    room = (len(lines) * 1.45 + 0.8) * float(STYLE["font.size"]) / 72
    figure.set_size_inches(width, height + room)
    legend = figure.legend(handles=lines, loc="lower left", fontsize="medium", borderaxespad=0.2)
    legend.set_in_layout(False)
    engine = figure.get_layout_engine()
    if engine is not None:
        engine.set(rect=(0.0, room / (height + room), 1.0, height / (height + room)))


def spread(wanted: Any, step: float, low: float, high: float) -> Any:
    """Heights `step` apart at least, as near as possible to where they want to be.

    >>> [float(x) for x in spread([50, 50, 50], 10, 0, 100)]
    [40.0, 50.0, 60.0]
    """
    wanted = np.asarray(wanted, dtype=float)
    order = np.argsort(wanted, kind="stable")
    step = min(step, (high - low) / max(1, len(order) - 1))
    blocks: list[tuple[int, float]] = []  # neighbours that touch: how many, and their middle
    for value in wanted[order]:
        count, middle = 1, float(value)
        while True:
            half = 0.5 * (count - 1) * step
            middle = min(high - half, max(low + half, middle))
            if not blocks or blocks[-1][1] + 0.5 * (blocks[-1][0] - 1) * step + step <= middle - half + 1e-9:
                break
            before, at = blocks.pop()
            middle = (before * at + count * middle) / (before + count)
            count += before
        blocks.append((count, middle))
    placed = [middle + (k - 0.5 * (count - 1)) * step for count, middle in blocks for k in range(count)]
    heights = np.empty(len(order))
    heights[order] = placed
    return heights


def plot_run(
    out: str | os.PathLike[str],
    folder: str | os.PathLike[str] | None = None,
    *,
    formats: Sequence[str] = ("svg",),
    chart: str | None = None,
    variants: Sequence[str] | None = None,
    size_mm: tuple[float, float] = (88.0, 66.0),
) -> list[Path]:
    """Writes the charts of a report, one file each: NAME.svg, NAME.png, NAME.pdf.

    Of a fit, by fit.json: the measured and simulated curves of each group, and their residuals over the band of the noise.

    :param out: the folder of a run or a fit, or of `compare`, `converge`, `reproduce`; or the report.html or fit.json itself
    :param folder: where to write; none: `plots` in `out`
    :param formats: svg, png, pdf
    :param chart: only charts whose title contains this
    :param variants: only lines of these
    :param size_mm: width and height; 88 mm is a column of a journal
    :returns: the files written
    :raises ValueError: for what cannot be drawn, with the way out
    """
    unknown = [x for x in formats if x not in FORMATS]
    if unknown or not formats:
        raise RunError(f"format {unknown[0] if unknown else 'none'!r}; there are: {', '.join(FORMATS)}")
    if not all(10 <= float(x) <= 1000 for x in size_mm):
        raise RunError(f"size is {size_mm[0]:g}x{size_mm[1]:g} mm; each may be 10 to 1000 mm")
    file = _file_of(Path(out))
    where = Path(folder) if folder is not None else file.parent / "plots"
    charts = _all_charts(file, variants, size_mm)
    chosen = [c for c in charts if chart is None or chart.casefold() in c[1].casefold()]
    if not chosen:
        titles = ", ".join(repr(title) for _, title, _ in charts) or "none"
        raise RunError(f"there is no chart {chart!r} in {file}; there are: {titles}" if chart else f"{file} has no charts")
    where.mkdir(parents=True, exist_ok=True)
    written: list[Path] = []
    used: set[str] = set()
    for name, _, make in chosen:
        name = _file_name(name, used)
        figure = make()
        for form in dict.fromkeys(formats):
            written.append(where / f"{name}.{form}")
            with style():
                figure.savefig(written[-1])
    return written


def _file_of(out: Path) -> Path:
    """The fit.json of a fit's folder, the report.html of any other."""
    if not out.is_dir():
        return out
    return out / "fit.json" if (out / "fit.json").exists() else out / "report.html"


def _all_charts(
    file: Path, variants: Sequence[str] | None, size_mm: tuple[float, float]
) -> list[tuple[str, str, Callable[[], Any]]]:
    """What each chart is called as a file, its title, and what draws it."""
    report = {"scenes": [], "fits": [read_fit(file)]} if file.suffix == ".json" else read_report(file)
    _check_variants(report, variants)
    charts: list[tuple[str, str, Callable[[], Any]]] = []
    for scene in report["scenes"]:
        for spec in charts_of(scene):
            name = spec["title"] if len(report["scenes"]) == 1 else f"{scene['name']} {spec['title']}"
            charts.append((name, spec["title"], partial(draw_chart, scene, spec, variants, size_mm)))
    several = len(report["scenes"]) + len(report["fits"]) > 1
    for fit in report["fits"]:
        for title, draw in fit_charts(fit):
            charts.append((f"{fit.get('name', 'fit')} {title}" if several else title, title, partial(_figure_of, draw, size_mm)))
    return charts


def _figure_of(draw: Callable[[Any], Iterable[dict[str, Any]] | None], size_mm: tuple[float, float]) -> Any:
    """A figure of its own, in the looks of all, into whose axes `draw` draws; the marks that it returns lie on the lines."""
    figures = need("matplotlib.figure", "matplotlib", "plot")
    with style():
        figure = figures.Figure(figsize=(size_mm[0] / 25.4, size_mm[1] / 25.4))
        need("matplotlib.backends.backend_agg", "matplotlib", "plot").FigureCanvasAgg(figure)
        ax = figure.add_subplot()
        marks = draw(ax)
        from_zero(ax)
        name_lines(ax)
        _draw_marks(ax, marks or [])
    return figure


def read_report(file: Path) -> dict[str, Any]:
    """The data of a report's page."""
    try:
        page = file.read_text(encoding="utf-8")
    except OSError as error:
        raise RunError(f"{file}: cannot be read: {error.strerror}; give the folder that `glisson run … --out OUT` wrote") from error
    found = re.search(r'<script id="glisson-data" type="application/json">(.*?)</script>', page, re.DOTALL)
    try:
        report = json.loads(found[1]) if found else None
    except ValueError:
        report = None
    if not isinstance(report, dict) or report.get("format") != 1:
        raise RunError(f"{file}: not a report of Glisson in format 1")
    report.setdefault("scenes", [])
    report.setdefault("fits", [])
    return report


def _check_variants(report: dict[str, Any], variants: Sequence[str] | None) -> None:
    known = [v["name"] for scene in report["scenes"] for v in scene["variants"]]
    unknown = [v for v in variants or () if v not in known]
    if unknown:
        raise RunError(f"there is no variant {unknown[0]!r}; there are: {', '.join(known) or 'none'}")


def _file_name(title: str, used: set[str]) -> str:
    """A title as a file's name, another one for each."""
    plain = unicodedata.normalize("NFKD", title).encode("ascii", "ignore").decode()
    stem = re.sub(r"[^\w.-]+", "-", plain).strip("-").lower() or "chart"
    name, number = stem, 2
    while name in used:
        name, number = f"{stem}-{number}", number + 1
    used.add(name)
    return name


def charts_of(scene: dict[str, Any]) -> list[dict[str, Any]]:
    """The charts of a scene as its report shows them: a needle's first, maps left out."""
    own = [spec for spec in scene.get("charts", []) if not spec.get("map")]
    first_is_needle = any((v.get("instruments") or [{}])[0].get("kind") == "needle" for v in scene["variants"])
    if own and first_is_needle:
        own.sort(key=lambda spec: 2 if spec["y"]["column"] != "force_N" else int(spec["x"]["column"] != "depth_m"))
    further = {x["name"]: x["kind"] for v in scene["variants"] for x in v.get("instruments", []) if x.get("forces")}
    needles = [spec for name, kind in further.items() if kind == "needle" for spec in _default_charts(scene, name)]
    if own:
        return needles + own
    others = [spec for name, kind in further.items() if kind != "needle" for spec in _default_charts(scene, name)]
    return needles + _default_charts(scene, None) + others


def _default_charts(scene: dict[str, Any], instrument: str | None) -> list[dict[str, Any]]:
    tables = [t for t in (_table(v, instrument) for v in scene["variants"]) if t and _column(t, "force_N") is not None]
    if not tables:
        return []
    most = max(float(np.nanmax(np.abs(_column(t, "force_N")))) for t in tables)
    force = {"column": "force_N", "label": "force [mN]", "scale": 1e3} if most < 0.1 else {"column": "force_N", "label": "force [N]", "scale": 1}
    of = f" of {instrument}" if instrument else ""
    common = {"y": force, "variants": None, "instrument": instrument}
    return [
        {"title": f"Force{of} against depth", "x": {"column": "depth_m", "label": "depth [mm]", "scale": 1e3}, **common},
        {"title": f"Force{of} against time", "x": {"column": "time_s", "label": "time [s]", "scale": 1}, **common},
    ]


def _table(variant: dict[str, Any], instrument: str | None) -> dict[str, Any] | None:
    if instrument is None:
        return variant["forces"]  # type: ignore[no-any-return]
    return next((x["forces"] for x in variant.get("instruments", []) if x["name"] == instrument and x.get("forces")), None)


def _column(table: dict[str, Any], name: str) -> Any:
    """A column as numbers, null as NaN; None where the table has none or it is empty."""
    if name not in table["columns"]:
        return None
    values = table["data"][table["columns"].index(name)]
    return np.array([np.nan if x is None else x for x in values], dtype=float) if values else None


def draw_chart(
    scene: dict[str, Any], spec: dict[str, Any], variants: Sequence[str] | None = None, size_mm: tuple[float, float] = (88.0, 66.0)
) -> Any:
    """A chart as a figure of its own."""
    return _figure_of(lambda ax: _draw_spec(ax, scene, spec, variants), size_mm)


def _draw_spec(ax: Any, scene: dict[str, Any], spec: dict[str, Any], variants: Sequence[str] | None) -> list[dict[str, Any]]:
    """The lines and names of a chart; returns the events that belong on them."""
    marks = _draw_variants(ax, scene, spec, variants)
    for curve in spec.get("points") or []:
        ax.plot(curve["x"], curve["y"], "o", markersize=2.8, markerfacecolor="none", color="#1a1f26", label=curve["label"] or "measured")
    for curve in spec.get("fits") or []:
        ax.plot(curve["x"], curve["y"], color="#1a1f26", linestyle=(0, (4, 4)), linewidth=0.9, label=curve["label"])
    names = list(dict.fromkeys(c["label"] for other in scene.get("charts", []) for c in other.get("lines") or []))
    for curve in spec.get("lines") or []:
        ax.plot(curve["x"], curve["y"], label=curve["label"], **line_look(names.index(curve["label"])))
    if spec.get("log_x"):
        ax.set_xscale("log")
    if spec.get("log_y"):
        ax.set_yscale("log")
    ax.set_xlabel(_capital(spec["x"]["label"]))
    ax.set_ylabel(_capital(spec["y"]["label"]))
    return marks


def _draw_variants(ax: Any, scene: dict[str, Any], spec: dict[str, Any], variants: Sequence[str] | None) -> list[dict[str, Any]]:
    """A line a variant; returns the events that belong on them."""
    marks = []
    for index, variant in enumerate(scene["variants"]):
        if spec.get("variants") is not None and variant["name"] not in spec["variants"]:
            continue
        if variants and variant["name"] not in variants:
            continue
        table = _table(variant, spec.get("instrument"))
        if table is None:
            continue
        probes = variant.get("probes") or {"columns": [], "data": []}
        x, y = (_first(_column(table, a["column"]), _column(probes, a["column"])) for a in (spec["x"], spec["y"]))
        if x is None or y is None:
            continue
        x, y = x * spec["x"]["scale"], y * spec["y"]["scale"]
        look = line_look(index)
        ax.plot(x, y, label=variant.get("label") or variant["name"], **look)
        marks += _marks(variant, spec, _column(variant["forces"], "time_s"), x, y, look["color"])
    return marks


def _first(*found: Any) -> Any:
    return next((x for x in found if x is not None), None)


def _marks(variant: dict[str, Any], spec: dict[str, Any], times: Any, x: Any, y: Any, colour: str) -> list[dict[str, Any]]:
    """Where the events of the chart's instrument lie on the variant's line."""
    listed = variant.get("instruments") or []
    whose = spec.get("instrument") or (listed[0]["name"] if listed else None)
    events = [e for e in variant.get("events", []) if whose is None or e["instrument"] in ("", whose)]
    if times is None or len(events) > _MOST_MARKS or len(times) != len(x):
        return []
    at = [e["time_s"] for e in events]
    pairs = zip(events, np.interp(at, times, x), np.interp(at, times, y), strict=True)
    return [{"x": px, "y": py, "label": e["event"], "colour": colour} for e, px, py in pairs]


def _draw_marks(ax: Any, marks: Iterable[dict[str, Any]]) -> None:
    """Rings on the lines; those of one line alone have words."""
    marks = list(marks)
    alone = len({mark["colour"] for mark in marks}) == 1
    for mark in marks:
        ax.plot([mark["x"]], [mark["y"]], "o", markersize=3.2, markerfacecolor="white", markeredgewidth=0.9, color=mark["colour"], label="_")
        if alone:
            ax.annotate(mark["label"], (mark["x"], mark["y"]), xytext=(4, 4), textcoords="offset points", fontsize="small")


def _capital(text: str) -> str:
    return text[:1].upper() + text[1:]
