// screenshot.ts — the 3D view as a picture that explains itself: mesh, scales, caption.
import { formatTick } from "../format/number.ts";
import { themeColour } from "../page/theme.ts";
import { barTicks } from "./colour_bar.ts";
import { colourOf } from "./colour_map.ts";
import { lengthText } from "./scale_bar.ts";

const CAPTION_HEIGHT = 36; // CSS pixels

export interface PictureScales {
  colours: { title: string; low: number; high: number } | null; // the colour scale; null: the body is not coloured
  scale: { metres: number; pixels: number }; // the bar of length, pixels in CSS
}

/** Puts the view with its scales on one canvas, a caption below it. */
export function composePicture(view: HTMLCanvasElement, scales: PictureScales, caption: string): HTMLCanvasElement {
  const canvas = document.createElement("canvas");
  canvas.width = view.width;
  const unit = view.width / Math.max(1, view.clientWidth); // canvas pixels per CSS pixel
  canvas.height = view.height + CAPTION_HEIGHT * unit;
  const context = canvas.getContext("2d");
  if (!context) return view;
  context.fillStyle = themeColour("--viewport");
  context.fillRect(0, 0, canvas.width, canvas.height);
  context.drawImage(view, 0, 0);
  context.fillStyle = themeColour("--ink");
  context.font = `${13 * unit}px ${themeColour("--font")}`;
  context.textBaseline = "middle";
  context.fillText(caption, 14 * unit, canvas.height - (CAPTION_HEIGHT / 2) * unit);
  if (scales.colours) drawBar(context, scales.colours, unit, canvas.width);
  drawLength(context, scales.scale, unit, view.height);
  return canvas;
}

function drawLength(
  context: CanvasRenderingContext2D,
  { metres, pixels }: PictureScales["scale"],
  unit: number,
  bottom: number,
): void {
  if (metres === 0) return;
  const [left, y] = [14 * unit, bottom - 14 * unit];
  context.strokeStyle = context.fillStyle = themeColour("--ink");
  context.lineWidth = 1.5 * unit;
  context.beginPath();
  context.moveTo(left, y - 5 * unit);
  context.lineTo(left, y);
  context.lineTo(left + pixels * unit, y);
  context.lineTo(left + pixels * unit, y - 5 * unit);
  context.stroke();
  context.textBaseline = "bottom";
  context.fillText(lengthText(metres), left + 4 * unit, y - 4 * unit);
}

function drawBar(
  context: CanvasRenderingContext2D,
  { title, low, high }: NonNullable<PictureScales["colours"]>,
  unit: number,
  width: number,
): void {
  const left = width - 62 * unit;
  const top = 38 * unit;
  const height = 150 * unit;
  const strips = 100;
  for (let i = 0; i < strips; i++) {
    const [r, g, b] = colourOf(1 - i / (strips - 1));
    context.fillStyle = `rgb(${r}, ${g}, ${b})`;
    context.fillRect(left, top + (i * height) / strips, 12 * unit, height / strips + 1);
  }
  context.fillStyle = themeColour("--ink");
  context.textBaseline = "middle";
  const { values, increment } = barTicks(high, low);
  for (const value of values) {
    const y = top + height * (1 - (high > low ? (value - low) / (high - low) : 0));
    context.fillText(formatTick(value, increment), left + 17 * unit, y);
  }
  context.textAlign = "right";
  context.fillText(title, width - 14 * unit, 20 * unit);
  context.textAlign = "left";
}
