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


class Frame:
    """What a fit asks of a data frame."""

    def __init__(self, **columns):
        self.columns = columns

    def to_csv(self, file, *, index):
        assert index is False
        rows = zip(*self.columns.values(), strict=True)
        lines = [",".join(self.columns), *(",".join(repr(float(x)) for x in row) for row in rows)]
        Path(file).write_text("\n".join(lines) + "\n", encoding="utf-8")


def test_data_frames_are_files():
    """A laboratory's tests as data frames, several in one fit: tension and shear of neo-Hooke's law give its modulus."""
    stretch, shear = np.linspace(1.0, 1.3, 16), np.linspace(0.0, 0.4, 12)
    pulled = Frame(stretch=stretch, stress_kPa=stretch - stretch**-2)
    sheared = Frame(shear_strain=shear, stress_kPa=shear)
    result = glisson.fit(
        {
            "specimen": {"kind": "point"},
            "tissue": {"hyperelastic": {"kind": "neo_hookean", "mu_Pa": 500, "bulk_modulus_Pa": 1e9}},
            "parameter": [{"key": "tissue.hyperelastic.mu_Pa", "low": 10, "high": 1e5}],
            "data": [{"files": [pulled], "test": "tension"}, {"files": [sheared], "test": "simple_shear"}],
        },
        **QUICK,
    )
    assert result.values["tissue.hyperelastic.mu_Pa"] == pytest.approx(1000.0, rel=1e-4)
    assert [(t.test, t.points, t.unit) for t in result.tests] == [("tension", 16, "Pa"), ("simple_shear", 12, "Pa")]
    assert all(t.r2 > 0.9999 and set(t.r2_of_alone) == {"tension", "simple_shear"} for t in result.tests)
    assert [curve.unit for curve in result.curves] == ["Pa", "Pa"] and result.curves[0].time.size == 0
    assert result.curves[1].displacement == pytest.approx(shear)


def book_of(place, **sheets):
    openpyxl = pytest.importorskip("openpyxl")
    book = openpyxl.Workbook()
    book.remove(book.active)
    for name, rows in sheets.items():
        sheet = book.create_sheet(name)
        for row in rows:
            sheet.append(row)
    book.save(place)


def test_workbooks_are_files(tmp_path):
    """A workbook with notes on one sheet and a test on another: every digit goes over, and a fit takes it as it is."""
    stretch = np.linspace(1.0, 1.3, 16)
    stress = np.round(stretch - stretch**-2, 12)  # a workbook has some 15 digits
    table = [["Stretch", "Stress (kPa)"], *([float(x), float(y)] for x, y in zip(stretch, stress, strict=True))]
    book_of(tmp_path / "pulled.xlsx", Notes=[["liver 1", "by hand"]], Test=table)
    command = [sys.executable, "-m", "glisson.workbook", str(tmp_path / "pulled.xlsx")]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    assert done.stdout == f"{tmp_path / 'pulled.csv'}\n" and done.stderr == ""
    lines = (tmp_path / "pulled.csv").read_text(encoding="utf-8").splitlines()
    assert [float(line.split(",")[1]) for line in lines[1:]] == stress.tolist()
    (tmp_path / "fit.toml").write_text(
        '[specimen]\nkind = "point"\n[tissue]\n'
        'hyperelastic = { kind = "neo_hookean", mu_Pa = 500, bulk_modulus_Pa = 1e9 }\n'
        '[[parameter]]\nkey = "tissue.hyperelastic.mu_Pa"\nlow = 10\nhigh = 1e5\n'
        '[[data]]\nfiles = ["pulled.xlsx"]\ntest = "tension"\n',
        encoding="utf-8",
    )
    result = glisson.fit(tmp_path / "fit.toml", **QUICK)
    assert result.values["tissue.hyperelastic.mu_Pa"] == pytest.approx(1000.0, rel=1e-4)
    assert result.curves[0].name == "pulled" and result.curves[0].measured.tolist() == (1e3 * stress).tolist()


def test_workbooks_of_several_tables_are_asked_about(tmp_path):
    """Two sheets with numbers: refused with their names and the command; a sheet that is not there, too."""
    rows = [["a", "b"], [1.0, 2.0], [3.0, 4.0]]
    book_of(tmp_path / "two.xlsx", One=rows, Two=rows)
    command = [sys.executable, "-m", "glisson.workbook", str(tmp_path / "two.xlsx")]
    for more, said in (([], "has 2 sheets with numbers: One, Two"), (["--sheet", "Three"], 'has no sheet "Three"')):
        done = subprocess.run([*command, *more], capture_output=True, text=True, check=False)
        assert done.returncode == 2 and said in done.stderr
    assert subprocess.run([*command, "--sheet", "Two"], capture_output=True, check=True).returncode == 0


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
