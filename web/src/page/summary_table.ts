// summary_table.ts — all variants side by side: a row for each quantity, one unit a row.
import { formatInteger, formatSignificant } from "../format/number.ts";
import { type SummaryField, summaryFields } from "../format/summary_fields.ts";
import { displayUnit } from "../format/units.ts";
import type { VariantData } from "../report_data.ts";
import { h } from "./dom.ts";

/** Times of what need not happen. */
const MAY_BE_NEVER = new Set(["first_inversion_s", "energy_gain_from_s"]);

export function summaryTable(variants: readonly VariantData[]): HTMLElement | null {
  const fields = summaryFields(new Set(variants.flatMap((variant) => Object.keys(variant.summary))));
  if (fields.length === 0) return null;
  const groups = [...new Set(fields.map((field) => field.group))];
  const head = h(
    "thead",
    {},
    h(
      "tr",
      {},
      h("th", { scope: "col" }, h("span", { class: "visually-hidden" }, "Quantity")),
      ...variants.map((variant) => h("th", { scope: "col", class: "number" }, variant.label)),
    ),
  );
  const bodies = groups.map((group) =>
    h(
      "tbody",
      {},
      h("tr", { class: "group" }, h("th", { scope: "rowgroup", colspan: variants.length + 1 }, group)),
      ...fields.filter((field) => field.group === group).map((field) => fieldRow(field, variants)),
    ),
  );
  return h(
    "div",
    { class: "table-scroll", tabindex: 0, role: "region", "aria-label": "Summary of all variants" },
    h("table", { class: "summary" }, head, ...bodies),
  );
}

function fieldRow(field: SummaryField, variants: readonly VariantData[]): HTMLElement {
  const values = variants.map((variant) => variant.summary[field.key]);
  const sizes = values.map((value) => (typeof value === "number" && Number.isFinite(value) ? Math.abs(value) : 0));
  const unit =
    field.unit === "" || field.unit === "ns"
      ? { unit: field.unit, factor: 1 }
      : displayUnit(field.unit, Math.max(...sizes));
  const name = unit.unit
    ? h("th", { scope: "row" }, field.label, h("span", { class: "unit" }, ` [${unit.unit}]`))
    : h("th", { scope: "row" }, field.label);
  return h("tr", {}, name, ...values.map((value) => h("td", { class: "number" }, cellText(field, value, unit.factor))));
}

function cellText(field: SummaryField, value: number | string | undefined, factor: number): string {
  if (value === undefined) return "–";
  if (typeof value === "string") return field.key === "end" ? value.replaceAll("_", " ") : value;
  if (MAY_BE_NEVER.has(field.key) && !(value >= 0)) return "none";
  if (field.unit === "" && Number.isInteger(value)) return formatInteger(value);
  return formatSignificant(value * factor, 4);
}
