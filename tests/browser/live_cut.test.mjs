// What a hand does to the body: a stroke of mouse or keys parts it, colours stand for what the legend says.
import assert from "node:assert/strict";
import { mkdirSync } from "node:fs";
import { join } from "node:path";
import { after, before, describe, test } from "node:test";
import { WEB_DIR, openBrowser, openPage, settle } from "./browser.mjs";
import { later, openLive, own, program, state, type, until } from "./live_under_test.mjs";
import { pixelsOf } from "./pixels.mjs";

const SCENE = `title = "A block, pulled"
[mesh]
kind = "box"
cells = [5, 5, 8]
size_m = [0.02, 0.02, 0.03]
[tissue]
youngs_modulus_Pa = 3600
poisson_ratio = 0.4
[motion]
damping_rate_per_s = 40
[[fixed]]
set = "z_min"
[[tool]]
set = "z_max"
direction = [0, 0, -1]
velocity_mm_s = 50
depth_mm = 8
`;
const shots = join(WEB_DIR, "live-screenshots");

describe("a hand on the body", { skip: program() === null ? "the program is not built" : false }, () => {
  let live, browser, page, troubles, box;
  before(async () => {
    mkdirSync(shots, { recursive: true });
    live = await openLive(SCENE);
    browser = await openBrowser({ colorScheme: "light", viewport: { width: 1100, height: 720 } });
    ({ page, troubles } = await openPage(browser.context, live.url));
    await until(page, (s) => Number(s.time) > 0.01, "the first frames");
    box = await page.locator(".live-canvas").boundingBox();
  });
  after(async () => {
    await browser?.close();
    await live?.close();
  });

  const pull = async () => {
    await type(page, "Depth [mm]", -1.5);
    await until(page, (s) => Number(s.depth) < -0.00149, "pulled");
    return Number((await later(page, 0.5)).force);
  };
  const bar = () => page.locator(".colour-bar");

  test("colours stand for what the legend says, with its unit", async () => {
    await pull();
    const pictures = new Set();
    for (const [name, title] of [
      ["Equivalent shear strain s", "Equivalent shear strain s [–]"],
      ["Shape measure q", "Shape q [–]"],
      ["Pressure p", "Pressure p [Pa]"],
      ["Displacement |u|", "|u| [mm]"],
    ]) {
      await page.getByLabel("Colour", { exact: true }).selectOption({ label: name });
      await later(page, 0.3);
      assert.equal(await bar().locator(".bar-title").innerText(), title);
      const ticks = (await bar().locator(".bar-ticks span").allInnerTexts()).map((t) => Number(t.replace("−", "-")));
      assert.ok(ticks.length >= 3 && ticks.every(Number.isFinite), `${name}: ${ticks}`);
      if (name.startsWith("Displacement")) assert.ok(Math.abs(Math.max(...ticks) - 1.5) < 0.3, `${ticks} mm of 1.5`);
      if (name.startsWith("Pressure"))
        assert.ok(Math.min(...ticks) < -50, `${ticks} Pa: what is pulled has less than none`);
      pictures.add((await pixelsOf(page, page.locator(".live-canvas"))).hash);
      await page.screenshot({ path: join(shots, `colour-${name.split(" ")[0].toLowerCase()}.png`) });
    }
    assert.equal(pictures.size, 4);
    await page.getByLabel("Colour", { exact: true }).selectOption("none");
    await settle(page);
    assert.equal(await bar().isVisible(), false);
    await page.getByLabel("Colour", { exact: true }).selectOption("intensity");
  });

  test("a stroke of the mouse through the body parts it, and what pulled lets go", async () => {
    const pulled = await pull();
    assert.ok(pulled < -0.05, `${pulled} N`);
    await page.getByLabel("Cut tissue").check();
    await type(page, "Depth of cut [mm]", 60);
    await page.mouse.move(box.x + 0.1 * box.width, box.y + 0.4 * box.height);
    await page.mouse.down();
    await page.mouse.move(box.x + 0.9 * box.width, box.y + 0.44 * box.height, { steps: 25 });
    await page.screenshot({ path: join(shots, "cut.png") });
    await page.mouse.up();
    await until(page, (s) => s.pieces === "2", "two pieces");
    const left = Number((await later(page, 1)).force);
    assert.ok(Math.abs(left) < 1e-3 * Math.abs(pulled), `${pulled} → ${left} N`);
    assert.match(await page.locator(".live-cut-told").innerText(), /[\d.]+ cm² cut, 2 pieces/);
    await page.screenshot({ path: join(shots, "cut-through.png") });
  });

  test("reset makes it whole, and the same is done by keys alone", async () => {
    await page.getByRole("button", { name: "Reset" }).click();
    await until(page, (s) => s.pieces === "1" && Number(s.time) > 0, "whole");
    await page.locator(".live-canvas").focus();
    await page.keyboard.press("t");
    assert.ok(await page.getByRole("radio", { name: "Turn" }).isChecked());
    await page.keyboard.press("k");
    assert.ok(await page.getByLabel("Cut tissue").isChecked());
    for (let i = 0; i < 45; i++) await page.keyboard.press("ArrowLeft");
    await page.keyboard.press("Enter");
    for (let i = 0; i < 90; i++) await page.keyboard.press("ArrowRight");
    await page.screenshot({ path: join(shots, "cut-keys.png") });
    await page.keyboard.press("Enter");
    await until(page, (s) => s.pieces === "2", "two pieces");
    assert.deepEqual(own(troubles), []);
    assert.ok((await state(page)).drives);
  });
});
