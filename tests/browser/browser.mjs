// browser.mjs — finds Chromium and drives it through playwright-core, off the network.
import { existsSync, mkdtempSync, rmSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { spawnSync } from "node:child_process";

const here = dirname(fileURLToPath(import.meta.url));
/** Folder of the page's package, with its node_modules and dist. */
export const WEB_DIR = resolve(process.env.GLISSON_WEB_DIR ?? join(here, "../../web"));

const CANDIDATES = [
  "/usr/bin/chromium",
  "/usr/bin/chromium-browser",
  "/usr/bin/google-chrome",
  "/usr/bin/google-chrome-stable",
  "/snap/bin/chromium",
];
const FLAGS = [
  "--headless",
  "--no-sandbox",
  "--disable-gpu",
  "--use-gl=angle",
  "--use-angle=swiftshader",
  "--enable-unsafe-swiftshader",
  "--disable-quic",
  "--no-first-run",
  "--disable-background-networking",
  "--disable-component-update",
  "--disable-sync",
];

/** Path of a Chromium that answers --version; throws with what to install where there is none. */
export function findChromium() {
  const tried = [];
  for (const path of [process.env.CHROMIUM, ...CANDIDATES, playwright().chromium.executablePath()]) {
    if (!path || !existsSync(path)) continue;
    const answer = spawnSync(path, ["--version"], { encoding: "utf8", timeout: 30_000 });
    if (answer.status === 0 && /\d+\./.test(answer.stdout)) return path;
    tried.push(`${path} (${(answer.stderr || answer.error?.message || "no answer").trim().split("\n")[0]})`);
  }
  throw new Error(
    "no usable Chromium for the browser tests" +
      (tried.length > 0 ? `; tried ${tried.join(", ")}` : "") +
      ".\n  Debian: apt-get install chromium" +
      "\n  Ubuntu: the package chromium-browser only stands for a snap; run `snap install chromium`, or" +
      `\n  in ${WEB_DIR}: npx playwright-core install --with-deps chromium` +
      "\n  or name one: CHROMIUM=/path/to/chrome",
  );
}

function playwright() {
  try {
    return createRequire(join(WEB_DIR, "package.json"))("playwright-core");
  } catch (error) {
    throw new Error(
      `playwright-core is not installed under ${WEB_DIR}: run npm ci there, or set GLISSON_WEB_DIR (${error.message})`,
    );
  }
}

/** Starts Chromium with a fresh profile; `close` ends it and removes the profile. */
export async function openBrowser({ extraFlags = [], ...options } = {}) {
  const profile = mkdtempSync(join(tmpdir(), "glisson-browser-"));
  const context = await playwright().chromium.launchPersistentContext(profile, {
    executablePath: findChromium(),
    headless: true,
    args: [...FLAGS, ...extraFlags],
    viewport: { width: 1440, height: 900 },
    deviceScaleFactor: 1,
    acceptDownloads: true,
    ...options,
  });
  const close = async () => {
    await context.close();
    rmSync(profile, { recursive: true, force: true });
  };
  return { context, close };
}

/** Opens a page and records what must not happen: console errors, page errors, requests to anything but the file. */
export async function openPage(context, url) {
  const page = await context.newPage();
  const troubles = [];
  page.on("console", (message) => {
    if (message.type() === "error" || message.type() === "warning")
      troubles.push(`${message.type()}: ${message.text()}`);
  });
  page.on("pageerror", (error) => troubles.push(`page error: ${error.message}`));
  page.on("request", (request) => {
    const target = request.url();
    if (target !== url && !/^(data|blob):/.test(target)) troubles.push(`request: ${target}`);
  });
  await page.goto(url);
  await page.evaluate(() => document.fonts.ready.then(() => true));
  return { page, troubles };
}

/** Waits until the page has had the time to notice what changed and to draw it, on a busy machine too. */
export async function settle(page) {
  await page.evaluate(
    () =>
      new Promise((done) => {
        let frames = 8;
        const next = () => (frames-- > 0 ? requestAnimationFrame(next) : setTimeout(done, 60));
        next();
      }),
  );
}
