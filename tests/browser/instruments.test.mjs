// A needle is seen where it was, the body can be cut open to look at it, and the force curve says what happened when.
import assert from "node:assert/strict";
import { after, before, describe, test } from "node:test";
import { openBrowser, openPage, settle } from "./browser.mjs";
import { surface } from "./fixture.mjs";
import { canvasOf, pixelsOf } from "./pixels.mjs";
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
    law: null,
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

  test("the cut moves with its slider", async () => {
    const place = panel.locator(".cut-place input");
    const middle = await mesh();
    await place.fill("0.3");
    await settle(page);
    assert.notEqual(await mesh(), middle);
    await place.fill("0");
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
