"""What a run of ctest skipped is listed with its reasons, whoever skipped it: GoogleTest, pytest, unittest, node, a program without its tools."""

import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SCRIPT = Path(__file__).resolve().parents[2] / "scripts/skipped_tests"
GTEST = """[ RUN      ] {name}
/src/a_test.cpp:7: Skipped
the liver mesh is not here:
 /shared/liver.vtu
[  SKIPPED ] {name} (0 ms)
[  PASSED  ] 0 tests.
[  SKIPPED ] 1 test, listed below:
[  SKIPPED ] {name}
"""
UNITTEST = '''
import unittest

class Runs(unittest.TestCase):
    def test_a(self):
        """Of one with a docstring."""
        self.skipTest("no runs here")

    def test_b(self):
        self.skipTest("it's not there")

    def test_c(self):
        pass

unittest.main()
'''
NODE = """﹣ a hand on the body (0.8ms) # the program is not built
✔ another (3.2ms)
# tests 2
# skipped 1
"""


def log_of(outputs):
    """A log as ctest writes it."""
    text = "Start testing: Nov 30 09:36 UTC\n" + "-" * 58 + "\n"
    for i, (name, output) in enumerate(outputs):
        text += f"{i + 1}/{len(outputs)} Testing: {name}\n{i + 1}/{len(outputs)} Test: {name}\n"
        text += f"Output:\n{'-' * 58}\n{output}<end of output>\nTest time =   0.01 sec\nTest Passed.\n\n"
    return text


class SkippedTests(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def said(self, outputs):
        log = Path(self.folder.name) / "Testing/Temporary/LastTest.log"
        log.parent.mkdir(parents=True, exist_ok=True)
        log.write_text(log_of(outputs), encoding="utf-8")
        done = subprocess.run([str(SCRIPT), self.folder.name], capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout.splitlines()

    def test_names_and_reasons(self):
        cases = Path(self.folder.name) / "cases.py"
        cases.write_text(UNITTEST, encoding="utf-8")
        own = subprocess.run([sys.executable, "-B", str(cases), "-v"], capture_output=True, text=True, check=False)
        self.assertEqual(
            self.said(
                [
                    ("Liver.IsRead", GTEST.format(name="Liver.IsRead")),
                    ("Liver.IsCut", GTEST.format(name="Liver.IsCut")),
                    ("Box.IsRead", "[ RUN      ] Box.IsRead\n[       OK ] Box.IsRead (0 ms)\n"),
                    ("python_tests", "....s\nSKIPPED [1] test_meshes.py:118: could not import 'meshio'\n4 passed, 1 skipped in 1 s\n"),
                    ("script_tests", own.stdout + own.stderr),
                    ("live_in_browser", NODE),
                    ("report_in_browser", "SKIPPED: no Chromium\n"),
                ]
            ),
            [
                "skipped: 7 tests for want of what they name:",
                "skipped: 1 × could not import 'meshio': test_meshes.py:118",
                "skipped: 1 × it's not there: __main__.Runs.test_b",
                "skipped: 1 × no Chromium: report_in_browser",
                "skipped: 1 × no runs here: __main__.Runs.test_a",
                "skipped: 2 × the liver mesh is not here: /shared/liver.vtu: Liver.IsRead, Liver.IsCut",
                "skipped: 1 × the program is not built: a hand on the body",
            ],
        )

    def test_nothing_skipped_is_said_too(self):
        self.assertEqual(self.said([("Box.IsRead", "[       OK ] Box.IsRead (0 ms)\n")]), ["skipped: 0 tests"])

    def test_a_folder_without_a_run_is_refused(self):
        done = subprocess.run([str(SCRIPT), self.folder.name], capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 1)
        self.assertIn("LastTest.log is not there: run ctest in", done.stderr)


if __name__ == "__main__":
    unittest.main()
