"""Pictures of a run for a paper: the body at one instant, coloured by a field, cut open, with its tools; no display needed.

`glisson picture` runs these files, which travel inside it: program and package draw the same.
"""

from __future__ import annotations

import os
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ._frames import Frame, RunError, read_frame, variants_of
from ._raster import rasterise


@dataclass(frozen=True)
class _Field:
    array: str
    of_cells: bool
    label: str
    units: tuple[tuple[str, float, float], ...]  # unit, factor, up to which size


_PASCALS = (("Pa", 1.0, 2e3), ("kPa", 1e-3, 2e6), ("MPa", 1e-6, np.inf))
_PLAIN = (("–", 1.0, np.inf),)
#: What a body can be coloured by.
COLOURS = {
    "displacement": _Field("displacement_m", False, "displacement", (("µm", 1e6, 1e-4), ("mm", 1e3, np.inf))),
    "von_mises": _Field("von_mises_Pa", True, "von Mises stress", _PASCALS),
    "pressure": _Field("pressure_Pa", True, "pressure", _PASCALS),
    "contact_pressure": _Field("contact_pressure_Pa", False, "contact pressure", _PASCALS),
    "s": _Field("s", True, "equivalent shear strain s", _PLAIN),
    "q": _Field("q", True, "shape measure q", _PLAIN),
    "jacobian": _Field("jacobian", True, "volume ratio det F", _PLAIN),
    "temperature": _Field("temperature_C", False, "temperature", (("°C", 1.0, np.inf),)),
    "coldest": _Field("coldest_C", False, "coldest temperature so far", (("°C", 1.0, np.inf),)),
    "frozen": _Field("frozen", False, "share that is frozen", _PLAIN),
    "dead": _Field("dead", False, "tissue that has died", _PLAIN),
}
_TISSUE = ("tissue", "none")
# The scale of reports and live view: equal steps look equal, and lightness rises all the way (web/src/mesh3d/colour_table.ts).
_TABLE = (
    "511d84 4f268e 4c2f97 47389f 4241a7 3a4aae 3052b4 215bb9 1964b6 1c6bb0 1e73ac 207aaa 2382a9 258aa9 2892aa 2a9aaa 2da2aa "
    "2faaaa 32b2a8 34b9a6 36c1a3 38c89e 3ace97 40d48f 5dd888 75dc80 8be079 9fe372 b3e56c c5e766 d7e962 e9eb5f faed5f"
).split()
_REGIONS = np.array([(0.66, 0.36, 0.32), (0.93, 0.86, 0.66), (0.36, 0.48, 0.72), (0.80, 0.45, 0.50), (0.55, 0.66, 0.42)])
_METAL = np.array((0.62, 0.66, 0.70))
_EYE = np.array((0.66, -1.0, 0.62))  # whence reports look
_FINER = 2  # pixels of the drawing in one of the picture, each way
_CREASE = np.cos(np.radians(40.0))


def picture(
    out: str | os.PathLike[str],
    *,
    frame: int = -1,
    variant: str | None = None,
    colour: str = "displacement",
    cut: str | None = None,
    flip: bool = False,
    size: tuple[int, int] = (1600, 1200),
    range: tuple[float, float] | None = None,  # noqa: A002: the word of the program's option
    exaggerate: float = 1.0,
    eye: Sequence[float] = tuple(_EYE),
    tools: bool = True,
    labels: bool = True,
    file: str | os.PathLike[str] | None = None,
) -> Any:
    """A frame of a run as a picture, in parallel projection.

    :param out: the folder that `glisson run` wrote
    :param frame: its number, from 0; −1 is the last
    :param variant: its name; none: the first
    :param colour: displacement, von_mises, pressure, contact_pressure, s, q, jacobian, or tissue; of a run of heat
        temperature, which is its default, coldest, frozen or dead
    :param cut: opens the body: "x=0", "y=20mm", "z = 0.03" [m]; the field is shown on the face
    :param flip: takes the other side away
    :param size: of the picture [pixels]
    :param range: ends of the colour scale [SI]; none: those of what is seen
    :param exaggerate: factor of the displacement
    :param eye: direction from the body to the eye
    :param labels: whether scale, length and time are written
    :param file: where to write it: .png, .svg, .pdf, …
    :returns: the matplotlib figure
    :raises ValueError: for what cannot be drawn, with the way out

    Tets that were removed stay in the frames, and are left out of the picture.
    """
    width, height = _checked_size(size)
    folder = Path(out)
    name = _variant(folder, variant)
    body = read_frame(folder, name, frame)
    field = _field(colour, body, name)
    drawn = _scene(body, field, _plane(cut, flip), exaggerate, tools)
    scale = _scale(drawn, range)
    view = _View(drawn, np.asarray(eye, dtype=float), width, height, 0.17 if labels and field else 0.0)
    image = _shaded(drawn, view, scale)
    figure = _figure(image, width, height)
    if labels:
        _write_labels(figure, field, scale, view, f"{folder.name} · {name} · {_number(body.time)} s")
    if file is not None:
        figure.savefig(file, dpi=figure.dpi)
    return figure


