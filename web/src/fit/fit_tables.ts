// fit_tables.ts — groups against their spread, laws against each other, experiments that would help most.
import { formatColumn, formatInteger, formatSignificant } from "../format/number.ts";
import { unitOfLabel } from "../format/units.ts";
import { type Child, h } from "../page/dom.ts";
import type { FitData, FitDesign, FitGroup } from "../report_data.ts";
import { nameElement, parameterUnit, shortNames } from "./names.ts";
import { judgement, use } from "./verdicts.ts";

/** A table in its own block; numeric columns stand right. */
function block(
  title: string,
  columns: readonly { name: string; numeric?: boolean }[],
  rows: readonly (readonly Child[])[],
  note = "",
): HTMLElement | null {
  if (rows.length === 0) return null;
  const classOf = (at: number) => (columns[at]!.numeric ? "number" : null);
  return h(
    "section",
    { class: "data-table", "aria-label": title },
    h("header", { class: "block-head" }, h("h3", {}, title)),
    h(
      "div",
      { class: "table-scroll", tabindex: 0, role: "region", "aria-label": title },
      h(
        "table",
        { class: "fit-table" },
        h(
          "thead",
          {},
          h("tr", {}, ...columns.map((column, at) => h("th", { scope: "col", class: classOf(at) }, column.name))),
        ),
        h(
          "tbody",
          {},
          ...rows.map((row) => h("tr", {}, ...row.map((cell, at) => h("td", { class: classOf(at) }, cell)))),
        ),
      ),
    ),
    note ? h("p", { class: "figure-note" }, note) : null,
  );
}

/** Laws shown of each number of terms, besides those that are compared. */
const BEST_OF_EACH = 3;

const withUnit = (name: string, unit: string) => (unit ? `${name} [${unit}]` : name);

/** Forces of two columns in the unit of the charts, all with the same decimals. */
function forces(
  first: readonly (number | null)[],
  second: readonly (number | null)[],
  fit: FitData,
): [string[], string[]] {
  const shown = [...first, ...second].map((value) => (value === null ? "–" : value * Math.abs(fit.y.scale)));
  const texts = formatColumn(shown, 3);
  return [texts.slice(0, first.length), texts.slice(first.length)];
}

export function groupTable(fit: FitData): HTMLElement | null {
  const unit = unitOfLabel(fit.y.label);
  const [rms, spread] = forces(
    fit.groups.map((group) => group.rms_N),
    fit.groups.map((group) => group.spread_N),
    fit,
  );
  const rows = fit.groups.map((group, at) => [
    group.name || "–",
    use(group.held_out),
    String(fit.curves.filter((curve) => curve.group === group.name && curve.held_out === group.held_out).length),
    rms[at]!,
    spread[at]!,
    againstSpread(group),
  ]);
  return block(
    "Error against the spread of repetitions",
    [
      { name: "Test" },
      { name: "Use" },
      { name: "Curves", numeric: true },
      { name: withUnit("rms", unit), numeric: true },
      { name: withUnit("Spread", unit), numeric: true },
      { name: "rms over spread" },
    ],
    rows,
    "An error no larger than the spread means that the simulation is as close to a test as a repetition of the test.",
  );
}

/** R² of each test by the fit of all, and by fits to one test alone; null where there is one kind of test. */
export function testTable(fit: FitData): HTMLElement | null {
  const tests = fit.tests;
  if (!tests.some((test) => test.r2_of_alone.length > 0)) return null;
  const alone = tests.filter((test) => !test.held_out).map((test) => test.name);
  const number = (r2: number | undefined) => (r2 !== undefined && Number.isFinite(r2) ? r2.toFixed(3) : "–");
  const rows = [
    ["all tests", ...tests.map((test) => number(test.r2))],
    ...alone.map((name) => [
      `${name} alone`,
      ...tests.map((test) => number(test.r2_of_alone.find((other) => other.name === name)?.r2)),
    ]),
  ];
  return block(
    "R² of each test",
    [{ name: "Fitted to" }, ...tests.map((test) => ({ name: test.name, numeric: true }))],
    rows,
    "R² is 1 − the sum of squares left over that about the mean: below 0 the mean would be nearer.",
  );
}

