// Isotherms: a surface of tets lies where the field has its level, encloses its volume, and has no gaps.
import { describe, expect, it } from "vitest";
import { drawnIsotherms } from "../src/mesh3d/isotherms.ts";
import { type LevelSurface, levelSurface, turnDownhill } from "../src/mesh3d/level_surface.ts";

/** A cube of n³ cells of six tets each, from −1 to 1. */
function cube(n: number): { positions: number[]; tets: number[] } {
  const positions: number[] = [];
  const tets: number[] = [];
  const at = (i: number, j: number, k: number) => i + (n + 1) * (j + (n + 1) * k);
  for (let k = 0; k <= n; k++)
    for (let j = 0; j <= n; j++)
      for (let i = 0; i <= n; i++) positions.push((2 * i) / n - 1, (2 * j) / n - 1, (2 * k) / n - 1);
  const paths = [
    [0, 1, 2],
    [0, 2, 1],
    [1, 0, 2],
    [1, 2, 0],
    [2, 0, 1],
    [2, 1, 0],
  ];
  for (let k = 0; k < n; k++)
    for (let j = 0; j < n; j++)
      for (let i = 0; i < n; i++)
        for (const path of paths) {
          const corner = [i, j, k];
          tets.push(at(i, j, k));
          for (const axis of path) {
            corner[axis]!++;
            tets.push(at(corner[0]!, corner[1]!, corner[2]!));
          }
        }
  return { positions, tets };
}

function placesOf({ from, to, shares }: LevelSurface, positions: number[]): number[] {
  return shares.flatMap((share, c) =>
    [0, 1, 2].map((k) => {
      const [a, b] = [positions[3 * from[c]! + k]!, positions[3 * to[c]! + k]!];
      return a + share * (b - a);
    }),
  );
}

/** By the divergence theorem, normals outward. */
function volumeOf(points: number[], triangles: number[]): number {
  let six = 0;
  for (let t = 0; t < triangles.length; t += 3) {
    const [p, q, r] = [0, 1, 2].map((c) => points.slice(3 * triangles[t + c]!, 3 * triangles[t + c]! + 3)) as [
      number[],
      number[],
      number[],
    ];
    six +=
      p[0]! * (q[1]! * r[2]! - q[2]! * r[1]!) -
      p[1]! * (q[0]! * r[2]! - q[2]! * r[0]!) +
      p[2]! * (q[0]! * r[1]! - q[1]! * r[0]!);
  }
  return six / 6;
}

const RADIUS = 0.6;

/** The surface on which 0.36 − r² passes 0, in a cube of n³ cells. */
function ball(n: number): { surface: LevelSurface; points: number[]; positions: number[] } {
  const { positions, tets } = cube(n);
  const heights = Array.from({ length: positions.length / 3 }, (_, v) => {
    const r = Math.hypot(positions[3 * v]!, positions[3 * v + 1]!, positions[3 * v + 2]!);
    return RADIUS * RADIUS - r * r;
  });
  const surface = levelSurface(heights, tets);
  const points = placesOf(surface, positions);
  turnDownhill(surface, points, positions);
  return { surface, points, positions };
}

describe("the surface of a level", () => {
  it("lies where the field has it", () => {
    const { points } = ball(12);
    for (let c = 0; c < points.length; c += 3)
      expect(Math.hypot(points[c]!, points[c + 1]!, points[c + 2]!)).toBeCloseTo(RADIUS, 1);
  });

  it("has no gaps, and its triangles face downhill", () => {
    const edges = new Map<string, number>();
    const { surface } = ball(12);
    for (let t = 0; t < surface.triangles.length; t += 3)
      for (let k = 0; k < 3; k++) {
        const [a, b] = [surface.triangles[t + k]!, surface.triangles[t + ((k + 1) % 3)]!];
        const key = `${Math.min(a, b)} ${Math.max(a, b)}`;
        edges.set(key, (edges.get(key) ?? 0) + (a < b ? 1 : -1));
      }
    expect([...edges.values()].every((sum) => sum === 0)).toBe(true);
  });

  it("encloses its volume to second order", () => {
    const missing = [12, 24].map((n) => {
      const { surface, points } = ball(n);
      return 1 - volumeOf(points, surface.triangles) / ((4 / 3) * Math.PI * RADIUS ** 3);
    });
    expect(missing[0]).toBeLessThan(0.06);
    expect(missing[0]! / missing[1]!).toBeGreaterThan(3.5);
    expect(missing[0]! / missing[1]!).toBeLessThan(4.5);
  });

  it("of a level that no vertex passes is empty", () => {
    expect(levelSurface([1, 2, 3, 4], [0, 1, 2, 3]).triangles).toEqual([]);
  });
});

describe("isotherms that are drawn", () => {
  it("go from the body's temperature to the coldest, each level once", () => {
    const drawn = drawnIsotherms([
      { name: "kill", temperature_C: -40 },
      { name: "ice", temperature_C: 0 },
      { name: "ice of the tumour", temperature_C: 0 },
    ]);
    expect(drawn.map(({ label }) => label)).toEqual(["0 °C (ice)", "−40 °C (kill)"]);
    expect(new Set(drawn.map(({ colour }) => colour)).size).toBe(2);
  });

  it("of heat have colours of their own", () => {
    const [cold, hot] = drawnIsotherms([
      { name: "", temperature_C: 0 },
      { name: "", temperature_C: 55 },
    ]);
    expect(hot!.colour).not.toBe(cold!.colour);
  });
});