def _checked_size(size: tuple[int, int]) -> tuple[int, int]:
    width, height = (int(x) for x in size)
    if not (64 <= width <= 8192 and 64 <= height <= 8192):
        raise RunError(f"size is {width}x{height}; each may be 64 to 8192 pixels")
    return width, height


def _variant(folder: Path, variant: str | None) -> str:
    names = variants_of(folder)
    if variant is not None and variant not in names:
        raise RunError(f"there is no variant {variant!r} with frames in {folder}; there are: {', '.join(names)}")
    return variant or names[0]


def _field(colour: str, body: Frame, variant: str) -> _Field | None:
    if colour in _TISSUE:
        return None
    if colour not in COLOURS:
        raise RunError(f"colour is {colour!r}; there are: {', '.join((*COLOURS, 'tissue'))}")
    if colour == "displacement" and "temperature_C" in body.points:
        colour = "temperature"  # of a run of heat, which does not move
    field = COLOURS[colour]
    if field.array not in (body.cells if field.of_cells else body.points):
        why = "it is written where an instrument or a container touches the body" if colour == "contact_pressure" else ""
        raise RunError(f"the frames of {variant} have no {field.array}{': ' + why if why else ''}")
    return field


def _plane(cut: str | None, flip: bool) -> tuple[Any, float] | None:
    """Normal into what stays, and its distance from the origin [m]. As in reports the side towards the eye is taken away."""
    if cut is None:
        return None
    match = re.fullmatch(r"\s*([xyz])\s*=\s*([-+]?[\d.]+(?:[eE][-+]?\d+)?)\s*(mm|m|)\s*", cut)
    if not match:
        raise RunError(f"cut is {cut!r}; write x=0, y=20mm or z=0.03, in metres where no unit stands")
    try:
        at = float(match[2]) * (1e-3 if match[3] == "mm" else 1.0)
    except ValueError:
        raise RunError(f"cut is {cut!r}; {match[2]!r} is no number") from None
    normal = {"x": (-1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, -1.0)}[match[1]]
    kept = np.array(normal) * (-1.0 if flip else 1.0)
    return kept, at * float(kept.sum())


@dataclass
class _Drawn:
    """Triangles with what they show: corners (n, 3, 3), normals (n, 3, 3), values (n, 3), and what each is."""

    corners: Any
    normals: Any
    values: Any
    kind: Any  # 0 skin, 1 the face of a cut, 2 a tool
    region: Any

    def __add__(self, other: _Drawn) -> _Drawn:
        return _Drawn(*(np.concatenate([getattr(self, n), getattr(other, n)]) for n in self.__dataclass_fields__))


def _scene(body: Frame, field: _Field | None, plane: tuple[Any, float] | None, exaggerate: float, tools: bool) -> _Drawn:
    places = body.rest + exaggerate * body.points.get("displacement_m", np.zeros_like(body.rest))
    values = _at_vertices(body, field)
    regions = body.cells.get("region", np.zeros(len(body.tets))).astype(int)
    triangles, owner = _surface(body.tets)
    corners = places[triangles]
    skin = np.zeros(len(triangles), int)
    drawn = _Drawn(corners, _normals(corners, triangles), values[triangles], skin, regions[owner])
    if plane is not None:
        drawn = _clipped(drawn, plane) + _section(places, values, body.tets, regions, plane)
        if not len(drawn.corners):
            raise RunError("cut: nothing of the body is left on that side of the plane")
    if tools:
        for points, faces in body.tools.values():
            drawn = drawn + _tool(points, faces, drawn)
    return drawn


def _at_vertices(body: Frame, field: _Field | None) -> Any:
    """The field at each vertex: of tets the mean over those around it, by their volume."""
    count = len(body.rest)
    if field is None:
        return np.zeros(count)
    if not field.of_cells:
        values = body.points[field.array].astype(float)
        return np.linalg.norm(values, axis=1) if values.ndim == 2 else values
    a, b, c, d = (body.rest[body.tets[:, k]] for k in range(4))
    volume = np.abs(np.einsum("ij,ij->i", b - a, np.cross(c - a, d - a)))
    of_tets = body.cells[field.array].astype(float)
    sums, weights = np.zeros(count), np.zeros(count)
    for k in range(4):
        np.add.at(sums, body.tets[:, k], volume * of_tets)
        np.add.at(weights, body.tets[:, k], volume)
    return sums / np.maximum(weights, 1e-300)


