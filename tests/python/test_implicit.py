"""Bodies of shapes: distances, meshes of several regions, any function of a point, the liver."""

import glisson
import numpy as np
import pytest


def test_a_body_of_two_regions_is_meshed():
    core = glisson.Solid(glisson.BallShape(radius=0.02))
    body = glisson.unite([core, glisson.Solid(glisson.BoxShape(size=[0.06, 0.05, 0.05], rounding=0.01))], blend=0.005)
    mesh, report = glisson.mesh_regions([glisson.BodyRegion("core", core), glisson.BodyRegion("body", body)], edge=0.005)
    assert set(np.unique(mesh.regions)) == {1, 2}
    assert mesh.region_names == {1: "core", 2: "body"}
    assert report.min_dihedral_deg >= 10 and report.max_dihedral_deg <= 165
    assert report.regions[0].volume == pytest.approx(4 / 3 * np.pi * 0.02**3, rel=0.01)
    assert sum(r.volume for r in report.regions) == pytest.approx(mesh.volume)
    assert sum(mesh.dihedral_histogram()) == 6 * len(mesh.tets)
    assert 0.4 < glisson.relative_stable_step(mesh, 0.005) < 1


def test_a_mesh_is_finer_where_sizes_ask_for_it():
    regions = [glisson.BodyRegion("core", glisson.Solid(glisson.BallShape(radius=0.01))),
               glisson.BodyRegion("ball", glisson.Solid(glisson.BallShape(radius=0.04)))]  # fmt: skip
    sizes = [glisson.MeshSize(edge=0.004, near="core"), glisson.MeshSize(edge=0.004, path=[glisson.PathPoint(at=[0, 0, 0.04])])]
    mesh, report = glisson.mesh_regions(regions, edge=0.008, sizes=sizes, growth=0.4)
    assert report.min_dihedral_deg >= 10 and report.max_dihedral_deg <= 165
    edges = glisson.edges_asked(mesh, regions, edge=0.008, sizes=sizes, growth=0.4)
    assert edges.shape == (len(mesh.tets),)
    assert edges.min() == pytest.approx(0.004) and edges.max() == pytest.approx(0.008)
    assert glisson.relative_stable_step(mesh, edges) > 0.3
    with pytest.raises(ValueError, match="no region of the mesh"):
        glisson.mesh_regions(regions, edge=0.008, sizes=[glisson.MeshSize(edge=0.004, near="cor")])


def test_a_size_is_any_function_of_a_point():
    regions = [glisson.BodyRegion("ball", glisson.Solid(glisson.BallShape(radius=0.04)))]
    asked = {"edge": 0.01, "size_at": lambda p: 0.004 if np.linalg.norm(p) < 0.012 else 0.01}
    mesh, report = glisson.mesh_regions(regions, **asked)
    assert report.min_dihedral_deg >= 10 and report.max_dihedral_deg <= 165
    edges = glisson.edges_asked(mesh, regions, **asked)
    assert set(np.unique(edges)) == {0.004, 0.01}
    corners = mesh.vertices[mesh.tets]
    pairs = [(i, j) for i in range(4) for j in range(i)]
    lengths = np.mean([np.linalg.norm(corners[:, i] - corners[:, j], axis=1) for i, j in pairs], axis=0)
    middle = np.linalg.norm(corners.mean(axis=1), axis=1) < 0.008
    assert lengths[middle].mean() == pytest.approx(0.004, rel=0.05)
    with pytest.raises(TypeError, match=r"size_at: gave no number at \(.*\) m; return a float in metres"):
        glisson.mesh_regions(regions, edge=0.01, size_at=lambda p: "fine")
    with pytest.raises(ValueError, match=r"size_at gives -1 m at \("):
        glisson.mesh_regions(regions, edge=0.01, size_at=lambda p: -1.0)
    with pytest.raises(ZeroDivisionError):
        glisson.mesh_regions(regions, edge=0.01, size_at=lambda p: 1 / 0)


def test_any_function_of_a_point_is_a_solid():
    wavy = glisson.Solid.from_function(lambda p: float(np.linalg.norm(p)) - 0.02, [-0.02] * 3, [0.02] * 3)
    assert wavy.distance([0.03, 0, 0]) == pytest.approx(0.01)
    mesh, _ = glisson.mesh_regions([glisson.BodyRegion("ball", wavy)], edge=0.01)
    assert len(mesh.tets) > 50


