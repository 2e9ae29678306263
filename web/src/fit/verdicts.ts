// verdicts.ts — signs with a word each: what is known of a parameter, a yes or no, fitted or held out.
import { h } from "../page/dom.ts";
import { type IconName, icon } from "../page/icons.ts";
import type { FitParameter } from "../report_data.ts";

type Verdict = FitParameter["verdict"];

const LOOKS: Record<Verdict, { sign: IconName; tone: "pass" | "warn" | "fail" }> = {
  identified: { sign: "pass", tone: "pass" },
  negligible: { sign: "pass", tone: "pass" },
  weak: { sign: "weak", tone: "warn" },
  "at bound": { sign: "bound", tone: "warn" },
  "read off": { sign: "weak", tone: "warn" },
  "not identifiable": { sign: "fail", tone: "fail" },
};

export function verdictTone(verdict: Verdict): "pass" | "warn" | "fail" {
  return LOOKS[verdict].tone;
}

export function verdictSign(verdict: Verdict): HTMLElement {
  const { sign, tone } = LOOKS[verdict];
  return h("span", { class: `sign ${tone}` }, icon(sign), verdict.charAt(0).toUpperCase() + verdict.slice(1));
}

/** What the curves of a group were used for. */
export function use(heldOut: boolean): HTMLElement {
  return h("span", { class: heldOut ? "use held-out" : "use" }, heldOut ? "held out" : "fitted");
}

/** A yes or no with words of its own. */
export function judgement(good: boolean, words: string): HTMLElement {
  return h("span", { class: `sign ${good ? "pass" : "warn"}` }, icon(good ? "pass" : "weak"), words);
}
