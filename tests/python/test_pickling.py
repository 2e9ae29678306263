"""What a program sends to another process arrives: tissues and all other options, meshes, results of runs and fits."""

import copy
import inspect
import pickle
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context

import glisson
import numpy as np
import pytest

SCENE = {
    "mesh": {"kind": "box", "cells": [2, 2, 2]},
    "tissue": {"youngs_modulus_Pa": 3600},
    "fixed": [{"set": "z_min"}],
    "tool": [{"set": "z_max", "velocity_mm_s": 10, "depth_mm": 1}],
}


def there_and_back(x):
    return pickle.loads(pickle.dumps(x))


def pressed(tissue, mesh):
    """In a process of its own: takes a tissue and a mesh, gives a result."""
    variant = glisson.parse_scene(SCENE).variants[0]
    variant.tissue = tissue
    return glisson._core.run_variant(variant, mesh)


def test_every_class_of_options_pickles():
    """Made anew from its fields, it is equal, whatever it holds."""
    classes = [c for _, c in inspect.getmembers(glisson, inspect.isclass) if hasattr(c, "_fields")]
    assert len(classes) > 40
    for made in (c() for c in classes):
        assert there_and_back(made) == made, made


def test_a_tissue_with_all_it_may_have_pickles():
    """Laws, branches and fibres are those that were sent."""
    for tissue in (
        glisson.Tissue(
            name="wall",
            law=glisson.ExponentialLaw(amplitude=600, rate=8),
            maxwell=[glisson.MaxwellBranch(share=0.3, time=1.86, time_law=glisson.ExponentialTime(rate=2))],
            fibres=glisson.Fibres(direction=[0, 1, 0]),
        ),
        glisson.tissue_preset("phantom_ef10_100t").tissue,
    ):
        assert there_and_back(tissue) == tissue == copy.deepcopy(tissue)
    assert there_and_back(glisson.tissue_preset("brain_miller").tissue).maxwell


def test_a_mesh_pickles():
    """Arrays, regions, their names, sets and fibres are those that were sent."""
    box = glisson.box_mesh(cells=[2, 2, 2])
    regions = np.arange(len(box.tets)) % 2
    fibres = np.tile([0.0, 0.0, 1.0], (len(box.tets), 1))
    mesh = glisson.TetMesh(
        box.vertices, box.tets, regions=regions, region_names={1: "lobe"}, vertex_sets=box.vertex_sets, fibres=fibres
    )
    for m in (box, mesh):
        sent = there_and_back(m)
        assert sent == m and sent.vertex_sets.keys() == m.vertex_sets.keys()
        assert np.array_equal(sent.regions, m.regions) and np.array_equal(sent.fibres, m.fibres)


def test_results_pickle():
    """A run in another process gives the bytes of one in this; only the description of its variant stays there."""
    mesh, tissue = glisson.box_mesh(cells=[2, 2, 4]), glisson.Tissue(youngs_modulus=2000)
    here = pressed(tissue, mesh)
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
        there = pool.submit(pressed, tissue, mesh).result()
    assert there.forces.to_csv() == here.forces.to_csv() and len(there.forces) > 5
    assert there.name == "main" and there.end == "finished" and there.trouble == ""
    assert there.summary["state_hash"] == here.summary["state_hash"]
    with pytest.raises(RuntimeError, match="unpickled"):
        there.variant  # noqa: B018
    kept = glisson.run(SCENE, frames=True)["main"]
    sent = there_and_back(kept)
    assert len(sent.frames) == len(kept.frames) > 1 and np.array_equal(sent.frames[-1][1], kept.frames[-1][1])
    assert sent.events == kept.events and sent.columns == kept.columns


def test_a_fit_pickles(scenes):
    """Parameters, curves and tissue are those that were found."""
    fit = glisson.fit(scenes / "fit" / "phantom_mean.toml", starts=4, bootstrap=0)
    sent = there_and_back(fit)
    assert sent.values == fit.values and sent.json == fit.json and sent.tissue_toml == fit.tissue_toml
