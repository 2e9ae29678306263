// main.ts — reads the data in the page and builds the report from it.
import "./styles/index.css";
import "uplot/dist/uPlot.min.css";
import { readReport } from "./data/read_report.ts";
import { h } from "./page/dom.ts";
import { buildPage } from "./page/page.ts";
import { startTheme } from "./page/theme.ts";

function main(): void {
  startTheme();
  const root = document.getElementById("report");
  const result = readReport(document);
  if (!root) return;
  if (!result.ok) {
    root.replaceChildren(h("p", { class: "empty", role: "alert" }, result.reason));
    return;
  }
  document.title = `${result.report.title} – Glisson`;
  root.replaceChildren(buildPage(result.report));
  if (location.hash) document.getElementById(decodeURIComponent(location.hash.slice(1)))?.scrollIntoView();
}

main();
