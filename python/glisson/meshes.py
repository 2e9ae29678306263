"""Meshes from files of any format and from PyVista, and back."""

from __future__ import annotations

import os
import warnings
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from ._core import MeshReport, TetMesh
from ._gmsh1 import is_gmsh1, read_gmsh1
from ._optional import need

OWN_FORMATS = {".vtu", ".vtk", ".msh", ".inp"}
LARGEST_ORGAN = 2.0  # [m]; a body that is longer is in millimetres, where no scale is given


def read_mesh(file: str | os.PathLike[str], scale: float | None = 1.0) -> TetMesh:
    """Reads a tetrahedral mesh: .vtu, .vtk, .msh and .inp by the engine's own readers, every other format, and other versions of
    .msh, through meshio. Tets of ten nodes are taken by their corners.

    :param scale: factor on all coordinates, 0.001 for a file in millimetres; None: 1, or 0.001 where the body would be more than 2 m
        across
    :raises FileError: where the file cannot be used as it is
    """
    return _read(Path(file), scale)[0]


def convert(source: str | os.PathLike[str], target: str | os.PathLike[str], scale: float | None = 1.0) -> MeshReport:
    """Writes a mesh of any format that `read_mesh` knows as .vtu, which the program `glisson` reads: its tets, regions and vertex sets.

    :param scale: as that of `read_mesh`
    :return: what is in the mesh, with warnings
    :raises FileError: where the source cannot be used as it is
    :raises ValueError: for a target of another format than .vtu
    """
    if Path(target).suffix.lower() != ".vtu":
        raise ValueError(f"{target}: meshes are written as .vtu; give a name that ends in .vtu")
    mesh, report = _read(Path(source), scale)
    write_vtu(target, mesh)
    return report or mesh.inspect()


def _read(path: Path, scale: float | None) -> tuple[TetMesh, MeshReport | None]:
    """The mesh of a file, and the report of the engine's own reader where it read it."""
    version = _gmsh_version(path) if path.suffix.lower() == ".msh" and path.exists() else ""
    if version == "1":
        mesh, curved = read_gmsh1(path, 1.0)
        _warn_of_corners(mesh.vertices, np.array(curved, dtype=np.int64).reshape(-1, 10))
        return _scaled(_without_middles(mesh, np.array(curved, dtype=np.int64).reshape(-1, 10)), scale), None
    if path.suffix.lower() in OWN_FORMATS and version not in {"4", "4.0"}:
        from ._io import read_mesh as read

        mesh, report = read(path, scale)
        return mesh, report
    return from_meshio(need("meshio", "meshio", "meshes").read(path), scale), None


def _gmsh_version(path: Path) -> str:
    """Of a file of Gmsh, in its own words; empty for another one."""
    if is_gmsh1(path):
        return "1"
    with path.open("rb") as file:
        head = file.read(64).split()
    return head[1].decode("ascii", "replace") if head[:1] == [b"$MeshFormat"] and len(head) > 1 else ""


def _scaled(mesh: TetMesh, scale: float | None) -> TetMesh:
    """A mesh with its coordinates multiplied; without a scale those of millimetres, for a body larger than any organ."""
    if scale is None:
        used = mesh.vertices[np.unique(mesh.tets)]
        extent = float(np.max(used.max(axis=0) - used.min(axis=0)))
        scale = 0.001 if extent > LARGEST_ORGAN else 1.0
        if scale != 1.0:
            warnings.warn(f"the mesh is {extent:.4g} across, more than any organ in metres: it was read as millimetres", stacklevel=4)
    if scale == 1.0:
        return mesh
    return TetMesh(
        mesh.vertices * scale,
        mesh.tets,
        regions=mesh.regions if mesh.regions.size else None,
        region_names=dict(mesh.region_names),
        vertex_sets=dict(mesh.vertex_sets),
    )


