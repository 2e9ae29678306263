"""A table of figures without its measurement, or with a command that is gone, is a fault that names page and line."""

import subprocess
import unittest

from page_in import PageIn

TABLE = "# Speed\n\n| body | tets | time |\n|---|---|---|\n| box | 768 | 2.3 ns |\n| large | 96000 | 2.9 ns |\n\n"


def caption(command="glisson bench --sizes 768", date="2026-11-22", commit="c2a367b"):
    return f"Measured with `{command}` on a machine of two cores, {date}, commit {commit}.\n"


class CheckFigures(unittest.TestCase):
    def faults(self, text):
        with PageIn(text) as page:
            done = page.run("check_figures", str(page.root))
        self.assertEqual(done.stderr, "")
        self.assertEqual(done.returncode, 0 if "0 faults" in done.stdout else 1)
        return done.stdout

    def test_a_table_that_says_how_it_was_measured_passes(self):
        for command in (
            "glisson bench realtime scenes/paper/figure2.toml --seconds 3",
            "cutting_bench",
            "build/release/bin/instruments_tests --gtest_filter='Hertz*'",
            "ctest -R FlatPunch",
            "scripts/fit_phantoms",
        ):
            self.assertIn("figures: 1 tables, 0 faults", self.faults(TABLE + caption(command)), command)

    def test_a_table_without_it_is_found(self):
        self.assertIn("docs/page.md:3: a table of figures without its measurement", self.faults(TABLE + "Fast.\n"))
        self.assertIn("1 faults", self.faults(TABLE + caption(date="yesterday")))
        self.assertIn("1 faults", self.faults(TABLE + caption(commit="main")))

    def test_a_reason_stands_for_a_measurement(self):
        self.assertIn("1 tables, 0 faults", self.faults(TABLE + "<!-- no command: bounds that the tests hold -->\n"))

    def test_commands_that_are_gone_are_named(self):
        for command, gone in (
            ("glisson bench --colour", "glisson bench has no option --colour"),
            ("glisson brew", "glisson has no command 'brew'"),
            ("glisson run scenes/paper/figure9.toml", "there is no scenes/paper/figure9.toml"),
            ("brewing_bench", "there is no program 'brewing_bench'"),
            ("scripts/no_such_script", "there is no scripts/no_such_script"),
            ("ctest -R NoSuchTest", "no test matches NoSuchTest"),
            ("instruments_tests --gtest_filter='NoSuch*'", "no test matches NoSuch*"),
        ):
            self.assertIn(gone, self.faults(TABLE + caption(command)), command)

    def test_a_commit_that_the_history_lacks_is_named(self):
        with PageIn(TABLE + caption(commit="0123456789")) as page:
            subprocess.run(["git", "init", "-q", str(page.root)], check=True)
            done = page.run("check_figures", str(page.root))
        self.assertIn("the history has no commit 0123456789", done.stdout)

    def test_other_tables_and_code_are_left_alone(self):
        words = "# A\n\n| key | type |\n|---|---|\n| a | 1 |\n| b | 2 |\n\n| to | do |\n|---|---|\n| push | slider |\n\n"
        self.assertIn("figures: 1 tables, 0 faults", self.faults(words + f"```text\n{TABLE}```\n" + TABLE + caption()))


if __name__ == "__main__":
    unittest.main()
