"""A copy of the repository that holds one page of its own: what the checks of pages are tested on."""

from __future__ import annotations

import subprocess
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


class PageIn:
    """A folder with the repository's sources and `text` as docs/page.md; gone at the end."""

    def __init__(self, text: str) -> None:
        self.folder = tempfile.TemporaryDirectory()
        self.root = Path(self.folder.name)
        (self.root / "docs").mkdir()
        (self.root / "docs/page.md").write_text(text, encoding="utf-8")
        for name in ("apps", "bench", "tests", "scenes", "scripts"):
            (self.root / name).symlink_to(ROOT / name)

    def __enter__(self) -> PageIn:
        return self

    def __exit__(self, *_: object) -> None:
        self.folder.cleanup()

    def run(self, script: str, *arguments: str) -> subprocess.CompletedProcess[str]:
        command = [str(ROOT / "scripts" / script), *arguments]
        return subprocess.run(command, capture_output=True, text=True, check=False, cwd=self.root)
