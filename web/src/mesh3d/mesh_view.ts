// mesh_view.ts — the deformed mesh of one variant at a time in a canvas: what is shown, without its buttons.
import * as THREE from "three";
import { strokeOf } from "../charts/line_style.ts";
import { column } from "../data/columns.ts";
import { currentTheme, onTheme, themeColour } from "../page/theme.ts";
import type { SurfaceData, VariantData } from "../report_data.ts";
import { type ClipBody, type ClipSettings, clipPlane } from "./clip.ts";
import { fineIsFast, hopeForFine, Pace } from "./drawing_speed.ts";
import { colouringOf } from "./fields.ts";
import { ForceArrow, type ForceNow } from "./force_arrow.ts";
import { interpolate } from "./interpolate.ts";
import { type DrawnIsotherm, drawnIsotherms } from "./isotherms.ts";
import { type LookSettings, TISSUE } from "./look.ts";
import { ScaleBar } from "./scale_bar.ts";
import { Stage } from "./stage.ts";
import { SurfaceModel } from "./surface_model.ts";
import { TissueMaterial } from "./tissue_material.ts";
import { joined, type Span, Timeline } from "./timeline.ts";

export type MeshVariant = VariantData & { surface: SurfaceData };
export type RangeChoice = "all" | "variant" | "frame";

export interface ViewSettings {
  variant: string;
  exaggeration: number;
  range: RangeChoice;
  edges: boolean;
  ghost: boolean;
  marks: boolean;
  arrow: boolean; // of the tool's force
  isotherms: boolean;
  look: LookSettings;
  clip: ClipSettings;
}

export class MeshView {
  readonly stage: Stage;
  private readonly timelines = new Map<string, Timeline>();
  readonly scaleBar = new ScaleBar();
  readonly arrow = new ForceArrow();
  private readonly material = new TissueMaterial();
  private readonly pace = new Pace();
  private canBeFine: boolean;
  private model: SurfaceModel | null = null;
  private modelOf = "";
  private range: Span = { low: 0, high: 0 };

  constructor(
    canvas: HTMLCanvasElement,
    context: WebGL2RenderingContext,
    private readonly variants: readonly MeshVariant[],
    readonly settings: ViewSettings,
  ) {
    this.stage = new Stage(canvas, context);
    this.canBeFine = hopeForFine();
    this.stage.beforeDrawing = () => {
      this.cut();
      this.arrow.keepInside(this.stage);
    };
    this.stage.afterDrawing = () => this.annotate();
    this.stage.scene.add(this.arrow.group);
    onTheme(() => this.recolour());
    this.showVariant();
    this.fit();
  }

  /** Motion of the variant shown, decoded at its first use. */
  get timeline(): Timeline {
    return this.timelineOf(this.settings.variant);
  }

  private timelineOf(name: string): Timeline {
    let timeline = this.timelines.get(name);
    if (!timeline) {
      const variant = this.variants.find((candidate) => candidate.name === name) ?? this.variants[0]!;
      timeline = new Timeline(variant.surface);
      this.timelines.set(name, timeline);
    }
    timeline.field = colouringOf(this.settings.look.colour).name;
    return timeline;
  }

  /** Between which numbers colours go at a time. A body that is opened shows what is inside. */
  private rangeAt(time: number): Span {
    const whole = this.settings.clip.on && this.timeline.tetsAt(time) !== null;
    if (this.settings.range === "frame") return this.timeline.spanAt(time, whole);
    if (this.settings.range === "variant") return this.timeline.span(whole);
    return this.variants.map(({ name }) => this.timelineOf(name).span(whole)).reduce(joined);
  }

  get marked(): { held: number; driven: number } {
    return { held: this.model?.heldCount ?? 0, driven: this.model?.drivenCount ?? 0 };
  }

  /** What is written over the picture, which numbers beside the arrow keep off. */
  labels: readonly Element[] = [];

  private annotate(): void {
    this.scaleBar.show(this.stage.metresPerPixel, this.stage.size.width);
    this.arrow.place(this.stage, this.labels);
  }

  /** Whether the body is drawn in the fine look. */
  get fine(): boolean {
    const { detail } = this.settings.look;
    return detail === "auto" ? this.canBeFine : detail === "fine";
  }

  /** Measures what has been set up for the first time, and does without the fine look where that is slow. */
  settleDetail(): void {
    if (this.settings.look.detail === "auto") this.canBeFine = fineIsFast(this.stage);
  }

