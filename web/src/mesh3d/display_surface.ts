// display_surface.ts — the surface as it is drawn: normals that are smooth but for creases, each triangle in four.
//
//   coarse vertices ──▶ wedges (a vertex once for each of its normals) ──┐
//   coarse edges ─────▶ middles, where subdivided ───────────────────────┴─▶ positions, normals, values, 4 T triangles
//
// The middle of a smooth edge lies on the cubic that meets both ends at right angles to their normals, as on curved PN
// triangles (Vlachos, Peters, Boyd & Mitchell 2001):  m = ½ (a + b) − ⅛ ((b − a)·n_a n_a + (a − b)·n_b n_b).  Ends stay where they
// are, so marks, instruments and forces of the coarse mesh lie on what is drawn. The middle of a crease lies on the
// cubic through the four points of the crease around it; it is the same from both sides, so nothing gapes.
import { next, type Wedges, wedgesOf } from "./creases.ts";

/** A surface of more triangles is fine enough as it is, and four times as many would cost too much; less so in the plain look. */
export const MOST_SUBDIVIDED = 24_000;
export const MOST_SUBDIVIDED_PLAIN = 6_000;
const NONE = -1;
/** Crease edges that meet at less than this cosine are a corner of the shape, not a curve. */
const CORNER = 0.5;

export class DisplaySurface {
  readonly count: number; // of display vertices: wedges, then middles
  readonly triangles: Uint32Array; // in display vertices
  readonly lines: Uint32Array; // pairs of display vertices: the coarse edges
  readonly positions: Float32Array;
  readonly normals: Float32Array;
  readonly wedges: Wedges;
  readonly hollow: Float32Array; // how much the surface caves in there: 0 flat or round, 1 a sharp notch
  private readonly middleEdge: Uint32Array; // of each middle: its coarse edge …
  private readonly middleFrom: Uint32Array; // … and the wedges at its ends, as its side sees them
  private readonly middleTo: Uint32Array;
  private readonly beyondFirst: Int32Array; // of each coarse edge: the next vertex along its crease, or none
  private readonly beyondSecond: Int32Array;

  /** @param kind  of each triangle; kinds meet in creases @param subdivide  each triangle in four */
  constructor(
    rest: Float32Array,
    readonly coarse: Uint32Array,
    kind: Uint8Array | null = null,
    readonly subdivide = coarse.length / 3 <= MOST_SUBDIVIDED,
  ) {
    this.wedges = wedgesOf(rest, coarse, kind);
    const { count } = this.wedges;
    const middles = middlesOf(this.wedges);
    [this.middleEdge, this.middleFrom, this.middleTo] = [middles.edge, middles.from, middles.to];
    this.count = count + (subdivide ? middles.edge.length : 0);
    this.triangles = subdivide ? quartered(this.wedges.ofCorner, middles.ofSide, count) : this.wedges.ofCorner;
    this.lines = linesOf(this.wedges, middles.ofSide, subdivide);
    this.positions = new Float32Array(3 * this.count);
    this.normals = new Float32Array(3 * this.count);
    this.hollow = new Float32Array(this.count);
    [this.beyondFirst, this.beyondSecond] = creaseNeighbours(rest, this.wedges);
    this.update(rest);
  }

  /** Follows the coarse vertices. */
  update(points: Float32Array): void {
    const { vertex, count } = this.wedges;
    for (let w = 0; w < count; w++) for (let k = 0; k < 3; k++) this.positions[3 * w + k] = points[3 * vertex[w]! + k]!;
    this.wedgeNormals();
    this.findHollows();
    if (!this.subdivide) return;
    for (let m = 0; m < this.middleEdge.length; m++) this.placeMiddle(m, points);
  }

  /** A number of each coarse vertex at each display vertex. */
  spread(values: Float32Array, out: Float32Array): void {
    const { vertex, count } = this.wedges;
    for (let w = 0; w < count; w++) out[w] = values[vertex[w]!]!;
    this.fillMiddles(out);
  }

  /** A number of each wedge at each display vertex: those of middles from their ends. */
  fillMiddles(out: Float32Array): void {
    if (!this.subdivide) return;
    const { count } = this.wedges;
    for (let m = 0; m < this.middleEdge.length; m++)
      out[count + m] = 0.5 * (out[this.middleFrom[m]!]! + out[this.middleTo[m]!]!);
  }

