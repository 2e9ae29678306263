// run.mjs FILE… — runs browser tests with node's own runner, where there is a browser to run them in.
//
// Without one it says what to install and exits 77, which ctest shows as skipped: Ubuntu has Chromium as a snap
// only. With CI set a missing browser is a failure, so that no pipeline goes green without having looked.
import { spawnSync } from "node:child_process";

import { findChromium } from "./browser.mjs";

const SKIPPED = 77;

try {
  findChromium();
} catch (error) {
  console.error(`SKIPPED: ${error.message}`);
  process.exit(process.env.CI ? 1 : SKIPPED);
}
process.exit(spawnSync(process.execPath, ["--test", ...process.argv.slice(2)], { stdio: "inherit" }).status ?? 1);
