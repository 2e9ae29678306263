// measure_drawing.mjs SCENE [WIDTHxHEIGHT …] — in the fine look unless GLISSON_DETAIL says plain or auto; what a frame costs the live page, and how many it draws: no test, a measurement.
//
//   GLISSON_WEB_DIR=build/release/web/page node tests/browser/measure_drawing.mjs box.toml 1440x900 600x400
//
// The page's own work of a frame is the time in its message handler (decoding) and in its animation callback (places, colours,
// upload, calls of WebGL). Rasterising is another process's affair: with a graphics card it is free, in software it sets the rate.
import { readFileSync } from "node:fs";
import { openBrowser } from "./browser.mjs";
import { openLive } from "./live_under_test.mjs";

const SECONDS = 12;

/** Runs in the page before its own script: times handlers and animation callbacks. */
function instrument() {
  const times = (window.drawingTimes = { message: [], draw: [], at: [] });
  const handler = Object.getOwnPropertyDescriptor(WebSocket.prototype, "onmessage");
  Object.defineProperty(WebSocket.prototype, "onmessage", {
    set(act) {
      handler.set.call(this, (event) => {
        const begin = performance.now();
        act(event);
        if (typeof event.data !== "string" && new Uint8Array(event.data, 0, 1)[0] === 2)
          times.message.push(performance.now() - begin);
      });
    },
  });
  const draw = WebGL2RenderingContext.prototype.drawElements;
  let drawn = false;
  WebGL2RenderingContext.prototype.drawElements = function (...all) {
    drawn = true;
    return draw.apply(this, all);
  };
  const request = window.requestAnimationFrame.bind(window);
  window.requestAnimationFrame = (act) =>
    request((now) => {
      drawn = false;
      const begin = performance.now();
      act(now);
      if (!drawn) return;
      times.draw.push(performance.now() - begin);
      times.at.push(begin);
    });
}

const share = (values, p) =>
  [...values].sort((a, b) => a - b)[Math.min(values.length - 1, Math.floor(p * values.length))];
const told = (values) => `${share(values, 0.5).toFixed(2)} / ${share(values, 0.99).toFixed(2)}`;

async function measure(url, [width, height]) {
  const browser = await openBrowser({ viewport: { width, height } });
  const page = await browser.context.newPage();
  await page.addInitScript(`(${instrument})()`);
  const look = { colour: "none", seeThrough: false, detail: process.env.GLISSON_DETAIL ?? "fine" };
  await page.addInitScript(
    (kept) => localStorage.setItem(`glisson-look:${location.pathname}:live`, kept),
    JSON.stringify(look),
  );
  await page.goto(url);
  await page.waitForFunction(() => document.querySelector(".live")?.dataset.drives === "true");
  const half = Math.round((SECONDS * 1000) / 2);
  const count = () => page.evaluate(() => window.drawingTimes.at.length);
  await page.getByRole("button", { name: "Play the scene" }).click();
  await page.waitForTimeout(half);
  const first = await count();
  await page.waitForTimeout(half);
  const times = await page.evaluate(() => window.drawingTimes);
  const canvas = await page.evaluate(() => {
    const c = document.querySelector(".live-canvas");
    return `${c.width} × ${c.height}`;
  });
  const late = times.at.slice(first);
  const rate = (1000 * (late.length - 1)) / (late[late.length - 1] - late[0]);
  console.log(
    `${width} × ${height}: message ${told(times.message)} ms, draw ${told(times.draw)} ms (p50 / p99 of ${times.draw.length}), ` +
      `${rate.toFixed(1)} drawn a second on a canvas of ${canvas}`,
  );
  await browser.close();
}

const [scene, ...sizes] = process.argv.slice(2);
for (const size of sizes.length > 0 ? sizes : ["1440x900", "600x400"]) {
  const live = await openLive(readFileSync(scene, "utf8"));
  await measure(live.url, size.split("x").map(Number));
  await live.close();
}
