// creases.ts — which corners of a surface's triangles share a normal, and along which edges the surface is sharp.
//
//   an edge is sharp where it has not exactly two triangles, where they meet at more than the limit at rest, or where
//   one is skin and the other a cut face. Corners at a vertex that smooth edges connect are one *wedge*: a box's corner
//   has three, a point of a ball one.

/** Triangles that meet at more than this at rest have an edge between them: less is the coarseness of a round surface. */
export const CREASE_DEGREES = 60;
const NONE = 0xffffffff;
const CUT = 1; // kind of a face that was cut

export interface Edges {
  count: number;
  first: Uint32Array; // vertex of each end
  second: Uint32Array;
  ofSide: Uint32Array; // edge of each side of a triangle: side k of triangle t, from corner k to k + 1, at 3 t + k
  sharp: Uint8Array;
}

export interface Wedges {
  edges: Edges;
  count: number;
  ofCorner: Uint32Array; // wedge of each corner of each triangle
  vertex: Uint32Array; // of each wedge
}

/** Edges, creases and wedges of a surface. @param kind  of each triangle, 1: a face that was cut; null: none was */
export function wedgesOf(
  rest: Float32Array,
  triangles: Uint32Array,
  kind: Uint8Array | null = null,
  limit = CREASE_DEGREES,
): Wedges {
  const edges = edgesOf(rest, triangles, kind, limit);
  const parent = Uint32Array.from(triangles, (_, corner) => corner);
  const root = (corner: number): number => {
    while (parent[corner] !== corner) corner = parent[corner] = parent[parent[corner]!]!;
    return corner;
  };
  const meet = (a: number, b: number) => (parent[root(a)] = root(b));
  const other = new Uint32Array(edges.count).fill(NONE);
  for (let side = 0; side < triangles.length; side++) {
    const edge = edges.ofSide[side]!;
    if (edges.sharp[edge]) continue;
    const before = other[edge]!;
    other[edge] = side;
    if (before === NONE) continue;
    const [end, endBefore] = [next(side), next(before)];
    if (triangles[side] === triangles[before]) {
      meet(side, before);
      meet(end, endBefore);
    } else {
      meet(side, endBefore);
      meet(end, before);
    }
  }
  const ofCorner = new Uint32Array(triangles.length);
  const number = new Uint32Array(triangles.length).fill(NONE);
  const vertex: number[] = [];
  for (let corner = 0; corner < triangles.length; corner++) {
    const top = root(corner);
    if (number[top] === NONE) number[top] = vertex.push(triangles[corner]!) - 1;
    ofCorner[corner] = number[top]!;
  }
  return { edges, count: vertex.length, ofCorner, vertex: Uint32Array.from(vertex) };
}

/** The corner after this one in its triangle. */
export const next = (corner: number): number => (corner % 3 === 2 ? corner - 2 : corner + 1);

function edgesOf(rest: Float32Array, triangles: Uint32Array, kind: Uint8Array | null, limit: number): Edges {
  const known = new Map<number, number>();
  const ofSide = new Uint32Array(triangles.length);
  const [first, second, owner, sharp]: [number[], number[], number[], number[]] = [[], [], [], []];
  const normals = unitNormals(rest, triangles);
  const least = Math.cos((limit * Math.PI) / 180);
  const vertices = rest.length / 3;
  for (let side = 0; side < triangles.length; side++) {
    const [a, b] = [triangles[side]!, triangles[next(side)]!];
    const key = Math.min(a, b) * vertices + Math.max(a, b);
    const triangle = Math.floor(side / 3);
    const edge = known.get(key);
    if (edge === undefined) {
      known.set(key, first.length);
      ofSide[side] = first.length;
      first.push(a);
      second.push(b);
      owner.push(triangle);
      sharp.push(1); // until a second triangle comes
      continue;
    }
    ofSide[side] = edge;
    const mate = owner[edge]!;
    owner[edge] = NONE; // a third triangle makes it sharp again
    const bends =
      mate === NONE ||
      normalsMeet(normals, mate, triangle) < least ||
      (kind && (kind[mate] === CUT) !== (kind[triangle] === CUT));
    sharp[edge] = bends ? 1 : 0;
  }
  return {
    count: first.length,
    first: Uint32Array.from(first),
    second: Uint32Array.from(second),
    ofSide,
    sharp: Uint8Array.from(sharp),
  };
}

/** Cosine between two normals; 1 where a triangle has no area, and so no direction of its own. */
function normalsMeet(normals: Float32Array, t: number, u: number): number {
  const dot =
    normals[3 * t]! * normals[3 * u]! +
    normals[3 * t + 1]! * normals[3 * u + 1]! +
    normals[3 * t + 2]! * normals[3 * u + 2]!;
  const flat = isZero(normals, t) || isZero(normals, u);
  return flat ? 1 : dot;
}

const isZero = (values: Float32Array, i: number): boolean =>
  values[3 * i] === 0 && values[3 * i + 1] === 0 && values[3 * i + 2] === 0;

function unitNormals(points: Float32Array, triangles: Uint32Array): Float32Array {
  const normals = new Float32Array(triangles.length);
  for (let i = 0; i < triangles.length; i += 3) {
    const [a, b, c] = [3 * triangles[i]!, 3 * triangles[i + 1]!, 3 * triangles[i + 2]!];
    const [ux, uy, uz] = [0, 1, 2].map((k) => points[b + k]! - points[a + k]!) as [number, number, number];
    const [vx, vy, vz] = [0, 1, 2].map((k) => points[c + k]! - points[a + k]!) as [number, number, number];
    const [x, y, z] = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
    const length = Math.hypot(x, y, z);
    if (length > 0) normals.set([x / length, y / length, z / length], i);
  }
  return normals;
}
