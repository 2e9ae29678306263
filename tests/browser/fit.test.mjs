// A report of fits: it draws its charts, says its figures, copes with very little and very much, and prints.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { after, before, describe, test } from "node:test";
import { bareFit, fitFixture, fitReport, largeFit } from "../../web/test/fit_fixture.mjs";
import { openBrowser, openPage, settle } from "./browser.mjs";
import { fixtureReport } from "./fixture.mjs";
import { pixelsOf } from "./pixels.mjs";
import { pageWith } from "./report_under_test.mjs";

const url = pageWith(fitReport(fitFixture()), "fit");

async function withPage(options, target, act) {
  const browser = await openBrowser(options);
  try {
    const { page, troubles } = await openPage(browser.context, target);
    await act(page);
    // A software GPU says of its own accord, in a warning, that reading pixels back stalls it.
    assert.deepEqual(
      troubles.filter((trouble) => !trouble.includes("GPU stall due to ReadPixels")),
      [],
    );
  } finally {
    await browser.close();
  }
}

/** Pixels of exactly this colour on a chart's canvas. */
const countOf = (canvas, colour) =>
  canvas.evaluate((element, [r, g, b]) => {
    const copy = new OffscreenCanvas(element.width, element.height);
    const context = copy.getContext("2d", { willReadFrequently: true });
    context.drawImage(element, 0, 0);
    const data = context.getImageData(0, 0, copy.width, copy.height).data;
    let count = 0;
    for (let i = 0; i < data.length; i += 4)
      if (data[i] === r && data[i + 1] === g && data[i + 2] === b && data[i + 3] > 250) count++;
    return count;
  }, colour);

const GREY = [143, 152, 162];
const INK = [26, 31, 38];
const WHITE_INK = [232, 235, 238];

const cells = (row) => row.locator("th, td").allInnerTexts();

