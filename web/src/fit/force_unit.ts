// force_unit.ts — forces of a fit in the unit of its charts.
import { formatSignificant } from "../format/number.ts";
import { unitOfLabel } from "../format/units.ts";
import type { FitAxis } from "../report_data.ts";

/** "0.123 kPa" for a force in newtons; "–" where there is none. */
export function forceText(force: number | null, axis: FitAxis, digits = 3): string {
  if (force === null || !Number.isFinite(force)) return "–";
  const unit = unitOfLabel(axis.label);
  return formatSignificant(force * Math.abs(axis.scale), digits) + (unit ? `\u00a0${unit}` : "");
}

/** Velocities of a group, e.g. "2 mm/s" or "2 – 10 mm/s"; "" where none is known. */
export function velocityText(velocities: readonly number[]): string {
  const known = velocities.filter((velocity) => Number.isFinite(velocity) && velocity !== 0).map(Math.abs);
  if (known.length === 0) return "";
  const [least, most] = [Math.min(...known), Math.max(...known)];
  const text = (value: number) =>
    formatSignificant(Number((value * 1e3).toPrecision(3)), 3)
      .replace(/(\.\d*?)0+$/, "$1")
      .replace(/\.$/, "");
  return `${text(least)}${text(least) === text(most) ? "" : ` – ${text(most)}`}\u00a0mm/s`;
}
