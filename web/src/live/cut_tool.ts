// cut_tool.ts — a stroke over the picture that cuts: along each line of sight a blade reaches from before the surface to a
// depth below it, and the stroke sweeps it through the body.
//
//   eye ──────────●━━━━━━━━━●   edge: LEAD before the surface, `depth` below it
//     ╲ ─────●━━━━━━━━━━━━━━●   beside the body: from before all of it, as the outline may lie anywhere between
import * as THREE from "three";
import type { Stage } from "../mesh3d/stage.ts";
import { h } from "../page/dom.ts";

const LEAD = 0.04; // of the body's size
const LEAST_MOVE = 3; // CSS px between two pieces of a stroke
const MOST_MOVE = 16; // the same: a quick hand's way is laid out, or a corner of the body would stand out of it
const KEY_MOVE = 8; // CSS px
const MOST_PIECES = 60; // at once: the program takes 400 messages a second
const FADES = 700; // ms that a stroke is seen for after its end

/** What the strokes become. */
export interface Blade {
  cut(begins: boolean, from: THREE.Vector3, to: THREE.Vector3): void;
}

interface Place {
  x: number;
  y: number;
}

export class CutTool {
  depth = 0.01; // below the surface [m]
  size = 1; // of the body [m]
  readonly crosshair = h("div", { class: "live-crosshair", hidden: true, "aria-hidden": "true" });
  readonly lines: THREE.LineSegments;
  private stroke: { at: Place; sent: Place; distance: number } | null = null;
  private points: THREE.Vector3[] = []; // surface and depth of each place, in turn
  private key: Place | null = null; // crosshair, from the canvas' corner
  private request = 0;
  private fading = 0;

  /** @param seen  how far from the eye the body is in a line of sight [m]; null: beside it */
  constructor(
    private readonly stage: Stage,
    private readonly canvas: HTMLCanvasElement,
    private readonly blade: Blade,
    private readonly seen: (caster: THREE.Raycaster) => number | null,
  ) {
    this.lines = new THREE.LineSegments(
      new THREE.BufferGeometry(),
      new THREE.LineBasicMaterial({ depthTest: false, transparent: true }),
    );
    this.lines.frustumCulled = this.lines.visible = false;
    this.lines.renderOrder = 11;
  }

  get cutting(): boolean {
    return this.stroke !== null;
  }

  /** Puts the blade where the pointer is; beside the body as far from the eye as its middle. */
  begin(at: Place): void {
    clearTimeout(this.fading);
    this.points = [];
    this.stroke = { at, sent: at, distance: this.stage.distance };
    this.put(true, at);
    this.draw();
  }

  moveTo(at: Place): void {
    if (!this.stroke) return;
    this.stroke.at = at;
    if (this.request === 0) this.request = requestAnimationFrame(() => this.go(LEAST_MOVE));
  }

  end(): void {
    if (!this.stroke) return;
    this.go(0.5);
    this.stroke = null;
    this.fading = window.setTimeout(() => this.clear(), FADES);
  }

  clear(): void {
    this.points = [];
    this.stroke = null;
    this.draw();
  }

  private go(least: number): void {
    cancelAnimationFrame(this.request);
    this.request = 0;
    const { stroke } = this;
    if (!stroke) return;
    const [from, to] = [stroke.sent, stroke.at];
    const way = Math.hypot(to.x - from.x, to.y - from.y);
    if (way < least) return;
    const pieces = Math.min(MOST_PIECES, Math.ceil(way / MOST_MOVE));
    for (let i = 1; i <= pieces; i++) {
      const share = i / pieces;
      this.put(false, { x: from.x + share * (to.x - from.x), y: from.y + share * (to.y - from.y) });
    }
    this.draw();
  }

  private put(begins: boolean, at: Place): void {
    const stroke = this.stroke!;
    const caster = this.stage.rayThrough(at.x, at.y);
    const seen = this.seen(caster);
    stroke.distance = seen ?? stroke.distance;
    const along = (distance: number) => caster.ray.at(Math.max(0, distance), new THREE.Vector3());
    const [near, far] = seen === null ? this.beside(stroke.distance) : [seen, seen];
    const to = along(far + this.depth);
    this.blade.cut(begins, along(near - LEAD * this.size), to);
    stroke.sent = at;
    this.points.push(along(stroke.distance), to);
  }

  /** Between here and the next place the body's outline is passed, wherever between its front and its middle that is. */
  private beside(distance: number): [number, number] {
    const middle = this.stage.distance;
    return [Math.min(distance, middle - 0.5 * this.size), Math.max(distance, middle)];
  }

  /** The path on the surface, and the blade itself at its last place. */
  private draw(): void {
    const pieces: THREE.Vector3[] = [];
    for (let i = 2; i < this.points.length; i += 2) pieces.push(this.points[i - 2]!, this.points[i]!);
    if (this.stroke) pieces.push(...this.points.slice(-2));
    this.lines.geometry.dispose();
    this.lines.geometry = new THREE.BufferGeometry().setFromPoints(pieces);
    this.lines.visible = pieces.length > 0;
    this.stage.invalidate();
  }

  /** Arrow keys lead a crosshair, Enter puts the blade down and lifts it. @return whether the key was one of these */
  keyDown(event: KeyboardEvent): boolean {
    const steps: Record<string, [number, number]> = {
      ArrowLeft: [-1, 0],
      ArrowRight: [1, 0],
      ArrowUp: [0, -1],
      ArrowDown: [0, 1],
    };
    const step = steps[event.key];
    if (!step && event.key !== "Enter") return false;
    const box = this.canvas.getBoundingClientRect();
    this.key ??= { x: 0.5 * box.width, y: 0.5 * box.height };
    if (step) {
      const by = event.shiftKey ? 0.25 * KEY_MOVE : KEY_MOVE;
      this.key.x = Math.min(box.width, Math.max(0, this.key.x + by * step[0]));
      this.key.y = Math.min(box.height, Math.max(0, this.key.y + by * step[1]));
    }
    const at = { x: box.left + this.key.x, y: box.top + this.key.y };
    if (step) this.moveTo(at);
    else if (this.cutting) this.end();
    else this.begin(at);
    this.showCrosshair(true);
    return true;
  }

  showCrosshair(shown: boolean): void {
    this.crosshair.hidden = !shown || this.key === null;
    this.crosshair.dataset["down"] = String(this.cutting);
    if (this.key) this.crosshair.style.translate = `${this.key.x}px ${this.key.y}px`;
  }
}
