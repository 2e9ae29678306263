// fit_section.ts — one fit: in short, the curves, the parameters, all conclusions, how sure they are, and what to measure next.
import { h } from "../page/dom.ts";
import type { SceneBlock, SceneView } from "../page/scene_section.ts";
import { sourceBlock } from "../page/source_block.ts";
import type { FitData } from "../report_data.ts";
import { correlationFigures } from "./correlations.ts";
import { fitCurves } from "./fit_curves.ts";
import { fitDownloads, resultFile } from "./fit_downloads.ts";
import { fitConclusions, fitHead } from "./fit_head.ts";
import { designTable, discoveredTable, groupTable, lawTable, testTable } from "./fit_tables.ts";
import { discoveryFigure, lawFigures } from "./law_figures.ts";
import { parameterTable } from "./parameter_table.ts";
import { profileFigures } from "./profiles.ts";
import { residualFigures } from "./residuals.ts";
import { startFigures } from "./starts.ts";

/** @param titled  whether the page's own title already is the fit's */
export function fitSection(fit: FitData, id: string, titled: boolean): SceneView {
  const blocks: SceneBlock[] = [];
  const block = (name: string, element: HTMLElement | null) => {
    if (!element) return null;
    element.id = `${id}-${name.toLowerCase()}`;
    blocks.push({ id: element.id, name, element });
    return element;
  };
  const element = h(
    "section",
    { class: "scene fit", id, "aria-labelledby": `${id}-title` },
    fitHead(fit, id, titled),
    block("Curves", fitCurves(fit)),
    block("Parameters", parameterTable(fit)),
    block("Conclusions", fitConclusions(fit)),
    block("Law", wrap("figures figures-pair", [...lawFigures(fit), discoveryFigure(fit)])),
    block("Profiles", wrap("figures", [profileFigures(fit)])),
    block("Correlations", wrap("figures figures-pair", correlationFigures(fit))),
    block("Residuals", wrap("figures", [residualFigures(fit)])),
    block("Starts", wrap("figures figures-pair", startFigures(fit))),
    block(
      "Tables",
      wrap("results", [testTable(fit), groupTable(fit), discoveredTable(fit), lawTable(fit), designTable(fit)]),
    ),
    block("Notes", notes(fit.notes)),
    block("Files", files(fit)),
  );
  return { element, blocks };
}

function wrap(className: string, parts: readonly (HTMLElement | null)[]): HTMLElement | null {
  const made = parts.filter((part) => part !== null);
  return made.length > 0 ? h("div", { class: className }, ...made) : null;
}

function notes(sentences: readonly string[]): HTMLElement | null {
  if (sentences.length === 0) return null;
  return h(
    "aside",
    { class: "notes", "aria-label": "Notes" },
    h("h3", {}, "Choices and their reasons"),
    h("ul", {}, ...sentences.map((note) => h("li", {}, note))),
  );
}

function files(fit: FitData): HTMLElement | null {
  const parts = [
    fitDownloads(fit),
    sourceBlock(resultFile(fit), fit.tissue, "Result, for scenes:"),
    sourceBlock(`${fit.name}.toml`, fit.source, "Fit"),
  ];
  return wrap("fit-files", parts);
}
