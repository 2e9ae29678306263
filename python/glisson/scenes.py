"""Scenes from files, from TOML text and from dicts."""

from __future__ import annotations

import math
import os
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from . import _core
from ._core import Scene

Overrides = Mapping[str, Any]
BARE_KEY = re.compile(r"[A-Za-z0-9_-]+")


def scenes_folder() -> Path:
    """Folder of the shipped scenes.

    >>> (scenes_folder() / "paper" / "figure2.toml").exists()
    True
    """
    return Path(__file__).parent / "scenes"


def load_scene(file: str | os.PathLike[str], overrides: Overrides | None = None) -> Scene:
    """Reads a scene from its file.

    :param overrides: values in place of the scene's, by dotted key, as `--set` takes them
    :raises SceneError: with a line for each error

    >>> scene = load_scene(scenes_folder() / "paper" / "figure2.toml", {"tissue.poisson_ratio": 0.45})
    >>> scene["linear"].tissue.poisson_ratio
    0.45
    """
    return _core.read_scene(Path(file), _pairs(overrides))


def parse_scene(
    text: str | Mapping[str, Any],
    name: str = "scene",
    base: str | os.PathLike[str] = ".",
    overrides: Overrides | None = None,
) -> Scene:
    """Reads a scene from TOML text, or from a dict of the same keys.

    :param name: stands for the file in messages
    :param base: folder that files named in the scene are relative to

    >>> parse_scene({"tissue": {"youngs_modulus_Pa": -1}})
    Traceback (most recent call last):
    ...
    glisson._core.SceneError: ...
    """
    source = text if isinstance(text, str) else to_toml(text)
    return _core.read_scene_text(source, name, Path(base), _pairs(overrides))


def to_toml(table: Mapping[str, Any]) -> str:
    """A dict as the TOML of a scene; arrays of NumPy are lists, tables within tables stand in one line.

    >>> print(to_toml({"title": "Press", "tissue": {"law": {"kind": "step", "threshold": 0.1}}}), end="")
    title = "Press"
    tissue = { law = { kind = "step", threshold = 0.1 } }
    """
    return "".join(f"{_key(key)} = {_value(value)}\n" for key, value in table.items() if value is not None)


def as_scene(scene: Scene | Mapping[str, Any] | str | os.PathLike[str], overrides: Overrides | None = None) -> Scene:
    """A scene from whatever describes it: itself, a dict, TOML text (with a line end), the name of a file."""
    if isinstance(scene, Scene):
        if overrides:
            raise ValueError("overrides go with a scene that is read: give its file, text or dict")
        return scene
    if isinstance(scene, Mapping) or (isinstance(scene, str) and "\n" in scene):
        return parse_scene(scene, overrides=overrides)
    return load_scene(scene, overrides)


def _pairs(overrides: Overrides | None) -> list[tuple[str, str]]:
    return [(key, _value(value)) for key, value in (overrides or {}).items()]


def _key(key: str) -> str:
    return key if BARE_KEY.fullmatch(key) else _text(key)


def _text(text: str) -> str:
    escaped = text.replace("\\", "\\\\").replace('"', '\\"')
    for code in (*range(0x20), 0x7F):
        escaped = escaped.replace(chr(code), f"\\u{code:04x}")
    return f'"{escaped}"'


def _number(value: float) -> str:
    if math.isnan(value):
        return "nan"
    return ("inf" if value > 0 else "-inf") if math.isinf(value) else repr(value)


def _value(value: Any) -> str:
    if isinstance(value, np.generic | np.ndarray):
        value = value.tolist()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        return _number(value)
    if isinstance(value, str | os.PathLike):
        return _text(os.fspath(value))
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{_key(k)} = {_value(v)}" for k, v in value.items() if v is not None) + " }"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(_value(v) for v in value) + "]"
    raise TypeError(f"{value!r} ({type(value).__name__}) has no place in a scene")
