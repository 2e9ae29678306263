// draw_lines.ts — strokes lines on a chart's canvas.
//
// uPlot's own series want one rising x for all; loading and unloading, and variants that end at different
// depths, do not have one. So uPlot keeps axes, scales, zoom and cursor, and the lines are drawn here.
import { MEASURED_STYLE } from "./line_style.ts";
import type { Extent, Line } from "./model.ts";
import type { Pen } from "./pen.ts";

export interface PlotBox {
  left: number; // canvas pixels
  top: number;
  width: number;
  height: number;
}

/** Points closer to the last drawn one than this, in canvas pixels along both axes, are not drawn. */
const LEAST_STEP = 0.4;

/** How a line stands among others: as all do, before them, or behind them. */
export type Standing = "plain" | "ahead" | "behind";
const ALPHA: Record<Standing, number> = { plain: 1, ahead: 1, behind: 0.16 };
const WIDTH: Record<Standing, number> = { plain: 1.75, ahead: 2.75, behind: 1.5 };

/** Strokes the line inside the box that shows `view`; `ratio` is canvas pixels per CSS pixel. */
export function drawLine(
  context: Pen,
  line: Line,
  stroke: string,
  view: Extent,
  box: PlotBox,
  ratio: number,
  standing: Standing = "plain",
): void {
  context.save();
  context.globalAlpha = ALPHA[standing];
  context.beginPath();
  context.rect(box.left, box.top - ratio, box.width + ratio, box.height + 2 * ratio);
  context.clip();
  const fit = line.style.colour < 0 && line.style.dash.length > 0;
  context.strokeStyle = stroke;
  if (line.points) {
    drawPoints(context, line, view, box, ratio);
    context.restore();
    return;
  }
  context.lineJoin = "round";
  context.lineCap = line.style.dash.length > 0 ? "butt" : "round";
  context.beginPath();
  tracePath(context, line, view, box);
  if (line.style.dash.length > 0 && !fit && standing !== "behind") strokeUnderlay(context, ratio);
  context.setLineDash(line.style.dash.map((length) => length * ratio));
  const thin = fit || line.style === MEASURED_STYLE;
  context.lineWidth = (thin && standing !== "ahead" ? 1.25 : WIDTH[standing]) * ratio;
  context.stroke();
  context.restore();
}

/** An open circle at every point. */
function drawPoints(context: Pen, line: Line, view: Extent, box: PlotBox, ratio: number): void {
  context.lineWidth = 1.5 * ratio;
  const count = Math.min(line.x.length, line.y.length);
  for (let i = 0; i < count; i++) {
    const px = box.left + ((line.x[i]! - view.xMin) / (view.xMax - view.xMin)) * box.width;
    const py = box.top + box.height * (1 - (line.y[i]! - view.yMin) / (view.yMax - view.yMin));
    if (px !== px || py !== py) continue;
    context.beginPath();
    context.arc(px, py, 3.5 * ratio, 0, 2 * Math.PI);
    context.stroke();
  }
}

/** A faint whole line under the dashes, or a line that jitters would fall apart between them. */
function strokeUnderlay(context: Pen, ratio: number): void {
  context.globalAlpha = 0.45;
  context.lineWidth = 0.9 * ratio;
  context.stroke();
  context.globalAlpha = 1;
}

function tracePath(context: Pen, line: Line, view: Extent, box: PlotBox): void {
  const perX = box.width / (view.xMax - view.xMin);
  const perY = box.height / (view.yMax - view.yMin);
  const count = Math.min(line.x.length, line.y.length);
  let lastX = NaN;
  let lastY = NaN;
  for (let i = 0; i < count; i++) {
    const px = box.left + (line.x[i]! - view.xMin) * perX;
    const py = box.top + box.height - (line.y[i]! - view.yMin) * perY;
    if (px !== px || py !== py) {
      lastX = NaN;
      continue;
    }
    if (lastX !== lastX) startPiece(context, line, i, px, py);
    else if (i < count - 1 && Math.abs(px - lastX) < LEAST_STEP && Math.abs(py - lastY) < LEAST_STEP) continue;
    else context.lineTo(px, py);
    lastX = px;
    lastY = py;
  }
}

/** Starts a piece after a gap; a point with gaps on both sides becomes a small square, or it would not be seen. */
function startPiece(context: Pen, line: Line, i: number, px: number, py: number): void {
  const next = i + 1 < line.x.length ? line.x[i + 1]! + line.y[i + 1]! : NaN;
  if (next !== next) context.rect(px - 1, py - 1, 2, 2);
  context.moveTo(px, py);
}
