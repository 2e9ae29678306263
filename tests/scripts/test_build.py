"""The build tells how long it will still take, passes on what compilers say, and fails when it fails."""

import os
import subprocess
import tempfile
import unittest
from pathlib import Path

BUILD = Path(__file__).resolve().parents[2] / "scripts/build.sh"


class Build(unittest.TestCase):
    def built(self, *lines, status=0):
        """What build.sh prints where cmake prints `lines`."""
        with tempfile.TemporaryDirectory() as folder:
            cmake = Path(folder) / "cmake"
            cmake.write_text("#!/bin/sh\ncat <<'END'\n" + "\n".join(lines) + f"\nEND\nexit {status}\n", encoding="utf-8")
            cmake.chmod(0o755)
            environment = {**os.environ, "PATH": f"{folder}:{os.environ['PATH']}"}
            command = [str(BUILD), folder, "2", "all"]
            return subprocess.run(command, env=environment, capture_output=True, text=True, check=False)

    def test_time_left_follows_from_the_steps_done(self):
        done = self.built("@50/200@40.123@ Building a.o", "@51/200@41.0@ Building b.o", "@100/200@100.0@ Building c.o", "@200/200@200.0@ Linking")
        self.assertEqual(done.stdout, "[50/200] 40 s, about 2 min left\n[100/200] 2 min, about 2 min left\n[200/200] 3 min\n")

    def test_nothing_is_foretold_in_the_first_seconds(self):
        self.assertEqual(self.built("@1/200@0.2@ Building a.o").stdout, "[1/200] 0 s\n")

    def test_messages_and_failure_come_through(self):
        done = self.built("@1/2@9.0@ Building a.o", "FAILED: b.o", "b.cpp:1:1: error: no", status=3)
        self.assertEqual(done.returncode, 3)
        self.assertIn("FAILED: b.o\nb.cpp:1:1: error: no\n", done.stdout)


if __name__ == "__main__":
    unittest.main()
