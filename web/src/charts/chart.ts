// chart.ts — one chart: uPlot for axes, zoom and cursor, our lines, legend and marks on top.
//
// A line that is pointed at, in the plot, the legend or at its end, stands out in all charts of its scene; a click keeps it so.
import uPlot from "uplot";
import { formatSignificant } from "../format/number.ts";
import { nameOfLabel, unitOfLabel } from "../format/units.ts";
import { h } from "../page/dom.ts";
import { setVector, svgButton } from "../page/save_svg.ts";
import { currentTheme, isPrinting, onTheme, themeColour } from "../page/theme.ts";
import { whenVisible } from "../page/visibility.ts";
import { logAxis, logYAxis, xAxis, yAxis } from "./axes.ts";
import { cssBox, drawAxes } from "./chart_svg.ts";
import { type PlotBox, drawLine } from "./draw_lines.ts";
import { type EndLabel, columnWidth, drawEnds, endAt, endFont, namesEnds, placeEnds } from "./end_labels.ts";
import { drawEvents, drawRings } from "./event_marks.ts";
import { Legend, entryOf } from "./legend.ts";
import { TOTAL_STYLE, strokeOf } from "./line_style.ts";
import { type ChartModel, type Extent, type Line, extentOf, keyOf } from "./model.ts";
import { isRising, nearestInX, nearestOnScreen } from "./nearest.ts";
import { Marks } from "./marks.ts";
import type { Pen } from "./pen.ts";
import type { SceneState } from "./scene_state.ts";
import { SvgPen } from "./svg_pen.ts";

const POINTED = 9; // CSS pixels from a line that still mean it
const PADDING = 14; // right of the plot [CSS px]
const PAPER_SIZE = { width: 640, height: 250 }; // CSS pixels, as in print.css

export class Chart {
  readonly element = h("div", { class: "chart" });
  private readonly canvasHost: HTMLElement;
  private readonly resetButton: HTMLButtonElement;
  private readonly legend: Legend;
  private readonly readout = h("output", { class: "chart-readout", "aria-live": "off" });
  private readonly rising: ReadonlyMap<string, boolean>;
  private readonly hidden = new Set<string>();
  private readonly stops: (() => void)[] = [];
  private marked: string | null = null; // variant whose events are drawn
  private plot: uPlot | null = null;
  private marks: Marks | null = null;
  private ends: EndLabel[] = []; // names beside the plot, of the last drawing
  private home: Extent;
  private view: Extent;

  /** @param owner  variant that all lines belong to, where the chart shows one variant only */
  constructor(
    private readonly model: ChartModel,
    private readonly state: SceneState,
    private readonly owner: string | null = null,
  ) {
    this.rising = new Map(model.lines.map((line) => [line.id, isRising(line.x)]));
    this.home = this.view = model.extent ?? extentOf(model.lines);
    this.legend = new Legend(
      model.lines,
      (line, only) => this.toggle(line, only),
      (line) => state.point(line ? keyOf(line) : null),
    );
    this.resetButton = h(
      "button",
      {
        type: "button",
        class: "button chart-reset",
        hidden: true,
        title: "Show everything again (also: double click, Escape)",
      },
      "Reset zoom",
    );
    this.resetButton.addEventListener("click", () => this.resetZoom());
    this.canvasHost = h("div", { class: "chart-plot", tabindex: 0, role: "group", "aria-label": this.describe() });
    this.canvasHost.addEventListener("keydown", (event) => this.onKey(event));
    this.element.append(
      h(
        "div",
        { class: "chart-top" },
        h("span", { class: "chart-y-label" }, model.yLabel),
        this.readout,
        this.resetButton,
        svgButton(this.element, model.title),
      ),
      this.canvasHost,
      this.legend.element,
    );
    if (model.note) this.element.append(h("p", { class: "figure-note" }, model.note));
    this.stops.push(whenVisible(this.canvasHost, () => this.create()));
    this.stops.push(
      state.onChange(() => this.refreshShown()),
      state.onPlayhead(() => this.followPlayhead()),
    );
    this.stops.push(onTheme(() => this.onLook()));
  }

