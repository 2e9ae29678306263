"""A unit without findings is not looked at again until something that it reads changes; findings fail each time."""

import json
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

LINT = Path(__file__).resolve().parents[2] / "scripts/lint"
# Finds the word BAD in a unit, and notes that it was asked.
TIDY = """#!/bin/sh
for unit; do :; done
[ "$unit" != --version ] || { echo "clang-tidy $VERSION"; exit 0; }
echo "$unit" >> "$ASKED"
echo "12 warnings generated." >&2
! grep -H BAD "$unit"
"""


class Lint(unittest.TestCase):
    def setUp(self):
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))
        (self.folder / "src").mkdir()
        (self.folder / "bin").mkdir()
        tidy = self.folder / "bin/clang-tidy"
        tidy.write_text(TIDY, encoding="utf-8")
        tidy.chmod(0o755)
        self.asked = self.folder / "asked"
        self.write("src/a.h", "int a();\n")
        self.write("src/a.cpp", '#include "a.h"\n')
        self.write("src/b.cpp", "int b();\n")
        self.write("other/c.cpp", "BAD\n")  # in no room

    def write(self, name, text):
        path = self.folder / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(text, encoding="utf-8")

    def lint(self, version="1", flags=""):
        """What lint does, and which units it had looked at."""
        self.write("compile_commands.json", json.dumps([
            {"file": f"{self.folder}/{name}", "directory": str(self.folder), "command": f"g++ {flags} -o x.o -c {self.folder}/{name}"}
            for name in ("src/a.cpp", "src/b.cpp", "other/c.cpp")]))
        self.asked.write_text("", encoding="utf-8")
        environment = {**os.environ, "PATH": f"{self.folder}/bin:{os.environ['PATH']}", "XDG_CACHE_HOME": f"{self.folder}/cache",
                       "ASKED": str(self.asked), "VERSION": version}
        done = subprocess.run([str(LINT), str(self.folder), "2"], env=environment, capture_output=True, text=True, check=False)
        return done, sorted(Path(line).name for line in self.asked.read_text(encoding="utf-8").split())

    def test_clean_units_are_remembered_until_they_change(self):
        done, asked = self.lint()
        self.assertEqual((done.returncode, done.stdout), (0, "lint: 2 units, no findings; 0 of them as they were when they had none\n"))
        self.assertEqual(asked, ["a.cpp", "b.cpp"])
        done, asked = self.lint()
        self.assertEqual((done.returncode, asked), (0, []))
        self.write("src/a.h", "int a(int);\n")
        self.assertEqual(self.lint()[1], ["a.cpp"])
        self.assertEqual(self.lint(flags="-DX")[1], ["a.cpp", "b.cpp"])
        self.assertEqual(self.lint(version="2")[1], ["a.cpp", "b.cpp"])

    def test_findings_fail_each_time(self):
        self.write("src/a.cpp", "int BAD();\n")
        for _ in range(2):
            done, asked = self.lint()
            self.assertEqual(done.returncode, 1)
            self.assertIn("int BAD();", done.stdout)
            self.assertIn("lint: clang-tidy has findings in 1 of 2 units", done.stderr)
            self.assertIn("a.cpp", asked)
        self.assertNotIn("12 warnings", done.stdout)

    def test_a_folder_that_is_not_configured_is_refused(self):
        done = subprocess.run([str(LINT), str(self.folder / "none"), "2"], capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 1)
        self.assertIn("not found", done.stderr)


if __name__ == "__main__":
    unittest.main()
