"""Gmsh's first format, which no other reader here knows: $NOD and $ELM, in text."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ._core import TetMesh

_NODES = {1: 2, 2: 3, 3: 4, 4: 4, 5: 8, 6: 6, 7: 5, 8: 3, 9: 6, 11: 10, 15: 1}
_DIMENSION = {1: 1, 2: 2, 3: 2, 8: 1, 9: 2, 15: 0}
_KIND = ("point", "curve", "surface")


def is_gmsh1(path: Path) -> bool:
    """Whether a file begins as one of the first format."""
    with path.open("rb") as file:
        return file.read(64).lstrip().startswith(b"$NOD")


def read_gmsh1(path: Path, scale: float) -> tuple[TetMesh, list[list[int]]]:
    """The mesh of a file, tets by their corners, with physical volumes as regions and other physical groups as vertex sets.

    :return: the mesh and the ten nodes of its tets that have as many
    :raises ValueError: naming the file, the section and what is wrong
    """

    def fail(what: str) -> ValueError:
        return ValueError(f"{path}: {what}")

    words = path.read_text(encoding="ascii", errors="replace").split()
    try:
        nodes, elements = words.index("$NOD"), words.index("$ELM")
        count = int(words[nodes + 1])
        table = np.array(words[nodes + 2 : nodes + 2 + 4 * count], dtype=float).reshape(count, 4)
    except (ValueError, IndexError) as error:
        raise fail("expected $NOD with a number of nodes, and for each its number, x, y and z; then $ELM") from error
    place = {int(tag): i for i, tag in enumerate(table[:, 0])}
    tets: list[list[int]] = []
    regions: list[int] = []
    curved: list[list[int]] = []
    sets: dict[str, set[int]] = {}
    at = elements + 2
    for element in range(1, int(words[elements + 1]) + 1):
        try:
            _, kind, group, _, size = (int(word) for word in words[at : at + 5])
            vertices = [place[int(word)] for word in words[at + 5 : at + 5 + size]]
        except (ValueError, KeyError) as error:
            raise fail(f"$ELM, element {element}: expected its number, type, two tags, and nodes that $NOD has") from error
        if len(vertices) != size or size != _NODES.get(kind, size):
            raise fail(f"$ELM, element {element}: {len(vertices)} nodes of type {kind}; the file is cut off or damaged")
        at += 5 + size
        if kind in (4, 11):
            tets.append(vertices[:4])
            regions.append(group)
            if kind == 11:  # the last two nodes of Gmsh stand the other way round elsewhere
                curved.append([*vertices[:8], vertices[9], vertices[8]])
        elif kind in _DIMENSION and group:
            sets.setdefault(f"{_KIND[_DIMENSION[kind]]}_{group}", set()).update(vertices)
    if not tets:
        raise fail("no tetrahedra in the file; mesh the volume with tetrahedra of 4 or 10 nodes")
    mesh = TetMesh(
        table[:, 1:] * scale, tets, regions=regions if any(regions) else None, vertex_sets={k: sorted(v) for k, v in sets.items()}
    )
    return mesh, curved
