// dom.ts — builds elements in one expression: h("p", { class: "note" }, "text").

export type Attributes = Record<string, string | number | boolean | null | undefined>;
export type Child = Node | string | null | undefined | false;

/** An HTML element with attributes (true: present, false/null: absent) and children (text is never markup). */
export function h<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  attributes: Attributes = {},
  ...children: Child[]
): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  setAttributes(element, attributes);
  append(element, children);
  return element;
}

/** The same for SVG. */
export function svg<K extends keyof SVGElementTagNameMap>(
  tag: K,
  attributes: Attributes = {},
  ...children: Child[]
): SVGElementTagNameMap[K] {
  const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
  setAttributes(element, attributes);
  append(element, children);
  return element;
}

function setAttributes(element: Element, attributes: Attributes): void {
  for (const [name, value] of Object.entries(attributes)) {
    if (value === false || value === null || value === undefined) continue;
    element.setAttribute(name, value === true ? "" : String(value));
  }
}

function append(element: Element, children: Child[]): void {
  for (const child of children) {
    if (child !== null && child !== undefined && child !== false) element.append(child);
  }
}

/** A button with an accessible name that does one thing. */
export function button(label: string, title: string, onClick: () => void, className = "button"): HTMLButtonElement {
  const element = h("button", { type: "button", class: className, title }, label);
  element.addEventListener("click", onClick);
  return element;
}

/** A labelled select; `onChange` gets the value chosen. */
export function select(
  label: string,
  options: readonly { value: string; label: string }[],
  value: string,
  onChange: (value: string) => void,
): HTMLLabelElement {
  const list = h("select", { "aria-label": label });
  for (const option of options) {
    list.append(h("option", { value: option.value, selected: option.value === value }, option.label));
  }
  list.addEventListener("change", () => onChange(list.value));
  return h("label", { class: "select" }, h("span", {}, label), list);
}

/** Offers a file to the reader. */
export function download(name: string, content: Blob): void {
  const url = URL.createObjectURL(content);
  const link = h("a", { href: url, download: name });
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(url), 10_000);
}
