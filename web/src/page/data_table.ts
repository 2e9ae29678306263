// data_table.ts — a table the scene brings along.
import { formatColumn } from "../format/number.ts";
import type { TableData } from "../report_data.ts";
import { h } from "./dom.ts";

export function dataTable(table: TableData): HTMLElement {
  const numeric = table.columns.map((_name, at) => table.rows.every((row) => typeof row[at] === "number"));
  const texts = table.columns.map((_name, at) => formatColumn(table.rows.map((row) => row[at] ?? "")));
  const cellClass = (at: number) => (numeric[at] ? "number" : null);
  return h(
    "section",
    { class: "data-table", "aria-label": table.title },
    h("header", { class: "block-head" }, h("h3", {}, table.title)),
    h(
      "div",
      { class: "table-scroll", tabindex: 0, role: "region", "aria-label": table.title },
      h(
        "table",
        {},
        h(
          "thead",
          {},
          h("tr", {}, ...table.columns.map((name, at) => h("th", { scope: "col", class: cellClass(at) }, name))),
        ),
        h(
          "tbody",
          {},
          ...table.rows.map((_row, line) =>
            h("tr", {}, ...texts.map((text, at) => h("td", { class: cellClass(at) }, text[line]))),
          ),
        ),
      ),
    ),
    table.note ? h("p", { class: "figure-note" }, table.note) : null,
  );
}
