// Browsers without WebGL, dark systems, printers, and reports with parts missing: the page copes.
import assert from "node:assert/strict";
import { test } from "node:test";
import { openBrowser, openPage, settle } from "./browser.mjs";
import { fixtureReport } from "./fixture.mjs";
import { pixelsOf } from "./pixels.mjs";
import { fixtureUrl, pageWith } from "./report_under_test.mjs";

const url = fixtureUrl();

async function withPage(options, target, act) {
  const browser = await openBrowser(options);
  try {
    const { page, troubles } = await openPage(browser.context, target);
    await act(page, troubles);
    assert.deepEqual(
      troubles.filter((trouble) => !trouble.includes("GPU stall due to ReadPixels")),
      [],
    );
  } finally {
    await browser.close();
  }
}

test("without WebGL the mesh is replaced by a message and the charts are drawn", () =>
  withPage({ extraFlags: ["--disable-3d-apis"] }, url, async (page) => {
    const figure = page.locator("#figure2 .figure-mesh");
    await figure.scrollIntoViewIfNeeded();
    await settle(page);
    assert.match(await figure.locator("[role=status]").innerText(), /WebGL/);
    const chart = await pixelsOf(page, page.locator("#figure2 .chart canvas").first());
    assert.ok(chart.colours > 8, JSON.stringify(chart));
  }));

test("a dark system gets a dark page from the first moment", () =>
  withPage({ colorScheme: "dark" }, url, async (page) => {
    assert.equal(await page.evaluate(() => document.documentElement.dataset.theme), "dark");
    assert.equal(await page.evaluate(() => getComputedStyle(document.body).backgroundColor), "rgb(20, 23, 27)");
  }));

test("on paper a dark page is light and every chart is there", () =>
  withPage({ colorScheme: "dark" }, url, async (page) => {
    await page.evaluate(() => window.dispatchEvent(new Event("beforeprint")));
    await settle(page);
    assert.equal(await page.evaluate(() => document.documentElement.dataset.theme), "light");
    assert.equal(await page.locator(".chart canvas").count(), await page.locator(".chart").count());
    for (const canvas of await page.locator(".mesh canvas").all()) {
      const colours = await canvas.evaluate((element) => {
        const copy = new OffscreenCanvas(element.width, element.height);
        const context = copy.getContext("2d", { willReadFrequently: true });
        context.drawImage(element, 0, 0);
        return new Set(new Uint32Array(context.getImageData(0, 0, copy.width, copy.height).data.buffer)).size;
      });
      assert.ok(colours > 20, `a mesh that was never scrolled to is drawn for the printer: ${colours} colours`);
    }
    await page.evaluate(() => window.dispatchEvent(new Event("afterprint")));
    assert.equal(await page.evaluate(() => document.documentElement.dataset.theme), "dark");
  }));

test("a scene with empty tables, gaps, no law and no frames still shows what it has", () =>
  withPage({}, url, async (page) => {
    const scene = page.locator("#bare");
    await scene.scrollIntoViewIfNeeded();
    await settle(page);
    assert.equal(await scene.locator(".figure", { hasText: "Law of stiffness" }).count(), 0);
    assert.match(await scene.locator(".mesh-readout").innerText(), /no frames/);
    assert.ok(await scene.locator(".play").isDisabled());
    assert.match(await scene.locator(".summary").innerText(), /interrupted/);
  }));

test("a report of no scenes, and the bare template, say so", async () => {
  await withPage({}, pageWith({ ...fixtureReport(), scenes: [] }), async (page) => {
    assert.match(await page.locator("main").innerText(), /holds no scenes/);
  });
  await withPage({}, pageWith({ format: 7 }), async (page) => {
    assert.match(await page.locator("[role=alert]").innerText(), /format 7/);
  });
});

test("texts of a scene are shown as text, never run as markup", () => {
  const report = fixtureReport();
  report.scenes[0].title = '</script><img src=x onerror="window.broken=1">';
  report.scenes[0].variants[0].label = "<b>bold</b> & <script>window.broken=1</script>";
  return withPage({}, pageWith(report), async (page) => {
    assert.equal(await page.evaluate(() => window.broken), undefined);
    assert.match(await page.locator("#figure2 h2").innerText(), /<\/script><img src=x/);
    assert.equal(await page.locator(".legend-item b").count(), 0);
  });
});

test("nothing is drawn while nothing happens", () =>
  withPage({}, url, async (page) => {
    await page.locator("#figure2 .mesh canvas").scrollIntoViewIfNeeded();
    await settle(page);
    const frames = await page.evaluate(async () => {
      let asked = 0;
      const original = window.requestAnimationFrame;
      window.requestAnimationFrame = (callback) => (asked++, original.call(window, callback));
      await new Promise((done) => setTimeout(done, 500));
      window.requestAnimationFrame = original;
      return asked;
    });
    assert.equal(frames, 0);
  }));
