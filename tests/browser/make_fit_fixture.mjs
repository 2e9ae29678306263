// make_fit_fixture.mjs — writes a report of fits: node make_fit_fixture.mjs TEMPLATE OUT [FIT_JSON…]
import { readFileSync } from "node:fs";
import { bareFit, fitFixture, fitReport, largeFit } from "../../web/test/fit_fixture.mjs";
import { writeReport } from "./template.mjs";

const [template, out, ...files] = process.argv.slice(2);
if (!template || !out) {
  console.error(
    "usage: node make_fit_fixture.mjs TEMPLATE OUT [FIT_JSON…]\n  TEMPLATE  report.html as built from web/\n" +
      "  OUT       the page to write\n  FIT_JSON  fits to show, each the text of one FitData; without: the fixture's",
  );
  process.exit(2);
}
const given = files.map((file) => JSON.parse(readFileSync(file, "utf8")));
writeReport(template, fitReport(...(given.length > 0 ? given : [fitFixture(), bareFit(), largeFit()])), out);
