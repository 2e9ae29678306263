"""The frames of a run's folder as arrays: what `glisson run` writes, read with NumPy alone."""

from __future__ import annotations

import base64
import re
import zlib
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

_TYPES = {"Float64": "<f8", "Float32": "<f4", "Int64": "<i8", "Int32": "<i4", "UInt8": "u1", "Int8": "i1"}


class RunError(ValueError):
    """A folder, file or option that cannot be used, with the way out."""


@dataclass
class Frame:
    """One instant of a body, without tets that were removed, and the tools with their surfaces."""

    time: float
    rest: Any  # (n, 3) [m]
    tets: Any  # (m, 4)
    points: dict[str, Any]  # arrays of points by name
    cells: dict[str, Any]  # arrays of tets by name
    tools: dict[str, tuple[Any, Any]] = field(default_factory=dict)  # points (n, 3), triangles (m, 3) by name


def variants_of(out: Path) -> list[str]:
    """Variants of a run's folder that have frames, in alphabetical order."""
    if not out.is_dir():
        raise RunError(f"{out}: there is no such folder; give the one that `glisson run … --out OUT` wrote")
    found = sorted(path.parent.name for path in out.glob("*/frames.pvd"))
    if not found:
        raise RunError(f"{out}: no VARIANT/frames.pvd in it; run the scene with `[output] frames = 20` or more")
    return found


def read_frame(out: Path, variant: str, number: int) -> Frame:
    """A frame by its number, from 0; negative ones count from the end."""
    folder = out / variant
    files = _collection(folder / "frames.pvd")
    if not -len(files) <= number < len(files):
        raise RunError(f"frame {number}: {folder} has {len(files)} frames, 0 to {len(files) - 1}, and −1 is the last")
    number %= len(files)
    time, file = files[number]
    head, arrays = _arrays(file)
    read = {name: _shaped(data, components) for (_, name), (data, components) in arrays.items()}
    groups: dict[str, dict[str, Any]] = {"PointData": {}, "CellData": {}}
    for group, name in arrays:
        if group in groups:
            groups[group][name] = read[name]
    del head
    tets = read["connectivity"].reshape(-1, 4).astype(np.int64)
    cells = groups["CellData"]
    if "removed" in cells:
        there = cells.pop("removed") == 0
        tets, cells = tets[there], {name: values[there] for name, values in cells.items()}
    tools = {}
    for series in sorted(folder.glob("tool_*.pvd")):
        surfaces = _collection(series)
        if number < len(surfaces):
            _, parts = _arrays(surfaces[number][1])
            points = _shaped(*parts[("Points", "Points")])
            tools[series.stem.removeprefix("tool_")] = (points, _shaped(*parts[("Polys", "connectivity")]).reshape(-1, 3))
    return Frame(time, read["Points"], tets, groups["PointData"], cells, tools)


def _collection(file: Path) -> list[tuple[float, Path]]:
    """Times and files of a .pvd."""
    try:
        text = file.read_text(encoding="utf-8")
    except OSError as error:
        raise RunError(f"{file}: cannot be read: {error.strerror}") from error
    rows = []
    for element in re.findall(r"<DataSet [^>]*>", text):
        words = dict(re.findall(r'(\w+)="([^"]*)"', element))
        rows.append((float(words["timestep"]), file.parent / words["file"]))
    if not rows:
        raise RunError(f"{file}: no frame in it")
    return rows


def _arrays(file: Path) -> tuple[str, dict[tuple[str, str], tuple[Any, int]]]:
    """All arrays of a .vtu or .vtp by group and name, as they lie in the file; with their numbers of components."""
    try:
        text = file.read_bytes()
    except OSError as error:
        raise RunError(f"{file}: cannot be read: {error.strerror}") from error
    begin = text.find(b'<AppendedData encoding="base64">')
    if begin < 0 or b'compressor="vtkZLibDataCompressor"' not in text[:begin] or b'header_type="UInt64"' not in text[:begin]:
        raise RunError(f"{file}: not as `glisson run` writes frames (appended base64 of zlib blocks)")
    data = text[text.index(b"_", begin) + 1 :]
    head = text[:begin].decode("utf-8", "replace")
    arrays: dict[tuple[str, str], tuple[Any, int]] = {}
    group = ""
    for match in re.finditer(r"<(PointData|CellData|FieldData|Points|Cells|Polys|Verts|Lines|Strips)\b|<DataArray ([^>]*)>", head):
        if match[1]:
            group = match[1]
            continue
        words = dict(re.findall(r'(\w+)="([^"]*)"', match[2]))
        kind = _TYPES.get(words.get("type", ""))
        if kind is None or words.get("format") != "appended":
            continue
        raw = _decoded(data, int(words["offset"]))
        arrays[(group, words["Name"])] = (np.frombuffer(raw, kind), int(words.get("NumberOfComponents", "1")))
    return head, arrays


def _shaped(data: Any, components: int) -> Any:
    return data if components == 1 else data.reshape(-1, components)


def _decoded(data: bytes, offset: int) -> bytes:
    """Blocks of an array: numbers of blocks and bytes in base64, then the blocks in base64."""
    count = int(np.frombuffer(base64.b64decode(data[offset : offset + 12])[:8], "<u8")[0])
    if count == 0:
        return b""
    letters = 4 * ((8 * (3 + count) + 2) // 3)
    sizes = np.frombuffer(base64.b64decode(data[offset : offset + letters]), "<u8")[3 : 3 + count]
    total = int(sizes.sum())
    begin = offset + letters
    packed = base64.b64decode(data[begin : begin + 4 * ((total + 2) // 3)])
    parts, at = [], 0
    for size in sizes:
        parts.append(zlib.decompress(packed[at : at + int(size)]))
        at += int(size)
    return b"".join(parts)
