// What a reader does with the page has its effect: toggling, zooming, playing, saving, switching to dark.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { after, before, describe, test } from "node:test";
import { openBrowser, openPage, settle } from "./browser.mjs";
import { fixtureReport } from "./fixture.mjs";
import { canvasOf, lineColours, pixelsOf } from "./pixels.mjs";
import { fixtureUrl } from "./report_under_test.mjs";

const url = fixtureUrl();
const BLUE = "0,104,168";
const VERMILLION = "207,82,0";

describe("reader's actions", () => {
  let browser, page, troubles, chart;
  before(async () => {
    browser = await openBrowser({ colorScheme: "light" });
    ({ page, troubles } = await openPage(browser.context, url));
    chart = page.locator("#figure2 .chart").first();
    await chart.scrollIntoViewIfNeeded();
    await settle(page);
  });
  after(() => browser?.close());

  const canvas = () => chart.locator("canvas");
  const item = (text) => chart.locator(".legend-item", { hasText: text });

  test("a line that is pointed at stands out in every chart of its scene, and all others step back", async () => {
    const before = (await lineColours(canvas()))[VERMILLION];
    await item("Linear").hover();
    await settle(page);
    assert.ok((await lineColours(canvas()))[BLUE] > 50, "the line pointed at keeps its colour");
    assert.ok(((await lineColours(canvas()))[VERMILLION] ?? 0) < 0.2 * before, "others are faint");
    const marked = await page.locator("#figure2 .chart").evaluateAll((all) => all.map((one) => one.dataset.highlight));
    assert.ok(marked.filter((key) => key !== "").length >= 3, `highlighted in ${marked}`);
    await page.mouse.move(2, 2);
    await settle(page);
    assert.equal((await lineColours(canvas()))[VERMILLION], before);
  });

  test("every chart is saved as SVG with its lines, letters and names", async () => {
    await chart.hover();
    const waiting = page.waitForEvent("download");
    await chart.locator(".save-svg").click();
    const download = await waiting;
    assert.match(download.suggestedFilename(), /^[a-z0-9-]+\.svg$/);
    const svg = readFileSync(await download.path(), "utf8");
    const read = await page.evaluate((text) => {
      const drawn = new DOMParser().parseFromString(text, "image/svg+xml");
      const texts = [...drawn.querySelectorAll("text")].map((one) => one.textContent);
      return {
        broken: drawn.querySelector("parsererror") !== null,
        long: [...drawn.querySelectorAll("path[stroke]")].filter((one) => one.getAttribute("d").length > 400).length,
        texts,
        images: drawn.querySelectorAll("image, foreignObject").length,
      };
    }, svg);
    assert.equal(read.broken, false);
    assert.ok(read.long >= 3, "a path a line");
    for (const text of ["Linear", "Depth [mm]"])
      assert.ok(
        read.texts.some((one) => one.includes(text)),
        text,
      );
    assert.ok(read.texts.filter((one) => /^[\d.]+$/.test(one)).length >= 6, "numbers at both axes");
    assert.equal(read.images, 0);
    await page.mouse.move(2, 2);
  });

  test("a legend entry hides and shows its line, by mouse and by keyboard, in every chart of the scene", async () => {
    assert.ok((await lineColours(canvas()))[BLUE] > 50, "the linear tissue is drawn in blue");
    await item("Linear").click();
    await settle(page);
    assert.equal((await lineColours(canvas()))[BLUE], undefined, "no blue is left");
    assert.equal(await item("Linear").getAttribute("aria-pressed"), "false");
    assert.equal(
      await page.locator("#figure2 .legend-item[aria-pressed=false]").count(),
      3,
      "both force charts and the law",
    );
    await item("Linear").focus();
    await page.keyboard.press("Enter");
    await settle(page);
    assert.ok((await lineColours(canvas()))[BLUE] > 50, "blue is back");
  });

  test("Shift shows one line alone, and all again", async () => {
    await item("Tissue 1").click({ modifiers: ["Shift"] });
    await settle(page);
    const alone = await lineColours(canvas());
    assert.ok(alone[VERMILLION] > 50 && alone[BLUE] === undefined, JSON.stringify(alone));
    await item("Tissue 1").click({ modifiers: ["Shift"] });
    await settle(page);
    assert.ok((await lineColours(canvas()))[BLUE] > 50);
  });

  test("the legend reads the values under the cursor", async () => {
    const box = await chart.locator(".u-over").boundingBox();
    await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
    await settle(page);
    assert.match(await chart.locator(".chart-readout").innerText(), /^Depth (4\.9\d*|5\.0\d*)\smm$/);
    const value = Number(await item("Linear").locator(".legend-value").innerText());
    assert.ok(Math.abs(value - 0.256) < 0.004, `half way down the linear tissue pushes with 0.256 N, shown ${value}`);
    await page.mouse.move(5, 5);
    await settle(page);
    assert.equal(await chart.locator(".chart-readout").innerText(), "");
  });

  test("arrow keys move the cursor", async () => {
    await chart.locator(".chart-plot").focus();
    await page.keyboard.press("ArrowRight");
    await page.keyboard.press("Shift+ArrowRight");
    assert.match(await chart.locator(".chart-readout").innerText(), /^Depth \S+\smm$/);
  });

  test("dragging zooms; double click, button and Escape reset", async () => {
    const home = (await canvasOf(canvas())).hash;
    const reset = chart.locator(".chart-reset");
    assert.equal(await reset.isVisible(), false);
    const ways = {
      button: () => reset.click(),
      "double click": async () => {
        const box = await chart.locator(".u-over").boundingBox();
        await page.mouse.dblclick(box.x + 100, box.y + 100);
      },
      Escape: async () => {
        await chart.locator(".chart-plot").focus();
        await page.keyboard.press("Escape");
      },
    };
    for (const [name, way] of Object.entries(ways)) {
      const box = await chart.locator(".u-over").boundingBox();
      await page.mouse.move(box.x + 0.5 * box.width, box.y + 0.2 * box.height);
      await page.mouse.down();
      await page.mouse.move(box.x + 0.8 * box.width, box.y + 0.7 * box.height, { steps: 6 });
      await page.mouse.up();
      await settle(page);
      assert.notEqual((await canvasOf(canvas())).hash, home, `${name}: the drag changed the picture`);
      assert.equal(await reset.isVisible(), true);
      await way();
      await page.mouse.move(5, 5);
      await page.evaluate(() => document.activeElement?.blur());
      await settle(page);
      assert.equal((await canvasOf(canvas())).hash, home, `${name}: the picture is the first one again`);
      assert.equal(await reset.isVisible(), false);
    }
  });

  test("the mesh plays to its end, takes another variant, exaggerates and turns", async () => {
    const mesh = page.locator("#figure2 .mesh");
    const view = mesh.locator("canvas");
    await view.scrollIntoViewIfNeeded();
    await settle(page);
    const first = (await pixelsOf(page, view)).hash;
    await mesh.locator("label.select", { hasText: "Speed" }).locator("select").selectOption("1");
    await mesh.locator(".play").click();
    assert.equal(await mesh.locator(".play").getAttribute("aria-label"), "Pause");
    await page.waitForFunction(
      () => document.querySelector("#figure2 .play").getAttribute("aria-label") === "Play",
      null,
      { timeout: 15_000 },
    );
    assert.match(await mesh.locator(".mesh-readout").innerText(), /^1\.100\ss · depth 10\.00\smm/);
    assert.equal((await pixelsOf(page, view)).hash, first, "the end looks as before");
    await mesh.getByLabel("Displacement", { exact: true }).selectOption("2");
    await settle(page);
    const exaggerated = (await pixelsOf(page, view)).hash;
    assert.notEqual(exaggerated, first);
    await view.focus();
    await page.keyboard.press("ArrowLeft");
    await settle(page);
    assert.notEqual((await pixelsOf(page, view)).hash, exaggerated, "an arrow key turns the view");
    await mesh.locator("input[name=ghost]").check();
    await page.locator("#figure2 .figure-mesh .figure-head select").selectOption("linear");
    assert.match(await view.getAttribute("aria-label"), /Linear/);
  });

  test("rings in the charts stand where the playback stands", async () => {
    const mesh = page.locator("#figure2 .mesh");
    await page.locator("#figure2 .figure-mesh .figure-head select").selectOption("linear");
    const slider = mesh.locator("input[aria-label=Time]");
    await slider.focus();
    await slider.press("Home");
    const ring = () =>
      chart
        .locator(".mark-playhead:not([hidden])")
        .evaluateAll((all) => all.map((dot) => new DOMMatrix(getComputedStyle(dot).transform).e));
    const atStart = await ring();
    assert.equal(atStart.length, 1, "one ring, on the line of the variant shown");
    assert.ok(Math.abs(atStart[0]) < 1, `at depth 0: ${atStart[0]} px`);
    await slider.press("End");
    const width = await chart.locator(".u-over").evaluate((over) => over.clientWidth);
    assert.ok(Math.abs((await ring())[0] - width) < 2, "at full depth: the right end");
  });

  test("the picture of the mesh is saved as PNG, the forces as CSV with all samples", async () => {
    const picture = page.waitForEvent("download");
    await page.locator("#figure2 .mesh [data-tool=camera]").click();
    const png = readFileSync(await (await picture).path());
    assert.equal(png.subarray(1, 4).toString(), "PNG");
    assert.ok(png.length > 10_000, `${png.length} bytes`);
    const table = page.waitForEvent("download");
    await page.locator("#figure2 .downloads button").nth(1).click();
    const download = await table;
    assert.equal(download.suggestedFilename(), "figure2-tissue1-forces.csv");
    const lines = readFileSync(await download.path(), "utf8")
      .trim()
      .split("\n");
    const forces = fixtureReport().scenes[0].variants[1].forces;
    assert.equal(lines[0], forces.columns.join(","));
    assert.equal(lines.length, forces.data[0].length + 1);
    assert.deepEqual(
      lines[251].split(",").map(Number),
      forces.data.map((column) => column[250]),
    );
  });

  test("the scene's source unfolds, unchanged", async () => {
    await page.locator("#figure2 details.source summary").click();
    const shown = await page.locator("#figure2 details.source pre").innerText();
    assert.equal(shown.trimEnd(), fixtureReport().scenes[0].source.trimEnd());
  });

  test("the theme button turns the page dark, charts included", async () => {
    const background = () => page.evaluate(() => getComputedStyle(document.body).backgroundColor);
    assert.equal(await background(), "rgb(255, 255, 255)");
    await page.locator(".page-bar button").click();
    await settle(page);
    assert.equal(await background(), "rgb(20, 23, 27)");
    const colours = await lineColours(canvas());
    assert.ok(colours["90,180,236"] > 50 && colours[BLUE] === undefined, "lines take the colours of the dark page");
    await page.locator(".page-bar button").click();
  });

  test("none of this caused a console error", () => {
    assert.deepEqual(
      troubles.filter((trouble) => !trouble.includes("GPU stall due to ReadPixels")),
      [],
    );
  });
});
