// mesh_view.ts — the deformed mesh of one variant at a time in a canvas: what is shown, without its buttons.
import type { SurfaceData, VariantData } from "../report_data.ts";
import { currentTheme, onTheme, themeColour } from "../page/theme.ts";
import { strokeOf } from "../charts/line_style.ts";
import { type ClipBody, type ClipSettings, clipPlane } from "./clip.ts";
import { Stage } from "./stage.ts";
import { SurfaceModel } from "./surface_model.ts";
import { Timeline } from "./timeline.ts";

export type MeshVariant = VariantData & { surface: SurfaceData };
export type RangeChoice = "all" | "variant" | "frame";

export interface ViewSettings {
  variant: string;
  exaggeration: number;
  range: RangeChoice;
  edges: boolean;
  ghost: boolean;
  marks: boolean;
  clip: ClipSettings;
}

export class MeshView {
  readonly stage: Stage;
  private readonly timelines = new Map<string, Timeline>();
  private readonly largest: number; // intensity over all variants
  private model: SurfaceModel | null = null;
  private modelOf = "";
  private range = 0;

  constructor(
    canvas: HTMLCanvasElement,
    context: WebGL2RenderingContext,
    private readonly variants: readonly MeshVariant[],
    readonly settings: ViewSettings,
  ) {
    this.stage = new Stage(canvas, context);
    this.stage.beforeDrawing = () => this.cut();
    this.largest = Math.max(
      0,
      ...variants.flatMap((variant) => variant.surface.frames.map((frame) => frame.intensity_max)),
    );
    onTheme(() => this.recolour());
    this.showVariant();
    this.fit();
  }

  /** Motion of the variant shown, decoded at its first use. */
  get timeline(): Timeline {
    const name = this.settings.variant;
    let timeline = this.timelines.get(name);
    if (!timeline) {
      const variant = this.variants.find((candidate) => candidate.name === name) ?? this.variants[0]!;
      timeline = new Timeline(variant.surface);
      this.timelines.set(name, timeline);
    }
    return timeline;
  }

  get marked(): { held: number; driven: number } {
    return { held: this.model?.heldCount ?? 0, driven: this.model?.drivenCount ?? 0 };
  }

  get edgesByDefault(): boolean {
    return this.model?.edgesByDefault ?? true;
  }

  /** End of the colour scale now. */
  get colourRange(): number {
    return this.range;
  }

  private showVariant(): void {
    if (this.model) {
      this.stage.scene.remove(this.model.group);
      this.model.dispose();
    }
    this.model = new SurfaceModel(this.timeline);
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
    this.stage.invalidate();
  }

  /** Shows the state at a time [s] with the present settings. */
  show(time: number): void {
    if (this.modelOf !== this.settings.variant) this.showVariant();
    const { exaggeration, range, edges, ghost, marks } = this.settings;
    this.range =
      range === "all"
        ? this.largest
        : range === "variant"
          ? this.timeline.intensityMax
          : this.timeline.intensityAt(time);
    this.model?.show({ edges, ghost, marks });
    this.model?.update(time, exaggeration, this.range);
    this.stage.invalidate();
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
