// heat.test.mjs — a body of heat: isotherms are seen within it, grow along the time line, and can be left out.
import assert from "node:assert/strict";
import { after, before, describe, test } from "node:test";
import { openBrowser, openPage, settle } from "./browser.mjs";
import { fixtureReport } from "./fixture.mjs";
import { pixelsOf } from "./pixels.mjs";
import { pageWith } from "./report_under_test.mjs";

const isTrouble = (text) => !text.includes("GPU stall due to ReadPixels");
const base64 = (array) => Buffer.from(array.buffer).toString("base64");

const N = 8;
const SIZE = 0.04;
const FRAMES = [0, 300, 600];
const at = (i, j, k) => i + (N + 1) * (j + (N + 1) * k);

/** A cube of six tets a cell; its middle cools from 37 °C to 37 °C − depth. */
function coldCube() {
  const points = [];
  for (let k = 0; k <= N; k++)
    for (let j = 0; j <= N; j++) for (let i = 0; i <= N; i++) points.push([i, j, k].map((x) => (SIZE * x) / N));
  const tets = [];
  const orders = [
    [0, 1, 2],
    [0, 2, 1],
    [1, 0, 2],
    [1, 2, 0],
    [2, 0, 1],
    [2, 1, 0],
  ];
  for (let k = 0; k < N; k++)
    for (let j = 0; j < N; j++)
      for (let i = 0; i < N; i++)
        for (const order of orders) {
          const corner = [i, j, k];
          const tet = [at(i, j, k)];
          for (const axis of order) {
            corner[axis]++;
            tet.push(at(...corner));
          }
          const odd = order[1] !== (order[0] + 1) % 3;
          tets.push(...(odd ? [tet[0], tet[2], tet[1], tet[3]] : tet));
        }
  const faces = new Map();
  for (let t = 0; t < tets.length; t += 4) {
    const [a, b, c, d] = tets.slice(t, t + 4);
    for (const face of [
      [b, c, d],
      [a, d, c],
      [a, b, d],
      [a, c, b],
    ]) {
      const key = [...face].sort((x, y) => x - y).join(" ");
      faces.has(key) ? faces.delete(key) : faces.set(key, face);
    }
  }
  const temperature = (depth) => {
    const values = points.map(
      (p) => 37 - depth * Math.exp(-((Math.hypot(...p.map((x) => x - SIZE / 2)) / 0.008) ** 2)),
    );
    const low = Math.min(0, ...values);
    return {
      low,
      high: 37,
      values: base64(Uint8Array.from(values, (t) => Math.round((255 * (t - low)) / (37 - low)))),
    };
  };
  return {
    vertices: points.length,
    triangles: base64(Uint32Array.from([...faces.values()].flat())),
    tets: base64(Uint32Array.from(tets)),
    rest: base64(Float32Array.from(points.flat())),
    fixed: base64(new Uint8Array(points.length)),
    isotherms: [
      { name: "kill", temperature_C: -40 },
      { name: "ice", temperature_C: 0 },
    ],
    instruments: [],
    frames: FRAMES.map((time, n) => ({
      time_s: time,
      displacement_scale_m: 0,
      displacement: "",
      intensity_max: 0,
      intensity: "",
      fields: { temperature: temperature(80 * n) },
      instruments: [],
    })),
  };
}

/** The fixture's first scene as one of heat. */
function heatReport() {
  const report = fixtureReport();
  report.scenes = report.scenes.slice(0, 1);
  const [scene] = report.scenes;
  scene.variants = scene.variants.slice(0, 1);
  const time = { columns: ["time_s"], data: [FRAMES] };
  Object.assign(scene.variants[0], { surface: coldCube(), forces: time, instruments: [], events: [] });
  return report;
}

describe("a body of heat", () => {
  let browser;
  let page;
  let troubles;
  before(async () => {
    browser = await openBrowser({ viewport: { width: 1200, height: 900 } });
    ({ page, troubles } = await openPage(browser.context, pageWith(heatReport(), "heat")));
    await page.locator(".mesh-canvas").scrollIntoViewIfNeeded();
    await settle(page);
  });
  after(() => browser?.close());

  const seek = async (step) => {
    await page.locator(".mesh-playback input").evaluate((slider, value) => {
      slider.value = value;
      slider.dispatchEvent(new Event("input"));
    }, String(step));
    await settle(page);
  };
  const picture = () => pixelsOf(page, page.locator(".mesh-canvas"));

  test("names its isotherms, the nearest to the body's temperature first", async () => {
    assert.deepEqual(await page.locator(".mesh-key .key-isotherm").allTextContents(), ["0 °C (ice)", "−40 °C (kill)"]);
  });

  test("has no displacement to exaggerate, and is seen through at first", async () => {
    assert.equal(await page.locator(".figure-mesh h3").first().textContent(), "Temperature in the body");
    assert.equal(await page.locator(".mesh-options", { hasText: "Displacement" }).count(), 0);
    assert.equal(await page.locator("input[name=see-through]").isChecked(), true);
    assert.equal(await page.locator(".mesh-readout").textContent(), "10.0\u00a0min");
  });

  test("shows other isotherms at other times, and none where they are left out", async () => {
    await seek(600);
    const end = await picture();
    await seek(300);
    const middle = await picture();
    assert.notEqual(end.hash, middle.hash, "they have grown");
    await page.locator("input[name=isotherms]").uncheck();
    await settle(page);
    const without = await picture();
    assert.notEqual(without.hash, middle.hash, "they are gone");
    await seek(600);
    assert.equal((await picture()).hash, without.hash, "without them nothing changes with time");
    assert.equal(await page.locator(".mesh-key .key-isotherm").count(), 0);
    await page.locator("input[name=isotherms]").check();
    await settle(page);
    assert.equal((await picture()).hash, end.hash);
  });

  test("says nothing in the console", () => assert.deepEqual(troubles.filter(isTrouble), []));
});
