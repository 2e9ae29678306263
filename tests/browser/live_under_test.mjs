// live_under_test.mjs — the real program serving a scene on loopback, for the tests of the live view.
import { spawn, spawnSync } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { WEB_DIR } from "./browser.mjs";

/** The program that was built with the page; null where there is none. */
export function program() {
  const found = [process.env.GLISSON_PROGRAM, join(WEB_DIR, "../../bin/glisson")]
    .filter(Boolean)
    .map((p) => resolve(p));
  return found.find((path) => existsSync(path)) ?? null;
}

/** Writes a scene, serves it, and knows its address; `close` ends the program as Ctrl-C does. */
export async function openLive(scene, extra = []) {
  const folder = mkdtempSync(join(tmpdir(), "glisson-live-"));
  const file = join(folder, "scene.toml");
  writeFileSync(file, scene);
  const child = spawn(program(), ["view", file, ...extra], { stdio: ["ignore", "pipe", "pipe"] });
  let said = "";
  const url = await new Promise((done, fail) => {
    child.stderr.on("data", (text) => (said += text));
    child.stdout.on("data", (text) => {
      said += text;
      const found = /http:\/\/\S+/.exec(said);
      if (found && said.includes("Ctrl-C")) done(found[0]);
    });
    child.on("exit", (code) => fail(new Error(`glisson view ended with ${code}: ${said}`)));
  });
  const close = () =>
    new Promise((done) => {
      child.removeAllListeners("exit");
      child.on("exit", (code) => {
        rmSync(folder, { recursive: true, force: true });
        done(code);
      });
      child.kill("SIGINT");
    });
  return { url, file, folder, close };
}

/** Force along the tool's direction at the end of `glisson run` of the same scene [N]. */
export function forceOfRun(file, folder) {
  const out = join(folder, "out");
  const run = spawnSync(program(), ["run", file, "--out", out, "--quiet"], { encoding: "utf8" });
  if (run.status !== 0) throw new Error(run.stderr);
  const [head, ...rows] = readFileSync(join(out, "main/forces.csv"), "utf8").trim().split("\n");
  return Number(rows[rows.length - 1].split(",")[head.split(",").indexOf("force_N")]);
}