def _curved_volume(points: npt.NDArray[np.float64], tets: npt.NDArray[np.int64]) -> npt.NDArray[np.float64]:
    """Volumes of tets of ten nodes: the determinant of the quadratic map, a cubic, at five points that integrate it exactly."""
    edges = ((0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3))
    slopes = np.array([[-1, 1, 0, 0], [-1, 0, 1, 0], [-1, 0, 0, 1]], dtype=float)
    volumes = np.zeros(len(tets))
    places = [(np.full(4, 0.25), -0.8)] + [(np.where(np.arange(4) == i, 0.5, 1 / 6), 0.45) for i in range(4)]
    for at, weight in places:
        shape = np.concatenate([(4 * at - 1) * slopes, np.stack([4 * (at[i] * slopes[:, j] + at[j] * slopes[:, i]) for i, j in edges], axis=1)], axis=1)
        volumes += weight * np.linalg.det(np.einsum("ka,tac->tkc", shape, points[tets])) / 6
    return volumes


def _warn_of_corners(points: npt.NDArray[np.float64], curved: npt.NDArray[np.int64]) -> None:
    """Says what tets of ten nodes lose by their straight edges."""
    if not len(curved):
        return
    corners = points[curved[:, :4]]
    straight = np.linalg.det(corners[:, 1:] - corners[:, :1]) / 6
    lost = float(np.sum(np.sign(straight) * (_curved_volume(points, curved) - straight)))
    share = round(100 * lost / (float(np.abs(straight).sum()) + lost), 9) + 0.0
    warnings.warn(f"{len(curved)} tets of 10 nodes were taken by the corners: straight edges lose {share:.2g} % of their volume", stacklevel=4)


def _without_middles(mesh: TetMesh, curved: npt.NDArray[np.int64]) -> TetMesh:
    """The mesh without those nodes of tets of ten that no tet has as a corner."""
    middles = np.setdiff1d(curved[:, 4:], np.asarray(mesh.tets))
    if not len(middles):
        return mesh
    kept = np.setdiff1d(np.arange(len(mesh.vertices)), middles)
    place = np.zeros(len(mesh.vertices), dtype=np.int64)
    place[kept] = np.arange(len(kept))
    sets = {name: place[np.setdiff1d(vertices, middles)] for name, vertices in mesh.vertex_sets.items()}
    regions = mesh.regions if mesh.regions.size else None
    return TetMesh(mesh.vertices[kept], place[mesh.tets], regions=regions, region_names=dict(mesh.region_names), vertex_sets=sets)


def from_meshio(mesh: Any, scale: float | None = 1.0) -> TetMesh:
    """A mesh of meshio, with its tetrahedra, those of ten nodes by their corners; cell data "region" or those of Gmsh and MEDIT become
    regions, point sets vertex sets. Inverted tets are reoriented.

    :param scale: as that of `read_mesh`
    :raises ValueError: for a mesh without tetrahedra
    """
    blocks = [block for block in mesh.cells if block.type in ("tetra", "tetra10")]
    if not blocks:
        kinds = ", ".join(sorted({block.type for block in mesh.cells})) or "no cells"
        raise ValueError(f"the mesh has no tetrahedra (it has: {kinds}); mesh the volume first")
    regions = None
    for name in ("region", "gmsh:physical", "medit:ref"):
        if name in mesh.cell_data:
            kept = [data for data, block in zip(mesh.cell_data[name], mesh.cells, strict=True) if block in blocks]
            regions = np.concatenate(kept).astype(np.int64)
            break
    sets = {str(name): np.asarray(points) for name, points in (mesh.point_sets or {}).items()}
    vertices = np.asarray(mesh.points, dtype=float)
    curved = np.concatenate([np.zeros((0, 10), dtype=np.int64), *(b.data for b in blocks if b.type == "tetra10")])
    _warn_of_corners(vertices, curved)
    whole = TetMesh(vertices, np.concatenate([b.data[:, :4] for b in blocks]), regions=regions, vertex_sets=sets)
    return _scaled(_without_middles(whole, curved), scale)


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
