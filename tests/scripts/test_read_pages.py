"""Blocks of pages run as they are printed; one that fails is told with page, line, command, exit code and its last lines."""

import subprocess
import unittest

from page_in import ROOT, PageIn


class Pages(unittest.TestCase):
    def read(self, text, *arguments):
        with PageIn(text) as page:
            git = ["git", "-C", str(page.root), "-c", "user.name=a", "-c", "user.email=a@b"]
            subprocess.run(["git", "init", "-q", str(page.root)], check=True)
            subprocess.run([*git, "add", "docs"], check=True)
            subprocess.run([*git, "commit", "-qm", "page"], check=True)
            done = page.run("read_pages", "--root", str(page.root), *arguments)
        return done.returncode, done.stdout + done.stderr

    def test_blocks_of_a_page_share_a_folder_and_an_empty_home(self):
        page = (
            "```toml file=a/b.toml\nx = 1\n```\n```sh\ngrep 'x = 1' a/b.toml\necho kept >left\n```\n"
            '```sh\ngrep kept left\ntest -z "$(ls -A "$HOME")"\ntest -z "${PYTHONPATH:-}${USER:-}"\n```\n'
        )
        status, said = self.read(page)
        self.assertEqual(status, 0, said)
        self.assertIn("pages: 2 passed, 0 failed, 0 left out", said)

    def test_a_failure_names_place_command_code_and_last_lines(self):
        status, said = self.read("# A\n\n```sh\ntrue\nsh -c 'echo reason; exit 3'\necho after\n```\n```sh\ntrue\n```\n")
        self.assertEqual(status, 1)
        self.assertIn("docs/page.md:3 sh: failed, line 5: `sh -c 'echo reason; exit 3'` ended with exit code 3", said)
        self.assertIn("    reason\n", said)
        self.assertNotIn("after", said)
        self.assertIn("pages: 1 passed, 1 failed", said)

    def test_long_blocks_wait_for_full(self):
        page = "```sh\ntrue\n```\n```sh full\nexit 5\n```\n"
        self.assertIn("pages: 1 passed, 0 failed, 1 left out", self.read(page)[1])
        self.assertIn("pages: 1 passed, 1 failed, 0 left out", self.read(page, "--full")[1])

    def test_data_that_is_not_there_is_said(self):
        status, said = self.read("```sh\ntrue\n```\n```sh data=no_such_mesh.vtu\nexit 5\n```\n")
        self.assertEqual(status, 0)
        self.assertIn("skipped, there is no no_such_mesh.vtu", said)

    def test_pages_that_run_nothing_pass_for_nothing(self):
        self.assertEqual(self.read("Words.\n")[0], 1)

    def test_what_is_wrong_without_running(self):
        for text, fault in (
            ("```\nmake run\n```\n", "docs/page.md:1: a block of ''"),
            ("```bash\nmake run\n```\n", "a block of 'bash'"),
            ("```toml\nx = 1\n```\n", "toml: say file=NAME"),
            ("```toml pattern\nx = \n```\n", "no TOML"),
            ("```text\nbuild/release/bin/glisson run FILE --colour\n```\n", "glisson run has no option --colour"),
            ("```sh\nbuild/release/bin/glisson run scenes/paper/none.toml\n```\n", "there is no scenes/paper/none.toml"),
            ("```sh\nfalse && true\ntrue\n```\n", "would go unnoticed"),
            ("Then\n\n    glisson view FILE\n", "docs/page.md:3: an indented command"),
        ):
            status, said = self.read(text, "--look")
            self.assertEqual(status, 1, text)
            self.assertIn(fault, said)

    def test_the_pages_of_this_repository_say_what_their_blocks_are(self):
        done = subprocess.run([ROOT / "scripts/read_pages", "--look"], capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stdout)


if __name__ == "__main__":
    unittest.main()