  /**
   * Mean of the normals of a wedge's triangles. With the cross product of two sides over the squares of both lengths as a
   * weight, it is exact wherever all vertices around lie on a sphere (Max 1999), however uneven the triangles are.
   */
  private wedgeNormals(): void {
    const { positions: p, normals: n } = this;
    const { ofCorner, count } = this.wedges;
    n.fill(0, 0, 3 * count);
    for (let i = 0; i < ofCorner.length; i += 3) {
      const [a, b, c] = [3 * ofCorner[i]!, 3 * ofCorner[i + 1]!, 3 * ofCorner[i + 2]!];
      const ux = p[b]! - p[a]!;
      const uy = p[b + 1]! - p[a + 1]!;
      const uz = p[b + 2]! - p[a + 2]!;
      const vx = p[c]! - p[a]!;
      const vy = p[c + 1]! - p[a + 1]!;
      const vz = p[c + 2]! - p[a + 2]!;
      const [wx, wy, wz] = [vx - ux, vy - uy, vz - uz];
      const ab = ux * ux + uy * uy + uz * uz;
      const ac = vx * vx + vy * vy + vz * vz;
      const bc = wx * wx + wy * wy + wz * wz;
      if (ab === 0 || ac === 0 || bc === 0) continue;
      const x = uy * vz - uz * vy;
      const y = uz * vx - ux * vz;
      const z = ux * vy - uy * vx;
      addScaled(n, a, x, y, z, 1 / (ab * ac));
      addScaled(n, b, x, y, z, 1 / (ab * bc));
      addScaled(n, c, x, y, z, 1 / (ac * bc));
    }
    for (let w = 0; w < count; w++) normalise(n, w);
  }

  /** Mean slope at which the edges of a wedge rise above its tangent plane: a dent is darker than what surrounds it. */
  private findHollows(): void {
    const { positions: p, normals: n, hollow } = this;
    hollow.fill(0);
    const weight = this.weights;
    weight.fill(0);
    for (let m = 0; m < this.middleEdge.length; m++) {
      const [a, b] = [this.middleFrom[m]!, this.middleTo[m]!];
      const dx = p[3 * b]! - p[3 * a]!;
      const dy = p[3 * b + 1]! - p[3 * a + 1]!;
      const dz = p[3 * b + 2]! - p[3 * a + 2]!;
      const length = Math.sqrt(dx * dx + dy * dy + dz * dz) || 1;
      hollow[a] = hollow[a]! + (dx * n[3 * a]! + dy * n[3 * a + 1]! + dz * n[3 * a + 2]!) / length;
      hollow[b] = hollow[b]! - (dx * n[3 * b]! + dy * n[3 * b + 1]! + dz * n[3 * b + 2]!) / length;
      weight[a] = weight[a]! + 1;
      weight[b] = weight[b]! + 1;
    }
    for (let w = 0; w < this.wedges.count; w++) hollow[w] = Math.min(1, Math.max(0, hollow[w]! / (weight[w]! || 1)));
    this.fillMiddles(hollow);
  }

  private get weights(): Float32Array {
    return (this.weight ??= new Float32Array(this.wedges.count));
  }
  private weight: Float32Array | null = null;

  private placeMiddle(m: number, points: Float32Array): void {
    const { positions: p, normals: n } = this;
    const [a, b, at] = [3 * this.middleFrom[m]!, 3 * this.middleTo[m]!, 3 * (this.wedges.count + m)];
    const dx = p[b]! - p[a]!;
    const dy = p[b + 1]! - p[a + 1]!;
    const dz = p[b + 2]! - p[a + 2]!;
    const alongA = dx * n[a]! + dy * n[a + 1]! + dz * n[a + 2]!;
    const alongB = dx * n[b]! + dy * n[b + 1]! + dz * n[b + 2]!;
    const square = dx * dx + dy * dy + dz * dz;
    const turn = square > 0 ? (2 * (alongA + alongB)) / square : 0;
    n[at] = n[a]! + n[b]! - turn * dx;
    n[at + 1] = n[a + 1]! + n[b + 1]! - turn * dy;
    n[at + 2] = n[a + 2]! + n[b + 2]! - turn * dz;
    normalise(n, at / 3);
    const edge = this.middleEdge[m]!;
    if (this.wedges.edges.sharp[edge]) return this.placeOnCrease(edge, at, points);
    for (let k = 0; k < 3; k++)
      p[at + k] = 0.5 * (p[a + k]! + p[b + k]!) - 0.125 * (alongA * n[a + k]! - alongB * n[b + k]!);
  }

  /** By the four points around it; a missing one lies straight on. */
  private placeOnCrease(edge: number, at: number, points: Float32Array): void {
    const { first, second } = this.wedges.edges;
    const [a, b] = [3 * first[edge]!, 3 * second[edge]!];
    const [before, after] = [this.beyondFirst[edge]!, this.beyondSecond[edge]!];
    for (let k = 0; k < 3; k++) {
      const [pa, pb] = [points[a + k]!, points[b + k]!];
      const left = before === NONE ? 2 * pa - pb : points[3 * before + k]!;
      const right = after === NONE ? 2 * pb - pa : points[3 * after + k]!;
      this.positions[at + k] = (9 * (pa + pb) - left - right) / 16;
    }
  }
}

