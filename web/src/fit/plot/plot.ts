// plot.ts — a small chart in SVG: no zoom, no legend, as many as a page needs.
//
//   y label                readout
//   ┌ ticks ┬───────────────────┐
//   │  HTML │ SVG, 1000 × 1000  │   The canvas is stretched to the place it is given while strokes keep their
//   │       │ stretched         │   width, so that width, theme and paper need no drawing anew.
//   └───────┴───────────────────┘
//           x ticks, x label
import { formatSignificant, formatTick } from "../../format/number.ts";
import { nameOfLabel, unitOfLabel } from "../../format/units.ts";
import { h, svg } from "../../page/dom.ts";
import { svgButton } from "../../page/save_svg.ts";
import { withSubscripts } from "../names.ts";
import type { PlotMark, PointsMark } from "./marks.ts";
import { nearestPoint, orderAlongX } from "./nearest_point.ts";
import { type Scale, place, tickValues } from "./scale.ts";
import { SIZE, bandPath, dotPath, linePath } from "./trace.ts";

export interface PlotAxis {
  label: string; // with unit
  scale: Scale;
  ticks?: number; // about how many
}

export interface PlotSpec {
  title: string; // for those who do not see it
  x: PlotAxis;
  y: PlotAxis;
  marks: readonly PlotMark[]; // later ones over earlier ones
  readout?: (mark: PointsMark, index: number) => string;
}

const TICKS = 4;

export function plot(spec: PlotSpec): HTMLElement {
  const frame = h("div", { class: "plot-frame" }, canvas(spec), ...gridTexts(spec));
  const named = spec.marks.filter((mark): mark is PointsMark => mark.kind !== "band" && "name" in mark);
  const readout = h("output", { class: "plot-readout", "aria-live": "off" });
  const element = h(
    "div",
    {
      class: "plot",
      ...(named.length > 0 ? { tabindex: 0, role: "group" } : { role: "img" }),
      "aria-label": words(spec),
    },
    h("div", { class: "plot-top" }, h("span", { class: "plot-y-label" }, ...withSubscripts(spec.y.label)), readout),
    frame,
    h("div", { class: "plot-x-label" }, ...withSubscripts(spec.x.label)),
  );
  element.querySelector(".plot-top")!.append(svgButton(element, spec.title));
  element.style.setProperty("--tick-room", `${widestTick(spec.y)}ch`);
  if (named.length > 0) follow(element, frame, readout, spec, named);
  return element;
}

const words = (spec: PlotSpec) =>
  `${spec.title}: ${spec.y.label} against ${spec.x.label}` +
  (spec.marks.some((mark) => "name" in mark) ? ". Arrow keys read its points." : "");

function canvas(spec: PlotSpec): SVGElement {
  const area = svg("svg", {
    class: "plot-area",
    viewBox: `0 0 ${SIZE} ${SIZE}`,
    preserveAspectRatio: "none",
    "aria-hidden": "true",
  });
  const { x, y } = { x: spec.x.scale, y: spec.y.scale };
  const grid = [
    ...ticksOf(spec.x).map((value) => linePath([value, value], [y.low, y.high], x, y)),
    ...ticksOf(spec.y).map((value) => linePath([x.low, x.high], [value, value], x, y)),
  ];
  area.append(svg("path", { class: "plot-grid", d: grid.join("") }));
  for (const mark of spec.marks) area.append(svg("path", { class: mark.className, d: pathOf(mark, x, y) }));
  return area;
}

function pathOf(mark: PlotMark, x: Scale, y: Scale): string {
  if (mark.kind === "band") return bandPath(mark.x, mark.y, x, y);
  if (mark.kind === "rule") {
    return mark.y === undefined
      ? linePath([mark.x!, mark.x!], [y.low, y.high], x, y)
      : linePath([x.low, x.high], [mark.y, mark.y], x, y);
  }
  return (mark.kind === "line" ? linePath : dotPath)(mark.x, mark.y, x, y);
}

const ticksOf = (axis: PlotAxis) => tickValues(axis.scale, axis.ticks ?? TICKS);

function tickTexts(axis: PlotAxis): { share: number; text: string }[] {
  const values = ticksOf(axis);
  const step = values.length > 1 && !axis.scale.log ? values[1]! - values[0]! : 0;
  return values.map((value) => ({
    share: place(axis.scale, value),
    text: step > 0 ? formatTick(value, step) : formatSignificant(value, digitsOf(value)),
  }));
}

/** Significant digits that a round number is written with. */
const digitsOf = (value: number) => value.toExponential().split("e")[0]!.replace(/\D/g, "").length;

const widestTick = (axis: PlotAxis) => Math.max(1, ...tickTexts(axis).map((tick) => tick.text.length));

function gridTexts(spec: PlotSpec): HTMLElement[] {
  const percent = (share: number) => `${Math.round(share * 10000) / 100}%`;
  const texts = [
    ...tickTexts(spec.x).map(({ share, text }) =>
      h("span", { class: "tick-x", style: `left:${percent(share)}` }, text),
    ),
    ...tickTexts(spec.y).map(({ share, text }) =>
      h("span", { class: "tick-y", style: `bottom:${percent(share)}` }, text),
    ),
  ];
  for (const mark of spec.marks) {
    if (mark.kind !== "rule" || mark.label === undefined || mark.y === undefined) continue;
    const bottom = percent(place(spec.y.scale, mark.y));
    texts.push(h("span", { class: "rule-label", style: `bottom:${bottom}` }, mark.label));
  }
  return texts;
}

/** Cursor and arrow keys read the named points. */
function follow(
  element: HTMLElement,
  frame: HTMLElement,
  readout: HTMLElement,
  spec: PlotSpec,
  marks: readonly PointsMark[],
): void {
  const dot = frame.appendChild(h("span", { class: "plot-dot", hidden: true }));
  const ordered = orderAlongX(marks);
  let at = -1;
  const show = (found: { mark: PointsMark; index: number } | null) => {
    dot.hidden = found === null;
    readout.textContent = found ? (spec.readout ?? defaultReadout(spec))(found.mark, found.index) : "";
    if (!found) return;
    dot.style.left = `${100 * place(spec.x.scale, found.mark.x[found.index]!)}%`;
    dot.style.bottom = `${100 * place(spec.y.scale, found.mark.y[found.index]!)}%`;
  };
  frame.addEventListener("pointermove", (event) => {
    const box = frame.getBoundingClientRect();
    show(nearestPoint(marks, spec.x.scale, spec.y.scale, event.clientX - box.left, event.clientY - box.top, box));
  });
  frame.addEventListener("pointerleave", () => show(null));
  element.addEventListener("blur", () => show(null));
  element.addEventListener("keydown", (event) => {
    const step = event.key === "ArrowRight" ? 1 : event.key === "ArrowLeft" ? -1 : 0;
    if (step === 0 || ordered.length === 0) return;
    event.preventDefault();
    at = Math.min(ordered.length - 1, Math.max(0, at + step * (event.shiftKey ? 10 : 1)));
    show(ordered[at]!);
  });
}

function defaultReadout(spec: PlotSpec) {
  const with_unit = (label: string, value: number) => {
    const unit = unitOfLabel(label);
    return `${nameOfLabel(label)} ${formatSignificant(value, 4)}${unit ? `\u00a0${unit}` : ""}`;
  };
  return (mark: PointsMark, index: number) =>
    [mark.name ?? "", with_unit(spec.x.label, mark.x[index]!), with_unit(spec.y.label, mark.y[index]!)]
      .filter((part) => part !== "")
      .join(" · ");
}
