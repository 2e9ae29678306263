// profiles.ts — profile likelihood of each parameter: how fast the fit worsens as the parameter leaves its optimum.
import { h } from "../page/dom.ts";
import { figure } from "../page/figure.ts";
import type { FitData, FitParameter, FitProfile } from "../report_data.ts";
import { type ShortName, nameWithUnit, parameterUnit, plainName, shortNames } from "./names.ts";
import { plot } from "./plot/plot.ts";
import { makeScale, scaleOf } from "./plot/scale.ts";

/** The charts reach this many thresholds up at most: what matters is near the threshold. */
const MOST_THRESHOLDS = 3;

export function profileFigures(fit: FitData): HTMLElement | null {
  const names = shortNames(fit.parameters);
  const plots = fit.profiles.flatMap((profile) => {
    const at = fit.parameters.findIndex((parameter) => parameter.name === profile.parameter);
    if (at < 0 || profile.values.length < 2) return [];
    return [profilePlot(profile, fit.parameters[at]!, names[at]!)];
  });
  if (plots.length === 0) return null;
  return figure("Profiles", h("div", { class: "plots" }, ...plots), caption(), "figure-wide");
}

const caption = () =>
  h("span", { class: "figure-about" }, "Rise of −2 ln L over a parameter, all others re-optimised; dashed: 95 %");

function profilePlot(profile: FitProfile, parameter: FitParameter, name: ShortName): HTMLElement {
  const { unit, factor } = parameterUnit(parameter);
  const values = profile.values.map((value) => value * factor);
  const label = nameWithUnit(name, unit);
  const top = riseTop(profile);
  const [low, high] = parameter.ci95_profile ?? [null, null];
  const chart = plot({
    title: `Profile of ${plainName(name)}`,
    x: { label, scale: scaleOf([...values, parameter.value * factor], 0.02, parameter.scale === "log") },
    y: { label: "Rise of −2 ln L", scale: makeScale(-0.03 * top, top), ticks: 3 },
    marks: [
      ...(parameter.ci95_profile
        ? [
            {
              kind: "band" as const,
              className: "plot-band",
              x: [scaledOrNull(low, factor), scaledOrNull(high, factor)] as const,
              y: [null, null] as const,
            },
          ]
        : []),
      { kind: "rule", className: "plot-rule dashed", y: profile.threshold, label: "95 %" },
      { kind: "rule", className: "plot-rule", x: parameter.value * factor },
      { kind: "line", className: "plot-line", x: values, y: profile.rise },
      { kind: "dots", className: "plot-dots", x: values, y: profile.rise, name: "" },
    ],
  });
  return h("div", { class: "plot-cell" }, chart, h("p", { class: "plot-words" }, profileWords(profile)));
}

const scaledOrNull = (value: number | null, factor: number) => (value === null ? null : value * factor);

/** Upper end of the axis: the whole profile, but not more than a few thresholds. */
export function riseTop(profile: FitProfile): number {
  const most = Math.max(profile.threshold, ...profile.rise.filter(Number.isFinite));
  return Math.min(1.08 * most, MOST_THRESHOLDS * profile.threshold) + 0.1 * profile.threshold;
}

/** The words of the profile, or, where it has none, on which sides it crosses the threshold. */
export function profileWords(profile: FitProfile): string {
  if (profile.words) return profile.words;
  const known = profile.rise.map((rise) => (Number.isFinite(rise) ? rise : 0));
  const least = known.indexOf(Math.min(...known));
  const left = known.slice(0, least + 1).some((rise) => rise >= profile.threshold);
  const right = known.slice(least).some((rise) => rise >= profile.threshold);
  if (left && right) return "Bounded on both sides.";
  if (!left && !right) return "Flat: the curves do not determine it.";
  return left ? "Open towards larger values." : "Open towards smaller values.";
}
