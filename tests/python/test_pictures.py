"""Charts and pictures of a run's folder, drawn without a display, by the package and by the program alike."""

from __future__ import annotations

import base64
import json
import os
import re
import shutil
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
import zlib
from pathlib import Path

import glisson
import matplotlib as mpl
import numpy as np
import pytest
from glisson._fit_charts import fit_charts

mpl.use("Agg")
PICTURES = Path(__file__).parent / "pictures"
# A ball pressed into a block on a table: contact pressure under it, displacement that fades with depth.
SCENE = """
title = "A ball on a block"
[mesh]
kind = "box"
cells = [8, 8, 6]
size_m = [0.04, 0.04, 0.03]
[tissue]
youngs_modulus_Pa = 3000
[motion]
damping_rate_per_s = 50
[[fixed]]
set = "z_min"
[[instrument]]
kind = "ball"
name = "ball"
tip_m = [0.02, 0.02, 0.0305]
radius_mm = 8
motion = { kind = "press", depth_mm = 5, velocity_mm_s = 25, ramp_s = 0.02 }
[output]
frames = 3
[[variant]]
name = "soft"
[[variant]]
name = "hard"
label = "three times as stiff"
tissue.youngs_modulus_Pa = 9000
"""
#: Both pictures that are kept, by what they are drawn with.
KEPT = {
    "displacement_cut": {"colour": "displacement", "cut": "y=20mm"},
    "contact_pressure": {"colour": "contact_pressure", "tools": False},
}


