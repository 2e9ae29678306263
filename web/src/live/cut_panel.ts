// cut_panel.ts — what a drag does: pull, grasp, place a tool, cut or turn; while it cuts, how deep, and what has been cut.
import { formatSignificant } from "../format/number.ts";
import { h } from "../page/dom.ts";
import type { DragMode, LiveView } from "./live_view.ts";
import type { Hello, Keyframe, SlowState } from "./protocol.ts";
import { Slider } from "./slider.ts";

const MODES: readonly { mode: DragMode; label: string; key: string; title: string }[] = [
  { mode: "pull", label: "Pull", key: "p", title: "A drag on tissue pulls it; outside the body it turns the view (P)" },
  {
    mode: "grasp",
    label: "Grasp",
    key: "b",
    title: "A patch that is picked is bonded to the pointer until it is let go (B)",
  },
  {
    mode: "place",
    label: "Place tool",
    key: "o",
    title: "The chosen tool goes before the point of the surface that is picked (O)",
  },
  { mode: "cut", label: "Cut tissue", key: "k", title: "A stroke over the body cuts it (K)" },
  { mode: "turn", label: "Turn", key: "t", title: "A drag turns the view (T)" },
];

export class CutPanel {
  readonly modes: HTMLElement;
  readonly element = h("div", { class: "live-drag", hidden: true });
  private readonly inputs = new Map<DragMode, HTMLInputElement>();
  private readonly told = h("span", { class: "muted live-cut-told", role: "status" }, "Draw a stroke over the body");
  private readonly depth = h("div", { class: "live-cut-depth" });

  constructor(private readonly view: LiveView) {
    const modes = MODES.map(({ mode, label, title }) => {
      const input = h("input", { type: "radio", name: "drag", value: mode, checked: mode === "pull" });
      input.addEventListener("change", () => this.choose(mode));
      this.inputs.set(mode, input);
      return h("label", { title }, input, h("span", {}, label));
    });
    this.modes = h("fieldset", { class: "live-modes live-hand", role: "radiogroup", "aria-label": "A drag" }, ...modes);
    this.element.append(this.depth, this.told);
    view.canvas.addEventListener("keydown", (event) => {
      const found = MODES.find(({ key }) => key === event.key.toLowerCase());
      if (!found || event.ctrlKey || event.altKey || event.metaKey || this.inputs.get(found.mode)!.matches(":disabled"))
        return;
      this.inputs.get(found.mode)!.checked = true;
      this.choose(found.mode);
    });
  }

  start(hello: Hello): void {
    const input = this.inputs.get("cut")!;
    input.disabled = hello.why_no_cut !== "" || !this.view.cutTool;
    for (const mode of ["pull", "grasp"] as const) this.inputs.get(mode)!.disabled = !hello.can_grab;
    this.inputs.get("place")!.parentElement!.hidden = !hello.tools.some((tool) => tool.instrument);
    if (hello.why_no_cut) input.parentElement!.title = `This body cannot be cut: ${hello.why_no_cut}`;
  }

  /** The slider goes as deep as the body is large. */
  takeKeyframe(keyframe: Keyframe): void {
    if (this.depth.childElementCount > 0 || !this.view.cutTool) return;
    const size = 1000 * diagonal(keyframe.rest);
    const step = 10 ** Math.floor(Math.log10(size / 200));
    const value = step * Math.round((0.12 * size) / step);
    const act = (depth: number) => (this.view.cutTool!.depth = depth / 1000);
    this.depth.append(new Slider("cut-depth", "Depth of cut", "mm", step, size, value, step, "acts", act).element);
    act(value);
  }

  show(state: SlowState): void {
    const area = state.cut_area_m2;
    const pieces = state.pieces > 1 ? `, ${state.pieces} pieces` : "";
    this.told.textContent =
      area > 0 ? `${formatSignificant(1e4 * area, 3)} cm² cut${pieces}` : "Draw a stroke over the body";
    this.told.title = `The longest piece of a stroke took ${formatSignificant(1e3 * state.cut_longest_s, 2)} ms`;
  }

  private choose(mode: DragMode): void {
    this.view.mode = mode;
    this.element.hidden = mode !== "cut";
  }
}

function diagonal(rest: Float32Array): number {
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  rest.forEach((x, i) => {
    low[i % 3] = Math.min(low[i % 3]!, x);
    high[i % 3] = Math.max(high[i % 3]!, x);
  });
  return Math.hypot(...high.map((x, k) => x - low[k]!));
}
