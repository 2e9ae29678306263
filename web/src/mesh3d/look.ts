// look.ts — how a body is looked at: as tissue or by a field, whole or seen through, in how much detail; kept for the next visit.

export const DETAILS = ["auto", "fine", "plain"] as const;
export type Detail = (typeof DETAILS)[number];

export interface LookSettings {
  colour: string; // TISSUE, or the name of a field
  seeThrough: boolean;
  detail: Detail; // auto: plain where drawing is slow
}

export const TISSUE = "none"; // no field colours the body

/** The body as tissue, whole or seen through. */
export const firstLook = (seeThrough = false): LookSettings => ({ colour: TISSUE, seeThrough, detail: "auto" });

/** g sees through, f goes between tissue and a field: whether a key was one of these. @param field  to go to */
export function lookKey(key: string, look: LookSettings, field: string): boolean {
  if (key === "g") look.seeThrough = !look.seeThrough;
  else if (key === "f") look.colour = look.colour === TISSUE ? field : TISSUE;
  else return false;
  return true;
}

const storeKey = (name: string): string => `glisson-look:${location.pathname}:${name}`;

/** The look of a view of that name as it was left. @param colours  that it may have @param first  of a view that was not seen before */
export function rememberedLook(name: string, colours: readonly string[], first = firstLook()): LookSettings {
  try {
    const kept: unknown = JSON.parse(localStorage.getItem(storeKey(name)) ?? "null");
    return isLook(kept, colours) ? kept : first;
  } catch {
    return first; // no storage, or something else in it
  }
}

export function rememberLook(name: string, look: LookSettings): void {
  try {
    localStorage.setItem(storeKey(name), JSON.stringify(look));
  } catch {
    // no storage for this page: it lasts as long as the page
  }
}

export function isLook(kept: unknown, colours: readonly string[]): kept is LookSettings {
  if (typeof kept !== "object" || kept === null) return false;
  const { colour, seeThrough, detail } = kept as Partial<LookSettings>;
  return (
    typeof colour === "string" &&
    colours.includes(colour) &&
    typeof seeThrough === "boolean" &&
    DETAILS.some((known) => known === detail)
  );
}
