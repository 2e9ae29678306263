// figure.ts — the frame every figure has: title, its own controls, content.
import { h } from "./dom.ts";

/** A figure; `controls` sit at the right of its title. */
export function figure(title: string, content: Node, controls: Node | null = null, className = ""): HTMLElement {
  return h(
    "section",
    { class: `figure ${className}`.trim(), "aria-label": title },
    h("header", { class: "figure-head" }, h("h3", {}, title), controls),
    content,
  );
}
