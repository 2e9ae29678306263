// mesh_panel.ts — the 3D figure of a scene: view, colour scale, playback and its settings.
import type { SceneState } from "../charts/scene_state.ts";
import { column, depthColumn } from "../data/columns.ts";
import { button, download, h, select } from "../page/dom.ts";
import { icon } from "../page/icons.ts";
import { whenVisible } from "../page/visibility.ts";
import type { SceneData } from "../report_data.ts";
import { clipKey, rememberClip, rememberedClip } from "./clip.ts";
import { ClipControls } from "./clip_controls.ts";
import { ColourBar } from "./colour_bar.ts";
import { type MeshVariant, MeshView, type RangeChoice, type ViewSettings } from "./mesh_view.ts";
import { Player, speedsFor } from "./player.ts";
import { type Colouring, COLOURINGS, colouringOf, spoken, unitOf } from "./fields.ts";
import { composePicture } from "./screenshot.ts";
import { interpolate } from "./interpolate.ts";
import { firstLook, lookKey, rememberedLook, rememberLook, TISSUE } from "./look.ts";
import { LookControls } from "./look_controls.ts";
import { webglContext } from "./webgl.ts";

const SLIDER_STEPS = 600;
/** More marks than this would hide the body: they are off until asked for. */
const MANY_MARKS = 40;
/** Times of a run of so many seconds are read in minutes. */
const LONG_S = 180;
const EXAGGERATIONS = [1, 2, 5, 10, 20, 50];

/** Variants of a scene that have a surface to show. */
export function meshVariants(scene: SceneData): MeshVariant[] {
  return scene.variants.filter((variant): variant is MeshVariant => variant.surface !== null);
}

export class MeshPanel {
  readonly element = h("div", { class: "mesh" });
  private readonly canvas = h("canvas", { class: "mesh-canvas", tabindex: 0, role: "img" });
  private readonly viewport = h("div", { class: "mesh-viewport" });
  private readonly bar = new ColourBar();
  private readonly readout = h("output", { class: "mesh-readout" });
  private readonly key = h("div", { class: "mesh-key" });
  private readonly slider = h("input", {
    type: "range",
    min: 0,
    max: SLIDER_STEPS,
    step: 1,
    value: SLIDER_STEPS,
    "aria-label": "Time",
  });
  private readonly playButton: HTMLButtonElement;
  private readonly settings: ViewSettings;
  private readonly cut: ClipControls;
  private readonly look: LookControls;
  private readonly rangeChoice = h("div", { class: "mesh-range" });
  private readonly player: Player;
  private readonly tools: HTMLElement;
  private view: MeshView | null = null;
  private readonly firstField: string; // what F goes to

  /** @param first  name of the variant to start with, where it has a surface */
  constructor(
    private readonly scene: SceneData,
    private readonly variants: readonly MeshVariant[],
    private readonly state: SceneState,
    first: string,
  ) {
    const shown = variants.find((variant) => variant.name === first) ?? variants[variants.length - 1]!;
    const fields = fieldsOf(variants);
    this.firstField = fields[0]?.name ?? TISSUE;
    this.settings = {
      variant: shown.name,
      exaggeration: 1,
      range: "all",
      edges: false,
      ghost: false,
      marks: true,
      arrow: true,
      isotherms: true,
      look: rememberedLook(scene.name, [TISSUE, ...fields.map(({ name }) => name)], firstLook(hasIsotherms(variants))),
      clip: rememberedClip(scene.name, {
        on: !hasIsotherms(variants) && shown.surface.instruments.some((form) => form.kind === "needle"),
        axis: "y",
        at: null,
        flipped: false,
      }),
    };
    this.cut = new ClipControls(
      this.settings.clip,
      () => this.view?.clipBody ?? null,
      () => this.cutChanged(),
    );
    this.look = new LookControls(
      this.settings.look,
      fields.map(({ name, label }) => ({ value: name, label })),
      () => this.lookChanged(),
    );
    const [start, end] = spanOf(shown);
    this.player = new Player(
      start,
      end,
      () => this.view?.stage.isVisible ?? false,
      () => this.refresh(),
    );
    this.playButton = h(
      "button",
      { type: "button", class: "button play", title: "Play", "aria-label": "Play" },
      icon("play"),
    );
    this.playButton.addEventListener("click", () => this.player.toggle());
    this.slider.addEventListener("input", () => this.seekSlider());
    this.tools = this.toolbar();
    this.viewport.append(this.canvas, this.bar.element, this.tools);
    this.element.append(
      this.viewport,
      this.key,
      h("div", { class: "mesh-playback" }, this.playButton, this.slider, this.readout),
      this.options(end - start),
      h(
        "p",
        { class: "figure-note" },
        h("span", { class: "for-mouse" }, "Drag turns, right drag moves; click the view once and the wheel zooms. "),
        h("span", { class: "for-touch" }, "Tap the view once, then drag turns and two fingers zoom and move. "),
        "Rings in the charts mark the time shown.",
      ),
    );
    this.canvas.addEventListener("keydown", (event) => this.onKey(event));
    whenVisible(this.canvas, () => this.create());
  }

