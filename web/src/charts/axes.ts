// axes.ts — how axes of charts look: quiet grid, ticks in the page's typeface, width that fits the labels.
import type uPlot from "uplot";
import { formatSignificant, formatTick } from "../format/number.ts";
import { themeColour } from "../page/theme.ts";

const FONT_SIZE = 12;
const TICK = 4;
const GAP = 5;

const font = (weight: number) => `${weight} ${FONT_SIZE}px ${themeColour("--font") || "sans-serif"}`;

function common(): uPlot.Axis {
  return {
    stroke: () => themeColour("--ink-2"),
    font: font(400),
    labelFont: font(500),
    gap: GAP,
    grid: { stroke: () => themeColour("--grid"), width: 1 },
    ticks: { stroke: () => themeColour("--rule-strong"), width: 1, size: TICK },
    border: { show: true, stroke: () => themeColour("--rule-strong"), width: 1 },
    values: (_plot, splits, _axis, _space, increment) => splits.map((value) => formatTick(value, increment)),
  };
}

export function xAxis(label: string): uPlot.Axis {
  return { ...common(), scale: "x", label, labelSize: 20, labelGap: 2, size: 30, space: 64 };
}

/** The same where the scale counts decades: a tick at each, and within them where less than two are shown. */
export function logAxis(label: string): uPlot.Axis {
  return { ...xAxis(label), ...DECADES };
}

const DECADES: Pick<uPlot.Axis, "incrs" | "values"> = {
  incrs: (_plot, _axis, low, high) => (high - low > 2 ? [1, 2, 5, 10] : [0.05, 0.1, 0.25, 0.5, 1]),
  values: (_plot, splits) =>
    splits.map((decades) => formatSignificant(10 ** decades, Number.isInteger(decades) ? 1 : 2)),
};

/** The same upwards. */
export function logYAxis(): uPlot.Axis {
  return { ...yAxis(), ...DECADES };
}

export function yAxis(): uPlot.Axis {
  return { ...common(), scale: "y", space: 36, size: (_plot, values) => widthOf(values) };
}

/** Room for the longest label [CSS px]; labels are digits, all of one width. */
function widthOf(values: readonly string[] | null): number {
  const longest = Math.max(1, ...(values ?? []).map((value) => value.length));
  return Math.ceil(TICK + GAP + 3 + 0.54 * FONT_SIZE * longest);
}