@pytest.fixture(scope="module")
def out(program, tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("run")
    (folder / "ball.toml").write_text(SCENE, encoding="utf-8")
    subprocess.run([program, "run", "ball.toml", "--out", "out", "--quiet"], cwd=folder, check=True)
    return folder / "out"


def channels(file: Path) -> np.ndarray:
    """Red, green and blue in 0 … 1 on white, means over blocks of 4 × 4 pixels."""
    image = mpl.image.imread(file)
    colours = image[..., :3]
    if image.shape[2] == 4:
        colours = colours * image[..., 3:] + 1 - image[..., 3:]
    h, w = (4 * (n // 4) for n in colours.shape[:2])
    return colours[:h, :w].reshape(h // 4, 4, w // 4, 4, 3).mean(axis=(1, 3)).transpose(2, 0, 1)


def structure(a: np.ndarray, b: np.ndarray) -> float:
    """Structural similarity (Wang et al. 2004) over windows of 7 × 7, of the channel that differs most: 1 for equal pictures."""
    c1, c2 = 0.01**2, 0.03**2
    found = []
    for one, other in zip(a, b, strict=True):
        windows = [np.lib.stride_tricks.sliding_window_view(x, (7, 7)) for x in (one, other)]
        ma, mb = (w.mean(axis=(2, 3)) for w in windows)
        va, vb = (w.var(axis=(2, 3)) for w in windows)
        both = (windows[0] * windows[1]).mean(axis=(2, 3)) - ma * mb
        similar = (2 * ma * mb + c1) * (2 * both + c2) / ((ma**2 + mb**2 + c1) * (va + vb + c2))
        found.append(float(similar[(va + vb) > 1e-5].mean()))  # white beside white says nothing
    return min(found)


@pytest.mark.parametrize("name", KEPT)
def test_pictures_have_the_structure_that_was_looked_at(out, tmp_path, name):
    """Body, cut, field and tool lie where they lay in the picture that was looked at; another field or cut does not pass."""
    file = tmp_path / f"{name}.png"
    glisson.picture(out, size=(480, 360), labels=False, file=file, **KEPT[name])
    if os.environ.get("GLISSON_KEEP_PICTURES"):
        PICTURES.joinpath(f"{name}.png").write_bytes(file.read_bytes())
    kept = channels(PICTURES / f"{name}.png")
    # Versions of NumPy move a pixel at an edge, instruction sets a value in its sixth digit: 0.99 and more.
    assert structure(channels(file), kept) > 0.97
    for changed in ({"colour": "von_mises"}, {"cut": "x=30mm"}, {"frame": 0}):
        glisson.picture(out, size=(480, 360), labels=False, file=file, **(KEPT[name] | changed))
        assert structure(channels(file), kept) < 0.93, changed


def test_values_of_a_picture_are_those_of_the_frame(out):
    """On a face through the body a linear field is exact: q x over the cut has the colours of the scale at their places."""
    from glisson._raster import rasterise

    corners = np.array([[[0, 0, 1], [200, 0, 1], [0, 200, 1]], [[50, 50, 0], [60, 50, 0], [50, 60, 0]]], dtype=float)
    seen = rasterise(corners, 200, 200)
    inside = np.add.outer(np.arange(200), np.arange(200)) < 199
    assert (seen.triangle >= 0).sum() == pytest.approx(inside.sum(), abs=200)  # of a border a pixel wide
    x = np.einsum("ijk,k->ij", seen.weights, corners[0, :, 0])
    rows, columns = np.nonzero(seen.triangle == 0)
    assert np.abs(x[rows, columns] - (columns + 0.5)).max() < 1e-9
    assert (seen.triangle[50:54, 50:54] == 1).all(), "the nearer one is seen"


def with_cells(file: Path, name: str, values: np.ndarray) -> None:
    """Gives a frame one more array of its tets, in the encoding of the others."""
    text = file.read_bytes()
    begin = text.index(b"_", text.index(b"<AppendedData")) + 1
    end = text.index(b"</AppendedData>")
    body = text[begin:end].rstrip()
    raw = values.astype("<f8").tobytes()
    packed = zlib.compress(raw)
    head = np.array([1, len(raw), 0, len(packed)], "<u8").tobytes()
    added = f'<DataArray type="Float64" Name="{name}" NumberOfComponents="1" format="appended" offset="{len(body)}"/>'
    front = text[:begin].replace(b"</CellData>", added.encode() + b"</CellData>")
    file.write_bytes(front + body + base64.b64encode(head) + base64.b64encode(packed) + text[end:])


def test_a_run_of_heat_is_coloured_by_temperature(program, tmp_path):
    """Without a displacement the body stays at rest, and its cut face has the temperatures of the frame."""
    scene = """
[mesh]
kind = "box"
cells = [6, 6, 6]
size_m = [0.03, 0.03, 0.03]
[heat]
duration_s = 60
[[heat.tissue]]
preset = "agar"
[[heat.boundary]]
set = "x_min"
temperature_C = -60
[output]
frames = 2
"""
    (tmp_path / "s.toml").write_text(scene, encoding="utf-8")
    subprocess.run([program, "run", "s.toml", "--out", "o", "--quiet"], cwd=tmp_path, check=True)
    figure = glisson.picture(tmp_path / "o", cut="y=15mm", size=(400, 300), file=tmp_path / "p.png")
    words = " ".join(text.get_text() for text in figure.findobj(mpl.text.Text))
    assert "temperature" in words and "°C" in words
    assert (tmp_path / "p.png").stat().st_size > 2000
    with pytest.raises(ValueError, match="no von_mises_Pa"):
        glisson.picture(tmp_path / "o", colour="von_mises")


def test_removed_tets_are_not_drawn(out, tmp_path):
    """Tets that `removed` names are gone from the picture, its cut and its colour scale."""
    from glisson._frames import read_frame

    folder = tmp_path / "out"
    shutil.copytree(out, folder)
    whole = read_frame(folder, "soft", 2)
    upper = whole.rest[whole.tets].mean(axis=1)[:, 2] > 0.015
    with_cells(folder / "soft/frames/frame_0002.vtu", "removed", upper)
    left = read_frame(folder, "soft", 2)
    assert np.array_equal(left.tets, whole.tets[~upper]) and "removed" not in left.cells
    assert np.array_equal(left.cells["von_mises_Pa"], whole.cells["von_mises_Pa"][~upper])
    for cut in (None, "x=0.02"):
        drawn = [channels(_drawn(where, tmp_path, cut)) for where in (out, folder)]
        body = [(np.ptp(one, axis=0) > 0.02).sum() for one in drawn]  # blocks of pixels that have colour
        assert structure(*drawn) < 0.9 and 0 < body[1]
    with pytest.raises(ValueError, match="nothing of the body is left"):
        glisson.picture(folder, cut="z=16mm", flip=True, variant="soft")


def _drawn(out: Path, folder: Path, cut: str | None) -> Path:
    file = folder / "drawn.png"
    glisson.picture(out, variant="soft", frame=2, tools=False, labels=False, size=(480, 360), cut=cut, file=file)
    return file


def test_program_and_package_draw_the_same(program, out, tmp_path):
    """`glisson picture` and `glisson plot` run the package's own files, with no display: the same bytes."""
    environment = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "PYTHONPATH")}
    environment |= {"GLISSON_PYTHON": sys.executable}
    by_program = tmp_path / "program.png"
    words = [program, "picture", out, "--frame", "2", "--colour", "von_mises", "--cut", "x=0.02", "--size", "320x240"]
    told = subprocess.run([*words, "--file", by_program], env=environment, check=True, capture_output=True, text=True)
    assert told.stdout == f"wrote {by_program}\n"
    by_package = tmp_path / "package.png"
    glisson.picture(out, frame=2, colour="von_mises", cut="x=0.02", size=(320, 240), file=by_package)
    assert by_program.read_bytes() == by_package.read_bytes()
    assert mpl.image.imread(by_program).shape[:2] == (240, 320)
    told = subprocess.run([program, "plot", out, "--svg", "--pdf"], env=environment, check=True, capture_output=True, text=True)
    assert sorted(line.split("/")[-1] for line in told.stdout.split()[1::2]) == [
        "force-against-depth.pdf",
        "force-against-depth.svg",
        "force-against-time.pdf",
        "force-against-time.svg",
    ]


def test_charts_have_lines_names_and_marks(out, tmp_path):
    """A chart as SVG has a path for each variant, its name, the labels of the axes, and a ring for each event."""
    files = glisson.plot.run(out, tmp_path, formats=["svg"], chart="depth")
    assert [f.name for f in files] == ["force-against-depth.svg"]
    text = files[0].read_text(encoding="utf-8")
    letters = [node.text for node in ElementTree.fromstring(text).iter("{http://www.w3.org/2000/svg}text")]
    for wanted in ("soft", "three times as stiff", "Depth [mm]", "Force [N]"):
        assert any(wanted in (row or "") for row in letters), (wanted, letters)
    assert "<image" not in text
    long = [d for d in re.findall(r'<path d="([^"]*)"', text) if len(d) > 400]
    assert len(long) == 2


FIT = """
[specimen]
kind = "block"
width_mm = 20
depth_mm = 20
height_mm = 20
[tissue]
hyperelastic = { kind = "neo_hookean", mu_Pa = 3000, bulk_modulus_Pa = 1e6 }
[[parameter]]
key = "tissue.hyperelastic.mu_Pa"
low = 100
high = 1e5
[search]
starts = 2
[proof]
bootstrap = 0
[[data]]
name = "slow"
files = ["a.csv"]
[[data]]
name = "fast"
files = ["b.csv"]
use = "test"
"""


def test_charts_of_a_fit(program, tmp_path):
    """A fit's folder has a chart of measured and simulated curves for each group, and one of their residuals, as numbers of fit.json."""
    rows = [(0.5 * i, 0.1 * i, 0.02 * i + 0.0004 * i * i + 0.002 * (-1) ** i) for i in range(41)]
    for name, factor in (("a", 1.0), ("b", 1.1)):
        lines = [f"{t:.3f},{d:.4f},{factor * f:.5f}" for t, d, f in rows]
        (tmp_path / f"{name}.csv").write_text("time (s),displacement (mm),force (N)\n" + "\n".join(lines) + "\n", encoding="utf-8")
    (tmp_path / "f.toml").write_text(FIT, encoding="utf-8")
    subprocess.run([program, "fit", "f.toml", "--out", "out", "--quiet"], cwd=tmp_path, check=True, capture_output=True)
    environment = os.environ | {"GLISSON_PYTHON": sys.executable}
    told = subprocess.run([program, "plot", "out", "--svg"], cwd=tmp_path, env=environment, check=True, capture_output=True, text=True)
    names = ["slow.svg", "fast.svg", "residuals-of-slow.svg", "residuals-of-fast.svg"]
    assert told.stdout.split()[1::2] == [f"out/plots/{name}" for name in names]
    by_package = glisson.plot.run(tmp_path / "out", tmp_path / "package")
    assert [f.name for f in by_package] == names
    for file in by_package:
        text = file.read_text(encoding="utf-8")
        letters = [node.text or "" for node in ElementTree.fromstring(text).iter("{http://www.w3.org/2000/svg}text")]
        residual, held_out = "residuals" in file.name, "fast" in file.name
        wanted = ["Residual [kPa]", "± 2 sd of the noise"] if residual else ["Nominal stress [kPa]", "Strain [%]", "measured"]
        for words in [*wanted, "predicted" if held_out else "simulated"]:
            assert any(words in row for row in letters), (file.name, words, letters)
    fit = json.loads((tmp_path / "out/fit.json").read_text(encoding="utf-8"))
    drawn = dict(fit_charts(fit))
    axes = mpl.figure.Figure().add_subplot()
    drawn["Residuals of slow"](axes)
    curve = fit["curves"][0]
    left = (np.array(curve["measured_N"]) - np.array(curve["fitted_N"])) * curve["y"]["scale"]
    assert np.allclose(axes.lines[-1].get_ydata(), left, rtol=1e-12, atol=0)
    assert axes.get_ylim()[1] == -axes.get_ylim()[0] >= np.abs(left).max()
    with pytest.raises(ValueError, match="no chart 'depth'.*'slow', 'fast', 'Residuals of slow'"):
        glisson.plot.run(tmp_path / "out", chart="depth")
    (tmp_path / "out/fit.json").write_text("[]", encoding="utf-8")
    with pytest.raises(ValueError, match="not the fit.json of a fit"):
        glisson.plot.run(tmp_path / "out")


def test_what_cannot_be_drawn_is_refused_with_the_way_out(program, out, tmp_path):
    """Each message names the option, its value and what there is."""
    for options, words in (
        ({"colour": "stress"}, "colour is 'stress'; there are: displacement, von_mises"),
        ({"cut": "w=1"}, "cut is 'w=1'; write x=0"),
        ({"frame": 9}, "frame 9: .* has 3 frames"),
        ({"variant": "none"}, "no variant 'none' .*hard, soft"),
        ({"size": (10, 10)}, "size is 10x10; each may be 64 to 8192"),
        ({"range": (1, 1)}, "range is 1 to 1"),
        ({"cut": "x=-9"}, "nothing of the body is left"),
    ):
        with pytest.raises(ValueError, match=words):
            glisson.picture(out, **options)
    with pytest.raises(ValueError, match="no such folder"):
        glisson.picture(tmp_path / "nowhere")
    with pytest.raises(ValueError, match="no chart 'speed'.*'Force against depth'"):
        glisson.plot.run(out, chart="speed")
    told = subprocess.run([program, "picture", out, "--size", "large"], capture_output=True, text=True, check=False)
    assert told.returncode == 2 and 'write two numbers as WIDTHxHEIGHT' in told.stderr
    without = {"PATH": "/nowhere", "GLISSON_PYTHON": "/nowhere/python3"}
    told = subprocess.run([program, "plot", out], capture_output=True, text=True, env=without, check=False)
    assert told.returncode == 1 and "apt-get install python3-matplotlib" in told.stderr
