"""Fits run from Python, and their results are those of the program."""

import json
import runpy
import subprocess
import sys
from pathlib import Path

import glisson
import numpy as np
import pytest

QUICK = {"starts": 3, "bootstrap": 0}


@pytest.fixture(scope="module")
def phantom():
    return glisson.fit(Path(glisson.scenes_folder()) / "fit" / "phantom_mean.toml", **QUICK)


def test_the_result_is_fit_json(program, scenes, tmp_path, phantom):
    """to_dict() is the object that the program writes, but for the time it took."""
    command = [program, "fit", scenes / "fit" / "phantom_mean.toml", "--out", tmp_path / "out", "--quiet"]
    done = subprocess.run([*command, "--starts", "3", "--bootstrap", "0"], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    written = json.loads((tmp_path / "out" / "fit.json").read_text(encoding="utf-8"))
    found = phantom.to_dict()

    def timeless(data):
        clocks = {"wall_s", "forward_run_s"}
        if isinstance(data, dict):
            return {k: timeless(v) for k, v in data.items() if k not in clocks}
        return [timeless(v) for v in data] if isinstance(data, list) else data

    for key in ("parameters", "curves", "correlation", "groups", "basins", "profiles", "name", "title"):
        assert timeless(found[key]) == timeless(written[key]), key
    assert phantom.tissue_toml == (tmp_path / "out" / "tissue.toml").read_text(encoding="utf-8")


def test_results_are_arrays(tmp_path, phantom):
    """Parameters have values and intervals, curves are arrays, the tissue can be simulated."""
    assert phantom.parameters and set(phantom.values) == set(phantom.parameters)
    for parameter in phantom.parameters.values():
        low, high = parameter.ci95
        assert (low is None or low <= parameter.value) and (high is None or parameter.value <= high)
    [curve] = phantom.curves
    assert curve.measured.shape == curve.fitted.shape == curve.displacement.shape == curve.time.shape
    assert curve.rms == pytest.approx(np.sqrt(np.mean((curve.fitted - curve.measured) ** 2)), rel=1e-6)
    assert glisson.shear_modulus(phantom.tissue.hyperelastic) > 0 and phantom.conclusions
    phantom.write(tmp_path)
    assert json.loads((tmp_path / "fit.json").read_text(encoding="utf-8")) == phantom.to_dict()
    assert repr(phantom).startswith("<FitResult ")


def test_progress_is_told_and_ends_the_fit(scenes):
    """A fit tells how far it is; what the watcher raises ends it."""

    def stop(stage, done, planned, rms):
        assert done <= planned and stage
        raise FloatingPointError("enough")

    with pytest.raises(FloatingPointError, match="enough"):
        glisson.fit(scenes / "fit" / "phantom_mean.toml", progress=stop, **QUICK)


def test_an_interrupted_fit_goes_on(scenes, tmp_path):
    """Ctrl-C ends a fit as KeyboardInterrupt; with `state` the next call goes on with the starts that are known, and finds
    what an uninterrupted one finds. The file is gone when the fit is complete."""
    script = (
        "import glisson, os, signal, sys\n"
        "def look(stage, done, planned, rms):\n"
        "    if stage == 'profiles': os.kill(os.getpid(), signal.SIGINT)\n"
        "try:\n"
        "    glisson.fit(sys.argv[1], starts=4, bootstrap=0, state=sys.argv[2], progress=look)\n"
        "except KeyboardInterrupt:\n"
        "    print('interrupted')\n"
    )
    description, state = scenes / "fit" / "phantom_mean.toml", tmp_path / "fit.state.json"
    done = subprocess.run([sys.executable, "-c", script, description, state], capture_output=True, text=True, check=False)
    assert done.stdout == "interrupted\n", done.stdout + done.stderr
    known = json.loads(state.read_text(encoding="utf-8"))
    resumed = glisson.fit(description, starts=4, bootstrap=0, state=state)
    assert known and not state.exists()
    whole = glisson.fit(description, starts=4, bootstrap=0)
    assert resumed.values == whole.values
    assert resumed.to_dict()["forward_runs"] < whole.to_dict()["forward_runs"]


def test_messages_and_laws():
    """A description that cannot be used is refused with its keys; laws are listed by name."""
    with pytest.raises(glisson.SceneError, match="missing key `data`"):
        glisson.fit({"specimen": {"kind": "cylinder", "diameter_mm": 50, "height_mm": 30}})
    with pytest.raises(glisson.SceneError, match="nothing"):
        glisson.fit("nothing = 1\n")
    assert {"constant", "linear", "ogden", "yeoh"} <= set(glisson.known_laws())


def test_the_example_finds_what_it_was_made_of(tmp_path, monkeypatch):
    """The curve of the example has μ = 2000 Pa and α = 4 with 1 % noise; its fit finds both within the noise."""
    example = Path(__file__).parents[2] / "python/examples/fit_your_csv.py"
    monkeypatch.setattr(sys, "argv", ["fit_your_csv.py", str(tmp_path)])
    found = runpy.run_path(str(example))["result"].values
    assert found["mu"] == pytest.approx(2000, rel=0.03) and found["alpha"] == pytest.approx(4, rel=0.15)
    assert (tmp_path / "fit.pdf").stat().st_size > 1000
