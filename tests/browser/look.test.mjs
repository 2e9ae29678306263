// How a body looks: tissue at first, a field by choice, what is inside through the surface, plain where WebGL is slow, and its
// scale and force beside it, whatever the screen.
import assert from "node:assert/strict";
import { after, before, describe, test } from "node:test";
import { openBrowser, openPage, settle } from "./browser.mjs";
import { fixtureReport, surface } from "./fixture.mjs";
import { grainAt, pixelsOf, tonesAt } from "./pixels.mjs";
import { pageWith } from "./report_under_test.mjs";

const isTrouble = (text) => !text.includes("GPU stall due to ReadPixels");

/** The fixture's first scene with a ball inside the body: twenty faces about its middle. */
function withInside() {
  const report = fixtureReport();
  report.scenes = report.scenes.slice(0, 1);
  for (const variant of report.scenes[0].variants) {
    const body = surface(6, 0.01, 1.1);
    variant.surface = { ...body, ...insideOf(body) };
  }
  return report;
}

function insideOf(body) {
  const bytes = (text) => new Uint8Array(Buffer.from(text, "base64")).buffer;
  const text = (array) => Buffer.from(array.buffer).toString("base64");
  const rest = new Float32Array(bytes(body.rest));
  const corners = [-1, 1].flatMap((x) => [-1, 1].flatMap((y) => [-1, 1].map((z) => [x, y, z])));
  const more = corners.flatMap(([x, y, z]) => [0.02 + 0.008 * x, 0.02 + 0.008 * y, 0.04 + 0.008 * z]);
  const first = rest.length / 3;
  const quads = [
    [0, 1, 3, 2],
    [4, 6, 7, 5],
    [0, 4, 5, 1],
    [2, 3, 7, 6],
    [0, 2, 6, 4],
    [1, 5, 7, 3],
  ];
  const triangles = quads.flatMap(([a, b, c, d]) => [a, b, c, a, c, d].map((i) => first + i));
  const grown = (array, count) => {
    const all = new array.constructor(array.length + count);
    all.set(array);
    return text(all);
  };
  return {
    vertices: first + 8,
    rest: text(Float32Array.from([...rest, ...more])),
    fixed: grown(new Uint8Array(bytes(body.fixed)), 8),
    tissue: "liver",
    regions: [{ name: "portal vein", triangles: text(Uint32Array.from(triangles)) }],
    frames: body.frames.map((frame) => ({
      ...frame,
      displacement: grown(new Int16Array(bytes(frame.displacement)), 24),
      intensity: grown(new Uint8Array(bytes(frame.intensity)), 8),
    })),
  };
}