  destroy(): void {
    for (const stop of this.stops) stop();
    this.plot?.destroy();
    this.plot = null;
    this.element.remove();
  }

  private describe(): string {
    const names = [...new Set(this.model.lines.map((line) => line.label))].join(", ");
    return (
      `${this.model.title}: ${this.model.yLabel} against ${this.model.xLabel}; lines: ${names}. ` +
      "Arrow keys move the cursor, Escape resets the zoom."
    );
  }

  private create(): void {
    if (this.plot) return;
    const { clientWidth: width, clientHeight: height } = this.canvasHost;
    this.plot = new uPlot(this.options(width, height), this.corners(), this.canvasHost);
    if (isPrinting()) this.plot.setSize(PAPER_SIZE);
    setVector(this.plot.root, () => this.toSvg());
    this.followPointer(this.plot);
    this.marks = new Marks(this.plot.over, this.model.lines);
    this.refreshShown();
    this.showPlayhead();
    const observer = new ResizeObserver(() => this.resize());
    observer.observe(this.canvasHost);
    this.stops.push(() => observer.disconnect());
    void document.fonts.ready.then(() => this.plot?.redraw(false, true));
  }

  /** Theme or medium changed: colours anew, and the size that print.css gives a chart on paper. */
  private onLook(): void {
    if (isPrinting()) this.plot?.setSize(PAPER_SIZE);
    else this.resize();
    this.plot?.redraw(false, true);
    this.showPlayhead();
  }

  private resize(): void {
    if (isPrinting()) return;
    const { clientWidth: width, clientHeight: height } = this.canvasHost;
    if (this.plot && width > 0 && (width !== this.plot.width || height !== this.plot.height)) {
      this.plot.setSize({ width, height });
      this.showPlayhead();
    }
  }

  private corners(): uPlot.AlignedData {
    return [
      [this.home.xMin, this.home.xMax],
      [this.home.yMin, this.home.yMax],
    ];
  }

  private options(width: number, height: number): uPlot.Options {
    const setView = () => this.readView();
    return {
      width,
      height,
      padding: [6, () => PADDING + this.column(), 0, 0],
      legend: { show: false },
      scales: {
        x: { time: false, auto: false, min: this.view.xMin, max: this.view.xMax, range: (_u, min, max) => [min, max] },
        y: { auto: false, min: this.view.yMin, max: this.view.yMax, range: (_u, min, max) => [min, max] },
      },
      axes: [
        this.model.logX ? logAxis(this.model.xLabel) : xAxis(this.model.xLabel),
        this.model.logY ? logYAxis() : yAxis(),
      ],
      series: [{}, { paths: () => null, points: { show: false } }],
      cursor: {
        x: true,
        y: false,
        points: { show: false },
        drag: { x: true, y: true, uni: 24, dist: 6, setScale: true },
        bind: { dblclick: () => () => (this.resetZoom(), null) },
      },
      hooks: {
        draw: [(plot) => this.drawLines(plot.ctx, plot.bbox, uPlot.pxRatio)],
        setCursor: [(plot) => this.onCursor(plot)],
        setScale: [setView],
      },
    };
  }

  private shownLines(): Line[] {
    return this.model.lines.filter((line) => !this.isHidden(line));
  }

  private isHidden(line: Line): boolean {
    return line.variant === null ? this.hidden.has(line.id) : this.state.isHidden(line.variant);
  }

  /** Room for the names beside the plot [CSS px]; 0: there are none. */
  private column(): number {
    const lines = this.namedLines();
    const width = this.plot?.width ?? this.canvasHost.clientWidth;
    if (!namesEnds(lines, width)) return 0;
    return columnWidth(lines, width, (text) => textWidth(text, endFont(fontFamily(), 1)));
  }

  private namedLines(): Line[] {
    return this.shownLines().filter((line) => !line.points);
  }

