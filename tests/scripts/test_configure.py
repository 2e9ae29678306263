"""A tree that was moved or copied with its build folder is configured as a fresh one, and says so; one that stays keeps its folder."""

import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

CONFIGURE = Path(__file__).resolve().parents[2] / "scripts/configure.sh"
PROJECT = """
cmake_minimum_required(VERSION 3.25)
project(Small LANGUAGES NONE)
option(GLISSON_BUILD_TESTS "Tests" ON)
add_custom_target(where ALL COMMAND ${CMAKE_COMMAND} -E echo ${CMAKE_SOURCE_DIR})
"""
PRESETS = """{"version": 6, "configurePresets": [
  {"name": "release", "generator": "Ninja", "binaryDir": "${sourceDir}/build/release"}]}"""


class Configure(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.tree = Path(self.folder.name) / "first"
        (self.tree / "scripts").mkdir(parents=True)
        shutil.copy2(CONFIGURE, self.tree / "scripts")
        (self.tree / "CMakeLists.txt").write_text(PROJECT, encoding="utf-8")
        (self.tree / "CMakePresets.json").write_text(PRESETS, encoding="utf-8")

    def configured(self, tree, *words):
        done = subprocess.run([str(tree / "scripts/configure.sh"), "release", *words], capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        built = subprocess.run(["cmake", "--build", str(tree / "build/release")], capture_output=True, text=True, check=False)
        self.assertEqual(built.returncode, 0, built.stdout + built.stderr)
        self.assertIn(str(tree), built.stdout)
        self.assertEqual(self.has_tests(tree), "ON" if words else self.has_tests(tree))
        return done.stderr

    def has_tests(self, tree):
        cache = (tree / "build/release/CMakeCache.txt").read_text(encoding="utf-8")
        return next(line.split("=")[1] for line in cache.splitlines() if line.startswith("GLISSON_BUILD_TESTS:"))

    def test_a_moved_tree_is_built_anew(self):
        self.assertEqual(self.configured(self.tree), "")
        (self.tree / "build/release/kept").touch()
        self.assertEqual(self.configured(self.tree), "", "nothing is said of a tree that stays")
        self.assertTrue((self.tree / "build/release/kept").exists())
        moved = self.tree.with_name("second")
        self.tree.rename(moved)
        said = self.configured(moved)
        self.assertIn(f"build/release was made in {self.tree}/build/release, and this tree is in {moved}", said)
        self.assertNotIn("CMake Error", said)
        self.assertFalse((moved / "build/release/kept").exists())
        self.assertEqual(self.has_tests(moved), "OFF")

    def test_a_copy_leaves_the_first_alone_and_keeps_its_tests(self):
        self.configured(self.tree, "tests")
        copy = self.tree.with_name("copy")
        shutil.copytree(self.tree, copy)
        self.assertIn("moved or copied", self.configured(copy))
        self.assertEqual(self.has_tests(copy), "ON")
        self.assertEqual(self.configured(self.tree), "")

    def test_a_link_to_the_tree_is_the_same_tree(self):
        self.configured(self.tree)
        link = self.tree.with_name("link")
        link.symlink_to(self.tree)
        done = subprocess.run([str(link / "scripts/configure.sh"), "release"], capture_output=True, text=True, check=False)
        self.assertEqual((done.returncode, done.stderr), (0, ""))


if __name__ == "__main__":
    unittest.main()
