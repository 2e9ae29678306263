"""The table of the commonest tasks in docs/python.md: its Python column runs, its scenes and commands are taken by the program.

The C++ column is compiled and run by tests/guide/side_by_side_test.cpp.
"""

import re
import shlex
import subprocess
from pathlib import Path

import glisson
import pytest

PAGE = Path(__file__).parents[2] / "docs/python.md"
FIT = "\n[search]\nstarts = 2\n\n[proof]\nprofiles = false\nbootstrap = 0\n"


def table():
    """Task: code of the three columns."""
    text = PAGE.read_text(encoding="utf-8").split("## Side by side")[1].split("\n## ")[0]
    rows = [line.strip("| ").split(" | ") for line in text.splitlines() if line.startswith("| ") and "`" in line]
    assert all(len(row) == 4 for row in rows)
    return {row[0]: [re.findall(r"`([^`]+)`", cell) for cell in row[1:]] for row in rows}


ROWS = table()


@pytest.fixture
def place(tmp_path, monkeypatch, scenes):
    """A folder with the files that the table names."""
    monkeypatch.chdir(tmp_path)
    millimetres = glisson.box_mesh(size=[40, 40, 80])
    glisson.write_vtu("liver.vtu", millimetres)
    meshio = pytest.importorskip("meshio")
    meshio.Mesh(millimetres.vertices, {"tetra": millimetres.tets}).write("liver.mesh")
    (tmp_path / "scene.toml").write_text(
        'mesh = { kind = "box", cells = [1, 1, 2] }\n[[fixed]]\nset = "z_min"\n'
        '[[tool]]\nset = "z_max"\nvelocity_mm_s = 20\ndepth_mm = 1\n',
        encoding="utf-8",
    )
    for name in ("phantom_mean.csv", "phantom_mean.toml"):
        (tmp_path / name).write_bytes((scenes / "fit" / name).read_bytes())
    (tmp_path / "fit.toml").write_text((tmp_path / "phantom_mean.toml").read_text(encoding="utf-8") + FIT, encoding="utf-8")
    return tmp_path


def names():
    """What the lines of the Python column take for granted."""
    meshio = pytest.importorskip("meshio")
    mesh = glisson.box_mesh()
    body = glisson.Simulation(mesh, glisson.Tissue())
    start = glisson.Pose(position=[0.005, 0.005, 0.081])
    known = {
        "glisson": glisson,
        "body": body,
        "set": [207, 211, 212],
        "m": meshio.Mesh(mesh.vertices, {"tetra": mesh.tets}),
        "g": glisson.to_pyvista(mesh),
        "options": glisson.NeedleOptions(),
        "driver": glisson.PathDriver(start, glisson.SteadyMotion()),
        "tissue": glisson.Tissue(youngs_modulus=7200),
        "times": [1, 2],
        "stretches": [1.05, 1.1],
        "frequencies": [1, 10],
        "twists": [5, 10],
    }
    known["tool"] = body.drive([224], glisson.PressMotion())
    return known


def test_the_python_column_runs(place):
    """Line by line, in the order of the table; what each gives is what its row says."""
    known = names()
    done = {}
    for task, (_, python, _) in ROWS.items():
        for line in python:
            value = eval(line, known)
            done.setdefault(task, value)
    assert len(done) == len(ROWS)
    assert done["a box"].tets.shape == (768, 4)
    assert done["a mesh file"].vertices[:, 2].max() == pytest.approx(0.08)
    assert glisson.law_value(done["a tissue with a law"].law, 3600, 0.1) == 5400
    assert done["a tissue with a source"] == glisson.tissue_preset("paper_liver").tissue
    assert done["its stress over stretch"].nominal[-1, 2, 2] == pytest.approx(720)
    mu = known["tissue"].lame()[1]
    assert done["its complex modulus"] == pytest.approx([mu, mu])
    assert done["a cylinder of it, twisted"].torque[-1] == pytest.approx(mu * 3.141592654 / 2 * 0.01**4 * 10)
    assert known["body"].tissue(0).youngs_modulus == 7200 and known["body"].steps == 1
    assert [result.end for result in done["run a scene"].values()] == ["finished"]
    assert max(done["fit a tissue to curves"].values()) > 100


def test_the_scene_column_is_a_scene(place, program):
    """The rows of keys together are scenes that the program runs: every mesh, tissue and tool of the table."""
    keys = {task: "\n".join(scene).replace("set = …", 'set = "z_max"') for task, (_, _, scene) in ROWS.items()}
    rate = ROWS["step, read forces"][2][0]
    press = keys["press"] + "\nvelocity_mm_s = 40\n"
    needle = keys["a needle"] + (
        "\ntip_m = [0.02, 0.02, 0.0805]\nrupture.force_N = 0.2\nfriction = { static_in_N_m = 20, dynamic_in_N_m = 10 }\n"
        '[instrument.motion]\nkind = "press"\ndepth_mm = 2\nvelocity_mm_s = 20\n'
    )
    for mesh, tissue, acts in (
        ("a box", "a tissue with a law", press),
        ("a mesh file", "a tissue with a source", press),
        ("a box", "a tissue with a source", needle),
    ):
        text = "\n".join([rate, keys[mesh], keys[tissue], keys["hold a side"], acts])
        (place / "table.toml").write_text(text, encoding="utf-8")
        command = [program, "run", "table.toml", "--out", place / "out"]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        assert done.returncode == 0, text + done.stdout + done.stderr
        [forces] = (place / "out").glob("**/forces.csv")
        assert len(forces.read_text(encoding="utf-8").splitlines()) > 20


def test_commands_run(place, program):
    """Rows whose third column is a command."""
    tests = ("its stress over stretch", "its complex modulus", "a cylinder of it, twisted")
    for task in (*tests, "run a scene", "fit a tissue to curves"):
        word, *arguments = shlex.split(ROWS[task][2][0])
        assert word == "glisson"
        done = subprocess.run([program, *arguments], capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stdout + done.stderr
