// A run that was recorded, in the live page: its frames and forces are those of its files, its time is moved by slider and keys,
// two watch the same moment, and no hand can change it.
import assert from "node:assert/strict";
import { mkdirSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, describe, test } from "node:test";
import { WEB_DIR, openBrowser, openPage, settle } from "./browser.mjs";
import { NEEDLE, openReplay, program, state, until } from "./live_under_test.mjs";
import { canvasOf, pixelsOf } from "./pixels.mjs";

const shots = join(WEB_DIR, "live-screenshots");
const own = (troubles) => troubles.filter((text) => !text.includes("GL Driver Message"));

describe("a recorded run", { skip: program() === null ? "the program is not built" : false }, () => {
  let live, browser, page, troubles, table;
  before(async () => {
    mkdirSync(shots, { recursive: true });
    live = await openReplay(NEEDLE.replace("frames = 2", "frames = 24"));
    const [head, ...rows] = readFileSync(join(live.run, "main/forces.csv"), "utf8").trim().split("\n");
    const names = head.split(",");
    table = rows.map((row) => Object.fromEntries(row.split(",").map((word, i) => [names[i], Number(word)])));
    browser = await openBrowser({ colorScheme: "light" });
    ({ page, troubles } = await openPage(browser.context, live.url));
    await until(page, (s) => s.recorded === "true" && s.drives === "true" && s.time !== undefined, "the first frame");
  });
  after(async () => {
    await browser?.close();
    assert.equal(await live?.close(), 0, "Ctrl-C ends the program cleanly");
  });

  const goTo = async (share) => {
    await page.locator(".live-replay input[type=range]").fill(String(Math.round(2000 * share)));
    const wanted = (share * table[table.length - 1].time_s).toFixed(2);
    return until(page, (s) => Math.abs(Number(s.time) - Number(wanted)) < 0.02, `${wanted} s`);
  };

  test("says what it is, and offers no hand", async () => {
    assert.match(await page.locator(".live-subtitle").innerText(), /24 recorded frames/);
    assert.equal(await page.getByText("Drag pulls tissue").isVisible(), false);
    assert.equal(await page.getByText("Young's modulus").count(), 0);
    assert.equal(await page.locator("#depth-0").count(), 0);
  });

  test("shows depth and force of the run at any time", async () => {
    for (const share of [0.1, 0.3, 1]) {
      const now = await goTo(share);
      const row = table.reduce((best, r) =>
        Math.abs(r.time_s - now.time) < Math.abs(best.time_s - now.time) ? r : best,
      );
      // The nearest line of the table is at most 1 ms away; in that time the needle goes 20 µm.
      assert.ok(Math.abs(now.depth - row.depth_m) < 2.5e-5, `${now.depth} m, ${row.depth_m} m`);
      assert.ok(Math.abs(now.force - row.force_N) < 0.02 * Math.max(...table.map((r) => r.force_N)), `${now.force} N`);
    }
  });

  test("the picture follows the time, and the curve carries its ring", async () => {
    const seen = new Set();
    const curve = page.locator(".live-plot canvas").first();
    const rings = new Set();
    for (const share of [0, 0.15, 0.3]) {
      await goTo(share);
      await settle(page);
      await page.waitForTimeout(300); // curves are drawn eight times a second
      seen.add((await pixelsOf(page, page.locator(".live-canvas"))).hash);
      rings.add((await canvasOf(curve)).hash);
    }
    assert.equal(seen.size, 3);
    assert.equal(rings.size, 3);
    await page.screenshot({ path: join(shots, "replay.png") });
  });

  test("plays by the space bar to its end, goes frame by frame, and plays again from the start", async () => {
    await goTo(0.9);
    await page.locator(".live-canvas").focus();
    await page.keyboard.press(" ");
    const end = table[table.length - 1].time_s;
    await until(page, (s) => Number(s.time) > end - 1e-3, "the end");
    await page.getByRole("button", { name: "Play", exact: true }).waitFor();
    await goTo(0);
    await page.getByRole("button", { name: "Next frame" }).click();
    const next = await until(page, (s) => Number(s.time) > 0.01, "the next frame");
    assert.ok(Math.abs(Number(next.time) - end / 23) < 2e-3, next.time);
    await page.getByRole("button", { name: "From the start" }).click();
    await until(page, (s) => Number(s.time) > 0.05 && Number(s.time) < 1, "plays");
    await page.locator(".live-canvas").focus();
    await page.keyboard.press(" ");
  });

  test("a picture that stands still has all pixels, however slow drawing is", async () => {
    await page.waitForTimeout(2000);
    const [drawn, shown] = await page.locator(".live-canvas").evaluate((c) => [c.width, c.clientWidth]);
    assert.equal(drawn, Math.floor(shown * (await page.evaluate(() => Math.min(devicePixelRatio, 2)))));
  });

  test("a second viewer sees the same moment and the whole curve, and moves nothing", async () => {
    const dark = await openBrowser({
      colorScheme: "dark",
      viewport: { width: 390, height: 844 },
      isMobile: true,
      hasTouch: true,
    });
    const { page: second, troubles: its } = await openPage(dark.context, live.url);
    await goTo(0.5);
    const here = await state(page);
    await until(second, (s) => s.time === here.time, "the same moment");
    assert.equal(await second.locator(".live-replay").evaluate((field) => field.disabled), true);
    assert.ok(Object.keys((await canvasOf(second.locator(".live-plot canvas").first())).colours).length > 0, "a curve");
    const width = await second.evaluate(() => document.documentElement.scrollWidth);
    assert.ok(width <= 390, `${width} px wide`);
    await settle(second);
    await second.screenshot({ path: join(shots, "replay-phone.png"), fullPage: true });
    assert.deepEqual(own(its), []);
    await dark.close();
  });

  test("nothing was said in the console", () => assert.deepEqual(own(troubles), []));
});
