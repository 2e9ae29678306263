"""Probes in Python: the readings of a body built by hand, of a scene's body, and the columns of a run."""

import pickle
import subprocess

import glisson
import numpy as np
import pytest

SCENE = {
    "mesh": {"kind": "box", "cells": [2, 2, 3], "size_m": [0.02, 0.02, 0.03]},
    "tissue": {"youngs_modulus_Pa": 3000, "poisson_ratio": 0.3},
    "motion": {"integrator": "quasi_static", "step_s": 0.05},
    "fixed": [{"set": "z_min"}],
    "tool": [{"set": "z_max", "velocity_mm_s": 10, "depth_mm": 2}],
    "probe": [
        {"name": "tip", "point_m": [0.011, 0.01, 0.02]},
        {"name": "cut", "plane_m": {"point": [0, 0, 0.0123], "normal": [0, 0, 1]}},
    ],
    "output": {"frames": 0},
}


def test_a_uniform_state_is_read_exactly():
    """Of a linear field point, region, set and section read the same strain, displacement and stress."""
    body = glisson.Simulation(glisson.box_mesh(cells=[2, 2, 2], size=[0.02, 0.02, 0.02]), glisson.Tissue(poisson_ratio=0.25))
    places = {
        "p": glisson.ProbePoint(position=[0.011, 0.012, 0.013]),
        "r": glisson.ProbeRegion(region="0"),
        "s": glisson.ProbeSet(set="z_max"),
        "c": glisson.ProbePlane(point=[0, 0, 0.013], normal=[0, 0, 2]),
    }
    probes = glisson.Probes(body, places)
    u = body.mesh.vertices * [0.0, 0.0, -0.01]
    body.set_state(u, 0 * u)
    read = probes.read()
    assert list(read) == probes.columns and probes.lost == []
    stress = -0.01 * 1.2 * body.tissue().youngs_modulus  # (1 − ν)/((1 + ν)(1 − 2ν)) of ν = ¼
    assert read["p_stress_zz_Pa"] == pytest.approx(stress, rel=1e-12) == read["r_stress_zz_Pa"]
    assert read["c_traction_z_Pa"] == pytest.approx(stress, rel=1e-12)
    assert read["s_displacement_z_m"] == pytest.approx(-2e-4, rel=1e-12)
    assert read["r_volume_m3"] == pytest.approx(8e-6 * 0.99, rel=1e-12)
    body.remove_tets(np.arange(len(body.mesh.tets)))
    assert np.isnan(probes.read()["r_volume_m3"]) and probes.lost == ["p", "r", "s", "c"]


def test_the_distance_of_a_tip():
    """A ball comes nearer through air: along is the way that is left to the point, across stays; a tip of no place is refused."""
    body = glisson.Simulation(glisson.box_mesh(cells=[2, 2, 2], size=[0.02, 0.02, 0.02]), glisson.Tissue())
    body.fix("z_min")
    path = glisson.PathDriver(glisson.Pose(position=[0.013, 0.01, 0.05]), glisson.SteadyMotion(velocity=0.1))
    ball = glisson.ContactTool(glisson.ContactOptions(name="ball"), path)
    body.attach(ball)
    places = {"tumour": glisson.ProbePoint(position=[0.01, 0.01, 0.01]), "other": glisson.ProbeRegion(region="0")}
    probes = glisson.Probes(body, places, {"tumour": ball})
    assert [c for c in probes.columns if "_tip_" in c] == [f"tumour_tip_{x}_m" for x in ("distance", "along", "across")]
    for time in (0.0, 0.05):
        body.advance(until=time)
        read = probes.read()
        assert read["tumour_tip_along_m"] == pytest.approx(0.04 - ball.depth, abs=1e-12)
        assert read["tumour_tip_across_m"] == pytest.approx(0.003, abs=1e-12)
        assert read["tumour_tip_distance_m"] == pytest.approx(np.hypot(0.04 - ball.depth, 0.003), abs=1e-12)
    assert ball.depth > 0.004
    with pytest.raises(KeyError, match="tumor"):
        glisson.Probes(body, places, {"tumor": ball})


def test_the_probes_of_a_scene():
    """A run has probes.csv as a table, row by row with forces; the scene's body reads the same by hand."""
    run = glisson.run(SCENE)["main"]
    assert run.probes.columns[0] == "time_s" and len(run.probes["time_s"]) == len(run.forces["time_s"])
    assert run.probes["cut_force_z_N"][-1] == pytest.approx(run["force_z_N"][-1], rel=1e-6), "static: the tool's force"
    again = pickle.loads(pickle.dumps(run))
    assert np.array_equal(again.probes["tip_stress_zz_Pa"], run.probes["tip_stress_zz_Pa"])
    assert glisson.parse_scene(glisson.to_toml(SCENE)).variants[0].probes == ["tip", "cut"]
    body = glisson.simulation(SCENE)
    while body.time < run.probes["time_s"][-1] - 1e-9:
        body.step()
    assert body.probes.read()["tip_displacement_z_m"] == run.probes["tip_displacement_z_m"][-1]
    plain = glisson.run({key: value for key, value in SCENE.items() if key != "probe"})["main"]
    assert plain.probes.columns == []


def test_probes_csv_is_that_of_the_program(program, tmp_path):
    """What `out=` writes has the bytes of `glisson run`."""
    (tmp_path / "s.toml").write_text(glisson.to_toml(SCENE), encoding="utf-8")
    subprocess.run([program, "run", tmp_path / "s.toml", "--out", tmp_path / "a", "--quiet"], check=True, capture_output=True)
    glisson.run(SCENE, out=tmp_path / "b")
    assert (tmp_path / "a/main/probes.csv").read_text() == (tmp_path / "b/main/probes.csv").read_text()


def test_what_is_not_there_is_refused():
    """A place outside of the body names the nearest point; what is no place is a TypeError."""
    body = glisson.Simulation(glisson.box_mesh(), glisson.Tissue())
    with pytest.raises(ValueError, match=r'probe "far".*outside of the body.*nearest point'):
        glisson.Probes(body, {"far": glisson.ProbePoint(position=[0, 0, 1])})
    with pytest.raises(TypeError, match="expected a ProbePoint, ProbeSet, ProbeRegion or ProbePlane"):
        glisson.Probes(body, {"far": [0, 0, 1]})
    assert body.probes.columns == [] and body.probes.read() == {}


def test_refined_meshes():
    """Every tet in eight: the same volume and sets that cover the same faces."""
    mesh = glisson.box_mesh(cells=[2, 2, 2])
    fine = mesh.refined()
    assert len(fine.tets) == 8 * len(mesh.tets) and fine.volume == pytest.approx(mesh.volume, rel=1e-12)
    assert len(fine.vertex_sets["z_max"]) == 25