  private drawLines(pen: Pen, box: PlotBox, ratio: number): void {
    const theme = currentTheme();
    const highlight = this.highlight;
    const shown = this.shownLines();
    const behindFirst = [...shown].sort((a, b) => Number(keyOf(a) === highlight) - Number(keyOf(b) === highlight));
    for (const line of behindFirst) {
      const standing = highlight === null ? "plain" : keyOf(line) === highlight ? "ahead" : "behind";
      drawLine(pen, line, strokeOf(line.style, theme), this.view, box, ratio, standing);
    }
    this.drawMarks(pen, box, ratio);
    const column = this.column();
    const stroke = (line: Line) => strokeOf(line.style, theme);
    this.ends = column > 0 ? placeEnds(this.namedLines(), stroke, this.view, box, ratio) : [];
    drawEnds(pen, this.ends, box, column * ratio, ratio, highlight, fontFamily());
  }

  /** Rings on the lines of all variants shown; those of one are named. */
  private drawMarks(pen: Pen, box: PlotBox, ratio: number): void {
    const theme = currentTheme();
    const shown = this.shownLines();
    const variant = (this.marked = this.markedVariant());
    const strokes = new Map(shown.map((line) => [line.variant, strokeOf(line.style, theme)]));
    const inkOf = (of: string) => (this.owner === null ? strokes.get(of) : undefined) ?? strokeOf(TOTAL_STYLE, theme);
    const own = this.model.events.filter((event) => event.variant === variant);
    const others = this.model.events.filter((event) => event.variant !== variant && strokes.has(event.variant));
    if (variant !== null) drawEvents(pen, own, inkOf(variant), this.view, box, ratio, fontFamily());
    const paper = themeColour("--page") || "#fff";
    if (this.highlight === null) drawRings(pen, others, inkOf, paper, this.view, box, ratio, 0.6);
    drawRings(pen, own, inkOf, paper, this.view, box, ratio);
  }

  /** The key that stands out, where a line of this chart has it. */
  private get highlight(): string | null {
    const key = this.state.highlight;
    return key !== null && this.shownLines().some((line) => keyOf(line) === key) ? key : null;
  }

  /** The canvas as SVG, in CSS pixels. */
  private toSvg(): string {
    const plot = this.plot!;
    const pen = new SvgPen(textWidth, `clip-${Math.round(performance.now())}-`);
    const box = cssBox(plot, uPlot.pxRatio);
    drawAxes(pen, plot, box, this.model.xLabel);
    this.drawLines(pen, box, 1);
    return pen.content;
  }

  /** Lines near the pointer and names at their ends stand out; a click keeps them so. */
  private followPointer(plot: uPlot): void {
    const at = (event: MouseEvent): string | null => {
      const corner = plot.root.getBoundingClientRect();
      const [x, y] = [event.clientX - corner.x, event.clientY - corner.y];
      const box = cssBox(plot, uPlot.pxRatio);
      const ratio = uPlot.pxRatio;
      const end = endAt(this.ends, plot.bbox, x * ratio, y * ratio, ratio);
      return end ? end.key : this.lineAt(plot, x - box.left, y - box.top);
    };
    plot.root.addEventListener("mousemove", (event) => {
      const key = event.buttons === 0 ? at(event) : null;
      plot.root.style.cursor = key === null ? "" : "pointer";
      this.state.point(key);
    });
    plot.root.addEventListener("mouseleave", () => this.state.point(null));
    plot.root.addEventListener("click", (event) => {
      const key = at(event);
      if (key !== null) this.state.pin(key);
    });
  }

  /** Key of the line that passes within a few pixels of a place of the plot [CSS px]; null: none does, or there is one only. */
  private lineAt(plot: uPlot, x: number, y: number): string | null {
    const shown = this.shownLines();
    if (x < 0 || y < 0 || new Set(shown.map(keyOf)).size < 2) return null;
    const perX = plot.over.clientWidth / (this.view.xMax - this.view.xMin);
    const perY = plot.over.clientHeight / (this.view.yMax - this.view.yMin);
    let best: { key: string; far: number } | null = null;
    for (const line of shown) {
      const far = distanceTo(
        line,
        (v) => (v - this.view.xMin) * perX,
        (v) => (this.view.yMax - v) * perY,
        x,
        y,
      );
      if (far <= POINTED && (!best || far < best.far)) best = { key: keyOf(line), far };
    }
    return best?.key ?? null;
  }