describe("a fit on a laptop", () => {
  let browser, page, troubles;
  before(async () => {
    browser = await openBrowser({ colorScheme: "light" });
    ({ page, troubles } = await openPage(browser.context, url));
  });
  after(() => browser?.close());

  test("has a way to each of its parts", async () => {
    const ways = await page
      .locator("nav.scenes a")
      .evaluateAll((links) => links.map((link) => document.querySelector(link.getAttribute("href")) !== null));
    assert.equal(ways.length, 10);
    assert.ok(ways.every(Boolean));
    assert.equal(await page.locator("h1").innerText(), "Phantom EF10_100T");
  });

  test("says itself in five lines, conclusions and key figures below the parameters, and no interruption", async () => {
    assert.equal(await page.locator(".fit-head .fit-lines dt").count(), 5);
    const order = await page.evaluate(() => {
      const place = (name) => document.querySelector(name).getBoundingClientRect().top;
      return [".fit-lines", ".fit-curves", ".parameter-table", ".conclusions", ".key-figures"].map(place);
    });
    assert.deepEqual(
      order,
      [...order].sort((a, b) => a - b),
    );
    assert.equal(await page.locator(".conclusions li").count(), 3);
    assert.match(await page.locator(".key-figures").innerText(), /16 of 20 starts/);
    assert.equal(await page.locator(".banner").count(), 0);
  });

  test("draws measured curves in grey and the simulation in black, fitted beside held out", async () => {
    const charts = page.locator(".fit-curves");
    assert.equal(await charts.count(), 2);
    assert.deepEqual(await charts.locator(".use").allInnerTexts(), ["fitted", "held out"]);
    for (const chart of await charts.all()) {
      await chart.scrollIntoViewIfNeeded();
      await settle(page);
      const canvas = chart.locator("canvas");
      const [grey, ink] = [await countOf(canvas, GREY), await countOf(canvas, INK)];
      assert.ok(grey > 20 && ink > 200, `grey ${grey}, black ${ink}`);
    }
    const boxes = await Promise.all((await charts.all()).map((chart) => chart.boundingBox()));
    assert.equal(boxes[0].y, boxes[1].y, "side by side");
  });

  test("reads the range of the repetitions at the cursor, and hides them in all charts together", async () => {
    const chart = page.locator(".fit-curves").first();
    await chart.scrollIntoViewIfNeeded();
    const box = await chart.locator(".u-over").boundingBox();
    await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
    await settle(page);
    assert.match(await chart.locator(".legend-item").first().innerText(), /measured, 3 repetitions\s*1\.\d+ … 1\.\d+/);
    await chart.locator(".legend-item").first().click();
    await page.mouse.move(5, 5);
    await settle(page);
    assert.equal(await countOf(chart.locator("canvas"), GREY), 0);
    assert.equal(await page.locator(".fit-curves .legend-item[aria-pressed=false]").count(), 2);
    await chart.locator(".legend-item").first().click();
  });

  test("tells value, intervals and verdict of each parameter", async () => {
    const rows = page.locator(".parameter-table tbody tr");
    const [mu, alpha, nu] = await Promise.all([0, 1, 2].map((at) => cells(rows.nth(at))));
    assert.match(mu[0], /^μ1\s+tissue\.hyperelastic\.mu_Pa\[0\]$/);
    assert.match(mu[1], /^1\.192\skPa$/);
    assert.match(mu[2].replace(/\s+/g, " "), /profile 1\.134 – 1\.257 curvature 1\.131 – 1\.253/);
    assert.match(mu[4], /Identified/);
    assert.match(alpha[4], /Weak/);
    assert.match(nu[0], /^Poisson’s ratio/);
    assert.match(nu[2], /open on both sides/);
    assert.match(nu[4], /Not identifiable/);
  });

  test("draws intervals where they lie between the bounds", async () => {
    const [track, part, mark] = await page
      .locator(".parameter-table tbody tr")
      .nth(2)
      .locator(".track, .part-1, .value-mark")
      .evaluateAll((all) => all.map((element) => element.getBoundingClientRect()));
    const share = (x) => (x - track.left) / track.width;
    assert.ok(Math.abs(share(part.left) - (0.3344 - 0.3) / 0.199) < 0.01, `${share(part.left)}`);
    assert.ok(Math.abs(share(part.right) - 1) < 0.01);
    assert.ok(Math.abs(share(mark.left + mark.width / 2) - (0.452 - 0.3) / 0.199) < 0.01);
  });

  test("draws every small chart, and says in words which profile is flat", async () => {
    const plots = page.locator(".plot-frame");
    const count = await plots.count();
    assert.equal(count, 3 + 3 + 2 + 1, "profiles, pairs, residuals, starts");
    for (let n = 0; n < count; n++) {
      const pixels = await pixelsOf(page, plots.nth(n));
      assert.ok(pixels.colours > 8 && pixels.drawn > 0.01, `plot ${n}: ${JSON.stringify(pixels)}`);
    }
    assert.match((await page.locator("#phantom-profiles .plot-words").allInnerTexts())[2], /Flat/);
  });

  test("reads a point of a small chart by mouse and by arrow keys", async () => {
    const plot = page.locator("#phantom-starts .plot");
    const reads = async (what) => {
      const text = () => plot.locator(".plot-readout").innerText();
      for (let n = 0; n < 40 && !what.test(await text()); n++) await page.waitForTimeout(50);
      assert.match(await text(), what);
    };
    await page.mouse.move(5, 5); // scrolling may take a plot away from under the mouse, which clears what it reads
    await plot.scrollIntoViewIfNeeded();
    await plot.focus();
    await page.keyboard.press("ArrowRight");
    await reads(/^best optimum: 388\.2/);
    const box = await plot.locator(".plot-frame").boundingBox();
    await page.mouse.move(box.x + box.width * 0.96, box.y + box.height * 0.1);
    await reads(/^another optimum: 5230\.1/);
    await page.mouse.move(5, 5);
    await reads(/^$/);
  });

  test("shows correlations as numbers, and the strongest in words", async () => {
    const second = await cells(page.locator(".matrix tbody tr").nth(1));
    assert.deepEqual(second.slice(1), ["−0.94", "1", "−0.12"]);
    assert.match(await page.locator(".figure-matrix .figure-note").innerText(), /μ1 and α1/);
  });

  test("ranks laws, sets errors against the spread, and proposes experiments", async () => {
    const table = (name) => page.locator(`.data-table[aria-label="${name}"] tbody tr`);
    assert.deepEqual((await cells(table("Laws").nth(1))).slice(0, 6), [
      "Ogden, 1 term",
      "2",
      "0.148",
      "0.152",
      "0",
      "0",
    ]);
    assert.match((await cells(table("Laws").nth(1)))[6], /Supported by the data/);
    assert.match(
      (await cells(table("Error against the spread of repetitions").nth(1))).join("|"),
      /held out\|2\|0\.178/,
    );
    assert.match((await cells(table("Next experiment").first()))[4], /^×\s9\.48$/);
  });

  test("saves every sample of the curves, and the tissue", async () => {
    const save = async (name) => {
      const waiting = page.waitForEvent("download");
      await page.locator("#phantom-files .downloads button", { hasText: name }).click();
      const download = await waiting;
      return [download.suggestedFilename(), readFileSync(await download.path(), "utf8")];
    };
    const [name, text] = await save("Curves");
    assert.equal(name, "phantom-curves.csv");
    assert.equal(text.trimEnd().split("\n").length, 1 + 5 * 260);
    assert.deepEqual(await save("tissue.toml"), ["tissue.toml", fitFixture().tissue]);
  });

  test("has no duplicate ids, and caused no console error", async () => {
    const ids = await page.locator("[id]").evaluateAll((all) => all.map((element) => element.id));
    assert.equal(new Set(ids).size, ids.length);
    assert.deepEqual(troubles, []);
  });
});

