// line_style.ts — colours and dashes of lines: told apart without colour, and by the colour-blind.
//
// Hues after Okabe and Ito's set, lightness moved so that each keeps 3 : 1 against its background.
import type { Theme } from "../page/theme.ts";

export interface LineStyle {
  colour: number; // index into the palette; −1: ink, −2: grey
  dash: readonly number[];
}

const PALETTES: Record<Theme, readonly string[]> = {
  light: ["#0068a8", "#cf5200", "#008a64", "#b4558f", "#a87400", "#3a8fc4", "#5c6670"],
  dark: ["#5ab4ec", "#f28b52", "#2fc39a", "#dd93c2", "#e3ad35", "#9ad0f2", "#a8b2bc"],
};
const INK: Record<Theme, string> = { light: "#1a1f26", dark: "#e8ebee" };
const GREY: Record<Theme, string> = { light: "#8f98a2", dark: "#77828d" };

const DASHES: readonly (readonly number[])[] = [[], [8, 4], [2, 3], [10, 3, 2, 3], [5, 2], [14, 4], [8, 3, 2, 3, 2, 3]];

/** Style of the n-th line of a chart. */
export function lineStyle(index: number): LineStyle {
  const palette = PALETTES.light.length;
  return { colour: index % palette, dash: DASHES[(index + Math.floor(index / palette)) % DASHES.length]! };
}

/** Style of a fitted line or a total. */
export const FIT_STYLE: LineStyle = { colour: -1, dash: [4, 4] };
export const TOTAL_STYLE: LineStyle = { colour: -1, dash: [] };
/** Style of repeated measurements, which are many. */
export const MEASURED_STYLE: LineStyle = { colour: -2, dash: [] };

export function strokeOf(style: LineStyle, theme: Theme): string {
  if (style.colour === MEASURED_STYLE.colour) return GREY[theme];
  return style.colour < 0 ? INK[theme] : PALETTES[theme][style.colour]!;
}
