// save_svg.ts — a figure of the page as an SVG file, on paper's colours: letters stay letters, lines stay lines.
//
// What the browser has laid out is written down: SVG as it stands with its styles, texts where they are, fills of boxes. A
// canvas is drawn anew by what drew it.
import { download, h } from "./dom.ts";
import { icon } from "./icons.ts";
import { onPaper } from "./theme.ts";

/** How a canvas' drawing is written as the inside of an SVG of its size in CSS pixels. */
const vectors = new WeakMap<Element, () => string>();

export function setVector(element: Element, draw: () => string): void {
  vectors.set(element, draw);
}

const STYLES = [
  ...["fill", "fill-opacity", "stroke", "stroke-width", "stroke-opacity", "stroke-dasharray", "stroke-linecap"],
  ...["stroke-linejoin", "opacity", "font-family", "font-size", "font-weight", "text-anchor", "vector-effect"],
];
const LEFT_OUT = ".save-svg, .chart-reset, .mark, output, select, .visually-hidden, .plot-dot, [aria-pressed=false]";

const number = (value: number): string => String(Math.round(value * 100) / 100);
const escaped = (text: string): string => text.replace(/&/g, "&amp;").replace(/</g, "&lt;").replace(/"/g, "&quot;");

/** A button that saves `figure` as NAME.svg. */
export function svgButton(figure: HTMLElement, name: string): HTMLButtonElement {
  const label = "Save this chart as SVG";
  const element = h("button", { type: "button", class: "button save-svg", title: label, "aria-label": label }, "SVG");
  element.prepend(icon("download"));
  element.addEventListener("click", () =>
    download(`${fileName(name)}.svg`, new Blob([figureSvg(figure, name)], { type: "image/svg+xml" })),
  );
  return element;
}

/** A title as the name of a file. */
export function fileName(title: string): string {
  return (
    title
      .normalize("NFKD")
      .replace(/[^\w.-]+/g, "-")
      .replace(/^-+|-+$/g, "")
      .toLowerCase() || "chart"
  );
}

/** The figure as the text of an SVG file. */
export function figureSvg(figure: HTMLElement, title: string): string {
  return onPaper(() => {
    const box = figure.getBoundingClientRect();
    const parts: string[] = [];
    write(figure, box, parts);
    const [width, height] = [number(Math.ceil(box.width)), number(Math.ceil(box.height))];
    return (
      `<svg xmlns="http://www.w3.org/2000/svg" width="${width}" height="${height}" viewBox="0 0 ${width} ${height}">\n` +
      `<title>${escaped(title)}</title>\n<rect width="100%" height="100%" fill="#fff"/>\n${parts.join("\n")}\n</svg>\n`
    );
  });
}

function write(element: Element, origin: DOMRect, parts: string[]): void {
  const style = getComputedStyle(element);
  if (element.matches(LEFT_OUT) || style.display === "none" || style.visibility === "hidden") return;
  const box = element.getBoundingClientRect();
  const [x, y] = [box.x - origin.x, box.y - origin.y];
  const draw = vectors.get(element);
  if (draw) return void parts.push(`<g transform="translate(${number(x)} ${number(y)})">\n${draw()}\n</g>`);
  if (element instanceof SVGSVGElement) return void parts.push(drawing(element, box, x, y));
  if (element instanceof HTMLElement) parts.push(...background(style, box, x, y));
  for (const child of element.childNodes) {
    if (child instanceof Element) write(child, origin, parts);
    else if (child instanceof Text) parts.push(...lines(child, style, origin));
  }
}

/** An SVG of the page where it stands, its styles with it. */
function drawing(element: SVGSVGElement, box: DOMRect, x: number, y: number): string {
  const copy = element.cloneNode(true) as SVGSVGElement;
  const [from, to] = [element.querySelectorAll("*"), copy.querySelectorAll("*")];
  from.forEach((source, i) => {
    const style = getComputedStyle(source);
    const target = to[i]!;
    for (const name of STYLES) {
      const value = style.getPropertyValue(name);
      if (value && value !== "none" && value !== "normal") target.setAttribute(name, value.replace(/"/g, "'"));
      else if (name === "fill" || name === "stroke") target.setAttribute(name, "none");
    }
    target.removeAttribute("class");
    target.removeAttribute("style");
  });
  for (const [name, value] of Object.entries({ x, y, width: box.width, height: box.height }))
    copy.setAttribute(name, number(value));
  copy.setAttribute("overflow", getComputedStyle(element).overflow === "visible" ? "visible" : "hidden");
  return new XMLSerializer().serializeToString(copy);
}

function background(style: CSSStyleDeclaration, box: DOMRect, x: number, y: number): string[] {
  const place = `x="${number(x)}" y="${number(y)}" width="${number(box.width)}" height="${number(box.height)}"`;
  const colours = style.backgroundImage.match(/rgba?\([^)]*\)/g);
  if (style.backgroundImage.startsWith("linear-gradient") && colours) {
    const up = /to top|0deg/.test(style.backgroundImage) && !/90deg/.test(style.backgroundImage);
    const id = `g${number(x)}-${number(y)}`;
    const stops = colours.map((c, i) => `<stop offset="${number(i / (colours.length - 1))}" stop-color="${c}"/>`);
    const way = up ? 'x1="0" y1="1" x2="0" y2="0"' : 'x1="0" y1="0" x2="1" y2="0"';
    return [
      `<linearGradient id="${id}" ${way}>${stops.join("")}</linearGradient>`,
      `<rect ${place} fill="url(#${id})"/>`,
    ];
  }
  const colour = style.backgroundColor;
  if (colour === "transparent" || /, 0\)$/.test(colour) || box.width === 0) return [];
  return [`<rect ${place} fill="${colour}"/>`];
}

/** The lines of a text as it is broken on the page. */
function lines(node: Text, style: CSSStyleDeclaration, origin: DOMRect): string[] {
  const text = node.data;
  if (text.trim() === "") return [];
  const size = parseFloat(style.fontSize);
  const rows: { top: number; left: number; bottom: number; words: string }[] = [];
  const range = document.createRange();
  for (let i = 0; i < text.length; i++) {
    range.setStart(node, i);
    range.setEnd(node, i + 1);
    const box = range.getBoundingClientRect();
    if (box.width === 0) continue;
    const row = rows[rows.length - 1];
    if (row && Math.abs(row.top - box.top) < 0.5 * size) row.words += text[i]!;
    else rows.push({ top: box.top, left: box.left, bottom: box.bottom, words: text[i]! });
  }
  const look =
    `font-family="${style.fontFamily.replace(/"/g, "'")}" font-size="${number(size)}" font-weight="${style.fontWeight}"` +
    ` fill="${style.color}"`;
  return rows.map(
    ({ top, left, bottom, words }) =>
      `<text x="${number(left - origin.x)}" y="${number((top + bottom) / 2 + 0.34 * size - origin.y)}" ${look}>${escaped(words)}</text>`,
  );
}
