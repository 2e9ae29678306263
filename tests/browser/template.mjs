// template.mjs — fills the built page with data, as the program does.
import { readFileSync, writeFileSync } from "node:fs";

const TOKEN = "/*GLISSON_DATA*/";

/** Splits the template at its token; throws where it does not hold it exactly once. */
export function fillTemplate(template, data) {
  const parts = template.split(TOKEN);
  if (parts.length !== 2)
    throw new Error(`the page must hold ${TOKEN} exactly once, it holds it ${parts.length - 1} times`);
  return parts[0] + JSON.stringify(data).replaceAll("<", "\\u003c") + parts[1];
}

/** Writes a page made of `template` and `data`. */
export function writeReport(templateFile, data, outFile) {
  writeFileSync(outFile, fillTemplate(readFileSync(templateFile, "utf8"), data));
}
