"""What presets and pages say of the phantoms' errors up to 66.5 % is what the database's runs give over that range."""

import pathlib
import re
import subprocess
import sys
import tomllib
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
RUNS = ROOT.parent / "shared" / "data" / "phantom"
LAWS = {"ogden": "_ogden", "yeoh": ""}


def errors_of_runs():
    """Standard error in kPa of the fits to whole runs, by mix and law."""
    script = [sys.executable, "-B", str(ROOT / "scripts" / "fit_phantoms"), str(RUNS)]
    text = subprocess.run(script, capture_output=True, text=True, check=True).stdout
    found = {}
    for mix, block in re.findall(r"^(EF10_\d+T), \d+ runs: \d+ strains up to 66.5 %\n((?:  .*\n)+)", text, re.MULTILINE):
        for law in LAWS:
            found[mix, law] = re.search(rf"^  {law} .*standard error (\S+) kPa", block, re.MULTILINE).group(1)
    return found


class FitPhantoms(unittest.TestCase):
    def test_errors_are_compared_over_one_range(self):
        if not RUNS.exists():
            self.skipTest(f"{RUNS} is not there: the phantoms' curves are not part of this repository")
        presets = tomllib.loads((ROOT / "src/scene/parse/preset_list.toml").read_text(encoding="utf-8"))["preset"]
        page = (ROOT / "docs/tissues.md").read_text(encoding="utf-8")
        errors = errors_of_runs()
        self.assertEqual(len(errors), 4)
        for (mix, law), error in errors.items():
            preset = next(p for p in presets if p["name"] == f"phantom_{mix.lower()}{LAWS[law]}")
            _, _, whole = preset["fitted_to"].partition("To 66.5 %, fitted to five of the runs: ")
            self.assertTrue(whole.startswith(f"{error} kPa"), f"{preset['name']}: {preset['fitted_to']}, not {error}")
            row = next(line for line in page.splitlines() if line.startswith(f"| {mix} |"))
            self.assertIn(f" {error} ", row)
        for preset in presets:
            before, published, _ = preset["fitted_to"].partition("(published")
            if preset["name"].startswith("phantom") and published:
                self.assertIn("To 66.5 %", before, "a published error of that range beside one of another")


if __name__ == "__main__":
    unittest.main()
