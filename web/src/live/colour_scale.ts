// colour_scale.ts — the scale of what colours the streamed body: its range, and the bar that tells it.
import { ColourBar } from "../mesh3d/colour_bar.ts";
import { TISSUE } from "../mesh3d/look.ts";
import { type Colouring, unitOf } from "../mesh3d/fields.ts";
import { ColourRange } from "./colouring.ts";
import type { LiveSurface } from "./live_surface.ts";

export class ColourScale {
  readonly bar = new ColourBar();
  private readonly range = new ColourRange();

  /** @param diagonal  of the body [m] */
  constructor(
    private colours: Colouring,
    private readonly diagonal: () => number,
  ) {
    this.bar.element.hidden = true;
  }

  get colouring(): Colouring {
    return this.colours;
  }

  set colouring(colouring: Colouring) {
    this.colours = colouring;
    this.reset();
    this.show();
  }

  /** Begins again about the value at rest. */
  reset(): void {
    this.range.reset(this.colours, this.least);
  }

  private get least(): number {
    return this.colours.least * (this.colours.name === "displacement" ? this.diagonal() : 1);
  }

  /** Brings a frame's numbers to colours; those of a field that has not come yet stay as they were. */
  take(span: { low: number; high: number } | null, surface: LiveSurface): void {
    if (!span) return;
    const { rest } = this.colours;
    const changed = this.range.follow(span.low, span.high, rest, this.least, performance.now());
    if (changed || !this.bar.element.dataset["range"]) this.show();
    surface.scale(this.range.low, this.range.high, rest === 1);
  }

  private show(): void {
    const { low, high } = this.range;
    const { unit, perUnit } = unitOf(this.colours, low, high);
    this.bar.describe(this.colours.label, `${this.colours.symbol} [${unit}]`);
    this.bar.setRange(perUnit * high, perUnit * low, this.colours.rest === 1);
    if (this.colours.name === TISSUE) this.bar.element.hidden = true;
    this.bar.element.dataset["range"] = `${low} ${high}`;
    this.bar.element.dataset["colouring"] = this.colours.name;
  }
}
