"""Other programs beside `glisson compare`: what is not installed is said, and what is installed answers the same experiment."""

import contextlib
import importlib.machinery
import importlib.util
import io
import json
import os
import pathlib
import stat
import subprocess
import sys
import tempfile
import unittest
from unittest import mock

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = pathlib.Path(os.environ.get("GLISSON_PROGRAM", ROOT / "build/release/bin/glisson"))
SCRIPT = ROOT / "scripts/compare_programs"
loader = importlib.machinery.SourceFileLoader("compare_programs", str(SCRIPT))
script = importlib.util.module_from_spec(importlib.util.spec_from_loader("compare_programs", loader))
loader.exec_module(script)
from programs import PROGRAMS  # noqa: E402, studies/compare/ is on the path now

try:
    from programs import experiment
except ImportError:
    experiment = None  # without numpy

SCENE = """
[mesh]
kind = "box"
cells = [2, 2, 2]
size_m = [0.02, 0.02, 0.02]
[tissue]
hyperelastic = { kind = "neo_hookean", mu_Pa = 1285.714, bulk_modulus_Pa = 6000 }
[motion]
damping_rate_per_s = 20
[[fixed]]
set = "z_min"
[[tool]]
set = "z_max"
velocity_mm_s = 2
depth_mm = 1
[compare]
meshes = 1
stations = 2
"""
ROW = {"model": "glisson", "tets": 6, "steps": 9, "iterations": 0, "error_force": 0.01, "error_surface": 0.02}
ROW |= {"wall_s": 0.5, "setup_s": 0.25, "bytes": 1, "forces": [[0, 0, 1]], "note": ""}
# A glisson that knows nothing but one row.
STAND_IN = f"""#!{sys.executable}
import sys
given = dict(zip(sys.argv, sys.argv[1:]))
open(given["--json"], "w").write('''{json.dumps({"scene": "block", "unit": "N", "rows": [ROW]})}''')
open(given["--problem"], "w").write("{{}}")
"""


def said(*arguments):
    """What the script prints, and the status it ends with."""
    out = io.StringIO()
    with mock.patch.object(sys, "argv", ["compare_programs", *arguments]), contextlib.redirect_stdout(out):
        try:
            status = script.main()
        except SystemExit as end:
            return str(end.code), 1
    return out.getvalue(), status or 0


class ComparePrograms(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.stand_in = self.folder / "glisson"
        self.stand_in.write_text(STAND_IN, encoding="utf-8")
        self.stand_in.chmod(self.stand_in.stat().st_mode | stat.S_IXUSR)

    def test_what_is_not_installed_is_a_row(self):
        file = self.folder / "rows.json"
        with mock.patch("programs.find_spec", return_value=None):
            text, status = said("block.toml", "--program", str(self.stand_in), "--json", str(file))
        self.assertEqual(status, 0, text)
        rows = json.loads(file.read_text(encoding="utf-8"))["rows"]
        self.assertEqual(rows[0]["model"], "glisson")
        self.assertEqual(rows[0]["wall_s"], 0.5)
        self.assertEqual([row["model"] for row in rows[1:]], [program.name for program in PROGRAMS])
        for row, program in zip(rows[1:], PROGRAMS):
            self.assertTrue((ROOT / f"studies/compare/programs/{program.file}.py").exists())
            self.assertEqual(row["note"], f"not installed: pip install {program.pip}")
            self.assertIsNone(row["error_force"])
            self.assertIn(row["note"], text)

    def test_names_and_files_that_are_not_there_are_refused(self):
        text, status = said("block.toml", "--program", str(self.stand_in), "--only", "magic")
        self.assertEqual(status, 1)
        self.assertIn("there is no program magic; there are scikit_fem", text)
        text, status = said("block.toml", "--program", str(self.folder / "none"))
        self.assertEqual(status, 1)
        self.assertIn("is not built", text)

    def test_a_run_that_ends_its_process_or_takes_too_long_has_its_note(self):
        ready = 'import sys\nprint("ready", flush=True)\n'
        cases = {"sys.exit('it breaks')": "ended with 1: it breaks", "import time; time.sleep(60)": "not done within 0.5 s"}
        for end, note in cases.items():
            worker = self.folder / "worker"
            worker.write_text(ready + end, encoding="utf-8")
            with mock.patch.object(script, "__file__", str(worker)):
                rows = list(script.answers_of_process(PROGRAMS[0], self.folder / "problem.json", [(6, "one")], 0, 0.5))
            self.assertEqual(rows, [note])

    @unittest.skipUnless(experiment, "numpy is not there")
    def test_tissue_that_programs_are_not_given_is_refused(self):
        problem = self.folder / "problem.json"
        for tissue in ({"law": "yeoh", "viscous": False}, {"law": "neo_hookean", "viscous": True}):
            problem.write_text(json.dumps({"cut_at_s": None, "tissues": [tissue]}), encoding="utf-8")
            with self.assertRaisesRegex(experiment.CannotRun, "neo-Hookean tissue without viscosity"):
                experiment.cases(problem)

    # The same linear tets, assembled by another program: the same forces and shape to the last digits.
    @unittest.skipUnless(PROGRAMS[0].installed() and PROGRAM.exists(), "scikit-fem or Glisson's program is not there")
    def test_linear_tets_of_scikit_fem_are_those_of_linear_fem(self):
        from programs import scikit_fem

        scene, problem, rows = (self.folder / name for name in ("block.toml", "problem.json", "rows.json"))
        scene.write_text(SCENE, encoding="utf-8")
        command = [PROGRAM, "compare", scene, "--out", self.folder / "o", "--problem", problem, "--json", rows, "--quiet"]
        subprocess.run([*command, "--set", 'compare.models=["linear_fem"]'], check=True, capture_output=True)
        row = json.loads(rows.read_text(encoding="utf-8"))["rows"][0]
        case = experiment.cases(problem)[0]
        answer = scikit_fem.run(case, "linear")
        for mine, own in zip(answer.forces, row["forces"], strict=True):
            for a, b in zip(mine, own):
                self.assertAlmostEqual(a, b, delta=1e-9 * max(abs(x) for x in own))
        for mine, own in zip(case.errors(answer), (row["error_force"], row["error_surface"])):
            self.assertAlmostEqual(mine, own, places=9)


if __name__ == "__main__":
    unittest.main()