interface Middles {
  edge: Uint32Array;
  from: Uint32Array;
  to: Uint32Array;
  ofSide: Uint32Array;
}

/** One for each smooth edge, one for each side of a crease. */
function middlesOf({ edges, ofCorner }: Wedges): Middles {
  const [edge, from, to]: [number[], number[], number[]] = [[], [], []];
  const ofSide = new Uint32Array(ofCorner.length);
  const smooth = new Int32Array(edges.count).fill(NONE);
  for (let side = 0; side < ofCorner.length; side++) {
    const e = edges.ofSide[side]!;
    if (smooth[e] !== NONE) {
      ofSide[side] = smooth[e]!;
      continue;
    }
    ofSide[side] = edge.length;
    if (!edges.sharp[e]) smooth[e] = edge.length;
    edge.push(e);
    from.push(ofCorner[side]!);
    to.push(ofCorner[next(side)]!);
  }
  return { edge: Uint32Array.from(edge), from: Uint32Array.from(from), to: Uint32Array.from(to), ofSide };
}

function quartered(corners: Uint32Array, middle: Uint32Array, wedges: number): Uint32Array {
  const fine = new Uint32Array(4 * corners.length);
  for (let i = 0; i < corners.length; i += 3) {
    const [a, b, c] = [corners[i]!, corners[i + 1]!, corners[i + 2]!];
    const [ab, bc, ca] = [wedges + middle[i]!, wedges + middle[i + 1]!, wedges + middle[i + 2]!];
    fine.set([a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca], 4 * i);
  }
  return fine;
}

function linesOf({ edges, ofCorner, count }: Wedges, middle: Uint32Array, subdivided: boolean): Uint32Array {
  const lines: number[] = [];
  const drawn = new Uint8Array(edges.count);
  for (let side = 0; side < ofCorner.length; side++) {
    const edge = edges.ofSide[side]!;
    if (drawn[edge]) continue;
    drawn[edge] = 1;
    const [a, b] = [ofCorner[side]!, ofCorner[next(side)]!];
    if (subdivided) lines.push(a, count + middle[side]!, count + middle[side]!, b);
    else lines.push(a, b);
  }
  return Uint32Array.from(lines);
}

/** Of each crease edge: the vertices before its first and after its second end, where the crease goes on as a curve. */
function creaseNeighbours(rest: Float32Array, { edges }: Wedges): [Int32Array, Int32Array] {
  const around = new Map<number, number[]>();
  for (let e = 0; e < edges.count; e++) {
    if (!edges.sharp[e]) continue;
    for (const [at, to] of [
      [edges.first[e]!, edges.second[e]!],
      [edges.second[e]!, edges.first[e]!],
    ] as const) {
      const list = around.get(at);
      if (list) list.push(to);
      else around.set(at, [to]);
    }
  }
  const beyond = (at: number, from: number): number => {
    const ends = around.get(at)!;
    if (ends.length !== 2) return NONE;
    const to = ends[0] === from ? ends[1]! : ends[0]!;
    return cosine(rest, from, at, to) > CORNER ? to : NONE;
  };
  const [before, after] = [new Int32Array(edges.count).fill(NONE), new Int32Array(edges.count).fill(NONE)];
  for (let e = 0; e < edges.count; e++) {
    if (!edges.sharp[e]) continue;
    before[e] = beyond(edges.first[e]!, edges.second[e]!);
    after[e] = beyond(edges.second[e]!, edges.first[e]!);
  }
  return [before, after];
}

/** Of the turn at b on the path a, b, c: 1 straight on. */
function cosine(points: Float32Array, a: number, b: number, c: number): number {
  let [dot, one, two] = [0, 0, 0];
  for (let k = 0; k < 3; k++) {
    const u = points[3 * b + k]! - points[3 * a + k]!;
    const v = points[3 * c + k]! - points[3 * b + k]!;
    dot += u * v;
    one += u * u;
    two += v * v;
  }
  return one > 0 && two > 0 ? dot / Math.sqrt(one * two) : 0;
}

function addScaled(values: Float32Array, at: number, x: number, y: number, z: number, scale: number): void {
  values[at] = values[at]! + scale * x;
  values[at + 1] = values[at + 1]! + scale * y;
  values[at + 2] = values[at + 2]! + scale * z;
}

function normalise(values: Float32Array, i: number): void {
  const [x, y, z] = [values[3 * i]!, values[3 * i + 1]!, values[3 * i + 2]!];
  const length = Math.sqrt(x * x + y * y + z * z) || 1;
  values[3 * i] = x / length;
  values[3 * i + 1] = y / length;
  values[3 * i + 2] = z / length;
}