  /** Events are marked of one variant: the owner of the chart, that of the 3D view, or the last one shown. */
  private markedVariant(): string | null {
    if (this.owner !== null) return this.owner;
    const shown = this.shownLines().map((line) => line.variant);
    if (this.highlight !== null && shown.includes(this.highlight)) return this.highlight;
    const playing = this.state.playhead?.variant;
    if (playing !== undefined && shown.includes(playing)) return playing;
    return shown.filter((name) => this.model.events.some((event) => event.variant === name)).pop() ?? null;
  }

  private readView(): void {
    const x = this.plot?.scales["x"];
    const y = this.plot?.scales["y"];
    if (x?.min == null || x.max == null || y?.min == null || y.max == null) return;
    this.view = { xMin: x.min, xMax: x.max, yMin: y.min, yMax: y.max };
    this.resetButton.hidden = sameExtent(this.view, this.home);
    this.showPlayhead();
  }

  private setView(view: Extent): void {
    this.view = view;
    const plot = this.plot;
    plot?.batch(() => {
      plot.setScale("x", { min: view.xMin, max: view.xMax });
      plot.setScale("y", { min: view.yMin, max: view.yMax });
    });
  }

  resetZoom(): void {
    this.setView(this.home);
  }

  private toggle(line: Line, only: boolean): void {
    if (line.variant !== null) this.state.toggle(line.variant, only);
    else if (only) this.showOnly(line);
    else if (!this.hidden.delete(line.id)) this.hidden.add(line.id);
    this.refreshShown();
  }

  private showOnly(line: Line): void {
    const alone = this.shownLines().every((other) => other === line);
    for (const other of this.model.lines) {
      if (other.variant !== null) continue;
      if (alone || other === line) this.hidden.delete(other.id);
      else this.hidden.add(other.id);
    }
  }

  /** After lines were shown, hidden or highlighted: legend, range (unless zoomed) and drawing follow. */
  private refreshShown(): void {
    for (const line of this.model.lines) this.legend.setShown(entryOf(line), !this.isHidden(line));
    const highlight = this.highlight;
    this.element.dataset["highlight"] = highlight ?? "";
    this.legend.setHighlight((line) => highlight === null || keyOf(line) === highlight);
    const zoomed = !sameExtent(this.view, this.home);
    const shown = this.shownLines();
    this.home = this.model.extent ?? extentOf(shown.length > 0 ? shown : this.model.lines);
    if (!zoomed) this.setView(this.home);
    this.plot?.redraw(false, false);
    this.showPlayhead();
  }

  private onCursor(plot: uPlot): void {
    const left = plot.cursor.left ?? -1;
    const top = plot.cursor.top ?? -1;
    const values = new Map<string, number[]>();
    if (left < 0 || !this.marks) {
      this.marks?.clearHover();
      this.legend.setValues(new Map());
      this.readout.textContent = "";
      return;
    }
    const atX = plot.posToVal(left, "x");
    const atY = plot.posToVal(top, "y");
    for (const line of this.model.lines) {
      const index = this.isHidden(line) ? -1 : this.indexAt(line, atX, atY, plot);
      if (index < 0) this.marks.hover(line.id, null, null);
      else {
        const y = this.model.logY ? 10 ** line.y[index]! : line.y[index]!;
        values.set(entryOf(line), [...(values.get(entryOf(line)) ?? []), y]);
        this.marks.hover(line.id, ...this.place(line, index, plot));
      }
    }
    const unit = unitOfLabel(this.model.xLabel);
    const shown = this.model.logX ? 10 ** atX : atX;
    this.readout.textContent = `${nameOfLabel(this.model.xLabel)} ${formatSignificant(shown, 4)}\u00a0${unit}`;
    this.legend.setValues(new Map([...values].map(([entry, found]) => [entry, valuesText(found)])));
  }

