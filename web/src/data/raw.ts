// raw.ts — parsed JSON of unknown shape, taken for what it should be; what is missing or wrong becomes empty.

export type Raw = Record<string, unknown>;

export const isRecord = (value: unknown): value is Raw =>
  typeof value === "object" && value !== null && !Array.isArray(value);
export const record = (value: unknown): Raw => (isRecord(value) ? value : {});
export const list = (value: unknown): unknown[] => (Array.isArray(value) ? value : []);
export const text = (value: unknown): string => (value === null || value === undefined ? "" : String(value));
export const finite = (value: unknown, otherwise: number): number =>
  typeof value === "number" && Number.isFinite(value) ? value : otherwise;
export const numberOrNaN = (value: unknown): number => (typeof value === "number" ? value : NaN);
export const numberOrNull = (value: unknown): number | null =>
  typeof value === "number" && Number.isFinite(value) ? value : null;
export const numbers = (value: unknown): number[] => list(value).map(numberOrNaN);
