// screenshots.mjs — pictures of a report for looking at: node screenshots.mjs REPORT OUT_DIR
import { mkdirSync } from "node:fs";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { openBrowser, openPage } from "./browser.mjs";

const [report, out] = process.argv.slice(2);
if (!report || !out) {
  console.error("usage: node screenshots.mjs REPORT OUT_DIR");
  process.exit(2);
}
mkdirSync(out, { recursive: true });

const SHOTS = [
  { name: "laptop-light", viewport: { width: 1440, height: 900 }, colorScheme: "light" },
  { name: "laptop-dark", viewport: { width: 1440, height: 900 }, colorScheme: "dark" },
  {
    name: "phone",
    viewport: { width: 390, height: 844 },
    deviceScaleFactor: 2,
    isMobile: true,
    hasTouch: true,
    colorScheme: "light",
  },
];
for (const { name, ...options } of SHOTS) {
  const { context, close } = await openBrowser(options);
  const { page, troubles } = await openPage(context, pathToFileURL(resolve(report)).href);
  const height = await page.evaluate(() => document.documentElement.scrollHeight);
  for (let y = 0; y < height; y += 500) {
    await page.evaluate((top) => window.scrollTo({ top, behavior: "instant" }), y);
    await page.waitForTimeout(120);
  }
  await page.evaluate(() => window.scrollTo({ top: 0, behavior: "instant" }));
  await page.waitForTimeout(400);
  await page.screenshot({ path: join(out, `${name}-top.png`) });
  await page.screenshot({ path: join(out, `${name}.png`), fullPage: true });
  for (const trouble of troubles) console.error(`${name}: ${trouble}`);
  await close();
}