  private indexAt(line: Line, atX: number, atY: number, plot: uPlot): number {
    const perX = plot.over.clientWidth / (this.view.xMax - this.view.xMin);
    const perY = plot.over.clientHeight / (this.view.yMax - this.view.yMin);
    if (this.rising.get(line.id)) return nearestInX(line.x, atX, 12 / perX);
    return nearestOnScreen(line.x, line.y, atX, atY, perX, perY);
  }

  private place(line: Line, index: number, plot: uPlot): [number | null, number | null] {
    const { xMin, xMax, yMin, yMax } = this.view;
    const x = line.x[index]!;
    const y = line.y[index]!;
    const inside = x >= xMin && x <= xMax && y >= yMin && y <= yMax;
    return inside ? [plot.valToPos(x, "x"), plot.valToPos(y, "y")] : [null, null];
  }

  /** The 3D view shows another moment, or another variant, whose events are marked then. */
  private followPlayhead(): void {
    if (this.model.events.length > 0 && this.markedVariant() !== this.marked) this.plot?.redraw(false, false);
    this.showPlayhead();
  }

  /** Marks the point of the mesh shown in the 3D view on the line of its variant. */
  private showPlayhead(): void {
    if (!this.plot || !this.marks) return;
    const playhead = this.state.playhead;
    for (const line of this.model.lines) {
      const shown = playhead && line.times && (line.variant ?? this.owner) === playhead.variant && !this.isHidden(line);
      const index = shown && line.times ? nearestInX(line.times, playhead.time, Infinity) : -1;
      this.marks.playhead(
        line.id,
        ...(index < 0 ? ([null, null] as [null, null]) : this.place(line, index, this.plot)),
      );
    }
  }

  private onKey(event: KeyboardEvent): void {
    const plot = this.plot;
    if (!plot) return;
    if (event.key === "Escape") this.resetZoom();
    else if (event.key === "ArrowLeft" || event.key === "ArrowRight") {
      const width = plot.over.clientWidth;
      const step = (event.key === "ArrowLeft" ? -1 : 1) * (event.shiftKey ? 0.1 : 0.01) * width;
      const start = (plot.cursor.left ?? -1) < 0 ? 0 : plot.cursor.left! + step;
      plot.setCursor({ left: Math.min(width, Math.max(0, start)), top: plot.over.clientHeight / 2 });
    } else return;
    event.preventDefault();
  }
}

const fontFamily = (): string => themeColour("--font") || "sans-serif";

const measuring = document.createElement("canvas").getContext("2d");

/** Width of a text [px]. */
function textWidth(text: string, font: string): number {
  if (!measuring) return 0.55 * text.length * parseFloat(font.replace(/^\d+ /, ""));
  measuring.font = font;
  return measuring.measureText(text).width;
}

/** Of a place from the nearest piece of a line, all in pixels. */
function distanceTo(
  line: Line,
  toX: (value: number) => number,
  toY: (value: number) => number,
  x: number,
  y: number,
): number {
  let best = Infinity;
  let [fromX, fromY] = [NaN, NaN];
  for (let i = 0; i < Math.min(line.x.length, line.y.length); i++) {
    const [px, py] = [toX(line.x[i]!), toY(line.y[i]!)];
    const [dx, dy] = [px - fromX, py - fromY];
    const length = dx * dx + dy * dy;
    const share = length > 0 ? Math.min(1, Math.max(0, ((x - fromX) * dx + (y - fromY) * dy) / length)) : 0;
    const far = length >= 0 ? Math.hypot(fromX + share * dx - x, fromY + share * dy - y) : Math.hypot(px - x, py - y);
    if (far < best) best = far;
    [fromX, fromY] = [px, py];
  }
  return best;
}

/** One value, or from the least to the largest of several. */
function valuesText(values: readonly number[]): string {
  const known = values.filter(Number.isFinite);
  const [least, most] = [formatSignificant(Math.min(...known), 4), formatSignificant(Math.max(...known), 4)];
  return least === most ? least : `${least} … ${most}`;
}

function sameExtent(a: Extent, b: Extent): boolean {
  return a.xMin === b.xMin && a.xMax === b.xMax && a.yMin === b.yMin && a.yMax === b.yMax;
}
