// tissue_material.ts — the material of a body: tissue, or the colours of a field; whole or seen through; fine or plain.
import * as THREE from "three";
import { colourTexels } from "./colour_map.ts";
import { FRAGMENT, VERTEX } from "./tissue_shader.ts";

const TEXELS = 256;
const TOOLS = 4; // as in the shader
/** Texture coordinate of a share 0 … 1 of the scale: from the middle of the first texel to that of the last. */
export const lookupOf = (share: number): number => (0.5 + Math.min(1, Math.max(0, share)) * (TEXELS - 1)) / TEXELS;

/** An instrument near the tissue takes some of its light. */
export interface NearTool {
  from: readonly [number, number, number];
  to: readonly [number, number, number];
  radius: number; // [m]
}

export class TissueMaterial extends THREE.ShaderMaterial {
  private readonly texture: THREE.DataTexture;

  constructor() {
    const texture = new THREE.DataTexture(colourTexels(TEXELS), TEXELS, 1);
    texture.colorSpace = THREE.SRGBColorSpace;
    texture.minFilter = texture.magFilter = THREE.LinearFilter;
    texture.needsUpdate = true;
    super({
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      side: THREE.DoubleSide,
      clipping: true,
      polygonOffset: true,
      polygonOffsetFactor: 1,
      polygonOffsetUnits: 1,
      uniforms: {
        perSize: { value: 1 },
        rawTissue: { value: new THREE.Color() },
        moisture: { value: 1 },
        coloured: { value: 0 },
        scale: { value: texture },
        glass: { value: 0 },
        toolCount: { value: 0 },
        toolFrom: { value: vectors() },
        toolTo: { value: vectors() },
        toolRadius: { value: new Float32Array(TOOLS) },
      },
    });
    this.texture = texture;
  }

  /** Diagonal of the body [m]: relief and mottles go by it. */
  set size(size: number) {
    this.uniforms["perSize"]!.value = 1 / size;
  }

  get size(): number {
    return 1 / (this.uniforms["perSize"]!.value as number);
  }

  /** Of tissue that was cut. */
  set raw(raw: string) {
    (this.uniforms["rawTissue"]!.value as THREE.Color).set(raw);
  }

  /** Whether colours stand for a field. */
  set coloured(on: boolean) {
    this.uniforms["coloured"]!.value = on ? 1 : 0;
  }

  get coloured(): boolean {
    return this.uniforms["coloured"]!.value === 1;
  }

  /** Whether what is inside shines through. */
  set seeThrough(on: boolean) {
    if (this.transparent === on) return;
    this.transparent = on;
    this.depthWrite = !on;
    this.uniforms["glass"]!.value = on ? 1 : 0;
    this.needsUpdate = true;
  }

  set fine(on: boolean) {
    if (on === "FINE" in this.defines) return;
    if (on) this.defines["FINE"] = "";
    else delete this.defines["FINE"];
    this.needsUpdate = true;
  }

  set tools(tools: readonly NearTool[]) {
    const count = Math.min(TOOLS, tools.length);
    this.uniforms["toolCount"]!.value = count;
    for (let i = 0; i < count; i++) {
      const { from, to, radius } = tools[i]!;
      (this.uniforms["toolFrom"]!.value as THREE.Vector3[])[i]!.set(...from);
      (this.uniforms["toolTo"]!.value as THREE.Vector3[])[i]!.set(...to);
      (this.uniforms["toolRadius"]!.value as Float32Array)[i] = radius;
    }
  }

  override dispose(): void {
    this.texture.dispose();
    super.dispose();
  }
}

const vectors = (): THREE.Vector3[] => Array.from({ length: TOOLS }, () => new THREE.Vector3());
