"""Figures show what they are given, and the examples run."""

import runpy
import sys
import tomllib
from pathlib import Path

import glisson
import matplotlib as mpl
import numpy as np
import pytest

mpl.use("Agg")
EXAMPLES = Path(__file__).parents[2] / "python/examples"
SCENE = {
    "mesh": {"kind": "box", "cells": [1, 1, 2]},
    "fixed": [{"set": "z_min"}],
    "tool": [{"set": "z_max", "velocity_mm_s": 10, "depth_mm": 1}],
    "variant": [{"name": "a"}, {"name": "b", "label": "hard", "tissue": {"youngs_modulus_Pa": 9000}}],
}


@pytest.fixture(scope="module")
def results():
    return glisson.run(SCENE)


def test_forces_are_drawn_as_they_are(results):
    """A line a run: depth in millimetres, the force column, the variant's label."""
    axes = glisson.plot.forces(results)
    for line, result in zip(axes.lines, results.values(), strict=True):
        assert np.array_equal(line.get_xdata(), 1e3 * result["depth_m"])
        assert np.array_equal(line.get_ydata(), result["force_N"]) and line.get_label() == result.label
    assert [text.get_text() for text in axes.get_legend().get_texts()] == ["a", "hard"]
    assert glisson.plot.forces(results.values(), against="time").get_xlabel() == "time [s]"
    with pytest.raises(ValueError, match="against"):
        glisson.plot.forces(results, against="speed")


def test_energies_and_laws(results):
    """Energies in millijoules; a law as its moduli in kilopascals."""
    axes = glisson.plot.energies(results["a"])
    assert np.array_equal(axes.lines[0].get_ydata(), 1e3 * results["a"]["work_tools_J"])
    axes = glisson.plot.laws([glisson.Tissue(name="x", law=glisson.LinearLaw(slope=1e4)), glisson.Tissue()], until=0.4)
    assert axes.lines[0].get_ydata()[-1] == pytest.approx(3.6 + 4) and axes.lines[1].get_ydata()[-1] == 3.6
    assert len(glisson.plot.laws(glisson.Tissue()).lines) == 1


def test_fits_are_drawn(scenes):
    """Measured and fitted curves, and a profile for every parameter."""
    result = glisson.fit(scenes / "fit" / "phantom_mean.toml", starts=2, bootstrap=0)
    axes = glisson.plot.repetitions(result)
    assert np.array_equal(axes.lines[0].get_ydata(), result.curves[0].measured)
    assert np.array_equal(axes.lines[-1].get_ydata(), result.curves[0].fitted)
    assert len(glisson.plot.profiles(result)) == len(result.parameters)
    with pytest.raises(ValueError, match="no curve was measured at 7"):
        glisson.plot.repetitions(result, velocity=7)


def test_the_papers_figures(tmp_path):
    """Figures 2, 3, 5 and 6 are drawn from the shipped scenes, with the curves that the paper has."""
    lines = []
    drawn = glisson.figures(names=("2", "3a", "3b"), out=tmp_path, progress=lines.append)
    assert lines == [f"figure {name}: running paper/figure{name}.toml" for name in ("2", "3a", "3b")]
    assert sorted(f.name for f in tmp_path.iterdir()) == ["figure2.pdf", "figure3a.pdf", "figure3b.pdf"]
    curves = {line.get_label(): line for line in drawn["2"].axes[0].lines}
    assert list(curves) == ["linear", "tissue 1, raw mean ratio, the paper's step", "tissue 2, raw mean ratio"]
    # the press of figure 2 goes on to 15 mm; both laws end stiffer than the line
    assert curves["linear"].get_xdata()[-1] == pytest.approx(15, rel=0.01)
    ends = [line.get_ydata()[-50:].mean() for line in curves.values()]
    assert ends[0] < ends[1] and ends[0] < ends[2]
    assert len(drawn["3a"].axes[0].lines) >= 3 and len(drawn["3b"].axes[0].lines) >= 3
    with pytest.raises(ValueError, match="no figure '4'; there are: 2, 3a"):
        glisson.figures(["4"])
    assert list(glisson.figures("2", progress=None)) == ["2"]


def test_figures_5_and_6(scenes):
    """A fit of five curves at 2 mm/s and what it says of five others, of 6 and of 10 mm/s: a short form of the shipped one."""
    folder = scenes / "fit"
    short = tomllib.loads((folder / "liver_velocity.toml").read_text(encoding="utf-8"))
    short |= {"search": {"starts": 1, "screen": 1}, "proof": {"profiles": False, "bootstrap": 0}}
    short["set"] |= {"mesh.radial_cells": 2, "mesh.axial_cells": 2, "motion.step_s": 0.04}
    short["forward"] = {"tolerance": 10}
    short["parameter"] = [p | {"start": s} for p, s in zip(short["parameter"], (4000, 15000, 1000), strict=True)]
    for data in short["data"]:
        data["resample"] = {"points": 8}
    result = glisson.fit(short, base=folder)
    drawn = glisson.figures(("5", "6"), result=result)
    assert [axes.get_title() for axes in drawn["5"].axes] == ["2 mm/s", "2 mm/s, others"]
    assert [axes.get_title() for axes in drawn["6"].axes] == ["6 mm/s", "10 mm/s"]
    for axes in (*drawn["5"].axes, *drawn["6"].axes):
        assert len(axes.lines) == 6
        measured, model = axes.lines[0].get_ydata(), axes.lines[-1].get_ydata()
        # the curves are of a finer mesh, with 4 % of scatter and 2 % of noise: the coarse one follows them to a fifth of the largest force
        assert np.abs(model - measured).max() < 0.2 * np.nanmax(measured)


@pytest.mark.parametrize("name", ["force_curve", "drive_a_needle"])
def test_examples_run(tmp_path, monkeypatch, name):
    """The examples run as scripts, write their figure, and a pushed needle pulls when it comes out."""
    monkeypatch.setattr(sys, "argv", [name, str(tmp_path)])
    names = runpy.run_path(str(EXAMPLES / f"{name}.py"))
    assert len(list(tmp_path.glob("*.pdf"))) == 1
    if name == "drive_a_needle":
        assert names["table"][:, -1].max() == pytest.approx(0.3, rel=0.05)  # its rupture force, read every ms
        assert names["table"][:, -1].min() < -0.05
    else:
        assert names["force"][-1] > 0.3
