"""The live view's format has one description: what follows from it is committed, and is as the description says."""

import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
FILES = ("apps/view/wire/messages.toml", "apps/view/wire/wire.h", "web/src/live/wire.ts", "docs/view.md")


def make(*words):
    done = subprocess.run([str(ROOT / "scripts/make_wire"), *map(str, words)], capture_output=True, text=True, check=False)
    return done.returncode, done.stdout + done.stderr


class MakeWire(unittest.TestCase):
    def setUp(self):
        self.root = Path(self.enterContext(tempfile.TemporaryDirectory()))
        for name in FILES:
            (self.root / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / name, self.root / name)

    def text(self, name):
        return (self.root / name).read_text(encoding="utf-8")

    def change(self, name, old, new):
        self.assertEqual(self.text(name).count(old), 1, old)
        (self.root / name).write_text(self.text(name).replace(old, new), encoding="utf-8")

    def test_what_is_committed_is_as_the_description_says(self):
        self.assertEqual(make("--check"), (0, ""))

    def test_what_is_stale_is_named_and_made_anew(self):
        before = self.text("web/src/live/wire.ts")
        self.change("web/src/live/wire.ts", "undo: 18", "undo: 20")
        self.assertEqual(make("--check", self.root), (1, "web/src/live/wire.ts is stale: run scripts/make_wire\n"))
        self.assertEqual(make(self.root), (0, "wrote web/src/live/wire.ts\n"))
        self.assertEqual(self.text("web/src/live/wire.ts"), before)

    def test_a_new_field_reaches_both_ends_and_the_page_about_them(self):
        old = 'fields.p99 = { type = "f32", unit = "µs" }\n'
        self.change(FILES[0], old, old + 'fields.heat = { type = "f32", count = 2, unit = "K" }\n')
        self.assertEqual(make("--check", self.root)[1].count("is stale"), 3)
        make(self.root)
        self.assertIn("std::array<double, 2> heat{};  ///< [K]", self.text("apps/view/wire/wire.h"))
        self.assertIn("heat = 36, dropped = 44, grab_force = 48, reach = 60, low = 64, high = 68, end = 72;", self.text("apps/view/wire/wire.h"))
        self.assertIn("for (const auto& each : x.heat) out.f32(each);", self.text("apps/view/wire/wire.h"))
        self.assertIn("  const heat = at.f32s(2);\n  const dropped", self.text("web/src/live/wire.ts"))
        self.assertIn("`heat` f32[2] ([K]), `dropped` u32", self.text("docs/view.md"))

    def test_a_new_field_of_json_and_a_new_command(self):
        self.change(FILES[0], 'fields.led = {', 'fields.leader = { type = "text" }\nfields.led = {')
        with (self.root / FILES[0]).open("a", encoding="utf-8") as file:
            file.write('\n[command.wait]\ncode = 20\nabout = "rests so long"\n')
            file.write('fields.time = { type = "f32", unit = "s", least = 0, largest = 5 }\n')
        make(self.root)
        header, module = self.text("apps/view/wire/wire.h"), self.text("web/src/live/wire.ts")
        self.assertIn('{"leader", x.leader},', header)
        self.assertIn("  wait = 20,  ///< rests so long: time\n", header)
        self.assertIn("std::array<Payload, 20>", header)
        self.assertIn("    Payload{.values = 1, .least = 0.0f, .largest = 5.0f},\n};", header)
        self.assertIn('role: { drives: "boolean", leader: "string", led: "boolean", viewers: "number" }', module)
        self.assertIn('| { kind: "wait"; values: [number] } // rests so long', module)
        self.assertIn("| 20 `wait` | rests so long | `time` f32 ([s]; 0 … 5) |", self.text("docs/view.md"))

    def test_commands_are_numbered_from_one_without_gaps(self):
        self.change(FILES[0], "code = 19", "code = 21")
        code, said = make(self.root)
        self.assertEqual(code, 1)
        self.assertIn("command.inside: code 21, expected 19", said)


if __name__ == "__main__":
    unittest.main()
