// The live view in a real browser: the body is drawn, a needle pushed by hand meets the scene's force, a change of the tissue
// is felt, a line that was cut comes back, and strangers stay out.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdirSync } from "node:fs";
import { join } from "node:path";
import { after, before, describe, test } from "node:test";
import { WEB_DIR, openBrowser, openPage, settle } from "./browser.mjs";
import { NEEDLE as SCENE, forceOfRun, later, openLive, own, program, state, type, until } from "./live_under_test.mjs";
import { pixelsOf } from "./pixels.mjs";

const shots = join(WEB_DIR, "live-screenshots");

describe("live view", { skip: program() === null ? "the program is not built" : false }, () => {
  let live, browser, page, troubles;
  before(async () => {
    mkdirSync(shots, { recursive: true });
    live = await openLive(SCENE);
    browser = await openBrowser({ colorScheme: "light" });
    ({ page, troubles } = await openPage(browser.context, live.url));
    await until(page, (s) => Number(s.time) > 0.01, "the first frames");
  });
  after(async () => {
    await browser?.close();
    assert.equal(await live?.close(), 0, "Ctrl-C ends the program cleanly");
  });

  test("draws the body and says what it is", async () => {
    await settle(page);
    const drawn = await pixelsOf(page, page.locator(".live-canvas"));
    assert.ok(drawn.drawn > 0.1 && drawn.colours > 50, JSON.stringify(drawn));
    assert.equal(await page.locator("h1").innerText(), "A needle, live");
    assert.match(await page.locator(".live-subtitle").innerText(), /1,?.?296 tetrahedra/);
    assert.match(await page.locator(".live-lead").innerText(), /You lead/);
    for (const unit of ["N", "mm", "s", "µs", "ms"])
      assert.match(await page.locator(".live-numbers").innerText(), new RegExp(`\\s${unit}(\\s|$)`, "m"));
  });

  test("a needle pushed 10 mm gives the force of the scene's own run within 1 %", async () => {
    const expected = forceOfRun(live.file, live.folder);
    assert.ok(Math.abs(expected) > 0.05, `the needle meets something: ${expected} N`);
    const before = await pixelsOf(page, page.locator(".live-canvas"));
    await type(page, "Depth [mm]", 10);
    await until(page, (s) => Number(s.depth) > 0.009999, "10 mm deep");
    const now = await later(page, 1);
    assert.ok(Math.abs(Number(now.depth) - 0.01) < 1e-6, now.depth);
    assert.ok(Math.abs(Number(now.force) / expected - 1) < 0.01, `${now.force} N by hand, ${expected} N by the run`);
    assert.notEqual((await pixelsOf(page, page.locator(".live-canvas"))).hash, before.hash, "the picture shows it");
    assert.match(await page.locator(".live-events").innerText(), /puncture/);
    await page.screenshot({ path: join(shots, "needle.png") });
  });

  test("the slider shows where the needle is led to, its mark and the number below where it is", async () => {
    await page.getByRole("button", { name: "Reset" }).click();
    await until(page, (s) => Number(s.depth) === 0, "at rest");
    await type(page, "Speed [mm/s]", 2);
    await type(page, "Depth [mm]", 8);
    await until(page, (s) => Number(s.depth) > 0.0005, "on its way");
    await page.getByRole("button", { name: "Pause" }).click();
    await page.getByRole("button", { name: "Go on" }).waitFor();
    await page.screenshot({ path: join(shots, "on-its-way.png") });
    const shown = await page.evaluate(() => {
      const range = document.querySelector("#depth-0");
      const row = range.closest(".live-slider");
      const [track, mark] = [range.getBoundingClientRect(), row.querySelector(".live-mark").getBoundingClientRect()];
      return {
        target: Number(range.value),
        now: row.querySelector(".live-now").textContent,
        share: (mark.left + mark.width / 2 - track.left - 8) / (track.width - 16),
        range: [Number(range.min), Number(range.max)],
        depth: 1000 * Number(document.querySelector(".live").dataset.depth),
      };
    });
    assert.equal(shown.target, 8);
    assert.ok(shown.depth < 7, `still on its way at ${shown.depth} mm`);
    assert.equal(shown.now, `now ${shown.depth.toFixed(2)} mm`);
    const share = (shown.depth - shown.range[0]) / (shown.range[1] - shown.range[0]);
    assert.ok(Math.abs(shown.share - share) < 0.02, `${shown.share}, expected ${share}`);
    await page.getByRole("button", { name: "Go on" }).click();
    await type(page, "Speed [mm/s]", 20);
  });

  test("numbers keep apart however long they are", async () => {
    const before = page.viewportSize();
    for (const width of [1440, 900, 390, 360]) {
      await page.setViewportSize({ width, height: 900 });
      const apart = await page.evaluate(() => {
        const numbers = document.querySelector(".live-numbers");
        const long = numbers.cloneNode(true);
        const texts = ["123\u00a0N", "−123.456\u00a0N", "−1234.56\u00a0mm", "12345.67\u00a0s", "10.0\u00a0N"];
        texts.push("0.0012 × real time", "1\u202f914 / 22\u202f418\u00a0µs", "12345\u00a0ms");
        long.querySelectorAll("dd").forEach((dd, i) => (dd.textContent = texts[i]));
        numbers.after(long);
        const room = long.getBoundingClientRect();
        const boxes = [...long.querySelectorAll("dt, dd")].map((field) => {
          const range = document.createRange();
          range.selectNodeContents(field);
          return range.getBoundingClientRect();
        });
        const meet = (a, b) => a.left < b.right + 4 && b.left < a.right + 4 && a.top < b.bottom && b.top < a.bottom;
        const outside = boxes.filter((box) => box.left < room.left - 1 || box.right > room.right + 1).length;
        let collisions = 0;
        for (let i = 0; i < boxes.length; i += 2)
          for (let k = 0; k < boxes.length; k++)
            if (k !== i && k !== i + 1 && (meet(boxes[i], boxes[k]) || meet(boxes[i + 1], boxes[k]))) collisions++;
        const fields = boxes.length;
        long.remove();
        return { fields, collisions, outside };
      });
      assert.deepEqual(apart, { fields: 16, collisions: 0, outside: 0 }, `${width} px wide`);
    }
    await page.setViewportSize(before);
  });

  test("a tissue three times as stiff pushes back three times as hard", async () => {
    await page.getByRole("button", { name: "Reset" }).click();
    await until(page, (s) => s.epoch === "2", "a body at rest"); // the second one made anew
    await type(page, "Depth [mm]", 0.8); // 0.3 mm into the tissue, before it is pierced: the small-strain element is linear
    await until(page, (s) => Number(s.depth) > 0.0007999, "in contact");
    const soft = Number((await later(page, 0.5)).force);
    assert.ok(soft > 0.001, `it is met: ${soft} N`);
    await type(page, "Young's modulus E [Pa]", 15000);
    const now = await later(page, 0.5);
    assert.equal(now.epoch, "2", "the same body, not one made anew");
    assert.ok(Math.abs(Number(now.depth) - 0.0008) < 1e-6, "the tool stays where it is");
    const stiff = Number(now.force);
    assert.ok(Math.abs(stiff / soft - 3) < 0.1, `${soft} → ${stiff} N`);
  });

  test("the slider is moved by keys, the clock held by the space bar", async () => {
    await page.locator("#depth-0").focus();
    await page.keyboard.press("Home");
    await until(page, (s) => Number(s.depth) < -0.001, "drawn back");
    await page.locator(".live-canvas").focus();
    await page.keyboard.press(" ");
    await page.getByRole("button", { name: "Go on" }).waitFor();
    const held = (await state(page)).time;
    await page.waitForTimeout(400);
    assert.equal((await state(page)).time, held);
    await page.keyboard.press(" ");
    await later(page, 0.01);
  });

  test("a drag on the tissue pulls it", async () => {
    await page.getByRole("button", { name: "Reset" }).click();
    await later(page, 0.02).catch(() => null);
    const box = await page.locator(".live-canvas").boundingBox();
    await page.mouse.move(box.x + 0.42 * box.width, box.y + 0.62 * box.height);
    await page.mouse.down();
    await page.mouse.move(box.x + 0.3 * box.width, box.y + 0.6 * box.height, { steps: 8 });
    await page.waitForFunction(() =>
      [...document.querySelectorAll(".live-numbers div")].some((d) => /^Pull\s+0\.(?!000)\d+\sN/.test(d.innerText)),
    );
    await page.screenshot({ path: join(shots, "pull.png") });
    await page.mouse.up();
  });

  test("a body cut open shows its face, and what was taken away cannot be pulled", async () => {
    const canvas = page.locator(".live-canvas");
    const open = page.locator("input[name=open]");
    const closed = (await pixelsOf(page, canvas)).hash;
    await open.check();
    await page.locator("select[aria-label=Cut]").selectOption("y");
    await settle(page);
    assert.notEqual((await pixelsOf(page, canvas)).hash, closed);
    await page.screenshot({ path: join(shots, "cut.png") });
    const box = await canvas.boundingBox();
    await page.mouse.move(box.x + 0.42 * box.width, box.y + 0.62 * box.height); // where tissue was pulled before
    await page.mouse.down();
    await page.mouse.move(box.x + 0.3 * box.width, box.y + 0.6 * box.height, { steps: 8 });
    await later(page, 0.2);
    assert.match(await page.locator(".live-numbers").innerText(), /Pull\s+0\sN/);
    await page.mouse.up();
    await open.uncheck();
  });

  test("a recording goes again by glisson run and ends with the force that was felt", async () => {
    const { epoch } = await state(page);
    await page.getByRole("button", { name: "Reset" }).click();
    await until(page, (s) => s.epoch !== epoch, "at rest");
    await type(page, "Depth [mm]", 5);
    await until(page, (s) => Number(s.depth) > 0.004999, "5 mm deep");
    const felt = await later(page, 0.3);
    const [saved] = await Promise.all([
      page.waitForEvent("download"),
      page.getByRole("button", { name: "Save recording" }).click(),
    ]);
    const zip = join(live.folder, "recording.zip");
    await saved.saveAs(zip);
    const again = join(live.folder, "recording");
    const unpacked = spawnSync("python3", ["-m", "zipfile", "-e", zip, again], { encoding: "utf8" });
    assert.equal(unpacked.status, 0, unpacked.stderr);
    const force = forceOfRun(join(again, "scene.toml"), again);
    assert.ok(Math.abs(Number(felt.force) / force - 1) < 0.01, `${felt.force} N by hand, ${force} N again`);
  });

  test("ten watch at once, a mebibyte of rubbish ends only the one that sent it", async () => {
    const told = await page.evaluate(async () => {
      const url = `ws://${location.host}/stream${location.search}`;
      const sockets = Array.from({ length: 9 }, () => new WebSocket(url));
      const frames = sockets.map(
        (socket) => new Promise((done) => (socket.onmessage = (event) => typeof event.data !== "string" && done(true))),
      );
      await Promise.all(frames);
      const bad = sockets[0];
      const closed = new Promise((done) => (bad.onclose = (event) => done(event.code)));
      bad.send(new Uint8Array(1 << 20).fill(255));
      const code = await closed;
      const open = sockets.slice(1).filter((socket) => socket.readyState === WebSocket.OPEN).length;
      sockets.forEach((socket) => socket.close());
      return { code, open };
    });
    // 1009 is what the server says; a browser that is still sending may find the line gone before it has read that.
    assert.ok(told.code === 1009 || told.code === 1006, `closed with ${told.code}`);
    assert.equal(told.open, 8);
    await later(page, 0.05);
  });

  test("a wrong token gets neither page nor stream", async () => {
    const answer = await browser.context.request.get(`${live.url}x`);
    assert.equal(answer.status(), 403);
    const opened = await page.evaluate(
      () =>
        new Promise((done) => {
          const socket = new WebSocket(`ws://${location.host}/stream?token=wrong`);
          socket.onopen = () => done(true);
          socket.onerror = () => done(false);
        }),
    );
    assert.equal(opened, false);
    troubles.splice(0, troubles.length, ...troubles.filter((text) => !text.includes("/stream?token=wrong")));
  });

  test("nothing was said in the console, and all of it fits a phone", async () => {
    assert.deepEqual(own(troubles), []);
    const phone = await openBrowser({ viewport: { width: 390, height: 844 }, isMobile: true, hasTouch: true });
    const { page: small, troubles: smallTroubles } = await openPage(phone.context, live.url);
    await until(small, (s) => Number(s.time) > 0, "frames on the phone");
    assert.match(await small.locator(".live-lead").innerText(), /You watch/);
    const width = await small.evaluate(() => document.documentElement.scrollWidth);
    assert.ok(width <= 390, `${width} px wide`);
    await small.screenshot({ path: join(shots, "phone.png"), fullPage: true });
    assert.deepEqual(own(smallTroubles), []);
    await phone.close();
  });
});

describe("a line that is cut", { skip: program() === null ? "the program is not built" : false }, () => {
  test("comes back by itself, with the lead", async () => {
    const live = await openLive(SCENE);
    const browser = await openBrowser({ colorScheme: "dark" });
    const page = await browser.context.newPage();
    const lines = [];
    await page.routeWebSocket(/\/stream/, (line) => {
      line.connectToServer();
      lines.push(line);
    });
    await page.goto(live.url);
    await until(page, (s) => s.drives === "true" && Number(s.time) > 0.01, "leads");
    await lines[0].close({ code: 1001 });
    await until(page, (s) => s.status === "waiting", "notices");
    await until(page, (s) => s.status === "open" && s.drives === "true", "is back");
    await later(page, 0.05);
    assert.ok(lines.length >= 2);
    assert.match(lines[lines.length - 1].url(), /session=[0-9a-f]{32}/);
    await page.screenshot({ path: join(shots, "dark.png") });
    await browser.close();
    await live.close();
  });
});