def _surface(tets: Any) -> tuple[Any, Any]:
    """Faces that one tet alone has, outward, and which tet each is of."""
    faces = np.concatenate([tets[:, order] for order in ([1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1])])
    owner = np.tile(np.arange(len(tets)), 4)
    keys = np.sort(faces, axis=1)
    _, first, counts = np.unique(keys, axis=0, return_index=True, return_counts=True)
    alone = np.sort(first[counts == 1])
    return faces[alone], owner[alone]


def _unit(vectors: Any) -> Any:
    return vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), 1e-300)


def _normals(corners: Any, triangles: Any) -> Any:
    """At each corner the mean over the triangles around it, where that is no crease; else the triangle's own."""
    own = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    total = np.zeros((int(triangles.max(initial=-1)) + 1, 3))
    for k in range(3):
        np.add.at(total, triangles[:, k], own)
    own = np.repeat(_unit(own)[:, None], 3, axis=1)
    mean = _unit(total)[triangles]
    smooth = np.einsum("ijk,ijk->ij", own, mean) > _CREASE
    return np.where(smooth[..., None], mean, own)


def _clipped(drawn: _Drawn, plane: tuple[Any, float]) -> _Drawn:
    """What lies in front of the plane; triangles that it crosses are cut there."""
    normal, at = plane
    heights = drawn.corners @ normal - at
    inside = heights >= 0
    count = inside.sum(axis=1)
    parts = [_taken(drawn, count == 3)]
    for wanted in (1, 2):
        chosen = np.flatnonzero(count == wanted)
        odd = np.argmax(inside[chosen] if wanted == 1 else ~inside[chosen], axis=1)
        order = (odd[:, None] + np.arange(3)) % 3  # the corner that stands alone first
        rows = chosen[:, None]
        h = heights[rows, order]
        rolled = [getattr(drawn, name)[rows, order] for name in ("corners", "normals", "values")]

        def along(values: Any, k: int, h: Any = h) -> Any:
            share = h[:, 0] / (h[:, 0] - h[:, k])
            share = share.reshape((-1,) + (1,) * (values.ndim - 2))
            return values[:, 0] + share * (values[:, k] - values[:, 0])

        def piece(*make: Any, rolled: Any = rolled, chosen: Any = chosen) -> _Drawn:
            made = [np.stack([corner(v) for corner in make], axis=1) for v in rolled]
            return _Drawn(made[0], made[1], made[2], drawn.kind[chosen], drawn.region[chosen])

        if wanted == 1:
            parts.append(piece(lambda v: v[:, 0], lambda v: along(v, 1), lambda v: along(v, 2)))
        else:
            parts.append(piece(lambda v: along(v, 1), lambda v: v[:, 1], lambda v: v[:, 2]))
            parts.append(piece(lambda v: along(v, 1), lambda v: v[:, 2], lambda v: along(v, 2)))
    total = parts[0]
    for part in parts[1:]:
        total = total + part
    return total


def _taken(drawn: _Drawn, chosen: Any) -> _Drawn:
    return _Drawn(*(getattr(drawn, name)[chosen] for name in drawn.__dataclass_fields__))


def _section(places: Any, values: Any, tets: Any, regions: Any, plane: tuple[Any, float]) -> _Drawn:
    """Where the plane meets the tets, with the field on it."""
    normal, at = plane
    heights = (places @ normal - at)[tets]
    above = heights >= 0
    count = above.sum(axis=1)
    corners, at_corners, of = [], [], []

    def add(chosen: Any, edges: Any) -> None:
        """Triangles of `chosen` tets, whose corners lie on these edges: pairs of (n,) local corners."""
        rows = np.arange(len(chosen))
        points, numbers = [], []
        for a, b in edges:
            ha, hb = heights[chosen][rows, a], heights[chosen][rows, b]
            share = ha / (ha - hb)
            va, vb = tets[chosen][rows, a], tets[chosen][rows, b]
            points.append(places[va] + share[:, None] * (places[vb] - places[va]))
            numbers.append(values[va] + share * (values[vb] - values[va]))
        corners.append(np.stack(points, axis=1))
        at_corners.append(np.stack(numbers, axis=1))
        of.append(regions[chosen])

    for wanted in (1, 3):
        chosen = np.flatnonzero(count == wanted)
        odd = np.argmax(above[chosen] if wanted == 1 else ~above[chosen], axis=1)
        add(chosen, [(odd, (odd + k) % 4) for k in (1, 2, 3)])
    chosen = np.flatnonzero(count == 2)
    order = np.argsort(~above[chosen], axis=1, kind="stable")
    a, b, c, d = (order[:, k] for k in range(4))
    add(chosen, [(a, c), (a, d), (b, d)])
    add(chosen, [(a, c), (b, d), (b, c)])
    triangles = np.concatenate(corners)
    normals = np.broadcast_to(-normal, triangles.shape)
    numbers = np.concatenate(at_corners)
    return _Drawn(triangles, normals, numbers, np.ones(len(triangles), int), np.concatenate(of))


