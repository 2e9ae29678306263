"""Packages that only some functions need."""

from __future__ import annotations

import importlib
import importlib.metadata
import re
import shlex
import sys
from typing import Any


def need(module: str, package: str, extra: str) -> Any:
    """A module of an optional package, or a sentence on how to get it.

    >>> need("json", "json", "plot").__name__
    'json'
    """
    try:
        return importlib.import_module(module)
    except ImportError as error:
        raise ImportError(f"this needs {package}, which is not installed: {advice(extra)}") from error


def advice(extra: str) -> str:
    """The command that installs what an extra names, into this Python, however Glisson itself was installed.

    >>> advice("plot")
    "... -m pip install 'matplotlib>=3.6'"
    """
    try:
        rows = importlib.metadata.requires("glisson") or []
    except importlib.metadata.PackageNotFoundError:  # run from a folder
        rows = []
    marked = (re.fullmatch(r"([^;]+?)\s*;\s*extra\s*==\s*['\"](\S+)['\"]", row) for row in rows)
    wanted = [shlex.quote(match[1]) for match in marked if match and match[2] == extra]
    packages = " ".join(wanted) or f"the packages that pyproject.toml lists under {extra}"
    return f"{shlex.quote(sys.executable)} -m pip install {packages}"
