// svg_pen.ts — draws as a canvas does, into SVG: every chart of a page can be saved with lines and letters, not dots.
import type { Pen } from "./pen.ts";

/** What save() keeps. */
interface Look {
  strokeStyle: string;
  fillStyle: string;
  globalAlpha: number;
  lineWidth: number;
  lineJoin: CanvasLineJoin;
  lineCap: CanvasLineCap;
  font: string;
  textBaseline: CanvasTextBaseline;
  textAlign: CanvasTextAlign;
  dash: readonly number[];
  clip: string; // id; "": none
}

const number = (value: number): string => String(Math.round(value * 100) / 100);
const escaped = (text: string): string => text.replace(/&/g, "&amp;").replace(/</g, "&lt;").replace(/"/g, "&quot;");
const ANCHORS: Partial<Record<CanvasTextAlign, string>> = { center: "middle", right: "end", end: "end" };
/** Where the middle and the top of letters lie above their base line, in sizes of the font. */
const RISE: Partial<Record<CanvasTextBaseline, number>> = { middle: 0.34, top: 0.8, bottom: -0.2 };

export class SvgPen implements Pen {
  strokeStyle: Pen["strokeStyle"] = "#000";
  fillStyle: Pen["fillStyle"] = "#000";
  globalAlpha = 1;
  lineWidth = 1;
  lineJoin: CanvasLineJoin = "miter";
  lineCap: CanvasLineCap = "butt";
  font = "12px sans-serif";
  textBaseline: CanvasTextBaseline = "alphabetic";
  textAlign: CanvasTextAlign = "start";
  private dash: readonly number[] = [];
  private clipId = "";
  private readonly kept: Look[] = [];
  private path = "";
  private readonly parts: string[] = [];
  private clips = 0;

  /** @param widthOf  of a text in a font, as a canvas measures it @param prefix  of the ids, unique on its page */
  constructor(
    private readonly widthOf: (text: string, font: string) => number,
    private readonly prefix = "c",
  ) {}

  /** What was drawn, as the inside of an <svg>. */
  get content(): string {
    return this.parts.join("\n");
  }

  save(): void {
    const { strokeStyle, fillStyle, globalAlpha, lineWidth, lineJoin, lineCap, font, textBaseline, textAlign } = this;
    this.kept.push({
      ...{ strokeStyle: String(strokeStyle), fillStyle: String(fillStyle), globalAlpha, lineWidth, lineJoin, lineCap },
      ...{ font, textBaseline, textAlign, dash: this.dash, clip: this.clipId },
    });
  }

  restore(): void {
    const look = this.kept.pop();
    if (!look) return;
    const { dash, clip, ...rest } = look;
    Object.assign(this, rest);
    this.dash = dash;
    this.clipId = clip;
  }

  setLineDash(dash: Iterable<number>): void {
    this.dash = [...dash];
  }

  beginPath(): void {
    this.path = "";
  }

  moveTo(x: number, y: number): void {
    this.path += `M${number(x)} ${number(y)}`;
  }

  /** As on a canvas, the first point of a path is moved to. */
  lineTo(x: number, y: number): void {
    this.path += `${this.path === "" ? "M" : "L"}${number(x)} ${number(y)}`;
  }

  rect(x: number, y: number, width: number, height: number): void {
    this.path += `M${number(x)} ${number(y)}h${number(width)}v${number(height)}h${number(-width)}z`;
  }

  /** A whole circle, which is all that charts draw. */
  arc(x: number, y: number, radius: number): void {
    const r = number(radius);
    this.path += `M${number(x - radius)} ${number(y)}a${r} ${r} 0 1 0 ${number(2 * radius)} 0`;
    this.path += `a${r} ${r} 0 1 0 ${number(-2 * radius)} 0z`;
  }

  clip(): void {
    this.clipId = `${this.prefix}${++this.clips}`;
    this.parts.push(`<clipPath id="${this.clipId}"><path d="${this.path}"/></clipPath>`);
  }

  stroke(): void {
    if (this.path === "") return;
    const dash = this.dash.length > 0 ? ` stroke-dasharray="${this.dash.map(number).join(" ")}"` : "";
    this.parts.push(
      `<path d="${this.path}" fill="none" stroke="${String(this.strokeStyle)}" stroke-width="${number(this.lineWidth)}"` +
        ` stroke-linejoin="${this.lineJoin}" stroke-linecap="${this.lineCap}"${dash}${this.common("stroke")}/>`,
    );
  }

  fill(): void {
    if (this.path === "") return;
    this.parts.push(`<path d="${this.path}" fill="${String(this.fillStyle)}"${this.common("fill")}/>`);
  }

  fillText(text: string, x: number, y: number): void {
    const [, weight = "400", size = "12", family = "sans-serif"] =
      /^(?:(\d+|bold|normal) )?([\d.]+)px (.*)$/.exec(this.font) ?? [];
    const down = (RISE[this.textBaseline] ?? 0) * Number(size);
    const anchor = ANCHORS[this.textAlign];
    this.parts.push(
      `<text x="${number(x)}" y="${number(y + down)}" font-family="${escaped(family)}" font-size="${number(Number(size))}"` +
        ` font-weight="${weight}"${anchor ? ` text-anchor="${anchor}"` : ""} fill="${String(this.fillStyle)}"` +
        `${this.common("fill")}>${escaped(text)}</text>`,
    );
  }

  measureText(text: string): TextMetrics {
    return { width: this.widthOf(text, this.font) } as TextMetrics;
  }

  private common(what: "stroke" | "fill"): string {
    const alpha = this.globalAlpha < 1 ? ` ${what}-opacity="${number(this.globalAlpha)}"` : "";
    return alpha + (this.clipId ? ` clip-path="url(#${this.clipId})"` : "");
  }
}
