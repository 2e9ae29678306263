"""Writes the stubs of the extension modules: nanobind's, with the constructors of option classes spelled out.

    stubs.py OUT_FOLDER MODULE_FOLDER [MODULE]

An option class takes every field by name; nanobind sees `**kwargs` there. The names and types of the fields are read off
the properties of the stub, so that a type checker knows them, and nobody types them a second time.

Each module is loaded by an interpreter of its own. One that cannot be loaded or read, whatever ends that interpreter, gets a
stub that allows every name, and a warning: the package works without stubs.
"""

from __future__ import annotations

import importlib.util
import re
import subprocess
import sys
import types
from pathlib import Path

MODULES = ("_core", "_io", "_fit")
ANY_NAME = "# Written without a look at the module: {why}\nfrom typing import Any\n\ndef __getattr__(name: str) -> Any: ...\n"
CLASS = re.compile(r"^class (\w+)[^\n]*:\n(?:(?:    [^\n]*|)\n)+", re.MULTILINE)
INIT = re.compile(r"^    def __init__\(self, \*\*kwargs\)[^\n]*\n", re.MULTILINE)
SETTER = re.compile(r"@(\w+)\.setter\n    def \1\(self, arg: (.+?), /\) -> None")
MAKER = re.compile(r"^def (box|cylinder|liver)_mesh\(\*\*kwargs\)", re.MULTILINE)


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


def package() -> None:
    """The package that the modules believe to be in."""
    glisson = types.ModuleType("glisson")
    glisson.__path__ = []
    sys.modules["glisson"] = glisson


def write(name: str, out: Path, folder: Path) -> None:
    """The stub of one module; those that it builds upon are loaded before it."""
    from nanobind.stubgen import StubGen

    package()
    for needed in MODULES[: MODULES.index(name) + 1]:
        module = load(needed, folder)
    generator = StubGen(module, include_docstrings=True)
    generator.put(module)
    (out / f"{name}.pyi").write_text(spelled_out(generator.get()), encoding="utf-8")


def write_all(out: Path, folder: Path) -> None:
    for name in MODULES:
        command = [sys.executable, __file__, str(out), str(folder), name]
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
        if done.returncode:
            why = (done.stdout.strip().splitlines() or ["no message"])[-1]
            print(f"warning: no stub of glisson.{name}, type checkers will take any name: {why}", file=sys.stderr)
            (out / f"{name}.pyi").write_text(ANY_NAME.format(why=why), encoding="utf-8")


def main() -> None:
    out, folder, *names = sys.argv[1:]
    if names:
        write(names[0], Path(out), Path(folder))
    else:
        write_all(Path(out), Path(folder))


if __name__ == "__main__":
    main()