  /** Select of the variant, for the head of the figure. */
  variantSelect(): HTMLElement | null {
    if (this.variants.length < 2) return null;
    const options = this.variants.map((variant) => ({ value: variant.name, label: variant.label }));
    return select("Variant", options, this.settings.variant, (name) => this.showVariant(name));
  }

  private showVariant(name: string): void {
    this.settings.variant = name;
    this.player.setRange(...spanOf(this.current()));
    this.describeMarks();
  }

  private current(): MeshVariant {
    return this.variants.find((variant) => variant.name === this.settings.variant) ?? this.variants[0]!;
  }

  private create(): void {
    const context = webglContext(this.canvas);
    if (!context) return this.showMissing();
    this.view = new MeshView(this.canvas, context, this.variants, this.settings);
    this.viewport.append(this.view.scaleBar.element, this.view.arrow.label);
    this.view.labels = [this.bar.element, this.view.scaleBar.element, this.tools, this.key];
    const { held, driven } = this.view.marked;
    this.settings.marks = held + driven <= MANY_MARKS;
    const box = this.element.querySelector<HTMLInputElement>("input[name=marks]");
    if (box) box.checked = this.settings.marks;
    this.refresh();
    this.view.settleDetail();
    this.refresh();
    this.cut.refresh();
    this.describeMarks();
  }

  private lookChanged(): void {
    rememberLook(this.scene.name, this.settings.look);
    this.look.refresh();
    this.refresh();
  }

  private cutChanged(): void {
    rememberClip(this.scene.name, this.settings.clip);
    this.refresh();
  }

  private showMissing(): void {
    this.element.replaceChildren(
      h(
        "div",
        { class: "mesh-missing", role: "status" },
        h("strong", {}, "The 3D view needs WebGL 2, which this browser does not offer."),
        h(
          "span",
          {},
          "Switch on hardware acceleration or try another browser. All other figures work without it; " +
            "the program also wrote the frames as .vtu files for ParaView.",
        ),
      ),
    );
  }

  private refresh(): void {
    const time = this.player.time;
    const [start, end] = this.player.range;
    this.view?.show(time);
    this.slider.value = String(
      end > start ? Math.round((SLIDER_STEPS * (time - start)) / (end - start)) : SLIDER_STEPS,
    );
    this.slider.disabled = this.playButton.disabled = end <= start;
    const playing = this.player.playing;
    if (this.playButton.dataset["playing"] !== String(playing)) {
      this.playButton.dataset["playing"] = String(playing);
      this.playButton.replaceChildren(icon(playing ? "pause" : "play"));
      this.playButton.title = playing ? "Pause" : "Play";
      this.playButton.setAttribute("aria-label", this.playButton.title);
    }
    if (this.player.playing && this.view?.tooSlow(performance.now())) this.view.show(time);
    const coloured = this.settings.look.colour !== TISSUE;
    const scale = this.scale();
    if (scale) this.bar.describe(spoken(scale.colouring), scale.title);
    this.bar.setRange(scale?.high ?? 0, scale?.low ?? 0);
    this.rangeChoice.hidden = !coloured;
    this.canvas.dataset["look"] = this.view?.fine === false ? "plain" : "fine";
    this.readout.textContent = this.describeTime();
    this.slider.setAttribute("aria-valuetext", this.readout.textContent);
    const label =
      `Surface of ${this.current().label}, ${scale ? `coloured by ${spoken(scale.colouring)}` : "as tissue"}, ` +
      `at ${this.readout.textContent}. Arrow keys turn it, + and − zoom, C cuts it open, G sees through it, ` +
      "F colours it by a field or as tissue.";
    this.canvas.setAttribute("aria-label", label);
    this.state.setPlayhead(end > start ? { variant: this.settings.variant, time } : null);
  }