describe("the look of a body", () => {
  let browser, page, troubles, panel;
  before(async () => {
    browser = await openBrowser({ colorScheme: "light" });
    ({ page, troubles } = await openPage(browser.context, pageWith(withInside(), "look")));
    panel = page.locator("#figure2 .mesh");
    await panel.scrollIntoViewIfNeeded();
    await settle(page);
  });
  after(() => browser?.close());

  const canvas = () => panel.locator("canvas");
  const hash = async () => (await pixelsOf(page, canvas())).hash;
  const choose = async (label, value) => {
    await panel.locator(`select[aria-label=${label}]`).selectOption(value);
    await settle(page);
  };
  /** Share of the body's middle that is red as tissue is, and blue as veins and the scale's low end are. */
  const tones = () =>
    tonesAt(page, canvas(), 0.44, 0.6, {
      red: ([, , high], [r, g, b]) => high === r && r > 1.5 * g && r > 1.5 * b,
      blue: ([, , high], [r, , b]) => high === b && b > r + 15,
    });

  test("is tissue at first, without a scale of colours; the field is one choice away", async () => {
    assert.ok((await tones()).red > 0.95, JSON.stringify(await tones()));
    assert.equal(await panel.locator(".colour-bar").isVisible(), false);
    assert.equal(await panel.locator("select[aria-label='Colours up to']").isVisible(), false);
    assert.match(await canvas().getAttribute("aria-label"), /as tissue/);
    await choose("Colour", "intensity");
    assert.ok((await tones()).blue > 0.95, JSON.stringify(await tones()));
    assert.equal(await panel.locator(".colour-bar").isVisible(), true);
    assert.equal(await panel.locator("select[aria-label='Colours up to']").isVisible(), true);
    assert.match(await canvas().getAttribute("aria-label"), /coloured by equivalent shear strain/);
    await choose("Colour", "none");
  });

  test("goes between tissue and field by a key, and sees through by another", async () => {
    await canvas().focus();
    await settle(page);
    const whole = await hash();
    await page.keyboard.press("f");
    await settle(page);
    assert.equal(await panel.locator("select[aria-label=Colour]").inputValue(), "intensity");
    await page.keyboard.press("f");
    await page.keyboard.press("g");
    await settle(page);
    assert.equal(await panel.locator("input[name=see-through]").isChecked(), true);
    assert.notEqual(await hash(), whole);
    await page.keyboard.press("g");
    await settle(page);
    assert.equal(await hash(), whole);
  });

  test("hides a vein in the whole body, and shows it through the surface and in the cut", async () => {
    const vein = () =>
      tonesAt(page, canvas(), 0.44, 0.5, { violet: ([, , high], [r, g, b]) => high === b && b > g + 12 && r > g });
    assert.equal((await vein()).violet, 0);
    await panel.locator("input[name=see-through]").check();
    await settle(page);
    assert.ok((await vein()).violet > 0.5, JSON.stringify(await vein()));
    await panel.locator("input[name=see-through]").uncheck();
    await panel.locator("input[name=open]").check();
    await settle(page);
    assert.ok((await vein()).violet > 0.5, JSON.stringify(await vein()));
    await panel.locator("input[name=open]").uncheck();
    await settle(page);
  });

  test("becomes plain by itself where WebGL is slow, and fine where that is asked for", async () => {
    // The browser of the tests draws in software: a drawing of the fine look takes longer than a sixtieth of a second there.
    const software = await page.evaluate(() => {
      const context = document.createElement("canvas").getContext("webgl2");
      const info = context.getExtension("WEBGL_debug_renderer_info");
      return /swiftshader|llvmpipe|software/i.test(context.getParameter(info.UNMASKED_RENDERER_WEBGL));
    });
    if (software) assert.equal(await canvas().getAttribute("data-look"), "plain");
    await choose("Detail", "plain");
    const plain = await grainAt(page, canvas(), 0.44, 0.6);
    await choose("Detail", "fine");
    assert.equal(await canvas().getAttribute("data-look"), "fine");
    const fine = await grainAt(page, canvas(), 0.44, 0.6);
    assert.ok(fine > 2 * plain, `relief: neighbours differ by ${fine} levels, by ${plain} in the plain look`);
    await choose("Detail", "auto");
  });

  test("has a bar of a round length, which is longer on the screen when one comes nearer", async () => {
    const bar = panel.locator(".scale-bar");
    assert.match(await bar.innerText(), /^(1|2|5)0*\smm$/);
    const perMillimetre = async () =>
      (await bar.locator("i").evaluate((i) => i.getBoundingClientRect().width)) / parseFloat(await bar.innerText());
    const far = await perMillimetre();
    await canvas().focus();
    await page.keyboard.press("+");
    await settle(page);
    assert.ok(Math.abs((await perMillimetre()) / far - 1 / 0.9) < 0.01);
    await page.keyboard.press("0");
    await settle(page);
  });

  test("shows the force of the moment beside its arrow, and none where there is none", async () => {
    const label = panel.locator(".force-label");
    // 0.0512 N a millimetre to 10 mm, and a little for viscosity and what goes aside, in the fixture's linear tissue.
    await page.locator("#figure2 .figure-mesh .figure-head select").selectOption("linear");
    await settle(page);
    assert.match(await label.innerText(), /^0\.51\d\sN$/);
    await panel.locator("input[name=arrow]").uncheck();
    await settle(page);
    assert.equal(await label.isVisible(), false);
    await panel.locator("input[name=arrow]").check();
    await settle(page);
  });

  test("is found again as it was left", async () => {
    await choose("Colour", "intensity");
    await page.reload();
    await panel.scrollIntoViewIfNeeded();
    await settle(page);
    assert.equal(await panel.locator("select[aria-label=Colour]").inputValue(), "intensity");
    await choose("Colour", "none");
  });

  test("caused no complaint", () => assert.deepEqual(troubles.filter(isTrouble), []));
});

for (const [name, viewport] of Object.entries({ phone: [390, 844], tablet: [800, 900], laptop: [1440, 900] })) {
  test(`what is written over the picture keeps apart on a ${name}, turned any way`, async () => {
    const browser = await openBrowser({ viewport: { width: viewport[0], height: viewport[1] } });
    try {
      const { page } = await openPage(browser.context, pageWith(withInside(), "look"));
      const panel = page.locator("#figure2 .mesh");
      await panel.scrollIntoViewIfNeeded();
      await panel.locator("select[aria-label=Colour]").selectOption("intensity");
      for (let turn = 0; turn < 8; turn++) {
        await panel.locator("canvas").focus();
        for (let i = 0; i < 6; i++) await page.keyboard.press(turn % 2 ? "ArrowRight" : "ArrowUp");
        await settle(page);
        const meeting = await panel.evaluate((element) => {
          const names = [".scale-bar", ".force-label", ".bar-title", ".bar-body", ".mesh-tools", ".mesh-key"];
          const boxes = names.map((selector) => {
            const found = element.querySelector(selector);
            const seen = found && getComputedStyle(found).visibility !== "hidden";
            return { selector, box: seen ? found.getBoundingClientRect() : new DOMRect() };
          });
          const apart = (a, b) =>
            a.width === 0 ||
            b.width === 0 ||
            a.right <= b.left ||
            b.right <= a.left ||
            a.bottom <= b.top ||
            b.bottom <= a.top;
          return boxes.flatMap((a, i) =>
            boxes
              .slice(i + 1)
              .filter((b) => !apart(a.box, b.box))
              .map((b) => a.selector + b.selector),
          );
        });
        assert.deepEqual(meeting, [], `turn ${turn}`);
      }
    } finally {
      await browser.close();
    }
  });
}
