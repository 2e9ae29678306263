"""Walls between rooms hold: the check names what breaks one, and the compiler finds no header behind one."""

import importlib.machinery
import importlib.util
import json
import os
import shlex
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
BUILD = Path(os.environ.get("GLISSON_BUILD", ROOT / "build/release"))
SCRIPT = ROOT / "scripts/check_rooms"
loader = importlib.machinery.SourceFileLoader("check_rooms", str(SCRIPT))
script = importlib.util.module_from_spec(importlib.util.spec_from_loader("check_rooms", loader))
loader.exec_module(script)


class CheckRooms(unittest.TestCase):
    def setUp(self):
        self.root = Path(self.enterContext(tempfile.TemporaryDirectory()))
        self.write("src/CMakeLists.txt", "glisson_room(low PUBLIC low.h)\nglisson_room(high TOUCHES low PUBLIC high.h)\n")
        self.write("docs/architecture.md", "<!-- rooms -->\n```text\nlow\nhigh  → low\n```\n")
        self.write("include/glisson/low.h", "")
        self.write("include/glisson/high.h", '#include "glisson/low.h"\n')
        self.write("src/low/a/of_a.h", "")
        self.write("src/low/b/of_b.h", '#include "low/a/of_a.h"\n')
        self.write("src/high/top.cpp", '#include "glisson/low.h"\n#include "low/b/of_b.h"\n')
        self.write("web/src/one.ts", 'import { two } from "./two.ts";\n')
        self.write("web/src/two.ts", "export const two = 2;\n")

    def write(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")

    def check(self):
        done = subprocess.run([str(SCRIPT), str(self.root)], capture_output=True, text=True, check=False)
        return done.returncode, done.stdout + done.stderr

    def test_a_sound_house_passes(self):
        self.assertEqual(self.check(), (0, "rooms: 2, each wall holds\n"))

    def test_an_include_of_a_room_above_is_named_with_its_line(self):
        for header in ("high/top.h", "glisson/high.h"):
            self.write("src/low/a/of_a.cpp", f'\n#include "{header}"\n')
            code, said = self.check()
            self.assertEqual(code, 1)
            self.assertIn(f'src/low/a/of_a.cpp:2: low includes "{header}" of high; it may touch none', said)

    def test_a_way_around_by_dots_is_refused(self):
        self.write("src/low/a/of_a.cpp", '#include "../../high/top.h"\n')
        self.assertIn('src/low/a/of_a.cpp:1: "../../high/top.h" goes around the rooms', self.check()[1])

    def test_folders_in_a_circle_are_named_with_a_line_each(self):
        self.write("src/low/a/of_a.h", '#include "low/b/of_b.h"\n')
        code, said = self.check()
        self.assertEqual(code, 1)
        self.assertIn("folders include each other: src/low/a, src/low/b\n  src/low/a → src/low/b, src/low/a/of_a.h:1", said)

    def test_modules_of_the_page_in_a_circle_are_named(self):
        self.write("web/src/two.ts", 'import type {\n  One,\n} from "./one.ts";\n')
        self.assertIn("modules import each other: web/src/one.ts, web/src/two.ts", self.check()[1])

    def test_an_old_drawing_is_named(self):
        self.write("docs/architecture.md", "<!-- rooms -->\n```text\nlow\nhigh\n```\n")
        self.assertIn("its list of rooms is not that of src/CMakeLists.txt", self.check()[1])

    def test_the_house_is_sound(self):
        done = subprocess.run([str(SCRIPT)], capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)


@unittest.skipUnless((BUILD / "compile_commands.json").exists(), "no build folder with compile commands")
class Compiler(unittest.TestCase):
    """With the very flags that a room is compiled with."""

    @classmethod
    def setUpClass(cls):
        cls.rooms = script.rooms_of(ROOT)
        cls.public = script.public_headers(ROOT, cls.rooms)
        cls.flags = {}
        for command in json.loads((BUILD / "compile_commands.json").read_text(encoding="utf-8")):
            if found := script.re.search(r"CMakeFiles/glisson_(\w+)\.dir/", command["command"]):
                cls.flags.setdefault(found[1], (command["directory"], shlex.split(command["command"])))

    def finds(self, room, header):
        """Whether a source of the room may include the header."""
        folder, words = self.flags[room]
        flags = [word for word in words if word.startswith(("-I", "-std", "-D"))]
        source = f'#if !__has_include("{header}")\n#error not found\n#endif\n'
        compiler = os.environ.get("CXX", "c++")
        done = subprocess.run([compiler, *flags, "-x", "c++", "-fsyntax-only", "-"], cwd=folder, input=source, text=True,
                              capture_output=True, check=False)
        return done.returncode == 0

    def header_of(self, room):
        return next(path for path in script.sources(ROOT / self.rooms[room][0]) if path.suffix == ".h")

    def test_finds_headers_of_rooms_that_are_touched_alone(self):
        looked_at = 0
        for room in self.rooms:
            if room not in self.flags:
                continue  # not in this build
            allowed = script.reach(self.rooms, room)
            for other, (folder, _, _) in self.rooms.items():
                inside = f"{other}/{self.header_of(other).relative_to(ROOT / folder).as_posix()}"
                for header in [inside, *sorted(name for name, owner in self.public.items() if owner == other)[:1]]:
                    self.assertEqual(self.finds(room, header), other in allowed, f"{room} and {header}")
                    looked_at += 1
        self.assertGreater(looked_at, 150)


if __name__ == "__main__":
    unittest.main()
