"""Turns the `///` comments of the public headers into a C++ table of docstrings.

    docstrings.py OUT.h HEADER...      one entry a declaration: {"Simulation::step", "Advances by step_size()."}

So a docstring is typed once, beside the declaration it is of. The reader knows the layout of these headers, which
clang-format keeps: a comment stands above its declaration or, as `///<`, behind it.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path

SCOPE = re.compile(r"^(?:template\s*<[^>]*>\s*)?(struct|class|enum class)\s+(\w+)[^;({]*\{?\s*(?:///<.*)?$")
FUNCTION = re.compile(r"(\w+)\(")
NOT_NAMES = {"if", "for", "while", "switch", "return", "sizeof"}
EXCEPTIONS = {
    "std::invalid_argument": "ValueError",
    "std::runtime_error": "RuntimeError",
    "std::out_of_range": "IndexError",
}


def plain(text: str) -> str:
    """A comment as a Python docstring: Doxygen's tags become lines of reStructuredText."""
    for cpp, python in EXCEPTIONS.items():
        text = text.replace(cpp, python)
    text = re.sub(r"\s*@param\s+(\w+)\s*", r"\n:param \1: ", text)
    text = re.sub(r"\s*@return\s+", "\n:return: ", text)
    text = re.sub(r"\s*@throws\s+(\w+)[,:]?\s*", r"\n:raises \1: ", text)
    return text.strip("\n")


def bare(line: str) -> str:
    """A declaration without comment, template arguments and initialisers."""
    line = re.sub(r"//.*$", "", line)
    line = re.sub(r"\{[^{}]*\}", "", line)
    while "<" in line and (shorter := re.sub(r"<[^<>]*>", "", line)) != line:
        line = shorter
    return line


def names_of(line: str) -> list[str]:
    """What a line declares: a function, or one or more members."""
    line = bare(line)
    call = FUNCTION.search(line)
    if call and call.group(1) not in NOT_NAMES:
        return [call.group(1)]
    parts = re.sub(r"=[^,;]*", "", line).rstrip("; ,").split(",")
    found = [re.search(r"(\w+)\s*$", part) for part in parts]
    return [match.group(1) for match in found if match and not match.group(1).isdigit()]


class Reader:
    """Reads headers line by line, keeping the comment that waits for its declaration."""

    def __init__(self) -> None:
        self.docs: dict[str, str] = {}
        self.scopes: list[tuple[str, int]] = []
        self.depth = 0
        self.waiting: list[str] = []

    def add(self, name: str, text: str) -> None:
        key = "::".join([scope for scope, _ in self.scopes] + [name])
        text = plain(text)
        known = self.docs.get(key)
        self.docs[key] = text if not known or known == text else f"{known}\n\n{text}"

    def line(self, line: str) -> None:
        text = line.strip()
        if text.startswith("///") and not text.startswith("///<"):
            self.waiting.append(text[3:].removeprefix(" "))
            return
        if not text or text.startswith(("//", "#")):
            self.waiting = self.waiting if text.startswith("//") else []
            return
        behind = re.search(r"///<\s*(.*)$", text)
        scope = SCOPE.match(text)
        if scope and not text.endswith(";"):
            self.add(scope.group(2), "\n".join(self.waiting))
            self.scopes.append((scope.group(2), self.depth))
        elif self.waiting or behind:
            words = "\n".join(self.waiting + ([behind.group(1)] if behind else []))
            for name in names_of(text):
                self.add(name, words)
        self.waiting = []
        code = re.sub(r"//.*$", "", text)
        self.depth += code.count("{") - code.count("}")
        while self.scopes and self.depth <= self.scopes[-1][1]:
            self.scopes.pop()


def literal(text: str) -> str:
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n") + '"'


def main() -> None:
    out, *headers = sys.argv[1:]
    reader = Reader()
    for header in headers:
        for line in Path(header).read_text(encoding="utf-8").splitlines():
            reader.line(line)
    rows = [f"    {{{literal(key)}, {literal(text)}}}," for key, text in sorted(reader.docs.items()) if text]
    head = "// Written by docstrings.py from the public headers.\n#pragma once\n#include <utility>\n\n"
    table = "inline constexpr std::pair<const char*, const char*> kDocstrings[] = {\n" + "\n".join(rows) + "\n};\n"
    Path(out).write_text(head + table, encoding="utf-8")


if __name__ == "__main__":
    main()
