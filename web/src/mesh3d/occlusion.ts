// occlusion.ts — how much of the sky each point of a surface sees at rest: what lies in a fold is darker.
//
// The surface is rasterised once from each of some directions, spread evenly over the sphere; a point sees a direction where
// nothing is nearer in its pixel. Weighted by the cosine to its normal, that is the share of a uniform sky that
// reaches it: 1 on a plane or a ball.
const PIXELS = 128;
const GOLDEN = Math.PI * (3 - Math.sqrt(5));
/** Of a pixel's depth beyond which something hides a point: grid and flat triangles both blur it. */
const BIAS = 0.02;

/** Directions that a surface of so many triangles can afford. @param effort  triangles times directions */
export const directionsFor = (triangles: number, effort: number): number =>
  Math.round(Math.min(48, Math.max(8, effort / Math.max(1, triangles))));

/**
 * Share of the sky, 0 … 1, at each point.
 * @param points  xyz each @param normals  of the same, unit @param triangles  of them
 */
export function skyShare(
  points: Float32Array,
  normals: Float32Array,
  triangles: Uint32Array,
  directions: number,
): Float32Array {
  const count = points.length / 3;
  const [seen, all] = [new Float32Array(count), new Float32Array(count)];
  const { middle, radius } = bounds(points);
  const places = new Float32Array(3 * count); // in pixels, and depth towards the light in radii
  const depth = new Float32Array(PIXELS * PIXELS);
  for (let d = 0; d < directions; d++) {
    const z = 1 - (2 * d + 1) / directions;
    const flat = Math.sqrt(1 - z * z);
    const light: [number, number, number] = [flat * Math.cos(GOLDEN * d), flat * Math.sin(GOLDEN * d), z];
    const [side, up] = across(light);
    for (let i = 0; i < count; i++) {
      const p = [0, 1, 2].map((k) => (points[3 * i + k]! - middle[k]!) / radius) as [number, number, number];
      places[3 * i] = (0.5 + 0.49 * dot(p, side)) * PIXELS;
      places[3 * i + 1] = (0.5 + 0.49 * dot(p, up)) * PIXELS;
      places[3 * i + 2] = dot(p, light);
    }
    depth.fill(-Infinity);
    for (let t = 0; t < triangles.length; t += 3)
      raster(depth, places, triangles[t]!, triangles[t + 1]!, triangles[t + 2]!);
    for (let i = 0; i < count; i++) {
      const facing = dot([normals[3 * i]!, normals[3 * i + 1]!, normals[3 * i + 2]!], light);
      if (facing <= 0.05) continue;
      all[i] = all[i]! + facing;
      const x = Math.min(PIXELS - 1, Math.max(0, Math.floor(places[3 * i]!)));
      const y = Math.min(PIXELS - 1, Math.max(0, Math.floor(places[3 * i + 1]!)));
      // A slanting surface spans more depth within a pixel.
      const slack = BIAS + ((2 / PIXELS) * Math.sqrt(1 - facing * facing)) / facing;
      if (depth[y * PIXELS + x]! <= places[3 * i + 2]! + slack) seen[i] = seen[i]! + facing;
    }
  }
  return seen.map((light, i) => (all[i]! > 0 ? light / all[i]! : 1));
}

function bounds(points: Float32Array): { middle: number[]; radius: number } {
  const [low, high] = [Array<number>(3).fill(Infinity), Array<number>(3).fill(-Infinity)];
  for (let i = 0; i < points.length; i++) {
    low[i % 3] = Math.min(low[i % 3]!, points[i]!);
    high[i % 3] = Math.max(high[i % 3]!, points[i]!);
  }
  const middle = low.map((l, k) => 0.5 * (l + high[k]!));
  return { middle, radius: 0.5 * Math.hypot(...high.map((h, k) => h - low[k]!)) || 1 };
}

type Triple = readonly [number, number, number];
const dot = (a: Triple, b: Triple): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

/** Two unit vectors across a third. */
function across(n: Triple): [Triple, Triple] {
  const far: Triple = Math.abs(n[0]) < 0.6 ? [1, 0, 0] : [0, 1, 0];
  const s = cross(far, n);
  const length = Math.hypot(...s);
  const side: Triple = [s[0] / length, s[1] / length, s[2] / length];
  return [side, cross(n, side)];
}

const cross = (a: Triple, b: Triple): [number, number, number] => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];

/** Keeps the nearest depth in each pixel whose middle a triangle covers. */
function raster(depth: Float32Array, places: Float32Array, a: number, b: number, c: number): void {
  const [ax, ay, az] = [places[3 * a]!, places[3 * a + 1]!, places[3 * a + 2]!];
  const [bx, by, bz] = [places[3 * b]!, places[3 * b + 1]!, places[3 * b + 2]!];
  const [cx, cy, cz] = [places[3 * c]!, places[3 * c + 1]!, places[3 * c + 2]!];
  const area = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay);
  if (Math.abs(area) < 1e-12) return;
  const x0 = Math.max(0, Math.ceil(Math.min(ax, bx, cx) - 0.5));
  const x1 = Math.min(PIXELS - 1, Math.floor(Math.max(ax, bx, cx) - 0.5));
  const y0 = Math.max(0, Math.ceil(Math.min(ay, by, cy) - 0.5));
  const y1 = Math.min(PIXELS - 1, Math.floor(Math.max(ay, by, cy) - 0.5));
  for (let y = y0; y <= y1; y++) {
    for (let x = x0; x <= x1; x++) {
      const [px, py] = [x + 0.5, y + 0.5];
      const u = ((bx - px) * (cy - py) - (cx - px) * (by - py)) / area;
      const v = ((cx - px) * (ay - py) - (ax - px) * (cy - py)) / area;
      if (u < 0 || v < 0 || u + v > 1) continue;
      const z = u * az + v * bz + (1 - u - v) * cz;
      const at = y * PIXELS + x;
      if (z > depth[at]!) depth[at] = z;
    }
  }
}
