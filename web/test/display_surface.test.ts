// What is drawn: sharp edges stay sharp, round surfaces become rounder, nothing gapes, and all of it follows the mesh.
import { describe, expect, it } from "vitest";
import { wedgesOf } from "../src/mesh3d/creases.ts";
import { DisplaySurface, MOST_SUBDIVIDED } from "../src/mesh3d/display_surface.ts";
import { ball, box, cylinder, lengthOf, type Shape } from "./shapes.ts";

const shown = ({ rest, triangles }: Shape, subdivide?: boolean) => new DisplaySurface(rest, triangles, null, subdivide);

/** Each side of a triangle, by where it is in space, with how often it occurs each way round. */
function sidesOf(surface: DisplaySurface): Map<string, number> {
  const place = (v: number) => [0, 1, 2].map((k) => surface.positions[3 * v + k]!.toFixed(6)).join(" ");
  const sides = new Map<string, number>();
  for (let c = 0; c < surface.triangles.length; c++) {
    const [a, b] = [surface.triangles[c]!, surface.triangles[c % 3 === 2 ? c - 2 : c + 1]!].map(place) as [
      string,
      string,
    ];
    const [key, sign] = a < b ? [`${a}|${b}`, 1] : [`${b}|${a}`, -1];
    sides.set(key, (sides.get(key) ?? 0) + sign);
  }
  return sides;
}

describe("creases", () => {
  it("give a box's corner three normals, its edge two, its face one", () => {
    const { rest, triangles } = box(3);
    const { vertex, edges } = wedgesOf(rest, triangles);
    const wedges = new Array<number>(rest.length / 3).fill(0);
    for (const v of vertex) wedges[v] = wedges[v]! + 1;
    for (let v = 0; v < wedges.length; v++) {
      const borders = [0, 1, 2].filter((k) => [0, 1].includes(rest[3 * v + k]!)).length;
      expect(wedges[v]).toBe(borders);
    }
    expect(edges.sharp.reduce((sum, sharp) => sum + sharp, 0)).toBe(12 * 3);
    expect(edges.count).toBe((triangles.length / 3) * 1.5); // closed: each edge has two triangles
  });

  it("are none on a ball, however coarse, and two circles on a cylinder", () => {
    const coarse = ball(3, 1);
    expect(wedgesOf(coarse.rest, coarse.triangles).count).toBe(coarse.rest.length / 3);
    const drum = cylinder(12, 2, 1, 2);
    expect(wedgesOf(drum.rest, drum.triangles).edges.sharp.reduce((sum, sharp) => sum + sharp, 0)).toBe(24);
  });

  it("part a cut face from the skin in its own plane, and torn skin from none", () => {
    const { rest, triangles } = box(2);
    const kinds = new Uint8Array(triangles.length / 3);
    const whole = wedgesOf(rest, triangles).count;
    kinds.fill(2, 0, 2);
    expect(wedgesOf(rest, triangles, kinds).count).toBe(whole);
    kinds.fill(1, 0, 2); // one of the four squares of a face
    expect(wedgesOf(rest, triangles, kinds).count).toBeGreaterThan(whole);
  });

  it("survive a triangle without area, an open border and an edge of three triangles", () => {
    const rest = Float32Array.from([0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 0, 0]);
    for (const triangles of [
      [0, 1, 4],
      [0, 1, 2],
      [0, 1, 2, 1, 0, 3, 0, 1, 3],
    ]) {
      const surface = shown({ rest, triangles: Uint32Array.from(triangles) });
      expect([...surface.positions, ...surface.normals].every(Number.isFinite)).toBe(true);
    }
  });
});

describe("normals", () => {
  it("of a box are those of its faces", () => {
    const surface = shown(box(3, [0.04, 0.02, 0.08]));
    for (let v = 0; v < surface.count; v++) {
      const normal = [0, 1, 2].map((k) => Math.abs(surface.normals[3 * v + k]!)).sort();
      expect(normal[2]).toBeCloseTo(1, 6);
      expect(normal[1]).toBeCloseTo(0, 6);
    }
  });

  it("of a ball point away from its middle", () => {
    const surface = shown(ball(6, 2));
    for (let v = 0; v < surface.count; v++) {
      const radius = lengthOf(surface.positions, v);
      let dot = 0;
      for (let k = 0; k < 3; k++) dot += (surface.positions[3 * v + k]! * surface.normals[3 * v + k]!) / radius;
      // At the vertices but for rounding; between them as near as a cubic comes.
      expect(dot).toBeGreaterThan(v < surface.wedges.count ? 1 - 1e-6 : Math.cos((0.5 * Math.PI) / 180));
    }
  });
});

