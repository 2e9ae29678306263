"""What the Python tests share. The installed package is tested, never the sources beside them."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def program() -> Path:
    """The built glisson program, named by GLISSON_PROGRAM."""
    path = Path(os.environ.get("GLISSON_PROGRAM", ""))
    if not path.is_file():
        pytest.fail("GLISSON_PROGRAM names no program; `make test` sets it, or give the path of a built one")
    return path


@pytest.fixture
def scenes() -> Path:
    return ROOT / "scenes"