/** The best laws of each number of terms; null where none were looked for. */
export function discoveredTable(fit: FitData): HTMLElement | null {
  const shown = fit.discovered.filter((law, at, all) => {
    const before = all.slice(0, at).filter((other) => other.terms === law.terms).length;
    return before < BEST_OF_EACH || law.taken;
  });
  const costs = formatColumn(
    shown.map((law) => law.cost),
    4,
  );
  const rows = shown.map((law, at) => [
    formatInteger(law.terms),
    formatInteger(law.parameters),
    law.taken ? h("strong", {}, law.name) : law.name,
    costs[at]!,
    Number.isFinite(law.least_r2) ? law.least_r2.toFixed(3) : "–",
  ]);
  return block(
    `The best of ${fit.discovered.length} laws of few terms`,
    [
      { name: "Terms", numeric: true },
      { name: "Parameters", numeric: true },
      { name: "Law" },
      { name: "Cost", numeric: true },
      { name: "Least R²", numeric: true },
    ],
    rows,
    "Every subset of a library of terms was fitted; those in bold are compared by data that their fits have not seen.",
  );
}

/** The ratio in words; a dash where nothing was repeated. */
function againstSpread(group: FitGroup): Child {
  const ratio = spreadRatio(group);
  if (ratio === null) return "–";
  return judgement(ratio <= 1, `${formatSignificant(ratio, 3)}: ${ratio <= 1 ? "within" : "above"}`);
}

export function spreadRatio(group: FitGroup): number | null {
  const ratio = group.spread_N === null ? NaN : group.rms_N / group.spread_N;
  return Number.isFinite(ratio) ? ratio : null;
}

export function lawTable(fit: FitData): HTMLElement | null {
  const unit = unitOfLabel(fit.y.label);
  const [fitted, heldOut] = forces(
    fit.laws.map((law) => law.rms_fit),
    fit.laws.map((law) => law.rms_heldout),
    fit,
  );
  const [aic, bic] = [aboveLeast(fit.laws.map((law) => law.aic)), aboveLeast(fit.laws.map((law) => law.bic))];
  const rows = fit.laws.map((law, at) => [
    law.best ? h("strong", {}, law.name) : law.name,
    formatInteger(law.parameters),
    fitted[at]!,
    heldOut[at]!,
    aic[at]!,
    bic[at]!,
    h("span", { class: "law-words" }, law.best ? judgement(true, "Supported by the data. ") : null, law.words),
  ]);
  return block(
    "Laws",
    [
      { name: "Law" },
      { name: "Parameters", numeric: true },
      { name: withUnit("rms, fitted", unit), numeric: true },
      { name: withUnit("rms, held out", unit), numeric: true },
      { name: "AIC − least", numeric: true },
      { name: "BIC − least", numeric: true },
      { name: "What the data say" },
    ],
    rows,
  );
}

/** Criteria as differences from the least of them, which is all they mean. */
export function aboveLeast(values: readonly number[]): string[] {
  const least = Math.min(...values.filter(Number.isFinite));
  return formatColumn(values.map((value) => Math.round(10 * (value - least)) / 10));
}

export function designTable(fit: FitData): HTMLElement | null {
  const names = shortNames(fit.parameters);
  const row = (design: FitDesign) => {
    const at = fit.parameters.findIndex((parameter) => parameter.name === design.parameter);
    const { unit, factor } = at < 0 ? { unit: "", factor: 1 } : parameterUnit(fit.parameters[at]!);
    const width = (value: number) => formatSignificant(value * factor, 3) + (unit ? `\u00a0${unit}` : "");
    return [
      design.what,
      at < 0 ? design.parameter : nameElement(names[at]!),
      width(design.width_now),
      width(design.width_after),
      shrinkText(design),
    ];
  };
  return block(
    "Next experiment",
    [
      { name: "Experiment" },
      { name: "Parameter" },
      { name: "95 % width now", numeric: true },
      { name: "after", numeric: true },
      { name: "narrower by", numeric: true },
    ],
    fit.designs.map(row),
    "Widths predicted by the simulation for one more curve of the present noise.",
  );
}

/** "× 2.4", or "not at all". */
export function shrinkText(design: Pick<FitDesign, "width_now" | "width_after">): string {
  const factor = design.width_now / design.width_after;
  if (!Number.isFinite(factor)) return "–";
  return factor <= 1.005 ? "not at all" : `×\u202f${formatSignificant(factor, 3)}`;
}
