// A needle is seen where it was, the body can be cut open to look at it, and the force curve says what happened when.
import assert from "node:assert/strict";
import { after, before, describe, test } from "node:test";
import { openBrowser, openPage, settle } from "./browser.mjs";
import { surface } from "./fixture.mjs";
import { canvasOf, pixelsOf, tonesAt } from "./pixels.mjs";
import { pageWith } from "./report_under_test.mjs";

const DEPTH = 0.03;
/** Reading a WebGL picture back makes Chromium warn of slowness; all else must not be. */
const isTrouble = (text) => !text.includes("GPU stall due to ReadPixels");

/** A variant in which a needle goes in from above at `speed` [m/s] and pierces after a third of its way. */
function needleVariant(name, speed, withEvents = true) {
  const end = DEPTH / speed;
  const times = Array.from({ length: 200 }, (_, i) => (end * i) / 199);
  const force = times.map((t) => (t < end / 3 ? 12 * (t / end) ** 2 : 0.2 + 0.8 * (t / end)));
  const body = surface(13, 0.006, end);
  body.instruments = [{ name: "needle", kind: "needle", radius_m: 0.001 }];
  body.frames.forEach((frame, i) => {
    const tip = 0.081 - (DEPTH * i) / 12;
    frame.instruments = [{ points: [0.018, 0.018, tip + 0.1, 0.018, 0.018, tip], axes: [] }];
  });
  const event = (share, what) => ({ time_s: share * end, depth_m: share * DEPTH, event: what, instrument: "needle" });
  return {
    name,
    label: name,
    summary: { scene: "needle", variant: name, end: "finished" },
    forces: {
      columns: ["time_s", "depth_m", "force_N", "normal_N", "friction_N", "cutting_N", "bottom_z_N", "side_z_N"],
      data: [
        times,
        times.map((t) => speed * t),
        force,
        force.map((f, i) => (times[i] < end / 3 ? f : 0)),
        force.map((f, i) => (times[i] < end / 3 ? 0 : f - 0.2)),
        force.map((_, i) => (times[i] < end / 3 ? 0 : 0.2)),
        force.map((f) => -0.9 * f),
        force.map((f) => -0.1 * f),
      ],
    },
    events: withEvents ? [event(0.03, "contact"), event(1 / 3, "puncture"), event(0.36, "drop")] : [],
    law_curves: [],
    surface: body,
  };
}

const reportOf = (variants) => ({
  format: 1,
  title: "Needle",
  scenes: [{ name: "needle", title: "Needle", description: "", notes: [], source: "", variants, charts: [] }],
});

