// theme.ts — light or dark: follows the system until the reader chooses; charts and meshes listen.

export type Theme = "light" | "dark";

const STORE_KEY = "glisson-theme";
const listeners = new Set<() => void>();
const systemDark = globalThis.matchMedia?.("(prefers-color-scheme: dark)"); // none outside a page
let chosen: Theme | null = stored();
let printing = false;

function stored(): Theme | null {
  try {
    const value = localStorage.getItem(STORE_KEY);
    return value === "light" || value === "dark" ? value : null;
  } catch {
    return null; // no storage for this file: the choice lasts as long as the page
  }
}

/** Theme in force now; paper is always light. */
export function currentTheme(): Theme {
  if (printing) return "light";
  return chosen ?? (systemDark?.matches ? "dark" : "light");
}

/** True while the page is laid out for paper. */
export function isPrinting(): boolean {
  return printing;
}

/** What `make` makes of the page as it looks on paper, without drawing it anew. */
export function onPaper<T>(make: () => T): T {
  const before = printing;
  printing = true;
  document.documentElement.dataset["theme"] = "light";
  try {
    return make();
  } finally {
    printing = before;
    document.documentElement.dataset["theme"] = currentTheme();
  }
}

/** Sets the other theme and remembers it. */
export function toggleTheme(): void {
  chosen = currentTheme() === "dark" ? "light" : "dark";
  try {
    localStorage.setItem(STORE_KEY, chosen);
  } catch {
    // see stored()
  }
  apply();
}

/** Calls back after each change of theme; returns how to stop. */
export function onTheme(listener: () => void): () => void {
  listeners.add(listener);
  return () => listeners.delete(listener);
}

/** Value of a CSS custom property in the present theme. */
export function themeColour(name: string): string {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

function apply(): void {
  document.documentElement.dataset["theme"] = currentTheme();
  for (const listener of listeners) listener();
}

/** Starts following system, reader and printer. */
export function startTheme(): void {
  systemDark?.addEventListener("change", apply);
  window.addEventListener("beforeprint", () => ((printing = true), apply()));
  window.addEventListener("afterprint", () => ((printing = false), apply()));
  apply();
}
