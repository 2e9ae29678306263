"""The commands that a page may name, read from the sources: no build is needed to know that one is gone.

A command is known when its program exists here (the glisson program, a target of bench/ or tests/, a script, a test)
and so do its subcommand, its options and the files of the repository that it names.
"""

from __future__ import annotations

import fnmatch
import re
import shlex
from functools import cached_property
from pathlib import Path

SUBCOMMAND = re.compile(r'add_subcommand\(\s*"([\w-]+)"')
OPTION = re.compile(r'add_(?:option|flag)\(\s*"([^"]+)"')
TEST = re.compile(r"^(?:TYPED_)?TEST(?:_F|_P)?\((\w+),\s*(\w+)\)", re.MULTILINE)
CTEST = re.compile(r"add_test\(NAME\s+(\w+)")
TARGET = re.compile(r"add_executable\((\w+)")
SHIPPED = re.compile(r"^(?:scenes|scripts|tests|bench|docs|python|include|mesher|src|studies)/")
SHELL_WORDS = {"cd", "cp", "node", "python3", "make", "cmake", "ninja", "ctest", "timeout", "env", "nice"}


class Commands:
    """What can be run in the repository at `root`."""

    def __init__(self, root: Path) -> None:
        self.root = root

    def texts(self, folder: str, pattern: str) -> dict[Path, str]:
        return {path: path.read_text(encoding="utf-8") for path in sorted((self.root / folder).rglob(pattern))}

    @cached_property
    def subcommands(self) -> dict[str, set[str]]:
        """Options by subcommand; those in files without a subcommand belong to every one."""
        shared: set[str] = {"--help", "--version"}
        own: dict[str, set[str]] = {}
        for text in self.texts("apps", "*.cpp").values():
            options = {name for entry in OPTION.findall(text) for name in entry.split(",") if name.startswith("-")}
            for name in SUBCOMMAND.findall(text):
                own.setdefault(name, set()).update(options)
            if not SUBCOMMAND.search(text):
                shared |= options
        return {name: options | shared for name, options in own.items()}

    @cached_property
    def targets(self) -> set[str]:
        text = (self.root / "bench/CMakeLists.txt").read_text(encoding="utf-8")
        folders = {path.parent.name for path in (self.root / "tests").glob("*/*_test.cpp")}
        return set(TARGET.findall(text)) | {f"{folder}_tests" for folder in folders} | {"glisson"}

    @cached_property
    def tests(self) -> set[str]:
        named = {f"{suite}.{name}" for text in self.texts("tests", "*.cpp").values() for suite, name in TEST.findall(text)}
        lists = [*self.texts("tests", "*.cmake").values(), *self.texts("tests", "CMakeLists.txt").values()]
        return named | {name for text in lists for name in CTEST.findall(text)}

    def fault(self, command: str) -> str | None:
        """What of the command does not exist, or None."""
        try:
            words = shlex.split(command, comments=True)
        except ValueError as error:
            return f"`{command}`: {error}"
        if not words:
            return "an empty command"
        program = words[0].removeprefix("build/release/bin/")
        missing = [word for word in words if SHIPPED.match(word) and not (self.root / word).exists()]
        if missing:
            return f"`{command}`: there is no {missing[0]}"
        if program == "glisson":
            return self.glisson_fault(command, words[1:])
        if program == "ctest" and "-R" in words:
            return self.test_fault(command, words[words.index("-R") + 1])
        if filters := [word.split("=", 1)[1] for word in words if word.startswith("--gtest_filter=")]:
            return self.filter_fault(command, program, filters[0])
        if program in self.targets | SHELL_WORDS or SHIPPED.match(program):
            return None
        return f"`{command}`: there is no program '{program}' (a target of bench/ or tests/, or a script)"

    def glisson_fault(self, command: str, words: list[str]) -> str | None:
        names = [word for word in words if not word.startswith("-")]
        if not names or names[0] not in self.subcommands:
            return f"`{command}`: glisson has no command '{names[0] if names else ''}'"
        known = set(self.subcommands[names[0]])
        if len(names) > 1 and names[1] == "realtime":
            known |= self.subcommands["realtime"]
        options = [word.split("=", 1)[0] for word in words if re.match(r"--?[a-z]", word)]
        gone = [option for option in options if option not in known]
        return f"`{command}`: glisson {names[0]} has no option {gone[0]}" if gone else None

    def test_fault(self, command: str, pattern: str) -> str | None:
        return None if any(re.search(pattern, name) for name in self.tests) else f"`{command}`: no test matches {pattern}"

    def filter_fault(self, command: str, program: str, filters: str) -> str | None:
        if program not in self.targets:
            return f"`{command}`: there is no program '{program}'"
        for pattern in filters.split("-")[0].split(":"):
            bare = pattern.split("/")[1] if "/" in pattern.split(".")[0] else pattern.split("/")[0]
            if not any(fnmatch.fnmatchcase(name, bare) for name in self.tests):
                return f"`{command}`: no test matches {pattern}"
        return None