  /** To be told of each drawing of a motion; true where the fine look has become too slow. */
  tooSlow(now: number): boolean {
    if (!this.pace.tooSlow(now) || !this.fine || this.settings.look.detail !== "auto") return false;
    this.canBeFine = false;
    return true;
  }

  /** Ends of the colour scale now [SI]. */
  get colourRange(): Span {
    return this.range;
  }

  private showVariant(): void {
    if (this.model) {
      this.stage.scene.remove(this.model.group);
      this.model.dispose();
    }
    this.model = new SurfaceModel(this.timeline, this.material, this.fine);
    this.modelOf = this.settings.variant;
    this.stage.scene.add(this.model.group);
    this.recolour();
  }

  private recolour(): void {
    this.model?.colour({
      edge: themeColour("--mesh-edge"),
      ghost: themeColour("--mesh-ghost"),
      held: themeColour("--mesh-held"),
      instrument: themeColour("--mesh-instrument"),
      cap: themeColour("--mesh-cap"),
      driven: strokeOf({ colour: 1, dash: [] }, currentTheme()),
    });
    this.arrow.colour = themeColour("--mesh-force");
    this.stage.invalidate();
  }

  /** Shows the state at a time [s] with the present settings. */
  show(time: number): void {
    if (this.modelOf !== this.settings.variant) this.showVariant();
    const { exaggeration, edges, ghost, marks, isotherms, look } = this.settings;
    this.range = look.colour === TISSUE ? { low: 0, high: 0 } : this.rangeAt(time);
    this.model?.setLook({ coloured: look.colour !== TISSUE, seeThrough: look.seeThrough, fine: this.fine });
    this.model?.show({ edges, ghost, marks, isotherms });
    this.model?.update(time, exaggeration, this.range);
    this.showForce(time);
    this.stage.invalidate();
  }

  /** The force of the first tool or instrument, at its tip or amid the vertices that it drives. */
  private showForce(time: number): void {
    const model = this.model;
    const table = this.forceTable();
    const at = this.settings.arrow && table ? model?.toolPlace(time) : null;
    let now: ForceNow | null = null;
    if (at && table) {
      const [x, y, z] = table.force.map((values) => interpolate(table.times, values, time)) as [number, number, number];
      if ([x, y, z].every(Number.isFinite)) now = { at, force: new THREE.Vector3(x, y, z), most: table.most };
    }
    if (model) this.arrow.show(now, model.middle, model.diagonal);
  }

  private forceTable(): ForceTable | null {
    const variant = this.variants.find(({ name }) => name === this.settings.variant) ?? this.variants[0]!;
    const known = this.tables.get(variant.name);
    if (known !== undefined) return known;
    const [times, ...force] = ["time_s", "force_x_N", "force_y_N", "force_z_N"].map((name) =>
      column(variant.forces, name),
    );
    let table: ForceTable | null = null;
    if (times && force.every((values) => values !== null)) {
      const [x, y, z] = force as [number[], number[], number[]];
      table = { times, force: [x, y, z], most: largest(x, y, z) };
    }
    this.tables.set(variant.name, table);
    return table;
  }

  private readonly tables = new Map<string, ForceTable | null>();

  /** What isotherms are drawn of the variant shown; none where its temperature is not known everywhere. */
  get isotherms(): readonly DrawnIsotherm[] {
    const { isotherms, start } = this.timeline;
    return this.timeline.tetsAt(start) ? drawnIsotherms(isotherms) : [];
  }

  get hasInstruments(): boolean {
    return this.model?.hasInstruments ?? false;
  }

  get clipBody(): ClipBody | null {
    return this.model?.clipBody ?? null;
  }

  private cut(): void {
    if (this.model) this.model.cutOpen(clipPlane(this.settings.clip, this.model.clipBody, this.stage.forward));
  }

  /** Brings all of the mesh into view. */
  fit(): void {
    if (this.model) this.stage.fit(this.model.extremes(this.settings.exaggeration));
  }
}

interface ForceTable {
  times: number[];
  force: [number[], number[], number[]];
  most: number;
}

function largest(x: readonly number[], y: readonly number[], z: readonly number[]): number {
  let most = 0;
  for (let i = 0; i < x.length; i++) {
    const size = Math.hypot(x[i] ?? 0, y[i] ?? 0, z[i] ?? 0);
    if (size > most) most = size;
  }
  return most;
}
