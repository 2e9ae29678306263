// level_surface.ts — where numbers at the vertices of tets pass through 0: the surface of an isotherm, or of a plane.
//
//   a tet with one corner on one side: a triangle      two and two: a quadrilateral, drawn as two
//
// Corners of the surface lie on edges of tets, in proportion to the numbers at their ends. Tets that share an edge share its corner,
// so that the surface has no gaps and its normals are smooth.

export interface LevelSurface {
  from: number[]; // of each corner: the vertex at 0 or above …
  to: number[]; // … and the one below, between which it lies
  shares: number[]; // of the way from the one to the other
  triangles: number[]; // three corners each; their order is that of the tets, not of a side
}

/** @param heights  at each vertex @param tets  four vertices each */
export function levelSurface(heights: ArrayLike<number>, tets: ArrayLike<number>): LevelSurface {
  const surface: LevelSurface = { from: [], to: [], shares: [], triangles: [] };
  const known = new Map<number, number>();
  const corner = (a: number, b: number): number => {
    const key = a * heights.length + b;
    const found = known.get(key);
    if (found !== undefined) return found;
    const made = surface.from.length;
    surface.from.push(a);
    surface.to.push(b);
    surface.shares.push(heights[a]! / (heights[a]! - heights[b]!));
    known.set(key, made);
    return made;
  };
  const [above, below]: [number[], number[]] = [[], []];
  for (let t = 0; t + 4 <= tets.length; t += 4) {
    above.length = below.length = 0;
    for (let k = 0; k < 4; k++) (heights[tets[t + k]!]! >= 0 ? above : below).push(tets[t + k]!);
    if (above.length === 0 || below.length === 0) continue;
    if (above.length === 2) {
      const [a, b] = above as [number, number];
      const [c, d] = below as [number, number];
      const [ac, ad, bd, bc] = [corner(a, c), corner(a, d), corner(b, d), corner(b, c)];
      surface.triangles.push(ac, ad, bd, ac, bd, bc);
    } else if (above.length === 1) for (const other of below) surface.triangles.push(corner(above[0]!, other));
    else for (const other of above) surface.triangles.push(corner(other, below[0]!));
  }
  return surface;
}

/** Turns each triangle so that its normal points to where the heights fall. @param points  xyz of each corner */
export function turnDownhill(
  { from, to, triangles }: LevelSurface,
  points: ArrayLike<number>,
  positions: ArrayLike<number>,
): void {
  for (let t = 0; t + 3 <= triangles.length; t += 3) {
    const [p, q, r] = [3 * triangles[t]!, 3 * triangles[t + 1]!, 3 * triangles[t + 2]!];
    const edge = (end: number, k: number) => points[end + k]! - points[p + k]!;
    let down = 0;
    for (let k = 0; k < 3; k++) {
      const [i, j] = [(k + 1) % 3, (k + 2) % 3];
      const normal = edge(q, i) * edge(r, j) - edge(q, j) * edge(r, i);
      for (let c = 0; c < 3; c++) {
        const corner = triangles[t + c]!;
        down += normal * (positions[3 * to[corner]! + k]! - positions[3 * from[corner]! + k]!);
      }
    }
    if (down < 0) [triangles[t + 1], triangles[t + 2]] = [triangles[t + 2]!, triangles[t + 1]!];
  }
}
