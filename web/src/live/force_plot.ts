// force_plot.ts — a force that grows while one looks: uPlot for axes and scales, one line that need not rise in x.
import uPlot from "uplot";
import { xAxis, yAxis } from "../charts/axes.ts";
import { strokeOf } from "../charts/line_style.ts";
import { h } from "../page/dom.ts";
import { currentTheme, onTheme, themeColour } from "../page/theme.ts";

const HEIGHT = 168; // CSS px
const LEAST_WAY = 0.6; // canvas px between two points of a line
const MARK_RADIUS = 4.5; // CSS px

export class ForcePlot {
  readonly element: HTMLElement;
  private readonly plot: uPlot;
  private x: readonly number[] = [];
  private y: readonly number[] = [];
  private first = 0;
  private mark = -1;

  constructor(
    title: string,
    xLabel: string,
    private readonly xScale: number,
  ) {
    const host = h("div", { class: "live-plot-canvas", role: "img", "aria-label": title });
    this.element = h("figure", { class: "live-plot" }, h("figcaption", {}, title), host);
    this.plot = new uPlot(
      {
        width: 320,
        height: HEIGHT,
        legend: { show: false },
        cursor: { show: false },
        scales: {
          x: { time: false, range: () => this.range(this.x, this.xScale) },
          y: { range: () => this.range(this.y, 1) },
        },
        axes: [xAxis(xLabel), yAxis()],
        series: [{}, { show: false }],
        hooks: { draw: [(plot) => this.drawLine(plot)] },
      },
      [
        [0, 1],
        [0, 1],
      ],
      host,
    );
    new ResizeObserver(() => this.plot.setSize({ width: Math.max(120, host.clientWidth), height: HEIGHT })).observe(
      host,
    );
    onTheme(() => this.plot.redraw(false));
  }

  /** Shows a line from point `first` on, with a ring at point `mark`; −1: none. */
  show(x: readonly number[], y: readonly number[], first = 0, mark = -1): void {
    this.x = x;
    this.y = y;
    this.first = first;
    this.mark = mark;
    this.plot.setData(
      [
        [0, 1],
        [0, 1],
      ],
      true,
    );
  }

  private range(values: readonly number[], scale: number): [number, number] {
    let [low, high] = values === this.y ? [0, 0] : [Infinity, -Infinity];
    for (let i = this.first; i < values.length; i += 1) {
      low = Math.min(low, values[i]! * scale);
      high = Math.max(high, values[i]! * scale);
    }
    if (!(high - low > 1e-9))
      return [Math.min(low, 0) || 0, (Number.isFinite(high) ? high : 0) + (values === this.y ? 0.1 : 1)];
    const room = values === this.y ? 0.06 * (high - low) : 0;
    return [low < 0 ? low - room : low, high + room];
  }

  private drawLine(plot: uPlot): void {
    const { ctx, bbox } = plot;
    ctx.save();
    ctx.beginPath();
    ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
    ctx.clip();
    ctx.beginPath();
    const [x, y] = [straight(plot, "x", this.xScale), straight(plot, "y", 1)];
    let [atX, atY] = [NaN, NaN];
    for (let i = this.first; i < this.x.length; i++) {
      const [toX, toY] = [x(this.x[i]!), y(this.y[i]!)];
      if (Math.abs(toX - atX) < LEAST_WAY && Math.abs(toY - atY) < LEAST_WAY) continue;
      ctx.lineTo(toX, toY);
      [atX, atY] = [toX, toY];
    }
    ctx.lineWidth = 1.75 * devicePixelRatio;
    ctx.lineJoin = "round";
    ctx.strokeStyle = strokeOf({ colour: 0, dash: [] }, currentTheme());
    ctx.stroke();
    if (this.mark >= 0 && this.mark < this.x.length) {
      const at = [
        plot.valToPos(this.x[this.mark]! * this.xScale, "x", true),
        plot.valToPos(this.y[this.mark]!, "y", true),
      ] as const;
      ctx.beginPath();
      ctx.arc(...at, MARK_RADIUS * devicePixelRatio, 0, 2 * Math.PI);
      ctx.fillStyle = themeColour("--page");
      ctx.fill();
      ctx.stroke();
    }
    ctx.restore();
  }
}

/** The plot's own map from numbers to canvas pixels; two of its answers say all of it. */
function straight(plot: uPlot, axis: "x" | "y", scale: number): (value: number) => number {
  const [zero, one] = [plot.valToPos(0, axis, true), plot.valToPos(1, axis, true)];
  return (value) => zero + scale * value * (one - zero);
}
