"""The fenced blocks of README.md and docs/*.md, and what each says of itself in the words behind its fence.

    sh, python          runs as it stands
    toml, cpp, cmake    with file=NAME a whole file, which the blocks after it use
    text                a pattern or a drawing, not run; commands of this repository in it must exist
    pattern             behind any language: a part of a file, not run; TOML must be TOML
    full                runs in `make pages FULL=1` only
    data=NAME           needs a file of the shared data, and is skipped with a word where that is not there
"""

from __future__ import annotations

import re
import tomllib
from dataclasses import dataclass
from pathlib import Path

from known_commands import Commands

PAGES = ("README.md", "docs/*.md", "CONTRIBUTING.md")
FENCE = re.compile(r"^ *```(.*)$")
RUN = ("sh", "python")
FILES = ("toml", "cpp", "cmake")
LANGUAGES = (*RUN, *FILES, "text")
COMMAND = re.compile(r"^(?:build/release/bin/|glisson |scripts/|make\b|cmake |ctest )")
INDENTED = re.compile(r"^ {4,}(?:build/release/bin/|glisson |scripts/|make |cmake |pip |python3? )")


@dataclass(frozen=True)
class Block:
    page: str  # from the root of the repository
    line: int  # of its fence, from 1
    words: tuple[str, ...]
    text: str

    @property
    def language(self) -> str:
        return self.words[0] if self.words else ""

    @property
    def place(self) -> str:
        return f"{self.page}:{self.line}"

    @property
    def runs(self) -> bool:
        return self.language in RUN and "pattern" not in self.words

    def value(self, name: str) -> str | None:
        return next((word.split("=", 1)[1] for word in self.words if word.startswith(f"{name}=")), None)


def blocks_of(root: Path, page: Path) -> list[Block]:
    """Every block of a page, in order."""
    found: list[Block] = []
    lines = page.read_text(encoding="utf-8").splitlines()
    opened: int | None = None
    for number, line in enumerate(lines):
        if not (fence := FENCE.match(line)):
            continue
        if opened is None:
            opened, words = number, tuple(fence.group(1).split())
        else:
            text = "\n".join(lines[opened + 1 : number]) + "\n"
            found.append(Block(str(page.relative_to(root)), opened + 1, words, text))
            opened = None
    return found


def pages(root: Path) -> list[Path]:
    return [page for pattern in PAGES for page in sorted(root.glob(pattern))]


def block_faults(block: Block, commands: Commands) -> list[str]:
    if block.language not in LANGUAGES:
        return [f"a block of '{block.language}': say {', '.join(LANGUAGES)} (scripts/page_blocks.py tells what each means)"]
    whole = block.value("file") is not None or "pattern" in block.words
    if block.language in FILES and not whole:
        return [f"{block.language}: say file=NAME where it is a whole file, pattern where it is a part of one"]
    if block.language == "toml":
        try:
            tomllib.loads(block.text)
        except tomllib.TOMLDecodeError as error:
            return [f"no TOML: {error}"]
    if block.language == "sh" and any("&&" in line for line in block.text.splitlines()[:-1]):
        return ["a failure before && would go unnoticed: give each command a line, or end the block there"]
    if block.language in ("sh", "text"):
        named = [line.strip() for line in block.text.splitlines() if COMMAND.match(line.strip())]
        return [fault for line in named if (fault := commands.fault(line.split(" && ")[0]))]
    return []


def indented_commands(page: Path) -> list[int]:
    """Lines outside of blocks that are commands by their looks."""
    code, found = False, []
    for number, line in enumerate(page.read_text(encoding="utf-8").splitlines(), 1):
        code ^= bool(FENCE.match(line))
        if not code and INDENTED.match(line):
            found.append(number)
    return found


def faults(root: Path) -> list[str]:
    """What can be told of all pages without running anything."""
    commands, found = Commands(root), []
    for page in pages(root):
        name = page.relative_to(root)
        found += [f"{block.place}: {fault}" for block in blocks_of(root, page) for fault in block_faults(block, commands)]
        found += [f"{name}:{line}: an indented command: put it into a block" for line in indented_commands(page)]
    return found
