// scene_section.ts — one scene: what it is, how it did, its figures, its numbers.
import { Chart } from "../charts/chart.ts";
import { containerChart, energyChart, partsChart } from "../charts/column_charts.ts";
import { lawCharts } from "../charts/law_charts.ts";
import type { ChartModel } from "../charts/model.ts";
import { forceMap } from "../charts/force_map.ts";
import { PROBE_QUANTITIES, probeChart } from "../charts/probe_charts.ts";
import { SceneState } from "../charts/scene_state.ts";
import { variantCharts } from "../charts/variant_charts.ts";
import { WARNING } from "../format/summary_fields.ts";
import { MeshPanel, meshVariants, moves } from "../mesh3d/mesh_panel.ts";
import type { SceneData } from "../report_data.ts";
import { checkList } from "./checks.ts";
import { dataTable } from "./data_table.ts";
import { h } from "./dom.ts";
import { downloads } from "./downloads.ts";
import { figure } from "./figure.ts";
import { sourceBlock } from "./source_block.ts";
import { summaryTable } from "./summary_table.ts";
import { variantFigure } from "./variant_figure.ts";

/** Up to this many notes stand beside the description; more would push the figures off the screen. */
const FEW_NOTES = 3;

export interface SceneBlock {
  id: string;
  name: string;
  element: HTMLElement;
}

export interface SceneView {
  element: HTMLElement;
  blocks: SceneBlock[]; // parts worth a way to them
}

/** @param titled  whether the page's own title already is the scene's */
export function sceneSection(scene: SceneData, id: string, titled: boolean): SceneView {
  const blocks: SceneBlock[] = [];
  const block = (name: string, element: HTMLElement | null) => {
    if (!element) return null;
    element.id = `${id}-${name.toLowerCase()}`;
    blocks.push({ id: element.id, name, element });
    return element;
  };
  const figures = sceneFigures(scene);
  const few = scene.notes.length <= FEW_NOTES;
  const element = h(
    "section",
    { class: "scene", id, "aria-labelledby": `${id}-title` },
    sceneHead(scene, id, titled, few ? notes(scene) : null),
    ...warnings(scene),
    block("Checks", checkList(scene.checks)),
    block("Figures", figures.length > 0 ? h("div", { class: "figures" }, ...figures) : null),
    scene.variants.length + scene.tables.length === 0
      ? h("p", { class: "muted" }, "This scene has no variants to show.")
      : null,
    few ? null : block("Choices", notes(scene)),
    block("Advice", advice(scene)),
    block("Numbers", results(scene)),
    block("Scene", sourceBlock(`${scene.name}.toml`, scene.source)),
  );
  return { element, blocks };
}

function sceneHead(scene: SceneData, id: string, titled: boolean, beside: HTMLElement | null): HTMLElement {
  const paragraphs = scene.description.split(/\n\s*\n/).filter((text) => text.trim() !== "");
  const later =
    !beside && scene.notes.length > 0
      ? h("p", {}, h("a", { href: `#${id}-choices` }, `${scene.notes.length} choices and their reasons`))
      : null;
  return h(
    "header",
    { class: beside ? "scene-head with-notes" : "scene-head" },
    h(
      "div",
      { class: "scene-words" },
      h("h2", { id: `${id}-title`, class: titled ? "visually-hidden" : null }, scene.title),
      ...paragraphs.map((text) => h("p", {}, text)),
      later,
    ),
    beside,
  );
}

/** What cannot be believed of a variant's run. */
function warnings(scene: SceneData): HTMLElement[] {
  return scene.variants.flatMap((variant) => {
    const text = variant.summary[WARNING];
    if (typeof text !== "string") return [];
    return [h("p", { class: "warning", role: "note" }, h("strong", {}, `${variant.label}: `), text)];
  });
}

function notes(scene: SceneData): HTMLElement | null {
  if (scene.notes.length === 0) return null;
  return h(
    "aside",
    { class: "notes", "aria-label": "Choices" },
    h("h3", {}, "Choices and their reasons"),
    h("ul", {}, ...scene.notes.map((note) => h("li", {}, note))),
  );
}

/** What `glisson check` says of the scene; of which variants, where it is not all of them. */
function advice(scene: SceneData): HTMLElement | null {
  if (scene.advice.length === 0) return null;
  const of = (variants: readonly string[]) =>
    variants.length === 0 || variants.length === scene.variants.length ? "" : `${variants.join(", ")}: `;
  return h(
    "aside",
    { class: "notes advice", "aria-label": "Advice" },
    h("h3", {}, "Advice on mesh, tissues, tools and steps"),
    h(
      "ul",
      {},
      ...scene.advice.map((one) =>
        h("li", {}, h("strong", {}, one.kind === "warning" ? "Warning. " : ""), of(one.variants), one.text),
      ),
    ),
  );
}

/** The variant to start with: the last one of the first chart, so that its ring is seen there. */
function firstShown(curves: readonly ChartModel[]): string {
  const named = curves[0]?.lines.map((line) => line.variant).filter((name) => name !== null) ?? [];
  return named[named.length - 1] ?? "";
}

/** Figures in reading order: the main curve beside the mesh, the law, the other curves, parts and energies. */
function sceneFigures(scene: SceneData): HTMLElement[] {
  const state = new SceneState(scene.variants.map((variant) => variant.name));
  const models = variantCharts(scene);
  const first = firstShown(models);
  const maps = scene.charts.flatMap((spec) => {
    const map = forceMap(spec);
    return map ? [figure(spec.title, map, null, "figure-map")] : [];
  });
  const curves = [...maps, ...models.map((model) => figure(model.title, new Chart(model, state).element))];
  const laws = lawCharts(scene.variants).map((model) => figure(model.title, new Chart(model, state).element));
  const meshes = meshVariants(scene);
  const panel = meshes.length > 0 ? new MeshPanel(scene, meshes, state, first) : null;
  const mesh = panel
    ? [
        figure(
          moves(meshes) ? "Deformed mesh" : "Temperature in the body",
          panel.element,
          panel.variantSelect(),
          "figure-mesh",
        ),
      ]
    : [];
  const perVariant = [
    variantFigure("Parts of the force", scene.variants, state, first, partsChart),
    variantFigure("Loads on the container", scene.variants, state, first, containerChart),
    ...PROBE_QUANTITIES.map((quantity) =>
      variantFigure(quantity.title, scene.variants, state, first, (variant) => probeChart(variant, quantity)),
    ),
    variantFigure("Energies", scene.variants, state, first, energyChart),
  ].filter((made): made is HTMLElement => made !== null);
  return [...curves.slice(0, 1), ...mesh, ...laws, ...curves.slice(1), ...perVariant];
}

function results(scene: SceneData): HTMLElement | null {
  const table = summaryTable(scene.variants);
  const files = downloads(scene);
  if (!table && !files && scene.tables.length === 0) return null;
  const numbers =
    table || files
      ? h(
          "section",
          { class: "numbers", "aria-label": "Numbers" },
          h("header", { class: "block-head" }, h("h3", {}, "Numbers")),
          table,
          files,
        )
      : null;
  return h("div", { class: "results" }, numbers, ...scene.tables.map(dataTable));
}
