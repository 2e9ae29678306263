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

/** A needle that goes 10 mm into a small block. */
export const NEEDLE = `title = "A needle, live"
[mesh]
kind = "box"
cells = [6, 6, 6]
size_m = [0.03, 0.03, 0.03]
[tissue]
youngs_modulus_Pa = 5000
poisson_ratio = 0.4
[motion]
damping_rate_per_s = 100
[[fixed]]
set = "z_min"
[[instrument]]
kind = "needle"
name = "needle"
tip_m = [0.0155, 0.0145, 0.0305]
diameter_mm = 1.2
zone_mm = 5
rupture.force_N = 0.1
tip.cutting_N = 0.1
friction = { static_in_N_m = 10, static_out_N_m = 10, dynamic_in_N_m = 6, dynamic_out_N_m = 6, viscous_in_N_s_m2 = 100, viscous_out_N_s_m2 = 100 }
[instrument.motion]
kind = "press"
velocity_mm_s = 20
depth_mm = 10
ramp_s = 0.002
hold_s = 1
[output]
frames = 2
`;

/** What the page says of itself. */
export const state = (page) => page.evaluate(() => ({ ...document.querySelector(".live").dataset }));

/** Waits for that; simulated time, not the clock, decides: the machine may be slow. */
export async function until(page, holds, what) {
  for (let i = 0; i < 600; i++) {
    const now = await state(page);
    if (holds(now)) return now;
    await page.waitForTimeout(100);
  }
  throw new Error(`${what}: ${JSON.stringify(await state(page))}`);
}

/** Writes a scene, serves it, and knows its address; `close` ends the program as Ctrl-C does. */
export async function openLive(scene, extra = []) {
  const folder = mkdtempSync(join(tmpdir(), "glisson-live-"));
  const file = join(folder, "scene.toml");
  writeFileSync(file, scene);
  return { ...(await serve(folder, file, extra)), file, folder };
}

/** Runs a scene and serves what that wrote, `run` its folder. */
export async function openReplay(scene, extra = []) {
  const folder = mkdtempSync(join(tmpdir(), "glisson-replay-"));
  const [file, run] = [join(folder, "scene.toml"), join(folder, "out")];
  writeFileSync(file, scene);
  const ran = spawnSync(program(), ["run", file, "--out", run, "--quiet"], { encoding: "utf8" });
  if (ran.status !== 0) throw new Error(ran.stderr);
  return { ...(await serve(folder, run, extra)), run, folder };
}

async function serve(folder, shown, extra) {
  const child = spawn(program(), ["view", shown, ...extra], { stdio: ["ignore", "pipe", "pipe"] });
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
  return { url, close };
}

/** Force along the tool's direction at the end of `glisson run` of the same scene [N]. */
export function forceOfRun(file, folder) {
  const out = join(folder, "out");
  const run = spawnSync(program(), ["run", file, "--out", out, "--quiet"], { encoding: "utf8" });
  if (run.status !== 0) throw new Error(run.stderr);
  const [head, ...rows] = readFileSync(join(out, "main/forces.csv"), "utf8").trim().split("\n");
  return Number(rows[rows.length - 1].split(",")[head.split(",").indexOf("force_N")]);
}

/** Software WebGL tells of its slow reading when a picture is taken; that is no trouble of the page. */
export const own = (troubles) => troubles.filter((text) => !text.includes("GL Driver Message"));

/** Lets the simulation go on by a time [s], which a restart would take back. */
export async function later(page, seconds) {
  const from = Number((await state(page)).time);
  return until(page, (s) => Number(s.time) > from + seconds, `${seconds} s later`);
}

/** Types a number into the box beside a slider. */
export async function type(page, label, value) {
  const box = page.getByLabel(`${label}, number`);
  await box.fill(String(value));
  await box.press("Enter");
}
