// tissue_panel.ts — the numbers of the tissues as sliders, as the program describes them; a change acts while a hand is on it.
import { h, select } from "../page/dom.ts";
import type { ParameterInfo } from "./protocol.ts";
import { Slider } from "./slider.ts";

export class TissuePanel {
  readonly element = h("section", { class: "live-panel", "aria-label": "Tissue" });
  private sliders: Slider[] = [];
  private wished = new Map<number, number>(); // one message of each a drawing
  private request = 0;

  constructor(private readonly send: (parameter: number, value: number) => void) {}

  build(parameters: readonly ParameterInfo[]): void {
    this.sliders = parameters.map((info, i) => this.slider(info, i));
    const tissues = [...new Set(parameters.map((info) => info.tissue))];
    const panels = tissues.map((tissue) =>
      h("div", { hidden: tissue !== tissues[0] }, ...this.groups(parameters, tissue)),
    );
    const choice = select(
      "of",
      tissues.map((tissue, i) => ({ value: String(i), label: tissue })),
      "0",
      (chosen) => panels.forEach((panel, i) => (panel.hidden = String(i) !== chosen)),
    );
    choice.hidden = tissues.length < 2;
    this.element.replaceChildren(
      h("fieldset", {}, h("legend", {}, "Tissue"), choice, ...panels),
      h("p", { class: "muted live-hint" }, "Changes act at once on the present body; Reset returns it to rest."),
    );
    this.element.hidden = parameters.length === 0;
  }

  private groups(parameters: readonly ParameterInfo[], tissue: string): HTMLElement[] {
    const mine = parameters.map((info, i) => ({ info, i })).filter(({ info }) => info.tissue === tissue);
    const names = [...new Set(mine.map(({ info }) => info.group))];
    return names.map((name) => {
      const of = mine.filter(({ info }) => info.group === name);
      const formula = of[0]!.info.formula;
      return h(
        "div",
        { class: "live-group", role: "group", "aria-label": name },
        formula && h("p", { class: "live-group-name" }, name, h("span", { class: "muted" }, formula)),
        ...of.map(({ i }) => this.sliders[i]!.element),
      );
    });
  }

  private slider(info: ParameterInfo, i: number): Slider {
    const { label, unit, least, most, value, log } = info;
    const step = 10 ** Math.floor(Math.log10((most - least) / 100));
    const act = (to: number) => this.wish(i, to);
    const made = new Slider(
      `parameter-${i}`,
      label,
      unit,
      least,
      most,
      value,
      step,
      "acts",
      act,
      log ? "log" : "linear",
    );
    made.element.title = info.help;
    return made;
  }

  private wish(parameter: number, value: number): void {
    this.wished.set(parameter, value);
    if (this.request !== 0) return;
    this.request = requestAnimationFrame(() => {
      this.request = 0;
      this.wished.forEach((to, index) => this.send(index, to));
      this.wished.clear();
    });
  }

  /** What the program has. */
  follow(values: readonly number[]): void {
    values.forEach((value, i) => this.sliders[i]?.follow(value));
  }
}
