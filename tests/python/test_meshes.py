"""Meshes come from arrays, generators, files and PyVista, and wrong ones are refused with a reason."""

import glisson
import numpy as np
import pytest

CORNERS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=float)


def test_box_fills_its_volume():
    """The tets of a box have its volume together, whatever the split."""
    for split in ("kuhn", "alternating"):
        mesh = glisson.box_mesh(cells=[2, 3, 4], size=[0.1, 0.2, 0.3], split=split)
        assert mesh.volume == pytest.approx(0.006, rel=1e-12)
        assert mesh.tets.shape == (2 * 3 * 4 * 6, 4)


def test_default_box_is_that_of_figure_1():
    """The default is the paper's mesh: 225 vertices and 768 tets."""
    mesh = glisson.box_mesh()
    assert (len(mesh.vertices), len(mesh.tets)) == (225, 768)
    assert set(mesh.vertex_sets) == {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"}
    assert np.all(mesh.vertices[mesh.vertex_sets["z_min"], 2] == 0)


def test_cylinder_has_its_sets():
    """A cylinder knows bottom, top, wall and axis, and its wall is at the radius."""
    mesh = glisson.cylinder_mesh(radius=0.02, height=0.03, radial_cells=3, axial_cells=2)
    radius = np.hypot(*mesh.vertices[mesh.vertex_sets["wall"], :2].T)
    assert np.allclose(radius, 0.02, rtol=1e-12)


def test_arrays_come_back():
    """What a mesh was made of is what it gives back, without a copy and not to be written to."""
    mesh = glisson.TetMesh(
        CORNERS, [[0, 1, 2, 3]], regions=[7], region_names={7: "lobe"}, vertex_sets={"base": [2, 0, 1]}, fibres=[[0, 0, 1]]
    )
    assert np.array_equal(mesh.vertices, CORNERS)
    assert mesh.tets.tolist() == [[0, 1, 2, 3]] and mesh.regions.tolist() == [7]
    assert mesh.region_names == {7: "lobe"} and mesh.vertex_sets["base"].tolist() == [0, 1, 2]
    assert mesh.fibres.tolist() == [[0, 0, 1]]
    with pytest.raises(ValueError, match="read-only"):
        mesh.vertices[0] = 1
    assert mesh == glisson.TetMesh(
        mesh.vertices, mesh.tets, regions=mesh.regions, region_names=mesh.region_names,
        vertex_sets=mesh.vertex_sets, fibres=mesh.fibres,
    )  # fmt: skip


def test_view_outlives_the_mesh():
    """An array of a mesh keeps the mesh."""
    vertices = glisson.box_mesh().vertices
    assert vertices.sum() == glisson.box_mesh().vertices.sum()


def test_inverted_tets_are_turned_or_refused():
    """orient turns a tet over; without it the mesh is refused."""
    turned = glisson.TetMesh(CORNERS, [[0, 2, 1, 3]])
    assert turned.volume == pytest.approx(1 / 6)
    with pytest.raises(ValueError, match="0"):
        glisson.TetMesh(CORNERS, [[0, 2, 1, 3]], orient=False)


@pytest.mark.parametrize(
    ("vertices", "tets", "error", "message"),
    [
        (CORNERS[:, :2], [[0, 1, 2, 3]], ValueError, r"vertices has the shape \(4, 2\); expected \(n, 3\)"),
        (CORNERS, [[0, 1, 2]], ValueError, r"expected \(n, 4\)"),
        (CORNERS, [[0, 1, 2, -1]], ValueError, "-1"),
        (CORNERS, [[0, 1, 2, 9]], ValueError, "9"),
        (CORNERS, [[0, 1, 2, 0.5]], TypeError, "whole numbers"),
    ],
)
def test_wrong_arrays_are_refused(vertices, tets, error, message):
    """Shape, kind and range of arrays are checked before the engine sees them."""
    with pytest.raises(error, match=message):
        glisson.TetMesh(vertices, tets)


def test_generators_name_what_is_wrong():
    """The engine's message comes through: option, value, range."""
    with pytest.raises(ValueError, match="radius"):
        glisson.cylinder_mesh(radius=-1)
    with pytest.raises(TypeError, match="CylinderOptions: unknown field 'radios': did you mean 'radius'?"):
        glisson.cylinder_mesh(radios=1)


def test_masks_make_sets():
    """A set may be a mask over the vertices."""
    mesh = glisson.box_mesh()
    mesh = mesh.with_set("upper", mesh.vertices[:, 2] > 0.04)
    assert len(mesh.vertex_sets["upper"]) == 25 * 4


def test_surface_and_report():
    """The boundary of a box is closed, and a sound mesh has no warnings."""
    mesh = glisson.box_mesh()
    triangles = mesh.boundary_triangles()
    report = mesh.inspect()
    assert len(triangles) == report.boundary_triangles == 2 * (4 * 4 * 2 + 4 * 8 * 4)
    assert report.warnings == [] and report.pieces == 1
    assert "768" in glisson.format_report("box", report, mesh)


def test_vtu_round_trip(tmp_path):
    """A mesh that is written and read again is the same, sets and regions with it."""
    mesh = glisson.TetMesh(
        CORNERS, [[0, 1, 2, 3]], regions=[2], region_names={2: "lobe"}, vertex_sets={"base": [0, 1, 2]}
    )
    glisson.write_vtu(tmp_path / "a.vtu", mesh, vertex_fields={"height_m": CORNERS[:, 2]})
    assert glisson.read_mesh(tmp_path / "a.vtu") == mesh
    with pytest.raises(RuntimeError, match="none.vtu"):
        glisson.read_mesh(tmp_path / "none.vtu")


def test_meshio_formats(tmp_path):
    """A format that only meshio knows gives the same tets, scaled."""
    meshio = pytest.importorskip("meshio")
    mesh = glisson.box_mesh(cells=[1, 1, 2])
    block = meshio.Mesh(1e3 * mesh.vertices, [("tetra", mesh.tets.astype(int))])
    block.write(tmp_path / "box.mesh")
    read = glisson.read_mesh(tmp_path / "box.mesh", scale=1e-3)
    assert np.allclose(read.vertices, mesh.vertices, atol=1e-15) and np.array_equal(read.tets, mesh.tets)
    with pytest.raises(ValueError, match="no tetrahedra"):
        glisson.from_meshio(meshio.Mesh(CORNERS, [("triangle", [[0, 1, 2]])]))


def test_any_format_is_converted(tmp_path):
    """Meshes of Medit, in millimetres, of Gmsh 4.0 and of Gmsh 1 become .vtu that the program reads: the same tets, regions and sets."""
    meshio = pytest.importorskip("meshio")
    mesh = glisson.box_mesh(cells=[1, 1, 2])
    block = meshio.Mesh(1e3 * mesh.vertices, [("tetra", mesh.tets.astype(int))])
    block.write(tmp_path / "box.mesh")
    with pytest.warns(UserWarning, match="read as millimetres"):
        report = glisson.convert(tmp_path / "box.mesh", tmp_path / "box.vtu", scale=None)
    read = glisson.read_mesh(tmp_path / "box.vtu")
    assert np.allclose(read.vertices, mesh.vertices, atol=1e-15) and np.array_equal(read.tets, mesh.tets)
    assert report.tets == 12 and report.warnings == []
    meshio.gmsh.write(tmp_path / "v40.msh", meshio.Mesh(mesh.vertices, block.cells), "4.0", binary=False)
    assert glisson.convert(tmp_path / "v40.msh", tmp_path / "v40.vtu").volume == pytest.approx(mesh.volume)
    nodes = [f"{i + 5} {x} {y} {z}" for i, (x, y, z) in enumerate(mesh.vertices)]
    tets = [f"{i + 2} 4 {7 + i % 2} 1 4 " + " ".join(str(v + 5) for v in tet) for i, tet in enumerate(mesh.tets)]
    lines = ["$NOD", str(len(nodes)), *nodes, "$ENDNOD", "$ELM", "13", "1 2 4 1 3 5 6 7", *tets, "$ENDELM"]
    (tmp_path / "v1.msh").write_text("\n".join(lines) + "\n")
    glisson.convert(tmp_path / "v1.msh", tmp_path / "v1.vtu")
    read = glisson.read_mesh(tmp_path / "v1.vtu")
    assert np.array_equal(read.tets, mesh.tets) and read.regions.tolist() == 6 * [7, 8]
    assert read.vertex_sets["surface_4"].tolist() == [0, 1, 2]
    (tmp_path / "v1.msh").write_text("\n".join(lines[:-3]) + "\n")
    with pytest.raises(ValueError, match=r"v1.msh: \$ELM, element 1"):
        glisson.read_mesh(tmp_path / "v1.msh")
    with pytest.raises(ValueError, match="written as .vtu"):
        glisson.convert(tmp_path / "box.mesh", tmp_path / "box.vtk")


def test_curved_tets_are_taken_by_their_corners():
    """A tet of ten nodes with an edge that bulges by 0.05 has 11/60 of volume, of which its corners keep 1/6: 9.1 % are lost."""
    meshio = pytest.importorskip("meshio")
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=float)
    middles = np.array([[0.5, 0, 0], [0.55, 0.55, 0], [0, 0.5, 0], [0, 0, 0.5], [0.5, 0, 0.5], [0, 0.5, 0.5]])
    with pytest.warns(UserWarning, match=r"1 tets of 10 nodes were taken by the corners: straight edges lose 9\.1 %"):
        mesh = glisson.from_meshio(meshio.Mesh(np.vstack([corners, middles]), [("tetra10", np.arange(10)[None])]))
    assert len(mesh.vertices) == 4 and mesh.volume == pytest.approx(1 / 6)


def test_pyvista_both_ways():
    """A grid of PyVista and back is the same mesh."""
    pytest.importorskip("pyvista")
    mesh = glisson.box_mesh(cells=[1, 1, 1])
    grid = glisson.to_pyvista(mesh, vertex_fields={"x": mesh.vertices[:, 0]}, tet_fields={"i": np.arange(6)})
    assert grid.volume == pytest.approx(mesh.volume, rel=1e-6)
    back = glisson.from_pyvista(grid)
    assert np.array_equal(back.vertices, mesh.vertices) and np.array_equal(back.tets, mesh.tets)
    assert {k: v.tolist() for k, v in back.vertex_sets.items()} == {k: v.tolist() for k, v in mesh.vertex_sets.items()}