describe("a scene with a needle", () => {
  let browser, page, troubles, panel;
  before(async () => {
    browser = await openBrowser({ colorScheme: "light" });
    const url = pageWith(reportOf([needleVariant("slow", 0.002), needleVariant("fast", 0.01)]), "needle");
    ({ page, troubles } = await openPage(browser.context, url));
    panel = page.locator("#needle .mesh");
    await panel.scrollIntoViewIfNeeded();
    await settle(page);
  });
  after(() => browser?.close());

  const mesh = async () => (await pixelsOf(page, panel.locator("canvas"))).hash;

  test("opens cut open, and closes", async () => {
    const open = panel.locator("input[name=open]");
    assert.equal(await open.isChecked(), true);
    assert.equal(await panel.locator(".cut-place").isVisible(), true);
    const opened = await mesh();
    await open.uncheck();
    await settle(page);
    assert.notEqual(await mesh(), opened, "the near half is there again");
    assert.equal(await panel.locator(".cut-place").isVisible(), false);
    await open.check();
    await settle(page);
    assert.equal(await mesh(), opened);
  });

  test("the cut has a face and shows none of the inside: raw tissue, pale grey where a field colours the skin", async () => {
    const open = panel.locator("input[name=open]");
    const colour = panel.locator("select[aria-label=Colour]");
    // Below the needle's tip, in the middle of the body: of the face when open, of the dark skin when closed.
    const tones = () =>
      tonesAt(page, panel.locator("canvas"), 0.4, 0.55, {
        grey: ([low, , high]) => high - low < 20 && low > 150,
        red: ([, , high], [r, g, b]) => high === r && r > 1.6 * g && r > 1.6 * b,
      });
    await colour.selectOption("intensity");
    await settle(page);
    const opened = await tones();
    assert.ok(opened.grey > 0.99 && opened.red === 0, JSON.stringify(opened));
    await open.uncheck();
    await settle(page);
    const closed = await tones();
    assert.ok(closed.grey < 0.01 && closed.red < 0.1, JSON.stringify(closed));
    await open.check();
    await colour.selectOption("none");
    await settle(page);
    const raw = await tones();
    assert.ok(raw.grey === 0 && raw.red > 0.99, JSON.stringify(raw));
  });

  test("the cut moves with its slider and goes across another axis; its place is said in millimetres", async () => {
    const place = panel.locator(".cut-place input");
    const axis = panel.locator("select[aria-label=Cut]");
    const middle = await mesh();
    assert.match(await panel.locator(".cut-readout").innerText(), /^y = 18\.0\smm$/); // the needle's tip
    await place.fill("0.75");
    await settle(page);
    assert.notEqual(await mesh(), middle);
    assert.match(await panel.locator(".cut-readout").innerText(), /^y = 30\.0\smm$/); // of 40
    const seen = new Set([middle]);
    for (const name of ["x", "z", "view"]) {
      await axis.selectOption(name);
      await settle(page);
      seen.add(await mesh());
    }
    assert.equal(seen.size, 4);
    await axis.selectOption("y");
    await settle(page);
    assert.equal(await mesh(), middle);
  });

  test("keys open, close and move the cut, and a reload finds it as it was left", async () => {
    const middle = await mesh();
    await panel.locator("canvas").focus();
    await page.keyboard.press("c");
    await settle(page);
    assert.equal(await panel.locator("input[name=open]").isChecked(), false);
    await page.keyboard.press("c");
    await page.keyboard.press("]");
    await settle(page);
    assert.notEqual(await mesh(), middle);
    await page.keyboard.press("x");
    await page.reload();
    await panel.scrollIntoViewIfNeeded();
    await settle(page);
    assert.equal(await panel.locator("select[aria-label=Cut]").inputValue(), "x");
    await panel.locator("select[aria-label=Cut]").selectOption("y");
    await settle(page);
    assert.equal(await mesh(), middle);
  });

  test("the needle moves with time", async () => {
    // All of the body's motion is taken away: what changes is the needle.
    await panel.locator("select[aria-label=Displacement]").selectOption("1");
    const seen = new Set();
    for (const step of [0, 200, 400, 600]) {
      await panel.locator("input[aria-label=Time]").fill(String(step));
      await settle(page);
      seen.add(await mesh());
    }
    assert.equal(seen.size, 4);
  });

  test("charts show what the container carries and the parts of the needle's force", async () => {
    const titles = await page.locator("#needle figure h3, #needle .figure-head h3").allInnerTexts();
    assert.ok(
      titles.some((title) => title.includes("Loads on the container")),
      titles.join(),
    );
    assert.ok((await page.locator("#needle .legend-item", { hasText: "cutting" }).count()) >= 1);
  });

  test("events are drawn into the force curve: without them it is another picture", async () => {
    const other = pageWith(
      reportOf([needleVariant("slow", 0.002, false), needleVariant("fast", 0.01, false)]),
      "plain",
    );
    const plain = await openPage(browser.context, other);
    const first = (where) => where.locator("#needle .chart canvas").first();
    await first(page).scrollIntoViewIfNeeded();
    await first(plain.page).scrollIntoViewIfNeeded();
    await settle(page);
    await settle(plain.page);
    assert.notEqual((await canvasOf(first(page))).hash, (await canvasOf(first(plain.page))).hash);
    assert.deepEqual(plain.troubles.filter(isTrouble), []);
    await plain.page.close();
  });

  test("nothing is complained about", () => assert.deepEqual(troubles.filter(isTrouble), []));
});
