// make_fixture.mjs — writes a report of the fixture's data: node make_fixture.mjs TEMPLATE OUT
import { fixtureReport } from "./fixture.mjs";
import { writeReport } from "./template.mjs";

const [template, out] = process.argv.slice(2);
if (!template || !out) {
  console.error(
    "usage: node make_fixture.mjs TEMPLATE OUT\n  TEMPLATE  report.html as built from web/\n  OUT       the page to write",
  );
  process.exit(2);
}
writeReport(template, fixtureReport(), out);
