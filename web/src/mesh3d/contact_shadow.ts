// contact_shadow.ts — a soft shadow of the body at rest on the ground below it, so that it lies somewhere and does not float.
//
// The body's lowest height above each cell of the ground is found once; what is near the ground darkens it, what is higher
// less, and the more blurred. Seen from below there is no ground.
import * as THREE from "three";

const CELLS = 72;
const MARGIN = 0.55; // of the body's width, on each side
const DARKEST = 0.42;
const REACH = 0.45; // of the body's size: a part as high casts 1/e of the shadow of one that lies on the ground

export class ContactShadow {
  readonly mesh: THREE.Mesh<THREE.PlaneGeometry, THREE.MeshBasicMaterial>;
  private readonly texture: THREE.DataTexture;

  constructor(rest: Float32Array, triangles: Uint32Array, box: THREE.Box3) {
    const size = box.getSize(new THREE.Vector3());
    const middle = box.getCenter(new THREE.Vector3());
    const width = Math.max(size.x, size.y) * (1 + 2 * MARGIN) || 1;
    const low = new THREE.Vector3(middle.x - width / 2, middle.y - width / 2, box.min.z);
    const shade = blurred(groundShade(rest, triangles, low, width, REACH * size.length()));
    const texels = new Uint8Array(4 * CELLS * CELLS);
    for (let i = 0; i < shade.length; i++) texels[4 * i + 3] = Math.round(255 * DARKEST * shade[i]!);
    this.texture = new THREE.DataTexture(texels, CELLS, CELLS);
    this.texture.magFilter = this.texture.minFilter = THREE.LinearFilter;
    this.texture.needsUpdate = true;
    const material = new THREE.MeshBasicMaterial({ map: this.texture, transparent: true, depthWrite: false });
    this.mesh = new THREE.Mesh(new THREE.PlaneGeometry(width, width), material);
    this.mesh.position.set(middle.x, middle.y, box.min.z - 0.004 * size.length());
    this.mesh.renderOrder = -4;
  }

  dispose(): void {
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
    this.texture.dispose();
  }
}

/** How much each cell of the ground is darkened, 0 … 1, before it is blurred. */
function groundShade(
  rest: Float32Array,
  triangles: Uint32Array,
  low: THREE.Vector3,
  width: number,
  reach: number,
): Float32Array {
  const height = new Float32Array(CELLS * CELLS).fill(Infinity);
  const cell = width / CELLS;
  for (let t = 0; t < triangles.length; t += 3) {
    const at = [0, 1, 2].map((k) => 3 * triangles[t + k]!);
    const xs = at.map((i) => (rest[i]! - low.x) / cell);
    const ys = at.map((i) => (rest[i + 1]! - low.y) / cell);
    const z = Math.min(...at.map((i) => rest[i + 2]! - low.z));
    for (let y = Math.floor(Math.min(...ys)); y <= Math.max(...ys); y++)
      for (let x = Math.floor(Math.min(...xs)); x <= Math.max(...xs); x++) {
        if (x < 0 || y < 0 || x >= CELLS || y >= CELLS || !covers(xs, ys, x + 0.5, y + 0.5)) continue;
        height[y * CELLS + x] = Math.min(height[y * CELLS + x]!, z);
      }
  }
  return height.map((z) => (Number.isFinite(z) ? Math.exp(-z / reach) : 0));
}

function covers(xs: number[], ys: number[], px: number, py: number): boolean {
  const sides = [0, 1, 2].map((k) => {
    const n = (k + 1) % 3;
    return (xs[n]! - xs[k]!) * (py - ys[k]!) - (ys[n]! - ys[k]!) * (px - xs[k]!);
  });
  return sides.every((side) => side >= 0) || sides.every((side) => side <= 0);
}

/** Three box blurs in a row: nearly that by a bell curve. */
function blurred(values: Float32Array): Float32Array {
  let now = values;
  for (const radius of [3, 4, 5]) now = along(along(now, radius, 1, CELLS), radius, CELLS, 1);
  return now;
}

function along(values: Float32Array, radius: number, step: number, across: number): Float32Array {
  const out = new Float32Array(values.length);
  for (let line = 0; line < CELLS; line++)
    for (let i = 0; i < CELLS; i++) {
      let sum = 0;
      for (let k = -radius; k <= radius; k++)
        if (i + k >= 0 && i + k < CELLS) sum += values[line * across + (i + k) * step]!;
      out[line * across + i * step] = sum / (2 * radius + 1);
    }
  return out;
}
