// mottle.ts — the mottles of tissue as one number a vertex, for the plain look, which has no noise in its shader.
//
// Value noise on two lattices of the rest position, as broad as that of the fine look; the hash is of integers.

const OCTAVES: readonly { frequency: number; share: number; shift: number }[] = [
  { frequency: 6, share: 0.45, shift: 0 },
  { frequency: 17, share: 0.35, shift: 7 },
  { frequency: 34, share: 0.2, shift: 19 },
];

/** 0 … 1 at each point, of mean ½. @param size  of the body [m]: mottles are shares of it */
export function mottles(points: Float32Array, size: number): Float32Array {
  const out = new Float32Array(points.length / 3);
  for (let i = 0; i < out.length; i++) {
    for (const { frequency, share, shift } of OCTAVES) {
      const [x, y, z] = [0, 1, 2].map((k) => (points[3 * i + k]! / size) * frequency + shift) as [
        number,
        number,
        number,
      ];
      // Turned, so that no face of a box lies along the lattice.
      out[i] =
        out[i]! + share * noise(0.8 * y + 0.6 * z, -0.8 * x + 0.36 * y - 0.48 * z, -0.6 * x - 0.48 * y + 0.64 * z);
    }
  }
  return out;
}

function noise(x: number, y: number, z: number): number {
  const [i, j, k] = [Math.floor(x), Math.floor(y), Math.floor(z)];
  const [u, v, w] = [ease(x - i), ease(y - j), ease(z - k)];
  const line = (dy: number, dz: number) => mix(hash(i, j + dy, k + dz), hash(i + 1, j + dy, k + dz), u);
  return mix(mix(line(0, 0), line(1, 0), v), mix(line(0, 1), line(1, 1), v), w);
}

const ease = (t: number): number => t * t * t * (t * (t * 6 - 15) + 10);
const mix = (a: number, b: number, t: number): number => a + (b - a) * t;

function hash(i: number, j: number, k: number): number {
  let n = Math.imul(i, 1597334673) ^ Math.imul(j, 3812015801) ^ Math.imul(k, 2798796415);
  n = Math.imul(n ^ (n >>> 15), 2246822519);
  n = Math.imul(n ^ (n >>> 13), 3266489917);
  return ((n ^ (n >>> 16)) >>> 8) / 16777215;
}
