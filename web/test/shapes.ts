// shapes.ts — surfaces with known normals, for tests: a box, a ball, a cylinder's side with its ends.

export interface Shape {
  rest: Float32Array;
  triangles: Uint32Array;
}

/** A box from the origin; each face in 2 n² triangles, its vertices shared along edges. */
export function box(n: number, size: readonly [number, number, number] = [1, 1, 1]): Shape {
  const points: number[] = [];
  const known = new Map<string, number>();
  const at = (x: number, y: number, z: number): number => {
    const key = `${x} ${y} ${z}`;
    const old = known.get(key);
    if (old !== undefined) return old;
    const next = points.length / 3;
    points.push((x / n) * size[0], (y / n) * size[1], (z / n) * size[2]);
    known.set(key, next);
    return next;
  };
  const triangles: number[] = [];
  for (let axis = 0; axis < 3; axis++)
    for (const end of [0, n])
      for (let u = 0; u < n; u++)
        for (let v = 0; v < n; v++) {
          const corner = (du: number, dv: number): number => {
            const p = [0, 0, 0];
            p[axis] = end;
            p[(axis + 1) % 3] = u + du;
            p[(axis + 2) % 3] = v + dv;
            return at(p[0]!, p[1]!, p[2]!);
          };
          const [a, b, c, d] = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
          if (end === 0) triangles.push(a, c, b, a, d, c);
          else triangles.push(a, b, c, a, c, d);
        }
  return { rest: Float32Array.from(points), triangles: Uint32Array.from(triangles) };
}

/** A ball about the origin: a box pushed out to it. */
export function ball(n: number, radius: number): Shape {
  const { rest, triangles } = box(n);
  for (let i = 0; i < rest.length; i += 3) {
    const [x, y, z] = [rest[i]! - 0.5, rest[i + 1]! - 0.5, rest[i + 2]! - 0.5];
    const scale = radius / Math.hypot(x, y, z);
    rest.set([x * scale, y * scale, z * scale], i);
  }
  return { rest, triangles };
}

/** A cylinder along z with flat ends, each a fan about its middle. */
export function cylinder(sides: number, layers: number, radius: number, height: number): Shape {
  const points: number[] = [];
  for (let k = 0; k <= layers; k++)
    for (let i = 0; i < sides; i++) {
      const angle = (2 * Math.PI * i) / sides;
      points.push(radius * Math.cos(angle), radius * Math.sin(angle), (height * k) / layers);
    }
  const triangles: number[] = [];
  const at = (i: number, k: number) => k * sides + (i % sides);
  for (let k = 0; k < layers; k++)
    for (let i = 0; i < sides; i++)
      triangles.push(at(i, k), at(i + 1, k), at(i + 1, k + 1), at(i, k), at(i + 1, k + 1), at(i, k + 1));
  const [low, high] = [points.length / 3, points.length / 3 + 1];
  points.push(0, 0, 0, 0, 0, height);
  for (let i = 0; i < sides; i++) triangles.push(low, at(i + 1, 0), at(i, 0), high, at(i, layers), at(i + 1, layers));
  return { rest: Float32Array.from(points), triangles: Uint32Array.from(triangles) };
}

export const lengthOf = (values: Float32Array, i: number): number =>
  Math.hypot(values[3 * i]!, values[3 * i + 1]!, values[3 * i + 2]!);
