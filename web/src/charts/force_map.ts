// force_map.ts — the largest value at each place as colours with numbers, one map beside the other for the variants of a scene.
import { formatSignificant, formatTick } from "../format/number.ts";
import { colourGradient, colourOf } from "../mesh3d/colour_map.ts";
import { barTicks } from "../mesh3d/colour_bar.ts";
import { svgButton } from "../page/save_svg.ts";
import { h, svg } from "../page/dom.ts";
import type { ChartSpec, MapData } from "../report_data.ts";

type OneMap = MapData["of"][number];

const LONGEST = 330; // of a map's longer side [units of its drawing]
const ROOM = { left: 38, right: 6, top: 6, bottom: 34 };

/** Distance of neighbouring places along an axis; `otherwise` where there is one only. */
export function spacing(values: readonly number[], otherwise: number): number {
  const sorted = [...new Set(values)].sort((a, b) => a - b);
  let least = Infinity;
  for (let i = 1; i < sorted.length; i++) least = Math.min(least, sorted[i]! - sorted[i - 1]!);
  return least < Infinity ? least : otherwise;
}

/** A map without places that have no value. */
function finiteOf(one: OneMap): OneMap {
  const kept = one.value.map((_value, i) => i).filter((i) => Number.isFinite(one.x[i]! + one.y[i]! + one.value[i]!));
  const of = (list: readonly number[]) => kept.map((i) => list[i]!);
  return { ...one, x: of(one.x), y: of(one.y), value: of(one.value) };
}

/** The maps of a chart; null where no variant has a place. All have the same colours and the same axes. */
export function forceMap(spec: ChartSpec): HTMLElement | null {
  const maps = (spec.map?.of ?? []).map(finiteOf).filter((one) => one.value.length > 0);
  if (maps.length === 0) return null;
  const all = (of: (one: OneMap) => number[]) => maps.flatMap(of);
  const most = Math.max(...all((one) => one.value));
  const dx = spacing(
    all((one) => one.x),
    1,
  );
  const dy = spacing(
    all((one) => one.y),
    dx,
  );
  const frame = {
    left: Math.min(...all((one) => one.x)) - dx / 2,
    right: Math.max(...all((one) => one.x)) + dx / 2,
    low: Math.min(...all((one) => one.y)) - dy / 2,
    high: Math.max(...all((one) => one.y)) + dy / 2,
  };
  const element = h(
    "div",
    { class: "force-maps" },
    ...maps.map((one) =>
      h("figure", {}, drawing(spec, one, frame, dx, dy, most), maps.length > 1 ? h("figcaption", {}, one.label) : null),
    ),
    bar(spec.map!.label, most),
  );
  element.prepend(svgButton(element, spec.title));
  return element;
}

interface Frame {
  left: number;
  right: number;
  low: number;
  high: number;
}

function drawing(spec: ChartSpec, one: OneMap, frame: Frame, dx: number, dy: number, most: number): SVGElement {
  const scale = LONGEST / Math.max(frame.right - frame.left, frame.high - frame.low);
  const at = {
    x: (x: number) => ROOM.left + (x - frame.left) * scale,
    y: (y: number) => ROOM.top + (frame.high - y) * scale,
  };
  const [wide, tall] = [(frame.right - frame.left) * scale, (frame.high - frame.low) * scale];
  const label = `${spec.title}, ${one.label}: ${spec.map!.label} over ${spec.x.label} and ${spec.y.label}, up to ${formatSignificant(Math.max(...one.value), 3)}`;
  const picture = svg("svg", {
    class: "force-map",
    viewBox: `0 0 ${wide + ROOM.left + ROOM.right} ${tall + ROOM.top + ROOM.bottom}`,
    role: "img",
    "aria-label": label,
  });
  one.value.forEach((value, i) => {
    const rgb = colourOf(value / most);
    const bright = 0.299 * rgb[0] + 0.587 * rgb[1] + 0.114 * rgb[2] > 140;
    const [x, y] = [one.x[i]!, one.y[i]!];
    const cell = svg("rect", {
      x: at.x(x - dx / 2),
      y: at.y(y + dy / 2),
      width: dx * scale,
      height: dy * scale,
      fill: `rgb(${rgb.map(Math.round).join(" ")})`,
    });
    cell.append(
      svg("title", {}, `${formatSignificant(value, 3)} at ${formatSignificant(x, 3)}, ${formatSignificant(y, 3)}`),
    );
    const size = Math.min(13, 0.36 * dx * scale);
    const number = svg(
      "text",
      {
        x: at.x(x),
        y: at.y(y) + 0.35 * size,
        "font-size": size,
        "text-anchor": "middle",
        fill: bright ? "#111" : "#fff",
      },
      formatSignificant(value, 2),
    );
    picture.append(cell, number);
  });
  const ticks = (low: number, high: number) => barTicks(high, low);
  const across = ticks(frame.left, frame.right);
  const up = ticks(frame.low, frame.high);
  for (const value of across.values) {
    const text = formatTick(value, across.increment);
    picture.append(
      svg("text", { class: "tick", x: at.x(value), y: ROOM.top + tall + 13, "text-anchor": "middle" }, text),
    );
  }
  for (const value of up.values) {
    const text = formatTick(value, up.increment);
    picture.append(svg("text", { class: "tick", x: ROOM.left - 5, y: at.y(value) + 4, "text-anchor": "end" }, text));
  }
  picture.append(
    svg(
      "text",
      { class: "label", x: ROOM.left + wide / 2, y: ROOM.top + tall + 29, "text-anchor": "middle" },
      spec.x.label,
    ),
    svg(
      "text",
      { class: "label", transform: `translate(9 ${ROOM.top + tall / 2}) rotate(-90)`, "text-anchor": "middle" },
      spec.y.label,
    ),
  );
  return picture;
}

function bar(label: string, most: number): HTMLElement {
  const colours = h("div", { class: "map-bar-colours" });
  colours.style.background = colourGradient("to right");
  const { values, increment } = barTicks(most);
  const ticks = values.map((value) => {
    const tick = h("span", {}, formatTick(value, increment));
    tick.style.left = `${(100 * value) / most}%`;
    return tick;
  });
  return h("div", { class: "map-bar" }, h("div", {}, label), colours, h("div", { class: "map-bar-ticks" }, ...ticks));
}
