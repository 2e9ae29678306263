// clip_controls.ts — what opens a body and moves the cut: a tick, an axis, a slider with its place, the other side.
import { h, select } from "../page/dom.ts";
import { CLIP_AXES, type ClipAxis, type ClipBody, type ClipSettings, clipPlace, clipShare } from "./clip.ts";

const LABELS: Record<ClipAxis, string> = { x: "across x", y: "across y", z: "across z", view: "across the view" };

export class ClipControls {
  readonly tick: HTMLElement; // stands among the view's other ticks
  readonly element: HTMLElement; // the rest, while the body is open
  private readonly open = h("input", { type: "checkbox", name: "open" });
  private readonly slider = h("input", {
    type: "range",
    min: 0,
    max: 1,
    step: 0.005,
    "aria-label": "Place of the cut",
  });
  private readonly place = h("output", { class: "cut-readout" });
  private readonly other = h("input", { type: "checkbox", name: "other-side" });
  private readonly side: HTMLElement;
  private readonly axis: HTMLSelectElement;

  /** @param body  null while there is none @param changed  after every change */
  constructor(
    private readonly settings: ClipSettings,
    private readonly body: () => ClipBody | null,
    private readonly changed: () => void,
  ) {
    const axes = CLIP_AXES.map((value) => ({ value, label: LABELS[value] }));
    const choice = select("Cut", axes, settings.axis, (axis) =>
      this.change({ axis: axis as ClipAxis, at: null, flipped: false }),
    );
    this.axis = choice.querySelector("select")!;
    this.side = h("label", { class: "check" }, this.other, h("span", {}, "Other side"));
    this.tick = h(
      "label",
      { class: "check", title: "Remove a part to look inside (C; [ and ] move the cut)" },
      this.open,
      h("span", {}, "Cut open"),
    );
    this.element = h(
      "div",
      { class: "cut", role: "group", "aria-label": "Cut" },
      choice,
      h("label", { class: "cut-place" }, this.slider, this.place),
      this.side,
    );
    this.open.addEventListener("change", () => this.change({ on: this.open.checked }));
    this.slider.addEventListener("input", () => this.change({ at: Number(this.slider.value) }));
    this.other.addEventListener("change", () => this.change({ flipped: this.other.checked }));
    this.refresh();
  }

  private change(to: Partial<ClipSettings>): void {
    Object.assign(this.settings, to);
    this.changed();
    this.refresh();
  }

  /** Shows what the settings say now. */
  refresh(): void {
    const { on, axis, flipped } = this.settings;
    const body = this.body();
    this.open.checked = on;
    this.axis.value = axis;
    this.other.checked = flipped;
    this.side.hidden = axis === "view";
    this.element.hidden = !on;
    if (!body) return;
    this.slider.value = String(clipShare(this.settings, body));
    const mm = `${(1000 * clipPlace(this.settings, body)).toFixed(1).replace("-", "−")}\u00a0mm`;
    this.place.textContent = axis === "view" ? `${mm} behind the middle` : `${axis} = ${mm}`;
    this.slider.setAttribute("aria-valuetext", this.place.textContent);
  }
}
