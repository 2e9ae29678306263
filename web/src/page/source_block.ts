// source_block.ts — a scene or another TOML file, folded away, to be read or copied.
import { button, h } from "./dom.ts";

/** A file by what it is; null where the report has none. */
export function sourceBlock(file: string, source: string, what = "Scene"): HTMLElement | null {
  if (source.trim() === "") return null;
  const said = h("span", { class: "copied", role: "status" });
  const copy = button("Copy", `Copy ${file} to the clipboard`, () => {
    void copyText(source).then((done) => {
      said.textContent = done ? "Copied" : "This browser does not allow copying; select the text instead";
      setTimeout(() => (said.textContent = ""), 2500);
    });
  });
  const lines = source.replace(/\s+$/, "").split("\n");
  return h(
    "details",
    { class: "source" },
    h("summary", {}, `${what} `, h("code", {}, file), h("span", { class: "muted" }, ` · ${lines.length} lines`)),
    h(
      "div",
      { class: "source-body" },
      h("div", { class: "source-tools" }, said, copy),
      h("pre", { tabindex: 0, "aria-label": `${what} source` }, h("code", {}, ...lines.map(codeLine))),
    ),
  );
}

/** One line with its comment set back and its table heads brought forward. */
function codeLine(line: string): HTMLElement {
  const comment = commentStart(line);
  const code = comment < 0 ? line : line.slice(0, comment);
  const head = /^\s*\[/.test(code) ? h("b", {}, code) : code;
  return h("span", { class: "code-line" }, head, comment < 0 ? null : h("i", {}, line.slice(comment)), "\n");
}

/** Where a # outside quotes starts, −1 without. */
function commentStart(line: string): number {
  let quote = "";
  for (let i = 0; i < line.length; i++) {
    const letter = line[i]!;
    if (quote) {
      if (letter === "\\" && quote === '"') i++;
      else if (letter === quote) quote = "";
    } else if (letter === '"' || letter === "'") quote = letter;
    else if (letter === "#") return i;
  }
  return -1;
}

/** Copies through the clipboard, or through a selection where files may not use it. */
async function copyText(text: string): Promise<boolean> {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    const area = h("textarea", { class: "visually-hidden" });
    area.value = text;
    document.body.append(area);
    area.select();
    const done = document.execCommand("copy");
    area.remove();
    return done;
  }
}