def test_a_cylinder_goes_from_one_end_to_the_other():
    cylinder = glisson.Solid(glisson.CylinderShape(from_=[0, 0, -1], to=[0, 0, 1], radius=2))
    assert cylinder.distance([0, 0, 1.5]) == pytest.approx(0.5)
    assert repr(glisson.CylinderShape()).startswith("CylinderShape(from_=")


def test_solids_combine_and_move():
    ball = glisson.Solid(glisson.BallShape(radius=1))
    other = ball.placed(move=[1, 0, 0])
    assert (ball | other).distance([2.5, 0, 0]) == pytest.approx(0.5)
    assert (ball & other).distance([0.5, 0, 0]) == pytest.approx(-0.5)
    assert (ball - other).distance([0.5, 0, 0]) == pytest.approx(0.5)
    low, high = (ball | other).bounds
    assert list(low) == [-1, -1, -1] and list(high) == [2, 1, 1]


CUBE = np.array([[i & 1, i >> 1 & 1, i >> 2] for i in range(8)], dtype=float)
FACES = [[0, 2, 1], [1, 2, 3], [4, 5, 6], [5, 7, 6], [0, 1, 4], [1, 5, 4], [2, 6, 3], [3, 6, 7], [0, 4, 2], [2, 4, 6],
         [1, 3, 5], [3, 7, 5]]  # fmt: skip


def test_a_closed_surface_is_a_solid(tmp_path):
    cube = glisson.surface_solid(CUBE, FACES)
    assert cube.distance([0.5, 0.5, 0.75]) == pytest.approx(-0.25)
    assert (cube | cube.placed(move=[1, 0, 0])).distance([3, 0.5, 0.5]) == pytest.approx(1)
    file = tmp_path / "cube.obj"
    lines = [f"v {x} {y} {z}" for x, y, z in 40 * CUBE] + [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in FACES]
    file.write_text("\n".join(lines))
    points, triangles = glisson.read_surface(file, scale=0.001)
    np.testing.assert_allclose(points, 0.04 * CUBE)
    np.testing.assert_array_equal(triangles, FACES)
    mesh, _ = glisson.mesh_regions([glisson.BodyRegion("cube", glisson.surface_solid(points, triangles))], edge=0.01)
    assert mesh.volume == pytest.approx(64e-6, rel=0.01)
    with pytest.raises(ValueError, match="is open at 3 edges"):
        glisson.surface_solid(CUBE, FACES[1:])
    with pytest.raises(ValueError, match=r"cube.obj:21: expected x of a vertex"):
        file.write_text("\n".join([*lines, "v x"]))
        glisson.read_surface(file)


def test_a_surface_as_it_comes_is_closed():
    """A triangle that is there twice is left out, and told; a surface that closes is as it was; a large hole is refused."""
    points, triangles, text = glisson.repair_surface(CUBE, [*FACES, FACES[4]])
    np.testing.assert_array_equal(triangles, FACES)
    assert text.startswith("1 double triangle was left out, at (")
    assert glisson.surface_solid(points, triangles).distance([0.5, 0.5, 0.75]) == pytest.approx(-0.25)
    assert glisson.repair_surface(CUBE, FACES)[2] == ""
    with pytest.raises(ValueError, match=r"has a hole of 9\.091 % of its area, 3 edges around"):
        glisson.repair_surface(CUBE, FACES[1:])


def test_what_cannot_be_meshed_is_named():
    ball = glisson.BodyRegion("ball", glisson.Solid(glisson.BallShape(radius=0.01)))
    with pytest.raises(ValueError, match="smaller edge"):
        glisson.mesh_regions([ball], edge=0.1)
    with pytest.raises(ValueError, match="radius"):
        glisson.Solid(glisson.BallShape(radius=-1))


def test_the_liver_has_its_regions_and_sets():
    mesh, report = glisson.liver_mesh(edge=0.012, tumour_radius=0.015)
    assert [r.name for r in report.regions][0] == "tumour"
    assert mesh.volume == pytest.approx(1.5e-3, rel=0.05)
    assert {"bare_area", "dome", "visceral_face", "falciform_ligament"} <= set(mesh.vertex_sets)


def test_the_liver_has_a_gallbladder_where_it_is_asked_for():
    mesh, report = glisson.liver_mesh(edge=0.012, gallbladder=True)
    volume = {r.name: r.volume for r in report.regions}
    assert volume["gallbladder"] == pytest.approx(33e-6, rel=0.1)
    assert "gallbladder" in mesh.vertex_sets
