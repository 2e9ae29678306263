// colour_map.ts — number in [0, 1] to colour, by the table of perceptually equal steps.
import { COLOUR_TABLE } from "./colour_table.ts";

export type Rgb = readonly [number, number, number]; // 0 … 255

const STOPS: readonly Rgb[] = COLOUR_TABLE.map((hex) => {
  const value = parseInt(hex.slice(1), 16);
  return [value >> 16, (value >> 8) & 255, value & 255];
});

/** Colour of t, clamped to [0, 1]; NaN counts as 0. */
export function colourOf(t: number): Rgb {
  const place = Math.min(1, Math.max(0, t || 0)) * (STOPS.length - 1);
  const index = Math.min(Math.floor(place), STOPS.length - 2);
  const low = STOPS[index]!;
  const high = STOPS[index + 1]!;
  const f = place - index;
  return [low[0] + (high[0] - low[0]) * f, low[1] + (high[1] - low[1]) * f, low[2] + (high[2] - low[2]) * f];
}

/** `size` colours as RGBA bytes, for a texture. */
export function colourTexels(size: number): Uint8Array<ArrayBuffer> {
  const texels = new Uint8Array(4 * size);
  for (let i = 0; i < size; i++) {
    const colour = colourOf(i / (size - 1));
    texels.set([Math.round(colour[0]), Math.round(colour[1]), Math.round(colour[2]), 255], 4 * i);
  }
  return texels;
}

/** The map as a CSS gradient, e.g. `colourGradient("to top")`. */
export function colourGradient(direction: string): string {
  return `linear-gradient(${direction}, ${COLOUR_TABLE.join(", ")})`;
}
