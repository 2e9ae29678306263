// Any report, real or made: it loads from a file, asks nothing of a network, draws its figures, fits its screens.
import assert from "node:assert/strict";
import { after, before, describe, test } from "node:test";
import { openBrowser, openPage, settle } from "./browser.mjs";
import { lineColours, pixelsOf } from "./pixels.mjs";
import { reportUrl } from "./report_under_test.mjs";

const url = reportUrl();
const inView = async (locator) => {
  await locator.scrollIntoViewIfNeeded();
  await settle(locator.page());
};

describe("a report on a laptop", () => {
  let browser, page, troubles;
  before(async () => {
    browser = await openBrowser();
    ({ page, troubles } = await openPage(browser.context, url));
  });
  after(() => browser?.close());

  test("shows its scenes, each with a way to it", async () => {
    const scenes = await page.locator(".scene").count();
    assert.ok(scenes >= 1, `${scenes} scenes`);
    const targets = await page
      .locator("nav.scenes a")
      .evaluateAll((links) => links.map((link) => document.querySelector(link.getAttribute("href"))?.className));
    assert.ok(
      targets.length >= scenes && targets.every((target) => target !== undefined),
      `ways lead to ${targets.join(", ")}`,
    );
    if (scenes > 1) assert.deepEqual(targets, Array(scenes).fill("scene"));
    assert.ok((await page.locator("h1").innerText()).length > 0);
  });

  test("has all advice of its scenes, warnings first and called so", async () => {
    const { wanted, shown } = await page.evaluate(() => {
      const { scenes } = JSON.parse(document.getElementById("glisson-data").textContent);
      return {
        wanted: scenes.flatMap((scene) => scene.advice ?? []).map(({ kind, text }) => ({ kind, text })),
        shown: [...document.querySelectorAll(".scene .advice li")].map((item) => item.textContent),
      };
    });
    assert.equal(shown.length, wanted.length);
    wanted.forEach(({ kind, text }, at) => {
      assert.ok(shown[at].endsWith(text), `${shown[at]} for ${text}`);
      assert.equal(shown[at].startsWith("Warning. "), kind === "warning");
    });
    assert.ok(wanted.length > 0, "there is some");
  });

  test("draws lines into every chart, and labels both axes with a unit", async () => {
    const charts = page.locator(".chart");
    const count = await charts.count();
    assert.ok(count >= 2, `${count} charts`);
    for (let n = 0; n < count; n++) {
      const chart = charts.nth(n);
      await inView(chart);
      const pixels = await pixelsOf(page, chart.locator("canvas"));
      assert.ok(pixels.colours > 8 && pixels.drawn > 0.005, `chart ${n}: ${JSON.stringify(pixels)}`);
      const label = await chart.locator(".chart-plot").getAttribute("aria-label");
      assert.match(label, /\[[^\]]+\] against .*\[[^\]]+\]/, `chart ${n} names units: ${label}`);
    }
    const coloured = await lineColours(charts.first().locator("canvas"));
    assert.ok(
      Object.values(coloured).reduce((sum, value) => sum + value, 0) > 150,
      "coloured line pixels in the first chart",
    );
  });

  test("draws the mesh in many colours, and differently at another time", async () => {
    const mesh = page.locator(".mesh").first();
    await inView(mesh.locator("canvas"));
    const end = await pixelsOf(page, mesh.locator("canvas"));
    assert.ok(end.colours > 200 && end.drawn > 0.04, `mesh at the end: ${JSON.stringify(end)}`);
    const slider = mesh.locator("input[aria-label=Time]");
    await slider.focus();
    await slider.press("Home");
    await settle(page);
    const start = await pixelsOf(page, mesh.locator("canvas"));
    assert.notEqual(start.hash, end.hash, "the picture follows the slider");
    assert.match(await mesh.locator(".mesh-readout").innerText(), /^0\.0+\s(s|ms)/);
  });

  test("has no duplicate ids, no unnamed buttons, no image of a network", async () => {
    const faults = await page.evaluate(() => {
      const found = [];
      const ids = [...document.querySelectorAll("[id]")].map((element) => element.id);
      if (new Set(ids).size !== ids.length) found.push("duplicate id");
      for (const element of document.querySelectorAll("button, a, input, select")) {
        const name =
          element.getAttribute("aria-label") ||
          element.textContent.trim() ||
          element.closest("label")?.textContent.trim();
        if (!name) found.push(`unnamed ${element.outerHTML.slice(0, 80)}`);
      }
      for (const element of document.querySelectorAll("[src], link[href]")) {
        const target = element.getAttribute("src") ?? element.getAttribute("href");
        if (!target.startsWith("data:")) found.push(`outside: ${target}`);
      }
      return found;
    });
    assert.deepEqual(faults, []);
  });

  test("caused no console error and asked for nothing but the file", () => {
    // Reading pixels back for a screenshot stalls a software GPU; Chromium says so as a warning.
    assert.deepEqual(
      troubles.filter((trouble) => !trouble.includes("GPU stall due to ReadPixels")),
      [],
    );
  });
});

for (const [name, options] of Object.entries({
  phone: { viewport: { width: 390, height: 844 }, deviceScaleFactor: 2, isMobile: true, hasTouch: true },
  "small laptop": { viewport: { width: 1024, height: 700 } },
})) {
  test(`a report on a ${name} does not scroll sideways, and nothing sticks out`, async () => {
    const browser = await openBrowser(options);
    try {
      const { page } = await openPage(browser.context, url);
      const height = await page.evaluate(() => document.documentElement.scrollHeight);
      for (let y = 0; y < height; y += 700) {
        await page.evaluate((top) => window.scrollTo({ top, behavior: "instant" }), y);
        await settle(page);
      }
      const sizes = await page.evaluate(() => ({
        content: document.documentElement.scrollWidth,
        window: window.innerWidth,
      }));
      assert.ok(sizes.content <= sizes.window, `content ${sizes.content} px wide in a window of ${sizes.window} px`);
      const outside = await page.evaluate(() =>
        [...document.querySelectorAll("h1, h2, h3, p, canvas, select, button")]
          .filter(
            (element) =>
              !element.closest(".table-scroll, .scenes, .skip, .source") &&
              element.getBoundingClientRect().right > window.innerWidth + 1,
          )
          .map((element) => element.outerHTML.slice(0, 80)),
      );
      assert.deepEqual(outside, []);
    } finally {
      await browser.close();
    }
  });
}