  /** The colour scale in the units that it is read in; null: the body looks as tissue. */
  private scale(): { colouring: Colouring; title: string; low: number; high: number } | null {
    if (!this.view || this.settings.look.colour === TISSUE) return null;
    const colouring = colouringOf(this.settings.look.colour);
    const { low, high } = this.view.colourRange;
    const { unit, perUnit } = unitOf(colouring, low, high);
    return { colouring, title: `${colouring.symbol} [${unit}]`, low: low * perUnit, high: high * perUnit };
  }

  private describeTime(): string {
    const variant = this.current();
    if (variant.surface.frames.length === 0) return "rest shape, no frames were recorded";
    const time = this.player.time;
    const depthName = depthColumn(variant.forces);
    const times = column(variant.forces, "time_s");
    const depths = depthName ? column(variant.forces, depthName) : null;
    const depth = times && depths ? interpolate(times, depths, time) : NaN;
    if (this.player.range[1] >= LONG_S) return `${(time / 60).toFixed(1)}\u00a0min`;
    const unit = this.player.range[1] < 0.5 ? "ms" : "s";
    const shownTime = `${(time * (unit === "ms" ? 1000 : 1)).toFixed(unit === "ms" ? 1 : 3)}\u00a0${unit}`;
    return Number.isFinite(depth) ? `${shownTime} · depth ${(depth * 1000).toFixed(2)}\u00a0mm` : shownTime;
  }

  private describeMarks(): void {
    const { held, driven } = this.view?.marked ?? { held: 0, driven: 0 };
    const entry = (kind: string, text: string) =>
      h("span", { class: `key-${kind}` }, h("i", { "aria-hidden": "true" }), text);
    this.key.replaceChildren();
    if (held > 0) this.key.append(entry("held", `held (${held})`));
    if (driven > 0) this.key.append(entry("driven", `driven by a tool (${driven})`));
    const isotherms = this.settings.isotherms ? (this.view?.isotherms ?? []) : [];
    for (const { label, colour } of isotherms)
      this.key.append(
        h("span", { class: "key-isotherm" }, h("i", { "aria-hidden": "true", style: `background: ${colour}` }), label),
      );
    this.key.hidden = isotherms.length === 0 && (!this.settings.marks || held + driven === 0);
  }

  private seekSlider(): void {
    const [start, end] = this.player.range;
    if (this.player.playing) this.player.pause();
    this.player.seek(start + ((end - start) * Number(this.slider.value)) / SLIDER_STEPS);
  }

  private toolbar(): HTMLElement {
    const tool = (name: "fit" | "camera" | "plus" | "minus", title: string, act: () => void) => {
      const element = button("", title, act, "button tool");
      element.setAttribute("aria-label", title);
      element.append(icon(name));
      element.dataset["tool"] = name;
      return element;
    };
    return h(
      "div",
      { class: "mesh-tools" },
      tool("plus", "Nearer", () => this.view?.stage.zoom(0.8)),
      tool("minus", "Farther", () => this.view?.stage.zoom(1.25)),
      tool("fit", "Fit view", () => this.view?.fit()),
      tool("camera", "Save picture", () => this.savePicture()),
    );
  }

