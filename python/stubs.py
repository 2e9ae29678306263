"""Writes the stubs of the extension modules: nanobind's, with the constructors of option classes spelled out.

    stubs.py OUT_FOLDER MODULE_FOLDER

An option class takes every field by name; nanobind sees `**kwargs` there. The names and types of the fields are read off
the properties of the stub, so that a type checker knows them, and nobody types them a second time.
"""

from __future__ import annotations

import importlib.util
import re
import sys
import types
from pathlib import Path

from nanobind.stubgen import StubGen

CLASS = re.compile(r"^class (\w+)[^\n]*:\n(?:(?:    [^\n]*|)\n)+", re.MULTILINE)
INIT = re.compile(r"^    def __init__\(self, \*\*kwargs\)[^\n]*\n", re.MULTILINE)
SETTER = re.compile(r"@(\w+)\.setter\n    def \1\(self, arg: (.+?), /\) -> None")
MAKER = re.compile(r"^def (box|cylinder)_mesh\(\*\*kwargs\)", re.MULTILINE)


def constructor(text: str) -> str:
    """The parameters of an option class, from its setters."""
    fields = [f"{name}: {kind} = ..." for name, kind in SETTER.findall(text)]
    return "self, *, " + ", ".join(fields) if fields else "self"


def spelled_out(stub: str) -> str:
    stub = stub.replace("os.PathLike", "os.PathLike[str]").replace("os.PathLike[str][str]", "os.PathLike[str]")
    constructors: dict[str, str] = {}

    def one(match: re.Match[str]) -> str:
        text = match.group(0)
        constructors[match.group(1)] = constructor(text)
        return INIT.sub(f"    def __init__({constructor(text)}) -> None: ...\n", text)

    def maker(match: re.Match[str]) -> str:
        options = constructors[match.group(1).capitalize() + "Options"].removeprefix("self, ")
        return f"def {match.group(1)}_mesh({options})"

    return MAKER.sub(maker, CLASS.sub(one, stub))


def load(name: str, folder: Path) -> types.ModuleType:
    """An extension module from its file; the package itself is not installed yet."""
    [file] = folder.glob(f"{name}.*.so")
    spec = importlib.util.spec_from_file_location(f"glisson.{name}", file)
    assert spec and spec.loader
    module = importlib.util.module_from_spec(spec)
    sys.modules[f"glisson.{name}"] = module
    spec.loader.exec_module(module)
    return module


def main() -> None:
    out, folder = Path(sys.argv[1]), Path(sys.argv[2])
    package = types.ModuleType("glisson")
    package.__path__ = []
    sys.modules["glisson"] = package
    for name in ("_core", "_io", "_fit"):
        generator = StubGen(load(name, folder), include_docstrings=True)
        generator.put(sys.modules[f"glisson.{name}"])
        (out / f"{name}.pyi").write_text(spelled_out(generator.get()), encoding="utf-8")


if __name__ == "__main__":
    main()
