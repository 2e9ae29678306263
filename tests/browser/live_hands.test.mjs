// What hands do in the live view: a patch is grasped, a tool is placed, an opened body shows its field; what is said agrees.
import assert from "node:assert/strict";
import { mkdirSync } from "node:fs";
import { join } from "node:path";
import { after, before, describe, test } from "node:test";
import { WEB_DIR, openBrowser, openPage, settle } from "./browser.mjs";
import { openLive, own, program, state, until } from "./live_under_test.mjs";
import { pixelsOf } from "./pixels.mjs";

const SCENE = `title = "A block in a box"
[mesh]
kind = "box"
cells = [6, 6, 4]
size_m = [0.04, 0.04, 0.02]
origin_m = [-0.02, -0.02, 0]
[tissue]
youngs_modulus_Pa = 3000
poisson_ratio = 0.4
[motion]
damping_rate_per_s = 60
[container]
kind = "box"
width_mm = 40
length_mm = 40
hold = "bonded"
[[instrument]]
kind = "ball"
name = "ball"
tip_m = [0, 0, 0.021]
radius_mm = 5
motion = { kind = "press", velocity_mm_s = 50, depth_mm = 3 }
[[instrument]]
kind = "punch"
name = "punch"
tip_m = [0.015, 0.015, 0.021]
radius_mm = 2
length_mm = 10
motion = { kind = "press", velocity_mm_s = 50, depth_mm = 3 }
`;
const shots = join(WEB_DIR, "live-screenshots");

describe("hands in the live view", { skip: program() === null ? "the program is not built" : false }, () => {
  let live, browser, page, troubles, box;
  before(async () => {
    mkdirSync(shots, { recursive: true });
    live = await openLive(SCENE);
    browser = await openBrowser({ colorScheme: "light", viewport: { width: 1200, height: 800 } });
    ({ page, troubles } = await openPage(browser.context, live.url));
    await until(page, (s) => Number(s.time) > 0.01, "the first frames");
    await settle(page);
    box = await page.locator(".live-canvas").boundingBox();
  });
  after(async () => {
    await browser?.close();
    await live?.close();
  });

  const numbers = () => page.locator(".live-numbers").innerText();
  const number = async (name) =>
    page
      .locator(".live-numbers div", { has: page.locator("dt", { hasText: new RegExp(`^${name}$`) }) })
      .locator("dd")
      .innerText();
  /** A place of the canvas, in shares of its size. */
  const at = (x, y) => [box.x + x * box.width, box.y + y * box.height];

  test("says how fast it goes, and counts no dropped frames", async () => {
    assert.match(await numbers(), /× real time/);
    assert.doesNotMatch(await numbers(), /dropped/i);
  });

  test("has one panel at a time for the tool that is chosen", async () => {
    assert.deepEqual(await page.locator(".live-tool:visible legend").allInnerTexts(), ["ball"]);
    await page.getByLabel("Tool", { exact: true }).selectOption("punch");
    assert.deepEqual(await page.locator(".live-tool:visible legend").allInnerTexts(), ["punch"]);
    await page.getByLabel("Tool", { exact: true }).selectOption("ball");
  });

  test("bonds a patch to the pointer: it follows at once, and arrow and number say the same force", async () => {
    await page.locator(".live-modes input[value=grasp]").check();
    await page.mouse.move(...at(0.36, 0.62));
    await page.mouse.down();
    await page.mouse.move(...at(0.3, 0.66), { steps: 6 });
    await page.waitForFunction(() => !document.querySelector(".force-label").hidden);
    await page.waitForTimeout(600);
    const [label, pull] = await page.evaluate(() => [
      document.querySelector(".force-label").textContent,
      [...document.querySelectorAll(".live-numbers div")].find((one) => one.firstChild.textContent === "Pull").lastChild
        .textContent,
    ]);
    assert.match(pull, /\d/);
    const [a, b] = [label, pull].map(parseFloat);
    assert.ok(a > 0 && Math.abs(a / b - 1) < 0.05, `${label} beside the arrow, ${pull} in the panel`);
    await page.screenshot({ path: join(shots, "grasp.png") });
    await page.mouse.move(...at(0.02, 0.98), { steps: 8 }); // as far as the picture goes: the arrow stays in it
    await page.waitForTimeout(400);
    await page.mouse.up();
  });

  test("puts a tool before the point of the surface that is picked", async () => {
    await page.locator(".live-modes input[value=place]").check();
    await page.mouse.click(...at(0.42, 0.42));
    const aside = () =>
      page.evaluate(() => ["side-0", "third-0"].map((id) => Number(document.getElementById(id).value)));
    await page.waitForFunction(() => Number(document.getElementById("side-0").value) !== 0);
    const target = await aside();
    const depth = () => page.evaluate(() => Number(document.getElementById("depth-0").value));
    for (let i = 0; i < 200 && !((await depth()) > -1); i++) await page.waitForTimeout(100); // down to before the surface
    assert.ok(Math.hypot(...target) > 2, `${target} mm aside`);
    const now = await until(page, (s) => Math.abs(1000 * Number(s.depth) - 0) < 3, "there");
    assert.ok(Math.abs(Number(now.force)) < 1e-3, "it does not touch the body yet");
    await page.waitForFunction(() => Number(document.getElementById("speed-0").value) === 50); // its own again
    await page.screenshot({ path: join(shots, "placed.png") });
  });

  test("shows the field on the face of a body that is cut open", async () => {
    await page.locator(".live-modes input[value=turn]").check();
    await page.getByLabel("Depth [mm], number").first().fill("3.5");
    await page.getByLabel("Depth [mm], number").first().press("Enter");
    await until(page, (s) => Number(s.depth) > 0.0034, "pressed");
    await page.getByLabel("Colour", { exact: true }).selectOption("von_mises");
    await settle(page);
    const closed = await pixelsOf(page, page.locator(".live-canvas"));
    await page.locator(".check", { hasText: "Cut open" }).locator("input").check();
    await page.waitForTimeout(1500);
    await settle(page);
    const open = await pixelsOf(page, page.locator(".live-canvas"));
    assert.notEqual(open.hash, closed.hash);
    assert.ok(open.colours > 100, JSON.stringify(open));
    assert.match(await page.locator(".colour-bar").innerText(), /Von Mises \[k?Pa\]/);
    await page.screenshot({ path: join(shots, "face.png") });
    assert.ok(Number((await state(page)).time) > 0);
  });

  test("caused no console error", () => assert.deepEqual(own(troubles), []));
});
