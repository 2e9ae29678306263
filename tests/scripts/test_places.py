"""What is added touches no more files than it did: scripts/places counts them in the code itself."""

import pathlib
import subprocess
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]


class Places(unittest.TestCase):
    def test_an_addition_touches_no_more_files_than_allowed(self):
        if not (ROOT / ".git").exists():
            self.skipTest("counts the files of a git checkout")
        run = subprocess.run([sys.executable, "-B", ROOT / "scripts/places"], capture_output=True, text=True, check=False)
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
        self.assertEqual(len(run.stdout.splitlines()), 5)


if __name__ == "__main__":
    unittest.main()
