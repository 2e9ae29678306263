// fit_downloads.ts — the files of fit_csv.ts as buttons, and the tissue ready for scenes.
import { button, download, h } from "../page/dom.ts";
import { icon } from "../page/icons.ts";
import type { FitData } from "../report_data.ts";
import { csvFiles } from "./fit_csv.ts";

export const resultFile = (fit: FitData): string => fit.result_file ?? "tissue.toml";

export function fitDownloads(fit: FitData): HTMLElement | null {
  const buttons = csvFiles(fit).map((file) =>
    saveButton(`${fit.name}-${file.name}.csv`, file.label, "text/csv", file.text),
  );
  if (fit.tissue) buttons.push(saveButton(resultFile(fit), resultFile(fit), "application/toml", () => fit.tissue));
  if (buttons.length === 0) return null;
  return h(
    "div",
    { class: "downloads" },
    h("span", {}, "Numbers in SI as CSV"),
    h("div", { class: "button-row" }, ...buttons),
  );
}

function saveButton(name: string, label: string, type: string, text: () => string): HTMLButtonElement {
  const element = button("", `Save ${name}`, () => download(name, new Blob([text()], { type })));
  element.append(icon("download"), label);
  return element;
}