test("in the dark the simulation is light, and small charts turn with the theme", () =>
  withPage({ colorScheme: "dark" }, url, async (page) => {
    const chart = page.locator(".fit-curves").first();
    await chart.scrollIntoViewIfNeeded();
    await settle(page);
    assert.ok((await countOf(chart.locator("canvas"), WHITE_INK)) > 200);
    const stroke = () =>
      page
        .locator(".plot-line")
        .first()
        .evaluate((path) => getComputedStyle(path).stroke);
    assert.equal(await stroke(), "rgb(232, 235, 238)");
    await page.locator(".page-bar button").click();
    assert.equal(await stroke(), "rgb(26, 31, 38)");
  }));

test("on paper everything is light, within the sheet, and without controls", () =>
  withPage({ colorScheme: "dark", viewport: { width: 688, height: 900 } }, url, async (page) => {
    await page.emulateMedia({ media: "print" });
    await page.evaluate(() => window.dispatchEvent(new Event("beforeprint")));
    await settle(page);
    assert.equal(await page.locator(".fit-curves canvas").count(), 2, "charts never scrolled to are drawn");
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= 688));
    assert.equal(await page.locator(".downloads").isVisible(), false);
    assert.equal(await page.locator(".parameter-table thead").isVisible(), true);
  }));

test("a fit of which little is known shows what it has", () =>
  withPage({}, pageWith(fitReport(bareFit()), "bare"), async (page) => {
    assert.match(await page.locator(".banner").innerText(), /Interrupted\. 1 of 20 starts/);
    assert.match(await page.locator(".key-figures").innerText(), /none held out/);
    assert.match(await page.locator(".parameter-table").innerText(), /not known/);
    assert.equal(await page.locator(".matrix, .conclusions, #bare-profiles").count(), 0);
  }));

test("texts of a fit are shown as text, never run as markup", () => {
  const fit = fitFixture();
  const evil = "<img src=x onerror='window.broken=1'>";
  Object.assign(fit, { title: evil, conclusions: [evil], notes: [evil], law: evil });
  fit.parameters[0].words = evil;
  fit.profiles[0].words = evil;
  fit.groups.forEach((group) => (group.name = evil));
  fit.curves.forEach((curve) => (curve.group = curve.name = evil));
  return withPage({}, pageWith(fitReport(fit), "evil"), async (page) => {
    await settle(page);
    assert.equal(await page.evaluate(() => window.broken), undefined);
    assert.equal(await page.locator("img").count(), 0);
  });
});

test("scenes and fits stand in one report, with a way to each", () => {
  const report = { ...fixtureReport(), fits: [fitFixture()] };
  return withPage({}, pageWith(report, "mixed"), async (page) => {
    assert.deepEqual(await page.locator("main > section").evaluateAll((all) => all.map((section) => section.id)), [
      ...report.scenes.map((scene) => scene.name),
      "phantom",
    ]);
    assert.equal(await page.locator('nav.scenes a[href="#phantom"]').innerText(), "Phantom EF10_100T");
  });
});

for (const width of [400, 760, 1280]) {
  test(`fits small and large do not scroll sideways at ${width} px, and nothing sticks out`, () =>
    withPage(
      { viewport: { width, height: 900 } },
      pageWith(fitReport(fitFixture(), bareFit(), largeFit()), "all"),
      async (page) => {
        await settle(page);
        assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), width);
        const outside = await page.evaluate(() =>
          [...document.querySelectorAll("main *")]
            .filter((element) => !element.closest(".table-scroll, .source, svg, .visually-hidden"))
            .filter((element) => element.getBoundingClientRect().right > window.innerWidth + 1)
            .map((element) => element.outerHTML.slice(0, 100)),
        );
        assert.deepEqual(outside, []);
        assert.equal(await page.locator("nav.scenes a").count(), 3, "a way to each fit");
      },
    ));
}
