"""A virtual environment that was moved or copied with its tree is removed, which is said; one that stays is kept."""

import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SETUP = Path(__file__).resolve().parents[2] / "scripts/setup.sh"


class MovedEnvironment(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def tree(self, name):
        """A tree with an environment, made by Python's own venv."""
        tree = Path(self.folder.name) / name
        (tree / "scripts").mkdir(parents=True)
        shutil.copy2(SETUP, tree / "scripts")
        subprocess.run([sys.executable, "-m", "venv", str(tree / "venv")], check=True)
        return tree

    def said(self, tree):
        environment = {**os.environ, "GLISSON_SKIP_SETUP": "1"}
        done = subprocess.run([str(tree / "scripts/setup.sh"), "python"], env=environment, capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout + done.stderr

    def pip_of(self, tree):
        """Where the environment's pip would install; nothing where it does not start."""
        try:
            done = subprocess.run([str(tree / "venv/bin/pip"), "--version"], capture_output=True, text=True, check=False)
        except FileNotFoundError:
            return None
        return Path(done.stdout.split(" from ")[1].split("/lib/")[0]) if done.returncode == 0 else None

    def test_a_moved_tree_loses_its_environment(self):
        # The path of the second has blanks and is too long for a first line: pip's script names Python in its second.
        for name in ("first", "a long name " * 12 + "."):
            with self.subTest(name=name[:12]):
                tree = self.tree(name)
                self.assertEqual(self.pip_of(tree), tree / "venv")
                self.assertEqual(self.said(tree), "", "nothing is said of one that stays")
                self.assertTrue((tree / "venv").exists())
                moved = tree.with_name("moved")
                tree.rename(moved)
                self.assertIsNone(self.pip_of(moved), "what is to be mended")
                self.assertIn(f"venv was made in {tree}/venv, and this tree is in {moved}: it was moved or copied", self.said(moved))
                self.assertFalse((moved / "venv").exists())
                shutil.rmtree(moved)

    def test_a_copy_leaves_the_first_alone_and_a_link_is_none(self):
        tree = self.tree("first")
        copy = tree.with_name("copy")
        shutil.copytree(tree, copy, symlinks=True)
        self.assertEqual(self.pip_of(copy), tree / "venv", "what is to be mended: it installs into the first")
        self.assertIn("moved or copied", self.said(copy))
        self.assertFalse((copy / "venv").exists())
        self.assertEqual(self.said(tree), "")
        self.assertEqual(self.pip_of(tree), tree / "venv")
        link = tree.with_name("link")
        link.symlink_to(tree)
        self.assertEqual(self.said(link), "", "a link to the tree is the same tree")
        self.assertTrue((tree / "venv").exists())


if __name__ == "__main__":
    unittest.main()
