// clip_cap.ts — closes a body that is cut open: a hatched face in the plane, where a line of sight is inside the body.
//
//   stencil of a pixel = backs − fronts of the skin that stays, along the line of sight
//   no skin between the plane and the inside: what is entered through the plane is left through a back, so it is not 0
import * as THREE from "three";

const HATCHES = 84; // lines across the face, which is twice the body
const TEXELS = 64;
const LINE = 0.84; // of the face's brightness

export class ClipCap {
  readonly group = new THREE.Group();
  private readonly counters: THREE.MeshBasicMaterial[];
  private readonly face: THREE.MeshBasicMaterial;
  private readonly sheet: THREE.Mesh;
  private readonly hatch = hatchTexture();

  /** @param size  diagonal of the body [m] */
  constructor(
    skin: THREE.BufferGeometry,
    private readonly middle: THREE.Vector3,
    size: number,
  ) {
    const backs = counter(THREE.BackSide, THREE.IncrementWrapStencilOp);
    const fronts = counter(THREE.FrontSide, THREE.DecrementWrapStencilOp);
    this.counters = [backs, fronts];
    this.hatch.repeat.set(HATCHES, HATCHES);
    this.face = new THREE.MeshBasicMaterial({
      map: this.hatch,
      side: THREE.DoubleSide,
      stencilWrite: true,
      stencilRef: 0,
      stencilFunc: THREE.NotEqualStencilFunc,
    });
    this.sheet = new THREE.Mesh(new THREE.PlaneGeometry(2 * size, 2 * size), this.face);
    const counting = this.counters.map((material) => new THREE.Mesh(skin, material));
    counting.forEach((mesh) => (mesh.renderOrder = -2)); // before the face, and that before all else
    this.sheet.renderOrder = -1;
    this.group.add(...counting, this.sheet);
    this.group.visible = false;
  }

  /** Where the body is cut; null: nowhere. */
  set plane(plane: THREE.Plane | null) {
    this.group.visible = plane !== null;
    if (!plane) return;
    for (const material of this.counters) material.clippingPlanes = [plane];
    plane.projectPoint(this.middle, this.sheet.position);
    this.sheet.quaternion.setFromUnitVectors(new THREE.Vector3(0, 0, 1), plane.normal);
  }

  set colour(colour: string) {
    this.face.color.set(colour);
  }

  dispose(): void {
    for (const material of this.counters) material.dispose();
    this.face.dispose();
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
