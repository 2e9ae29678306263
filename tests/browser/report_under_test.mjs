// report_under_test.mjs — the page the tests open: GLISSON_REPORT, or one of the fixture's data.
import { existsSync, mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { WEB_DIR } from "./browser.mjs";
import { fixtureReport } from "./fixture.mjs";
import { writeReport } from "./template.mjs";

const template = join(WEB_DIR, "dist/report.html");

const folders = [];
process.on("exit", () => folders.forEach((folder) => rmSync(folder, { recursive: true, force: true })));

/** URL of a page with the given data in the built template; the page is there until the tests end. */
export function pageWith(data, name = "report") {
  if (!existsSync(template)) throw new Error(`${template} does not exist: run npm run build in ${WEB_DIR} first`);
  const folder = mkdtempSync(join(tmpdir(), "glisson-report-"));
  folders.push(folder);
  const file = join(folder, `${name}.html`);
  writeReport(template, data, file);
  return pathToFileURL(file).href;
}

/** URL of the fixture's page. */
export function fixtureUrl() {
  return pageWith(fixtureReport(), "fixture");
}

/** URL of the page named by GLISSON_REPORT, the fixture's without. */
export function reportUrl() {
  const given = process.env.GLISSON_REPORT;
  if (!given) return fixtureUrl();
  if (!existsSync(given)) throw new Error(`GLISSON_REPORT names ${given}, which does not exist`);
  return pathToFileURL(resolve(given)).href;
}
