// chart.ts — one chart: uPlot for axes, zoom and cursor, our lines, legend and marks on top.
import uPlot from "uplot";
import { formatSignificant } from "../format/number.ts";
import { nameOfLabel, unitOfLabel } from "../format/units.ts";
import { h } from "../page/dom.ts";
import { currentTheme, isPrinting, onTheme } from "../page/theme.ts";
import { whenVisible } from "../page/visibility.ts";
import { logAxis, logYAxis, xAxis, yAxis } from "./axes.ts";
import { drawLine } from "./draw_lines.ts";
import { drawEvents } from "./event_marks.ts";
import { Legend, entryOf } from "./legend.ts";
import { TOTAL_STYLE, strokeOf } from "./line_style.ts";
import { type ChartModel, type Extent, type Line, extentOf } from "./model.ts";
import { isRising, nearestInX, nearestOnScreen } from "./nearest.ts";
import { Marks } from "./marks.ts";
import type { SceneState } from "./scene_state.ts";

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
    this.legend = new Legend(model.lines, (line, only) => this.toggle(line, only));
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
      padding: [6, 14, 0, 0],
      legend: { show: false },
      scales: {
        x: { time: false, auto: false, min: this.view.xMin, max: this.view.xMax, range: (_u, min, max) => [min, max] },
        y: { auto: false, min: this.view.yMin, max: this.view.yMax, range: (_u, min, max) => [min, max] },
      },
      axes: [this.model.logX ? logAxis(this.model.xLabel) : xAxis(this.model.xLabel), this.model.logY ? logYAxis() : yAxis()],
      series: [{}, { paths: () => null, points: { show: false } }],
      cursor: {
        x: true,
        y: false,
        points: { show: false },
        drag: { x: true, y: true, uni: 24, dist: 6, setScale: true },
        bind: { dblclick: () => () => (this.resetZoom(), null) },
      },
      hooks: {
        draw: [(plot) => this.drawLines(plot)],
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

  private drawLines(plot: uPlot): void {
    const theme = currentTheme();
    for (const line of this.shownLines()) {
      drawLine(plot.ctx, line, strokeOf(line.style, theme), this.view, plot.bbox, uPlot.pxRatio);
    }
    const variant = (this.marked = this.markedVariant());
    const marks = this.model.events.filter((event) => event.variant === variant);
    drawEvents(plot.ctx, marks, strokeOf(TOTAL_STYLE, theme), this.view, plot.bbox, uPlot.pxRatio);
  }

  /** Events are marked of one variant: the owner of the chart, that of the 3D view, or the last one shown. */
  private markedVariant(): string | null {
    if (this.owner !== null) return this.owner;
    const shown = this.shownLines().map((line) => line.variant);
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

  /** After lines were shown or hidden: legend, range (unless zoomed) and drawing follow. */
  private refreshShown(): void {
    for (const line of this.model.lines) this.legend.setShown(entryOf(line), !this.isHidden(line));
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

/** One value, or from the least to the largest of several. */
function valuesText(values: readonly number[]): string {
  const known = values.filter(Number.isFinite);
  const [least, most] = [formatSignificant(Math.min(...known), 4), formatSignificant(Math.max(...known), 4)];
  return least === most ? least : `${least} … ${most}`;
}

function sameExtent(a: Extent, b: Extent): boolean {
  return a.xMin === b.xMin && a.xMax === b.xMax && a.yMin === b.yMin && a.yMax === b.yMax;
}
