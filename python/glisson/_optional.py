"""Packages that only some functions need."""

from __future__ import annotations

import importlib
from typing import Any


def need(module: str, package: str, extra: str) -> Any:
    """A module of an optional package, or a sentence on how to get it.

    >>> need("json", "json", "plot").__name__
    'json'
    """
    try:
        return importlib.import_module(module)
    except ImportError as error:
        raise ImportError(f"this needs {package}, which is not installed: pip install 'glisson[{extra}]'") from error
