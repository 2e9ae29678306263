// clip_cap.ts — closes a body that is cut open: a face in the plane, where a line of sight is inside the body. It is raw
// tissue; where a field colours the body and is known on its surface only it is hatched (else field_cap.ts draws the face).
//
//   stencil of a pixel = backs − fronts of the skin that stays, along the line of sight
//   no skin between the plane and the inside: what is entered through the plane is left through a back, so it is not 0
import * as THREE from "three";
import { CAP_FRAGMENT, CAP_VERTEX } from "./tissue_shader.ts";

const HATCHES = 84; // lines across the face, which is twice the body
const TEXELS = 64;
const LINE = 0.84; // of the face's brightness

export class ClipCap {
  readonly group = new THREE.Group();
  private readonly counting: THREE.Mesh[];
  private readonly counters: THREE.MeshBasicMaterial[];
  private readonly face: THREE.MeshBasicMaterial;
  private readonly flesh: THREE.ShaderMaterial;
  private readonly sheet: THREE.Mesh;
  private readonly hatch = hatchTexture();

  /** @param size  diagonal of the body [m] @param layer  0 for the body; what is inside lies over it, one by one */
  constructor(
    skin: THREE.BufferGeometry,
    private readonly middle: THREE.Vector3,
    size: number,
    layer = 0,
  ) {
    const backs = counter(THREE.BackSide, THREE.IncrementWrapStencilOp);
    const fronts = counter(THREE.FrontSide, THREE.DecrementWrapStencilOp);
    this.counters = [backs, fronts];
    this.hatch.repeat.set(HATCHES, HATCHES);
    // What has been counted is forgotten as it is drawn, for the layer that comes next.
    const where = {
      side: THREE.DoubleSide,
      stencilWrite: true,
      stencilRef: 0,
      stencilFunc: THREE.NotEqualStencilFunc,
      stencilFail: THREE.ZeroStencilOp,
      stencilZFail: THREE.ZeroStencilOp,
      stencilZPass: THREE.ZeroStencilOp,
      polygonOffset: layer > 0,
      polygonOffsetFactor: -layer,
      polygonOffsetUnits: -layer,
    } as const;
    this.face = new THREE.MeshBasicMaterial({ map: this.hatch, ...where });
    this.flesh = new THREE.ShaderMaterial({
      vertexShader: CAP_VERTEX,
      fragmentShader: CAP_FRAGMENT,
      uniforms: { rawTissue: { value: new THREE.Color() }, perSize: { value: 1 / size } },
      defines: { FINE: "" },
      ...where,
    });
    this.sheet = new THREE.Mesh(new THREE.PlaneGeometry(2 * size, 2 * size), this.flesh);
    this.counting = this.counters.map((material) => new THREE.Mesh(skin, material));
    // Before the face, and that before all else.
    this.counting.forEach((mesh) => (mesh.renderOrder = -3 + layer / 100));
    this.sheet.renderOrder = -3 + (layer + 0.5) / 100;
    this.group.add(...this.counting, this.sheet);
    this.group.visible = false;
  }

  /** The skin it closes. */
  set skin(skin: THREE.BufferGeometry) {
    for (const mesh of this.counting) mesh.geometry = skin;
  }

  get open(): boolean {
    return this.isOpen;
  }

  private isOpen = false;
  private isHidden = false;

  set hidden(on: boolean) {
    this.isHidden = on;
    this.group.visible = this.isOpen && !on;
  }

  /** Where the body is cut; null: nowhere. */
  set plane(plane: THREE.Plane | null) {
    this.isOpen = plane !== null;
    this.group.visible = this.isOpen && !this.isHidden;
    if (!plane) return;
    for (const material of this.counters) material.clippingPlanes = [plane];
    plane.projectPoint(this.middle, this.sheet.position);
    this.sheet.quaternion.setFromUnitVectors(new THREE.Vector3(0, 0, 1), plane.normal);
  }

  /** Of the hatched face. */
  set colour(colour: string) {
    this.face.color.set(colour);
  }

  /** Of raw tissue. */
  set tissue(colour: string) {
    (this.flesh.uniforms["rawTissue"]!.value as THREE.Color).set(colour);
  }

  /** Whether a field colours the body. */
  set coloured(on: boolean) {
    this.sheet.material = on ? this.face : this.flesh;
  }

  /** With the grain of tissue. */
  set fine(on: boolean) {
    if (on === "FINE" in this.flesh.defines) return;
    if (on) this.flesh.defines["FINE"] = "";
    else delete this.flesh.defines["FINE"];
    this.flesh.needsUpdate = true;
  }

  dispose(): void {
    for (const material of this.counters) material.dispose();
    this.face.dispose();
    this.flesh.dispose();
    this.hatch.dispose();
    this.sheet.geometry.dispose();
  }
}

/** Draws nothing; counts what one side of the skin covers. */
function counter(side: THREE.Side, count: THREE.StencilOp): THREE.MeshBasicMaterial {
  return new THREE.MeshBasicMaterial({
    side,
    colorWrite: false,
    depthWrite: false,
    depthTest: false,
    stencilWrite: true,
    stencilFunc: THREE.AlwaysStencilFunc,
    stencilFail: count,
    stencilZFail: count,
    stencilZPass: count,
  });
}

/** One diagonal line, which repeats. */
function hatchTexture(): THREE.DataTexture {
  const texels = new Uint8Array(4 * TEXELS * TEXELS);
  for (let y = 0; y < TEXELS; y++) {
    for (let x = 0; x < TEXELS; x++) {
      const off = Math.abs(((x + y) % TEXELS) - TEXELS / 2) / TEXELS; // 0 on the line, ½ between two
      const tone = 255 * (LINE + (1 - LINE) * Math.min(1, Math.max(0, (off - 0.06) / 0.08)));
      texels.set([tone, tone, tone, 255], 4 * (y * TEXELS + x));
    }
  }
  const texture = new THREE.DataTexture(texels, TEXELS, TEXELS);
  texture.wrapS = texture.wrapT = THREE.RepeatWrapping;
  texture.magFilter = THREE.LinearFilter;
  texture.minFilter = THREE.LinearMipmapLinearFilter;
  texture.generateMipmaps = true;
  texture.anisotropy = 4;
  texture.needsUpdate = true;
  return texture;
}
