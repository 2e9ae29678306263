// page.ts — the whole page: head, way to the scenes and fits, these, foot.
import { fitSection } from "../fit/fit_section.ts";
import type { FitData, ReportData, SceneData } from "../report_data.ts";
import { passed, verdict } from "./checks.ts";
import { h } from "./dom.ts";
import { icon } from "./icons.ts";
import { type SceneBlock, type SceneView, sceneSection } from "./scene_section.ts";
import { followScroll } from "./scroll_spy.ts";
import { toggleTheme } from "./theme.ts";

export function buildPage(report: ReportData): Node {
  const parts: (SceneData | FitData)[] = [...report.scenes, ...(report.fits ?? [])];
  const ids = uniqueIds(parts);
  const alone = parts.length === 1;
  const views = parts.map((part, at) => section(part, ids[at]!, alone && part.title === report.title));
  const blocks = views[0]?.blocks ?? [];
  const navigation = alone ? blockNavigation(blocks) : sceneNavigation(parts, ids);
  followScroll(navigation, alone ? blocks.map((block) => block.element) : views.map((view) => view.element));
  const page = document.createDocumentFragment();
  page.append(
    h("a", { class: "skip", href: "#content" }, "Skip to the content"),
    head(report),
    bar(navigation),
    h(
      "main",
      { id: "content" },
      ...views.map((view) => view.element),
      parts.length === 0 ? h("p", { class: "empty" }, "This report holds no scenes.") : null,
    ),
    foot(report),
  );
  return page;
}

function section(part: SceneData | FitData, id: string, titled: boolean): SceneView {
  return "variants" in part ? sceneSection(part, id, titled) : fitSection(part, id, titled);
}

function head(report: ReportData): HTMLElement {
  const fact = (name: string, value: string) => (value ? h("div", {}, h("dt", {}, name), h("dd", {}, value)) : null);
  return h(
    "header",
    { class: "page-head" },
    h(
      "div",
      { class: "page-words" },
      h("h1", {}, report.title),
      report.subtitle ? h("p", { class: "subtitle" }, report.subtitle) : null,
      verdict(report.scenes.flatMap((scene) => scene.checks)),
    ),
    h(
      "dl",
      { class: "page-facts" },
      fact("Glisson", report.version),
      fact("Made", readableDate(report.created)),
      fact("On", report.machine),
    ),
  );
}

function bar(navigation: HTMLElement): HTMLElement {
  const theme = h(
    "button",
    { type: "button", class: "button tool", title: "Light or dark", "aria-label": "Switch between light and dark" },
    icon("moon"),
  );
  theme.addEventListener("click", toggleTheme);
  return h("div", { class: "page-bar" }, navigation, theme);
}

function sceneNavigation(parts: readonly (SceneData | FitData)[], ids: readonly string[]): HTMLElement {
  const links = parts.map((part, at) => {
    const checks = "checks" in part ? part.checks : [];
    const count = checks.length;
    const good = passed(checks);
    const result =
      count === 0
        ? null
        : h(
            "span",
            { class: good === count ? "count pass" : "count fail", title: `${good} of ${count} checks pass` },
            `${good}/${count}`,
          );
    return h("li", {}, h("a", { href: `#${ids[at]!}` }, h("span", {}, part.title), result));
  });
  return h("nav", { class: "scenes", "aria-label": "Scenes" }, h("ul", {}, ...links));
}

function blockNavigation(blocks: readonly SceneBlock[]): HTMLElement {
  return h(
    "nav",
    { class: "scenes", "aria-label": "Parts of this report" },
    h("ul", {}, ...blocks.map((block) => h("li", {}, h("a", { href: `#${block.id}` }, block.name)))),
  );
}

function foot(report: ReportData): HTMLElement {
  return h(
    "footer",
    { class: "page-foot" },
    h(
      "p",
      {},
      `Made by Glisson ${report.version}. Drag in a chart zooms, a double click resets. ` +
        "The numbers are those of the files next to this report.",
    ),
    h(
      "p",
      {},
      "This page contains three.js, uPlot and the typeface Source Sans 3; their licences are at the end of its source.",
    ),
  );
}

/** "2026-01-31T12:05:09Z" as "31 January 2026, 12:05 UTC"; other texts as they are. */
export function readableDate(created: string): string {
  const date = new Date(created);
  if (created === "" || Number.isNaN(date.getTime())) return created;
  const day = date.toLocaleDateString("en-GB", { day: "numeric", month: "long", year: "numeric", timeZone: "UTC" });
  return `${day}, ${date.toISOString().slice(11, 16)} UTC`;
}

function uniqueIds(parts: readonly { name: string }[]): string[] {
  const used = new Set<string>();
  return parts.map((part, at) => {
    const plain = part.name.replace(/[^A-Za-z0-9_-]+/g, "-") || "scene";
    const id = used.has(plain) ? `${plain}-${at + 1}` : plain;
    used.add(id);
    return id;
  });
}
