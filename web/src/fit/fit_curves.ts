// fit_curves.ts — measured repetitions in grey, the simulation in black: a chart for each group.
import { Chart } from "../charts/chart.ts";
import { SceneState } from "../charts/scene_state.ts";
import { h } from "../page/dom.ts";
import { figure } from "../page/figure.ts";
import type { FitData } from "../report_data.ts";
import { forceText, velocityText } from "./force_unit.ts";
import { use } from "./verdicts.ts";
import { FURTHER, MEASURED, type Panel, SIMULATED, curveCharts, panelsOf } from "./panels.ts";

/** More charts than this stand three in a row. */
const FEW = 4;

export function fitCurves(fit: FitData): HTMLElement | null {
  const panels = panelsOf(fit);
  if (panels.length === 0) return null;
  const state = new SceneState([MEASURED, SIMULATED, FURTHER]);
  const figures = curveCharts(panels).map((model, at) => {
    model.note = panelNote(fit, panels[at]!);
    return figure(model.title, new Chart(model, state).element, use(panels[at]!.group.held_out), "fit-curves");
  });
  const many = panels.length > FEW ? "many" : "";
  return h("div", { class: `figures ${many}`.trim() }, ...figures);
}

function panelNote(fit: FitData, panel: Panel): string {
  const { rms_N, spread_N } = panel.group;
  const velocity = velocityText(panel.curves.map((curve) => curve.velocity_m_s));
  const parts = [
    velocity,
    `rms of simulated − measured ${forceText(rms_N, fit.y)}`,
    spread_N === null ? "" : `spread of the repetitions ${forceText(spread_N, fit.y)}`,
  ];
  return `${parts.filter((part) => part !== "").join("; ")}.`;
}
