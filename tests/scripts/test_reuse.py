"""The wheel takes libraries of a build folder only where they are what would be compiled, and as the sources are now."""

import os
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
LIBRARIES = ("glisson", "glisson_heat", "glisson_mesher", "glisson_image", "glisson_scene", "glisson_io", "glisson_fit", "glisson_report", "glisson_fit_files")
PROJECT = """
cmake_minimum_required(VERSION 3.25)
project(Small LANGUAGES CXX)
include(%s/cmake/GlissonReuse.cmake)
add_library(glisson_options INTERFACE)
if(REUSE)
  glisson_reuse_libraries("${REUSE}")
endif()
if(NOT GLISSON_REUSED)
  add_library(room_base INTERFACE)
  set_property(GLOBAL PROPERTY glisson_rooms base)
  foreach(name %s)
    add_library(${name} STATIC ${name}.cpp)
    target_link_libraries(${name} PUBLIC ${before})
    set(before ${name})
  endforeach()
  glisson_offer_libraries()
endif()
add_executable(answer main.cpp)
target_link_libraries(answer PRIVATE glisson_fit_files room_base)
""" % (ROOT, " ".join(LIBRARIES))


class Reuse(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.root = Path(self.folder.name)
        (self.root / "CMakeLists.txt").write_text(PROJECT, encoding="utf-8")
        for name in LIBRARIES:
            (self.root / f"{name}.cpp").write_text(f"int {name}() {{ return 1; }}\n", encoding="utf-8")
        (self.root / "main.cpp").write_text("int glisson_report();\nint main() { return glisson_report(); }\n", encoding="utf-8")

    def cmake(self, *words):
        environment = {**os.environ, "CXXFLAGS": ""}
        return subprocess.run(["cmake", *words], cwd=self.root, env=environment, capture_output=True, text=True, check=False)

    def made(self, folder, *options, expect=True):
        """Configures and builds `folder`; what configuring said."""
        said = self.cmake("-S", ".", "-B", folder, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", *options)
        self.assertEqual(said.returncode, 0, said.stderr)
        done = self.cmake("--build", folder)
        self.assertEqual(done.returncode == 0, expect, done.stdout)
        return said.stdout

    def answer(self, folder):
        return subprocess.run([str(self.root / folder / "answer")], check=False).returncode

    def reused(self, *options, expect=True):
        shutil.rmtree(self.root / "wheel", ignore_errors=True)
        said = self.made("wheel", f"-DREUSE={self.root}/release", *options, expect=expect)
        return "brought up to date there" in said and "compiled here" not in said

    def test_same_libraries_are_taken(self):
        self.made("release")
        self.assertTrue(self.reused())
        self.assertEqual(self.answer("wheel"), 1)

    def test_a_compiler_by_another_name_is_the_same(self):
        self.made("release")
        (self.root / "cxx").symlink_to(shutil.which("c++"))
        self.assertTrue(self.reused(f"-DCMAKE_CXX_COMPILER={self.root}/cxx"))

    def test_a_folder_behind_its_sources_is_brought_up_to_date(self):
        self.made("release")
        (self.root / "glisson_report.cpp").write_text("int glisson_report() { return 7; }\n", encoding="utf-8")
        self.assertTrue(self.reused())
        self.assertEqual(self.answer("wheel"), 7)

    def test_other_flags_or_a_missing_folder_are_compiled_here(self):
        self.assertFalse(self.reused())
        self.made("release")
        self.assertFalse(self.reused("-DCMAKE_CXX_FLAGS=-DOTHER"))
        self.assertFalse(self.reused("-DCMAKE_BUILD_TYPE=Debug"))
        self.assertFalse(self.reused("-DVTK_DIR=/elsewhere"))
        self.assertEqual(self.answer("wheel"), 1)

    def test_a_compiler_of_another_version_is_compiled_here(self):
        self.made("release")
        text = self.root / "release/glisson_libraries.txt"
        text.write_text(text.read_text(encoding="utf-8").replace("COMPILER_VERSION=", "COMPILER_VERSION=1"), encoding="utf-8")
        self.assertFalse(self.reused())

    def test_a_folder_that_cannot_be_built_is_left_alone(self):
        self.made("release")
        (self.root / "release/build.ninja").write_text("nonsense", encoding="utf-8")
        self.assertFalse(self.reused())
        self.assertEqual(self.answer("wheel"), 1)

    def test_a_folder_of_a_moved_tree_is_named(self):
        self.made("release")
        moved = self.root.with_name(self.root.name + "-moved")
        shutil.copytree(self.root, moved)
        self.addCleanup(shutil.rmtree, moved)
        old, self.root = self.root, moved
        said = self.made("wheel", f"-DREUSE={moved}/release")
        self.assertIn(f"was built of the sources in {old.resolve()}: this tree was moved or copied", " ".join(said.split()))
        self.assertEqual(self.answer("wheel"), 1)


if __name__ == "__main__":
    unittest.main()