describe("subdivision", () => {
  it("makes four triangles of each, and keeps the coarse vertices where they are", () => {
    const shape = ball(4, 1);
    const surface = shown(shape);
    expect(surface.triangles.length).toBe(4 * shape.triangles.length);
    for (let w = 0; w < surface.wedges.count; w++)
      for (let k = 0; k < 3; k++)
        expect(surface.positions[3 * w + k]).toBe(shape.rest[3 * surface.wedges.vertex[w]! + k]);
  });

  it("brings the middles of a ball's edges to the ball: a tenth of the error of flat facets is left", () => {
    // With exact normals, ¾ θ² of it for edges of half angle θ: 0.08 at the longest, of 37°.
    const shape = ball(4, 1);
    const { wedges, positions, count } = shown(shape);
    const round = Array.from({ length: count - wedges.count }, (_, m) =>
      Math.abs(1 - lengthOf(positions, wedges.count + m)),
    );
    const flat = Array.from({ length: wedges.edges.count }, (_, e) => {
      const [a, b] = [wedges.edges.first[e]!, wedges.edges.second[e]!];
      return 1 - Math.hypot(...[0, 1, 2].map((k) => 0.5 * (shape.rest[3 * a + k]! + shape.rest[3 * b + k]!)));
    });
    const mean = (all: number[]) => all.reduce((sum, x) => sum + x, 0) / all.length;
    expect(mean(round)).toBeLessThan(0.1 * mean(flat));
    expect(Math.max(...round)).toBeLessThan(0.1 * Math.max(...flat));
  });

  it("leaves a box what it is: flat faces, straight edges", () => {
    const surface = shown(box(2));
    for (let v = 0; v < surface.count; v++) {
      const p = [0, 1, 2].map((k) => surface.positions[3 * v + k]!);
      expect(Math.min(...p.map((x) => Math.min(Math.abs(x), Math.abs(1 - x))))).toBeLessThan(1e-6);
      expect(p.every((x) => x > -1e-6 && x < 1 + 1e-6)).toBe(true);
    }
  });

  it("rounds the rim of a cylinder along its crease, not over it", () => {
    const surface = shown(cylinder(16, 2, 1, 2));
    const { edges } = surface.wedges;
    let rims = 0;
    for (let v = surface.wedges.count; v < surface.count; v++) {
      const [x, y, z] = [0, 1, 2].map((k) => surface.positions[3 * v + k]!) as [number, number, number];
      const radius = Math.hypot(x, y);
      const atEnd = Math.abs(z) < 1e-6 || Math.abs(z - 2) < 1e-6;
      if (!atEnd || radius < 0.9) continue;
      rims++;
      expect(Math.abs(radius - 1)).toBeLessThan(0.002); // straight sides would be 0.019 within
    }
    expect(rims).toBe(2 * edges.sharp.reduce((sum, sharp) => sum + sharp, 0)); // from the side and from the end
  });

  it("gapes nowhere, at rest or pressed in: each side of a triangle has its opposite", () => {
    for (const shape of [ball(3, 1), box(3), cylinder(12, 3, 1, 2)]) {
      const surface = shown(shape);
      expect([...sidesOf(surface).values()].every((times) => times === 0)).toBe(true);
      const pressed = shape.rest.map((x, i) =>
        i % 3 === 2 ? x - 0.4 * Math.exp(-8 * (shape.rest[i - 2]! - 0.4) ** 2) : x,
      );
      surface.update(pressed);
      expect([...sidesOf(surface).values()].every((times) => times === 0)).toBe(true);
    }
  });

  it("follows a turn and a shift exactly as the coarse mesh does", () => {
    const shape = cylinder(10, 3, 1, 2);
    const surface = shown(shape);
    const before = surface.positions.slice();
    // (x, y, z) → (−y, x, z) + (1, 2, 3)
    const turn = (p: Float32Array) =>
      p.map((x, i) => (i % 3 === 0 ? -p[i + 1]! + 1 : i % 3 === 1 ? p[i - 1]! + 2 : x + 3));
    surface.update(turn(shape.rest));
    const expected = turn(before);
    for (let i = 0; i < expected.length; i++) expect(surface.positions[i]).toBeCloseTo(expected[i]!, 5);
  });

  it("is left out for large surfaces, whose triangles stay as they are", () => {
    const n = Math.ceil(Math.sqrt(MOST_SUBDIVIDED / 12)) + 1;
    const large = box(n);
    expect(shown(large).triangles.length).toBe(large.triangles.length);
    expect(shown(box(4)).subdivide).toBe(true);
  });
});

describe("what a vertex carries", () => {
  it("is carried to the middles as the mean of both ends", () => {
    const shape = ball(3, 1);
    const surface = shown(shape);
    const height = new Float32Array(shape.rest.length / 3).map((_, v) => shape.rest[3 * v + 2]!);
    const out = new Float32Array(surface.count);
    surface.spread(height, out);
    for (let w = 0; w < surface.wedges.count; w++) expect(out[w]).toBe(height[surface.wedges.vertex[w]!]);
    expect(Math.max(...out)).toBe(Math.max(...height));
  });

  it("is dark in a dent and not on a dome", () => {
    const shape = box(10);
    const surface = shown(shape);
    const dent = (depth: number) =>
      shape.rest.map((x, i) => {
        if (i % 3 !== 2 || x < 1) return x;
        return x - depth * Math.exp(-20 * ((shape.rest[i - 2]! - 0.5) ** 2 + (shape.rest[i - 1]! - 0.5) ** 2));
      });
    const middle = () => {
      for (let w = 0; w < surface.wedges.count; w++) {
        const v = 3 * surface.wedges.vertex[w]!;
        if (shape.rest[v] === 0.5 && shape.rest[v + 1] === 0.5 && shape.rest[v + 2] === 1) return surface.hollow[w]!;
      }
      return NaN;
    };
    expect(middle()).toBe(0);
    surface.update(dent(0.3));
    expect(middle()).toBeGreaterThan(0.2);
    surface.update(dent(-0.3));
    expect(middle()).toBe(0);
  });

  it("draws each coarse edge once, as two halves", () => {
    const shape = box(2);
    const surface = shown(shape);
    expect(surface.lines.length).toBe(4 * surface.wedges.edges.count);
    expect(shown(shape, false).lines.length).toBe(2 * surface.wedges.edges.count);
  });
});
