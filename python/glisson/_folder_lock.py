"""A folder of results while this process writes it: the lock of `glisson run`, with its rule and its words."""

from __future__ import annotations

import contextlib
import os
import warnings
from collections.abc import Iterator
from pathlib import Path

from . import _core


@contextlib.contextmanager
def alone_in(folder: str | os.PathLike[str]) -> Iterator[None]:
    """Makes a folder and locks it, and others against runs inside it or around it; the system frees it where the process ends.

    :raises RuntimeError: naming the folder and the process that writes there, inside it or around it
    """
    held = _core.HeldFolder(Path(folder), lambda text: warnings.warn(text, stacklevel=4))
    try:
        yield
    finally:
        held.release()
