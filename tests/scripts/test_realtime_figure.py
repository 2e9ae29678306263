"""The picture of a real-time run has every frame and event, that of a search every size; other files are refused."""

import json
import subprocess
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree
from pathlib import Path

FIGURE = Path(__file__).resolve().parents[2] / "scripts/realtime_figure"
SVG = "{http://www.w3.org/2000/svg}"
RUN = {
    "variant": "live", "tets": 768, "threads": 1, "frame_s": 1e-3, "simulated_s": 4e-3, "missed": 1,
    "p50_us": 500.0, "p99_us": 1500.0, "max_us": 9000.0, "frames_us": [400.0, 500.0, 9000.0, 1500.0],
    "events": [{"events": "contact", "frame": 1, "compute_us": 500.0}],
}  # fmt: skip


def trial(tets, threads, p50, p99, kept):
    return {"tets": tets, "threads": threads, "p50_us": p50, "p99_us": p99, "kept": kept}


FOUND = {
    "variant": "live", "frame_s": 1e-3,
    "trials": [trial(768, 1, 100, 150, True), trial(4096, 1, 900, 1400, False), trial(4096, 1, 800, 900, True),
               trial(768, 2, 90, 140, True), trial(4096, 2, 500, 700, True)],
}  # fmt: skip


class RealtimeFigure(unittest.TestCase):
    def setUp(self):
        self.folder = Path(self.enterContext(tempfile.TemporaryDirectory()))

    def draw(self, result):
        (self.folder / "r.json").write_text(json.dumps(result), encoding="utf-8")
        out = self.folder / "r.svg"
        run = subprocess.run([FIGURE, self.folder / "r.json", out], capture_output=True, text=True, check=False)
        return run, ElementTree.parse(out) if out.exists() else None

    def test_run(self):
        run, svg = self.draw(RUN)
        self.assertEqual(run.returncode, 0, run.stderr)
        dots = [(float(c.get("cx")), float(c.get("cy"))) for c in svg.iter(SVG + "circle")]
        self.assertEqual(len(dots), 4)
        self.assertGreater(dots[0][1], dots[1][1])  # less time lies lower
        words = [t.text for t in svg.iter(SVG + "text")]
        self.assertIn("contact", words)
        self.assertIn("p99 1500 µs", words)
        self.assertIn("1 of 4 frames took longer than a frame, 1 of them lie above the chart", words)

    def test_sizes(self):
        run, svg = self.draw(FOUND)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertEqual(len(list(svg.iter(SVG + "circle"))), 8)  # two sizes, p50 and p99, of one and of two threads
        self.assertEqual(sum(c.get("fill") == "white" for c in svg.iter(SVG + "circle")), 0)  # the quieter run counts
        words = [t.text for t in svg.iter(SVG + "text")]
        self.assertIn("1 thread", words)
        self.assertIn("2 threads", words)

    def test_refuses_other_results(self):
        run, _ = self.draw({"variant": "live"})
        self.assertNotEqual(run.returncode, 0)
        self.assertIn("r.json: has neither trials nor frames_us", run.stderr)


if __name__ == "__main__":
    unittest.main()
