"""Meshes from files of any format and from PyVista, and back."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from ._core import MeshReport, TetMesh
from ._optional import need

OWN_FORMATS = {".vtu", ".vtk", ".msh"}


def read_mesh(file: str | os.PathLike[str], scale: float = 1.0) -> TetMesh:
    """Reads a tetrahedral mesh: .vtu, .vtk and .msh by the engine's own readers, every other format through meshio.

    :param scale: factor on all coordinates, 0.001 for a file in millimetres
    :raises FileError: where the file cannot be used as it is
    """
    path = Path(file)
    if path.suffix.lower() in OWN_FORMATS:
        from ._io import read_mesh as read

        return read(path, scale)[0]
    return from_meshio(need("meshio", "meshio", "meshes").read(path), scale)


def from_meshio(mesh: Any, scale: float = 1.0) -> TetMesh:
    """A mesh of meshio, with its tetrahedra; cell data "region" or those of Gmsh and MEDIT become regions, point sets
    vertex sets. Inverted tets are reoriented.

    :raises ValueError: for a mesh without tetrahedra
    """
    tets = [block.data for block in mesh.cells if block.type == "tetra"]
    if not tets:
        kinds = ", ".join(sorted({block.type for block in mesh.cells})) or "no cells"
        raise ValueError(f"the mesh has no linear tetrahedra (it has: {kinds}); mesh the volume first")
    regions = None
    for name in ("region", "gmsh:physical", "medit:ref"):
        if name in mesh.cell_data:
            kept = [data for data, block in zip(mesh.cell_data[name], mesh.cells, strict=True) if block.type == "tetra"]
            regions = np.concatenate(kept).astype(np.int64)
            break
    sets = {str(name): np.asarray(points) for name, points in (mesh.point_sets or {}).items()}
    vertices = np.asarray(mesh.points, dtype=float) * scale
    return TetMesh(vertices, np.concatenate(tets), regions=regions, vertex_sets=sets)


def from_pyvista(grid: Any, scale: float = 1.0) -> TetMesh:
    """A PyVista (or VTK) unstructured grid; cell data "region" becomes regions, other cells than tets are left out.

    :raises ValueError: for a grid without tetrahedra
    """
    pyvista = need("pyvista", "PyVista", "meshes")
    grid = pyvista.wrap(grid).cast_to_unstructured_grid()
    kind = int(pyvista.CellType.TETRA)
    if kind not in grid.cells_dict:
        raise ValueError(f"the grid has no linear tetrahedra among its {grid.n_cells} cells; grid.triangulate() makes some")
    regions = None
    if "region" in grid.cell_data:
        regions = np.asarray(grid.cell_data["region"])[np.asarray(grid.celltypes) == kind].astype(np.int64)
    sets = {
        name.removeprefix("set:"): np.flatnonzero(grid.point_data[name])
        for name in grid.point_data.keys()
        if name.startswith("set:")
    }
    return TetMesh(np.asarray(grid.points, dtype=float) * scale, grid.cells_dict[kind], regions=regions, vertex_sets=sets)


def to_pyvista(
    mesh: TetMesh,
    positions: npt.ArrayLike | None = None,
    vertex_fields: Mapping[str, npt.ArrayLike] | None = None,
    tet_fields: Mapping[str, npt.ArrayLike] | None = None,
) -> Any:
    """The mesh as a PyVista grid at the present positions, with fields on vertices and tets.

    :param positions: (n, 3) [m]; none: at rest
    """
    pyvista = need("pyvista", "PyVista", "meshes")
    points = np.array(mesh.vertices if positions is None else positions, dtype=float)
    grid = pyvista.UnstructuredGrid({int(pyvista.CellType.TETRA): np.asarray(mesh.tets, dtype=np.int64)}, points)
    if mesh.regions.size:
        grid.cell_data["region"] = np.array(mesh.regions)
    for name, vertices in mesh.vertex_sets.items():
        mask = np.zeros(len(points), dtype=np.uint8)
        mask[vertices] = 1
        grid.point_data[f"set:{name}"] = mask
    for name, values in (vertex_fields or {}).items():
        grid.point_data[name] = np.asarray(values)
    for name, values in (tet_fields or {}).items():
        grid.cell_data[name] = np.asarray(values)
    return grid


def write_vtu(
    file: str | os.PathLike[str],
    mesh: TetMesh,
    positions: npt.ArrayLike | None = None,
    vertex_fields: Mapping[str, npt.ArrayLike] | None = None,
    tet_fields: Mapping[str, npt.ArrayLike] | None = None,
) -> None:
    """Writes a .vtu with regions, vertex sets and fields; names carry their unit, as "displacement_m"."""
    from ._io import write_vtu as write

    write(Path(file), mesh, positions, dict(vertex_fields or {}), dict(tet_fields or {}))


def format_report(name: str, report: MeshReport, mesh: TetMesh) -> str:
    """The output of `glisson info MESH`: counts, extent, volume, shape, pieces and warnings.

    >>> import glisson
    >>> mesh = glisson.box_mesh()
    >>> print(glisson.format_report("box", mesh.inspect(), mesh).splitlines()[0].split()[0])
    box
    """
    from ._io import format_report as text

    return text(name, report, mesh)
