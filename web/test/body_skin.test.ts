// The body's own object: its relief is tied to the rest, cut faces and regions have their colours, plain is the coarse mesh.
import * as THREE from "three";
import { describe, expect, it } from "vitest";
import { BodySkin } from "../src/mesh3d/body_skin.ts";
import { lookupOf, TissueMaterial } from "../src/mesh3d/tissue_material.ts";
import { box } from "./shapes.ts";

const shape = box(4, [0.04, 0.04, 0.04]);
const triangles = shape.triangles.length / 3;
const none = new Float32Array(shape.rest.length / 3);

function skinOf(kinds: Uint8Array | null = null, tints = (_: number): [number, number, number] => [0.2, 0.1, 0.1]) {
  const skin = new BodySkin(shape.rest, () => tints, new TissueMaterial(), new THREE.LineBasicMaterial());
  skin.build(shape.triangles, kinds);
  return skin;
}
const values = (skin: BodySkin, name: string) => skin.mesh.geometry.getAttribute(name).array as Float32Array;

describe("the body's surface", () => {
  it("takes relief from places at rest: pressed, the tissue moves and its relief with it", () => {
    const skin = skinOf();
    const rest = values(skin, "rest").slice();
    expect([...values(skin, "position")]).toEqual([...rest]);
    skin.update(
      shape.rest.map((x, i) => (i % 3 === 2 ? 0.6 * x : x)),
      none,
    );
    expect([...values(skin, "rest")]).toEqual([...rest]);
    const lowered = values(skin, "position").filter((_, i) => i % 3 === 2);
    expect(Math.max(...lowered)).toBeCloseTo(0.024, 6);
  });

  it("is raw where it was cut, nearly so where its capsule is torn, and skin elsewhere to the very edge of a cut", () => {
    const kinds = new Uint8Array(triangles);
    kinds.fill(1, 0, 32); // one whole face of the box
    kinds[40] = 2; // of another
    const raw = values(skinOf(kinds), "raw");
    const index = skinOf(kinds).mesh.geometry.index!;
    const of = (t: number) => [0, 1, 2].map((k) => raw[index.getX(12 * t + k)]!);
    for (let t = 0; t < 32; t++) expect(of(t)).toEqual([1, 1, 1]);
    expect(of(40).every((x) => x > 0.7 && x < 1)).toBe(true);
    const others = Array.from({ length: triangles - 64 }, (_, i) => of(64 + i)).flat();
    expect(Math.max(...others)).toBe(0); // the faces beside the cut one share its edges, not its rawness
  });

  it("has the colour of the region whose surface a triangle is", () => {
    const tint = values(
      skinOf(null, (t) => (t < 32 ? [0.1, 0.2, 0.9] : [0.2, 0.1, 0.1])),
      "tint",
    );
    const blue = tint.filter((x, i) => i % 3 === 2 && x > 0.8).length;
    expect(blue).toBeGreaterThan(25);
    expect(blue).toBeLessThan(tint.length / 9);
  });

  it("is rounded up to a size, which is smaller where it is plain", () => {
    const large = box(23); // 6348 triangles
    for (const [fine, times] of [
      [true, 4],
      [false, 1],
    ] as const) {
      const skin = new BodySkin(
        large.rest,
        () => () => [0, 0, 0],
        new TissueMaterial(),
        new THREE.LineBasicMaterial(),
        fine,
      );
      skin.build(large.triangles, null);
      expect(skin.mesh.geometry.index!.count).toBe(times * large.triangles.length);
    }
    expect(skinOf().mesh.geometry.index!.count).toBe(12 * triangles);
  });

  it("brings shares of the scale to its texels", () => {
    const skin = skinOf();
    skin.update(
      shape.rest,
      none.map(() => 1),
    );
    expect(values(skin, "value").every((x) => Math.abs(x - lookupOf(1)) < 1e-6)).toBe(true);
  });
});
