// variant_figure.ts — a chart of one variant with a select for which one.
import { Chart } from "../charts/chart.ts";
import type { ChartModel } from "../charts/model.ts";
import type { SceneState } from "../charts/scene_state.ts";
import type { VariantData } from "../report_data.ts";
import { h, select } from "./dom.ts";
import { figure } from "./figure.ts";

/** The figure, or null where no variant has the columns for it. Starts with `preferred` where that one has. */
export function variantFigure(
  title: string,
  variants: readonly VariantData[],
  state: SceneState,
  preferred: string,
  model: (variant: VariantData) => ChartModel | null,
): HTMLElement | null {
  const usable = variants.filter((variant) => model(variant) !== null);
  const first = usable.find((variant) => variant.name === preferred) ?? usable[usable.length - 1];
  if (!first) return null;
  const host = h("div");
  let chart: Chart | null = null;
  const show = (name: string) => {
    const chosen = usable.find((variant) => variant.name === name) ?? first;
    const made = model(chosen);
    chart?.destroy();
    chart = made ? new Chart(made, state, chosen.name) : null;
    if (chart) host.append(chart.element);
  };
  show(first.name);
  const options = usable.map((variant) => ({ value: variant.name, label: variant.label }));
  return figure(title, host, usable.length > 1 ? select("Variant", options, first.name, show) : null);
}