  private options(duration: number): HTMLElement {
    const { speeds, preferred } = speedsFor(duration);
    this.player.speed = preferred;
    const factor = (value: number) => ({ value: String(value), label: `${value}×` });
    const ranges = [
      { value: "variant", label: "this variant" },
      { value: "frame", label: "this moment" },
    ];
    if (this.variants.length > 1) ranges.unshift({ value: "all", label: "all variants" });
    else this.settings.range = "variant";
    this.rangeChoice.append(
      select("Colours up to", ranges, this.settings.range, (value) => {
        this.settings.range = value as RangeChoice;
        this.refresh();
      }),
    );
    return h(
      "div",
      { class: "mesh-options" },
      select("Speed", speeds.map(factor), String(preferred), (value) => (this.player.speed = Number(value))),
      moves(this.variants)
        ? select("Displacement", EXAGGERATIONS.map(factor), "1", (value) => {
            this.settings.exaggeration = Number(value);
            this.refresh();
          })
        : null,
      this.look.colour,
      this.rangeChoice,
      this.look.detail,
      h(
        "div",
        { class: "mesh-checks" },
        this.check("Edges", "edges"),
        ...(moves(this.variants) ? [this.check("Rest shape", "ghost"), this.check("Marks", "marks")] : []),
        this.hasForces() ? this.check("Force", "arrow") : null,
        hasIsotherms(this.variants) ? this.check("Isotherms", "isotherms") : null,
        this.look.seeThrough,
        this.cut.tick,
      ),
      this.cut.element,
    );
  }

  /** Whether a variant has forces: one of heat alone has none. */
  private hasForces(): boolean {
    return this.variants.some(({ forces }) => column(forces, "force_x_N") !== null);
  }

  private check(label: string, setting: "edges" | "ghost" | "marks" | "arrow" | "isotherms"): HTMLElement {
    const input = h("input", { type: "checkbox", name: setting, checked: this.settings[setting] });
    input.addEventListener("change", () => {
      this.settings[setting] = input.checked;
      this.refresh();
      this.describeMarks();
    });
    return h("label", { class: "check" }, input, h("span", {}, label));
  }

  private savePicture(): void {
    if (!this.view) return;
    const colours = this.scale();
    const { scaleBar } = this.view;
    const factor = this.settings.exaggeration;
    const caption =
      `${this.scene.title} · ${this.current().label} · ${this.describeTime()}` +
      (factor === 1 ? "" : ` · displacement ${factor}×`);
    this.view.stage.withFinePicture((canvas) =>
      composePicture(canvas, { colours, scale: scaleBar.shownLength }, caption).toBlob((blob) => {
        if (blob) download(`${this.scene.name}-${this.settings.variant}.png`, blob);
      }),
    );
  }

  private onKey(event: KeyboardEvent): void {
    const stage = this.view?.stage;
    const step = Math.PI / 24;
    const actions: Record<string, () => void> = {
      ArrowLeft: () => stage?.turn(-step, 0),
      ArrowRight: () => stage?.turn(step, 0),
      ArrowUp: () => stage?.turn(0, -step),
      ArrowDown: () => stage?.turn(0, step),
      "+": () => stage?.zoom(0.9),
      "-": () => stage?.zoom(1 / 0.9),
      "0": () => this.view?.fit(),
      " ": () => this.player.toggle(),
    };
    if (event.ctrlKey || event.metaKey) return;
    const action = actions[event.key];
    const body = this.view?.clipBody;
    if (action) action();
    else if (body && clipKey(event.key, this.settings.clip, body)) {
      this.cutChanged();
      this.cut.refresh();
    } else if (lookKey(event.key, this.settings.look, this.firstField)) this.lookChanged();
    else return;
    event.preventDefault();
  }
}

/** What frames of the variants can be coloured by, in the order of the list. */
function fieldsOf(variants: readonly MeshVariant[]): Colouring[] {
  const known = new Set<string>();
  for (const { surface } of variants)
    for (const frame of surface.frames) {
      if (frame.displacement !== "") known.add("intensity").add("displacement");
      for (const name of Object.keys(frame.fields ?? {})) known.add(name);
    }
  return COLOURINGS.filter(({ name }) => known.has(name));
}

/** Whether one of them deforms: of heat alone none does. */
export function moves(variants: readonly MeshVariant[]): boolean {
  return variants.some(
    ({ surface }) => !surface.isotherms || surface.frames.some((frame) => frame.displacement !== ""),
  );
}

/** Whether a surface of one of them is crossed by isotherms. */
function hasIsotherms(variants: readonly MeshVariant[]): boolean {
  return variants.some(({ surface }) => (surface.isotherms ?? []).length > 0);
}

/** First and last frame's time; equal where nothing moves. */
function spanOf(variant: MeshVariant): [number, number] {
  const frames = variant.surface.frames;
  return frames.length === 0 ? [0, 0] : [frames[0]!.time_s, frames[frames.length - 1]!.time_s];
}
