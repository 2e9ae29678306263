// chart_svg.ts — grid, ticks and labels of a chart as SVG: what uPlot draws on its canvas, drawn again with a pen.
import type uPlot from "uplot";
import { themeColour } from "../page/theme.ts";
import type { PlotBox } from "./draw_lines.ts";
import type { Pen } from "./pen.ts";

const FONT_SIZE = 12;
const TICK = 4;

/** What uPlot keeps of an axis that it has laid out. */
interface LaidOut {
  _splits: number[] | null;
  _values: (string | number | null)[] | null;
}

/** The box of a plot's lines [CSS px]. */
export function cssBox(plot: uPlot, ratio: number): PlotBox {
  const { left, top, width, height } = plot.bbox;
  return { left: left / ratio, top: top / ratio, width: width / ratio, height: height / ratio };
}

export function drawAxes(pen: Pen, plot: uPlot, box: PlotBox, xLabel: string): void {
  const font = themeColour("--font") || "sans-serif";
  const [across, up] = plot.axes as unknown as [LaidOut, LaidOut];
  const [right, bottom] = [box.left + box.width, box.top + box.height];
  const rule = (colour: string, x0: number, y0: number, x1: number, y1: number) => {
    pen.strokeStyle = themeColour(colour);
    pen.beginPath();
    pen.moveTo(x0, y0);
    pen.lineTo(x1, y1);
    pen.stroke();
  };
  pen.save();
  pen.lineWidth = 1;
  pen.font = `400 ${FONT_SIZE}px ${font}`;
  pen.fillStyle = themeColour("--ink-2");
  (across._splits ?? []).forEach((value, i) => {
    const x = box.left + plot.valToPos(value, "x");
    rule("--grid", x, box.top, x, bottom);
    rule("--rule-strong", x, bottom, x, bottom + TICK);
    pen.textAlign = "center";
    pen.textBaseline = "top";
    pen.fillText(String(across._values?.[i] ?? ""), x, bottom + TICK + 5);
  });
  (up._splits ?? []).forEach((value, i) => {
    const y = box.top + plot.valToPos(value, "y");
    rule("--grid", box.left, y, right, y);
    rule("--rule-strong", box.left - TICK, y, box.left, y);
    pen.textAlign = "right";
    pen.textBaseline = "middle";
    pen.fillText(String(up._values?.[i] ?? ""), box.left - TICK - 5, y);
  });
  rule("--rule-strong", box.left, box.top, box.left, bottom);
  rule("--rule-strong", box.left, bottom, right, bottom);
  pen.font = `500 ${FONT_SIZE}px ${font}`;
  pen.textAlign = "center";
  pen.textBaseline = "top";
  pen.fillText(xLabel, (box.left + right) / 2, bottom + 32);
  pen.restore();
}