def _tool(points: Any, faces: Any, body: _Drawn) -> _Drawn:
    """A tool's surface, as far as it is near the body: a plate without end would make the body a dot."""
    low, high = body.corners.reshape(-1, 3).min(axis=0), body.corners.reshape(-1, 3).max(axis=0)
    room = 0.5 * float(np.linalg.norm(high - low))
    corners = np.clip(points, low - room, high + room)[faces]
    return _Drawn(
        corners, _normals(corners, faces), np.zeros(corners.shape[:2]), np.full(len(faces), 2), np.zeros(len(faces), int)
    )


def _scale(drawn: _Drawn, range_: tuple[float, float] | None) -> tuple[float, float]:
    if range_ is not None:
        low, high = (float(x) for x in range_)
        if not low < high:
            raise RunError(f"range is {low:g} to {high:g}; the second has to be larger")
        return low, high
    seen = drawn.values[drawn.kind < 2]
    seen = seen[np.isfinite(seen)]
    low, high = (float(seen.min()), float(seen.max())) if seen.size else (0.0, 1.0)
    if 0 < low < 0.5 * high:
        low = 0.0
    return (low, high) if high > low else (low, low + 1.0)


class _View:
    """Parallel projection: all of the body and what of the tools is near it, in the middle of the picture."""

    def __init__(self, drawn: _Drawn, eye: Any, width: int, height: int, room: float) -> None:
        if not np.linalg.norm(eye) > 0:
            raise RunError("eye is 0, 0, 0; give the direction from the body to the eye, as 0.66,-1,0.62")
        self.width, self.height = width, height
        self.back = _unit(eye)
        up = np.array((0.0, 0.0, 1.0)) if abs(self.back[2]) < 0.999 else np.array((0.0, 1.0, 0.0))
        self.right = _unit(np.cross(up, self.back))
        self.up = np.cross(self.back, self.right)
        body = drawn.corners[drawn.kind < 2].reshape(-1, 3)
        across, along = body @ self.right, body @ self.up
        free = width * (1.0 - room)
        self.per_metre = 0.86 * min(free / max(np.ptp(across), 1e-12), height / max(np.ptp(along), 1e-12))
        self.middle = ((across.max() + across.min()) / 2, (along.max() + along.min()) / 2)
        self.centre = (free / 2, height / 2)

    def pixels(self, points: Any, finer: int) -> Any:
        """x to the right, y down, depth away from the eye [pixels of the finer drawing]."""
        x = (points @ self.right - self.middle[0]) * self.per_metre + self.centre[0]
        y = (self.middle[1] - points @ self.up) * self.per_metre + self.centre[1]
        return np.stack([x * finer, y * finer, -(points @ self.back) * self.per_metre * finer], axis=-1)


def _colours(values: Any, scale: tuple[float, float]) -> Any:
    table = np.array([[int(c[k : k + 2], 16) for k in (0, 2, 4)] for c in _TABLE]) / 255.0
    share = np.clip((values - scale[0]) / (scale[1] - scale[0]), 0.0, 1.0) * (len(table) - 1)
    share = np.where(np.isfinite(share), share, 0.0)
    return np.stack([np.interp(share, np.arange(len(table)), table[:, k]) for k in range(3)], axis=-1)


