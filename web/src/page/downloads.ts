// downloads.ts — the numbers behind the figures, as files.
import { rowCount } from "../data/columns.ts";
import { toCsv } from "../data/csv.ts";
import type { SceneData } from "../report_data.ts";
import { button, download, h } from "./dom.ts";
import { icon } from "./icons.ts";

/** A button for the forces of each variant; null where no variant has any. */
export function downloads(scene: SceneData): HTMLElement | null {
  const variants = scene.variants.filter((variant) => rowCount(variant.forces) > 0);
  if (variants.length === 0) return null;
  const buttons = variants.map((variant) => {
    const name = `${scene.name}-${variant.name}-forces.csv`;
    const element = button("", `Save ${name}`, () =>
      download(name, new Blob([toCsv(variant.forces)], { type: "text/csv" })),
    );
    element.append(icon("download"), variant.label);
    return element;
  });
  const probes = scene.variants.filter((variant) => rowCount(variant.probes) > 0);
  const probeButtons = probes.map((variant) => {
    const name = `${scene.name}-${variant.name}-probes.csv`;
    const element = button("", `Save ${name}`, () =>
      download(name, new Blob([toCsv(variant.probes)], { type: "text/csv" })),
    );
    element.append(icon("download"), variant.label);
    return element;
  });
  return h(
    "div",
    { class: "downloads" },
    h("span", {}, "Forces and energies as CSV"),
    h("div", { class: "button-row" }, ...buttons),
    probes.length > 0 ? h("span", {}, "Probes as CSV") : null,
    probes.length > 0 ? h("div", { class: "button-row" }, ...probeButtons) : null,
  );
}
