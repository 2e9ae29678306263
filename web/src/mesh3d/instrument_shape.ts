// instrument_shape.ts — the surfaces of instruments as plain triangles, without three.js: tested by themselves.

/** Rings of a tube around a polyline (xyz each), `sides` points a ring, the last ring drawn together to a point. */
export function tubePositions(line: readonly number[], radius: number, sides: number): Float32Array {
  const points = withTip(line, 3 * radius);
  const rings = points.length / 3;
  const out = new Float32Array(3 * rings * sides);
  let across: Vector = [0, 0, 0];
  for (let i = 0; i < rings; i++) {
    const before = at(points, Math.max(0, i - 1));
    const after = at(points, Math.min(rings - 1, i + 1));
    const along = unit(minus(after, before));
    across = i === 0 ? anyAcross(along) : unit(minus(across, times(along, dot(across, along))));
    const third = cross(along, across);
    const own = i === rings - 1 ? 0 : radius;
    for (let k = 0; k < sides; k++) {
      const angle = (2 * Math.PI * k) / sides;
      for (let n = 0; n < 3; n++) {
        const off = own * (Math.cos(angle) * across[n]! + Math.sin(angle) * third[n]!);
        out[3 * (i * sides + k) + n] = points[3 * i + n]! + off;
      }
    }
  }
  return out;
}

/** Triangles of such a tube of `rings` rings, outward. */
export function tubeTriangles(rings: number, sides: number): Uint32Array {
  const out: number[] = [];
  for (let i = 0; i + 1 < rings; i++) {
    for (let k = 0; k < sides; k++) {
      const next = (k + 1) % sides;
      const [a, b, c, d] = [i * sides + k, i * sides + next, (i + 1) * sides + k, (i + 1) * sides + next];
      out.push(a, b, c, b, d, c);
    }
  }
  return Uint32Array.from(out);
}

/** Between two places of one instrument: its points on straight lines, its axes those of the nearer. */
export function placeBetween(
  before: { points: number[]; axes: number[] },
  after: { points: number[]; axes: number[] },
  share: number,
): { points: number[]; axes: number[] } {
  const nearer = share < 0.5 ? before : after;
  if (before.points.length !== after.points.length) return nearer;
  return { points: before.points.map((x, i) => x * (1 - share) + after.points[i]! * share), axes: nearer.axes };
}

type Vector = readonly [number, number, number];

/** The polyline with one more point `length` before its end, where the tip begins to taper. */
function withTip(line: readonly number[], length: number): number[] {
  const count = Math.floor(line.length / 3);
  if (count < 2) return line.slice(0, 3 * count);
  const end = at(line, count - 1);
  const last = minus(end, at(line, count - 2));
  const whole = Math.hypot(...last);
  if (!(whole > 1.001 * length)) return [...line];
  const base = minus(end, times(last, length / whole));
  return [...line.slice(0, 3 * (count - 1)), ...base, ...end];
}

const at = (line: readonly number[], i: number): Vector => [line[3 * i]!, line[3 * i + 1]!, line[3 * i + 2]!];
const minus = (a: Vector, b: Vector): Vector => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const times = (a: Vector, s: number): Vector => [a[0] * s, a[1] * s, a[2] * s];
const dot = (a: Vector, b: Vector): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a: Vector, b: Vector): Vector => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];

function unit(a: Vector): Vector {
  const length = Math.hypot(...a);
  return length > 0 ? times(a, 1 / length) : [0, 0, 1];
}

function anyAcross(along: Vector): Vector {
  return unit(cross(along, Math.abs(along[2]) < 0.9 ? [0, 0, 1] : [1, 0, 0]));
}
