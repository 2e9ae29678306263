// checks.ts — figures held against the literature: what, measured, expected, verdict.
import type { CheckData } from "../report_data.ts";
import { h } from "./dom.ts";
import { icon } from "./icons.ts";

export function passed(checks: readonly CheckData[]): number {
  return checks.filter((check) => check.pass).length;
}

/** The verdict in words, e.g. "5 of 6 checks pass"; null without checks. */
export function verdict(checks: readonly CheckData[]): HTMLElement | null {
  if (checks.length === 0) return null;
  const count = passed(checks);
  const all = count === checks.length;
  const noun = checks.length === 1 ? "check" : "checks";
  const words = all
    ? count === 1
      ? "The check passes"
      : `All ${count} ${noun} pass`
    : `${count} of ${checks.length} ${noun} pass`;
  return h("span", { class: `verdict ${all ? "pass" : "fail"}` }, icon(all ? "pass" : "fail"), words);
}

/** All checks of a scene, failed ones first; null without checks. */
export function checkList(checks: readonly CheckData[]): HTMLElement | null {
  if (checks.length === 0) return null;
  const ordered = [...checks].sort((a, b) => Number(a.pass) - Number(b.pass));
  return h(
    "section",
    { class: "checks", "aria-label": "Checks" },
    h("header", { class: "block-head" }, h("h3", {}, "Checks"), verdict(checks)),
    h(
      "table",
      { class: "check-table" },
      h(
        "thead",
        {},
        h(
          "tr",
          {},
          h("th", { scope: "col" }, "What"),
          h("th", { scope: "col" }, "Measured"),
          h("th", { scope: "col" }, "Expected"),
        ),
      ),
      h("tbody", {}, ...ordered.map(checkRow)),
    ),
  );
}

function checkRow(check: CheckData): HTMLElement {
  const word = check.pass ? "Pass" : "Fail";
  return h(
    "tr",
    { class: check.pass ? "pass" : "fail" },
    h(
      "td",
      { class: "check-what" },
      h(
        "div",
        {},
        h(
          "span",
          { class: "check-sign", title: word },
          icon(check.pass ? "pass" : "fail"),
          h("span", { class: "visually-hidden" }, `${word}: `),
        ),
        h("span", {}, check.what),
      ),
    ),
    h("td", { "data-label": "Measured" }, check.measured),
    h("td", { "data-label": "Expected" }, check.expected),
  );
}