def _shaded(drawn: _Drawn, view: _View, scale: tuple[float, float]) -> Any:
    """The picture, (h, w, 4) in 0 … 1: light from the eye and a little from the left, thin lines where things end."""
    tissue = not np.any(drawn.values)
    seen = rasterise(view.pixels(drawn.corners, _FINER), view.width * _FINER, view.height * _FINER)
    hit = seen.triangle >= 0
    triangle, weights = seen.triangle[hit], seen.weights[hit]
    kind, region = drawn.kind[triangle], drawn.region[triangle]
    normal = _unit(np.einsum("ik,ikj->ij", weights, drawn.normals[triangle]))
    light = _unit(view.back - 0.35 * view.right + 0.45 * view.up)
    facing = np.abs(normal @ view.back)
    shade = 0.62 + 0.26 * np.clip(normal @ light * np.sign(normal @ view.back), 0, 1) + 0.14 * facing
    colour = _colours(np.einsum("ik,ik->i", weights, drawn.values[triangle]), scale)
    if tissue:
        colour = _REGIONS[region % len(_REGIONS)]
    colour = np.where((kind == 2)[:, None], _METAL, colour)
    shade = np.where(kind == 1, 1.0, shade)[:, None]
    image = np.zeros((*hit.shape, 4))
    image[hit, :3] = np.clip(colour * shade, 0, 1)
    image[hit, 3] = 1.0
    _draw_lines(image, seen, drawn)
    return _averaged(image)


def _draw_lines(image: Any, seen: Any, drawn: _Drawn) -> None:
    """Dark where one thing ends before another: outlines, and borders of regions on a face."""
    kind = drawn.kind[seen.triangle]
    on_face = np.where(kind == 1, drawn.region[seen.triangle], 0)
    what = np.where(seen.triangle >= 0, kind + 8 * on_face, -1)
    border = np.zeros(what.shape, bool)
    border[:, 1:] |= what[:, 1:] != what[:, :-1]
    border[1:] |= what[1:] != what[:-1]
    border &= seen.triangle >= 0
    image[border, :3] *= 0.35


def _averaged(image: Any) -> Any:
    """Finer pixels into those of the picture, colours by what is covered."""
    h, w = image.shape[0] // _FINER, image.shape[1] // _FINER
    blocks = image.reshape(h, _FINER, w, _FINER, 4)
    alpha = blocks[..., 3:].mean(axis=(1, 3))
    colour = (blocks[..., :3] * blocks[..., 3:]).mean(axis=(1, 3)) / np.maximum(alpha, 1e-9)
    return np.concatenate([colour, alpha], axis=-1)


def _figure(image: Any, width: int, height: int) -> Any:
    from ._optional import need

    figure = need("matplotlib.figure", "matplotlib", "plot").Figure(figsize=(width / 200, height / 200), dpi=200, facecolor="white")
    axes = figure.add_axes((0, 0, 1, 1))
    axes.imshow(image, extent=(0, width, height, 0), aspect="auto", interpolation="none")
    axes.set(xlim=(0, width), ylim=(height, 0))
    axes.axis("off")
    return figure


def _write_labels(figure: Any, field: _Field | None, scale: tuple[float, float], view: _View, caption: str) -> None:
    points = 0.0155 * min(view.width, 1.4 * view.height) * 72 / 200  # a letter's height [pt]
    if field is not None:
        most = max(abs(scale[0]), abs(scale[1]))
        unit, factor, _ = next(u for u in field.units if most <= u[2])
        bar = figure.add_axes((1 - 0.15, 0.2, 0.025, 0.6))
        ramp = _colours(np.linspace(*scale, 256), scale)[:, None]
        bar.imshow(ramp, extent=(0, 1, scale[0] * factor, scale[1] * factor), aspect="auto", origin="lower")
        bar.set_xticks([])
        bar.yaxis.tick_right()
        bar.tick_params(labelsize=points, length=3, width=0.6)
        for spine in bar.spines.values():
            spine.set_linewidth(0.6)
        figure.text(1 - 0.155, 0.82, f"{field.label}\n[{unit}]", fontsize=points, ha="left", va="bottom", wrap=False)
    metres = _round_below(0.18 * view.width / view.per_metre)
    left, bottom = 0.025 * view.width, 0.955 * view.height
    axes = figure.axes[0]
    axes.plot([left, left + metres * view.per_metre], [bottom, bottom], color="black", linewidth=1.4, solid_capstyle="butt")
    axes.text(left, bottom - 0.014 * view.height, f"{_number(1e3 * metres)} mm", fontsize=points, va="bottom")
    axes.text(left, 0.035 * view.height, caption, fontsize=points, va="top", color="0.35")


def _round_below(most: float) -> float:
    power = 10.0 ** np.floor(np.log10(most))
    return float(max(step * power for step in (1, 2, 5) if step * power <= most * (1 + 1e-9)))


def _number(value: float) -> str:
    return f"{value:.4g}".replace("-", "−")
