// tissue_colours.ts — the colour of a tissue by its name, as it looks fresh: for regions, too, whose names say what they are.
import * as THREE from "three";
import type { SurfaceMotion } from "./timeline.ts";

export interface TissueColours {
  tissue: string;
  raw: string; // where it was cut
}

const NAMED: readonly [RegExp, TissueColours][] = [
  [/tumou?r|nodule|lesion|metasta|target/i, { tissue: "#c9a26a", raw: "#b98a62" }],
  [/portal/i, { tissue: "#6f5f9c", raw: "#564377" }],
  [/hepatic.*vein|vena|venous|vein|cava/i, { tissue: "#3f5f9a", raw: "#33406f" }],
  [/arter|aort/i, { tissue: "#b03030", raw: "#8c2020" }],
  [/vessel/i, { tissue: "#5a5f9a", raw: "#443f70" }],
  [/bile|gall/i, { tissue: "#5d7a3a", raw: "#58652c" }],
  [/fat|adipose/i, { tissue: "#d8b15c", raw: "#cf9f55" }],
  [/brain|cortex|white|grey|gray/i, { tissue: "#c9a296", raw: "#c08a80" }],
  [/skin|dermis/i, { tissue: "#cf9a7e", raw: "#b06a5c" }],
  [/muscle/i, { tissue: "#93342f", raw: "#862a2a" }],
  [/kidney|renal/i, { tissue: "#7c3630", raw: "#8a2f2d" }],
  [/capsule|membrane|fascia|ligament|tendon/i, { tissue: "#c8b3a4", raw: "#bfa090" }],
  [/bone|rib|plate|frame/i, { tissue: "#d9cdb4", raw: "#cdb79a" }],
  [/gel|phantom|silicone|ecoflex/i, { tissue: "#c8b59a", raw: "#c0a98c" }],
];
const LIVER: TissueColours = { tissue: "#75332a", raw: "#722622" };
/** For regions whose names say nothing, one after the other. */
const OTHERS = ["#b98a5c", "#6f5f9c", "#3f5f9a", "#7f8a4a", "#b0605a", "#5f8a8a"];

/** Colours of what a name says it is; of liver where it says nothing known. */
export const coloursOf = (name: string): TissueColours => NAMED.find(([known]) => known.test(name))?.[1] ?? LIVER;

/** Colours of a region inside another tissue: never that of the liver, which would hide it. */
export function regionColours(name: string, index: number): TissueColours {
  const known = NAMED.find(([pattern]) => pattern.test(name))?.[1];
  const other = OTHERS[index % OTHERS.length]!;
  return known ?? { tissue: other, raw: other };
}

export type Tint = readonly [number, number, number];

/** Colour of a triangle: of the region whose surface it is part of at any time, else of the tissue. */
export function regionTints(
  tissue: string,
  { regions, frames }: Pick<SurfaceMotion, "regions" | "frames">,
): (all: Uint32Array) => (t: number) => Tint {
  const tint = (colour: string): Tint => new THREE.Color(colour).toArray() as unknown as Tint;
  const key = (all: Uint32Array, at: number) => [all[at]!, all[at + 1]!, all[at + 2]!].sort((a, b) => a - b).join(" ");
  const own = tint(tissue);
  const known = new Map<string, Tint>();
  regions.forEach(({ name, triangles }, i) => {
    const colour = tint(regionColours(name, i).tissue);
    for (const each of new Set([triangles, ...frames.map((frame) => frame.regions[i] ?? triangles)])) {
      for (let at = 0; at < each.length; at += 3) known.set(key(each, at), colour);
    }
  });
  if (known.size === 0) return () => () => own;
  return (all) => (t) => known.get(key(all, 3 * t)) ?? own;
}
