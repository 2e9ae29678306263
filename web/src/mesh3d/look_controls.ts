// look_controls.ts — what chooses the look: a list of what colours stand for, a list of how much detail, a tick to see through.
import { h, select } from "../page/dom.ts";
import { DETAILS, type Detail, type LookSettings, TISSUE } from "./look.ts";

const DETAIL_LABELS: Record<Detail, string> = { auto: "as fast as it can", fine: "fine", plain: "plain" };

export class LookControls {
  readonly colour: HTMLElement;
  readonly detail: HTMLElement;
  readonly seeThrough: HTMLElement; // stands among the view's ticks
  private readonly tick = h("input", { type: "checkbox", name: "see-through" });
  private readonly colours: HTMLSelectElement;
  private readonly details: HTMLSelectElement;

  /** @param fields  what can colour the body; tissue comes before them @param changed  after every change */
  constructor(
    private readonly look: LookSettings,
    fields: readonly { value: string; label: string }[],
    private readonly changed: () => void,
  ) {
    const colours = [{ value: TISSUE, label: "Tissue" }, ...fields];
    this.colour = select("Colour", colours, look.colour, (colour) => this.change({ colour }));
    this.colour.title = "What the colours of the body stand for (F goes between tissue and the first field)";
    this.colours = this.colour.querySelector("select")!;
    const details = DETAILS.map((value) => ({ value, label: DETAIL_LABELS[value] }));
    this.detail = select("Detail", details, look.detail, (detail) => this.change({ detail: detail as Detail }));
    this.detail.title = "Fine: relief, moist shine and rounded facets. Plain: quick without a graphics card";
    this.details = this.detail.querySelector("select")!;
    this.seeThrough = h(
      "label",
      { class: "check", title: "Look through the surface at what is inside (G)" },
      this.tick,
      h("span", {}, "See through"),
    );
    this.tick.addEventListener("change", () => this.change({ seeThrough: this.tick.checked }));
    this.refresh();
  }

  private change(to: Partial<LookSettings>): void {
    Object.assign(this.look, to);
    this.changed();
  }

  /** Shows what the settings say now. */
  refresh(): void {
    this.tick.checked = this.look.seeThrough;
    this.colours.value = this.look.colour;
    this.details.value = this.look.detail;
  }
}
