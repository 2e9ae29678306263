// force_shown.ts — which force of a streamed frame the arrow shows: the hand's pull while there is one, else that of a tool.
import * as THREE from "three";
import { ForceArrow } from "../mesh3d/force_arrow.ts";
import type { SurfaceModel } from "../mesh3d/surface_model.ts";
import type { Hello, LiveFrame } from "./protocol.ts";

const LEAST = 0.02; // that an arrow is as long as can be for [N]

export class ForceShown {
  readonly arrow = new ForceArrow();
  on = true;
  tool = 0; // whose force it is
  private most = LEAST;

  constructor(private readonly hello: () => Hello | null) {}

  /** @param held  where the hand holds the tissue; null: it holds none */
  show(frame: LiveFrame, model: SurfaceModel, held: THREE.Vector3 | null): void {
    const at = held ?? this.tip(frame, model);
    const force = new THREE.Vector3(...(held ? frame.grabForce : (frame.tools[this.tool]?.force ?? [0, 0, 0])));
    this.most = Math.max(this.most, force.length());
    this.arrow.show(at && this.on ? { at, force, most: this.most } : null, model.middle, model.diagonal);
  }

  private tip(frame: LiveFrame, model: SurfaceModel): THREE.Vector3 | null {
    const info = this.hello()?.tools[this.tool];
    if (info && !info.instrument) return model.toolPlace(0);
    const tip = frame.tools[this.tool]?.points.slice(-3) ?? [];
    return tip.length === 3 ? new THREE.Vector3(...(tip as [number, number, number])) : null;
  }
}
