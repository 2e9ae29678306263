"""A force curve that left the kept one is seen, wherever it does: a value, a column, the end of the run, a number that is none."""

import importlib.machinery
import importlib.util
import pathlib
import tempfile
import unittest

SCRIPT = str(pathlib.Path(__file__).resolve().parents[2] / "scripts/golden_curves")
loader = importlib.machinery.SourceFileLoader("golden_curves", SCRIPT)
golden = importlib.util.module_from_spec(importlib.util.spec_from_loader("golden_curves", loader))
loader.exec_module(golden)


def ramp(slope, samples, noise=0.0):
    times = [i / (samples - 1) for i in range(samples)]
    return {"time_s": times, "depth_m": [0.01 * t for t in times], "force_N": [slope * t + noise for t in times]}


class Deviation(unittest.TestCase):
    kept = ramp(2.0, 61)

    def share(self, now):
        return golden.deviation(self.kept, now)[0]

    def test_the_same_curve_at_other_times_does_not_deviate(self):
        self.assertAlmostEqual(self.share(ramp(2.0, 977)), 0.0)

    def test_the_share_is_of_the_largest_force(self):
        self.assertAlmostEqual(self.share(ramp(2.02, 61)), 0.01)
        self.assertAlmostEqual(self.share(ramp(2.0, 61, noise=0.03)), 0.015)

    def test_it_names_column_time_and_values(self):
        _, column, time, kept, now = golden.deviation(self.kept, ramp(2.2, 61))
        self.assertEqual((column, time, kept), ("force_N", 1.0, 2.0))
        self.assertAlmostEqual(now, 2.2)

    def test_a_column_that_is_gone_deviates(self):
        now = ramp(2.0, 61)
        del now["depth_m"]
        self.assertEqual(golden.deviation(self.kept, now)[:2], (float("inf"), "depth_m is gone"))

    def test_a_run_that_ended_early_deviates(self):
        now = {column: values[:30] for column, values in ramp(2.0, 61).items()}
        self.assertEqual(self.share(now), float("inf"))

    def test_a_value_that_is_not_finite_deviates(self):
        now = ramp(2.0, 61)
        now["force_N"][20] = float("nan")
        self.assertFalse(self.share(now) <= 1.0)

    def test_a_kept_curve_is_read_back(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "curve.csv")
            golden.write(golden.thinned(ramp(2.0, 977)), path)
            back = golden.read(path)
        self.assertEqual(len(back["time_s"]), golden.ROWS + 1)
        self.assertLess(golden.deviation(back, ramp(2.0, 977))[0], 1e-5)


if __name__ == "__main__":
    unittest.main()
