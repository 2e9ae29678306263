"""A module whose stub cannot be written costs the wheel its stub, never the wheel."""

import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

STUBS = Path(__file__).resolve().parents[2] / "python/stubs.py"


class Stubs(unittest.TestCase):
    def written(self, *modules):
        """What stubs.py says and writes of modules that are no libraries at all."""
        with tempfile.TemporaryDirectory() as folder:
            for name in modules:
                (Path(folder) / f"{name}.cpython.so").write_bytes(b"not a library")
            done = subprocess.run([sys.executable, str(STUBS), folder, folder], capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 0, done.stderr)
            return done.stderr, {path.name: path.read_text(encoding="utf-8") for path in Path(folder).glob("*.pyi")}

    def test_a_module_that_does_not_load_is_a_warning(self):
        said, stubs = self.written("_core", "_io", "_fit")
        self.assertEqual(sorted(stubs), ["_core.pyi", "_fit.pyi", "_io.pyi"])
        for name, stub in stubs.items():
            self.assertIn(f"warning: no stub of glisson.{name.removesuffix('.pyi')}", said)
            compile(stub, name, "exec")
            self.assertIn("def __getattr__(name: str) -> Any: ...", stub)

    def test_a_module_that_is_not_there_is_a_warning(self):
        said, stubs = self.written()
        self.assertEqual(len(stubs), 3)
        self.assertEqual(said.count("warning:"), 3)


if __name__ == "__main__":
    unittest.main()
