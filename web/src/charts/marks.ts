// marks.ts — dots over a chart: the points the cursor means, and where the mesh's playback stands.
import { h } from "../page/dom.ts";
import { currentTheme, onTheme } from "../page/theme.ts";
import { strokeOf } from "./line_style.ts";
import type { Line } from "./model.ts";

export class Marks {
  private readonly hovers = new Map<string, HTMLElement>();
  private readonly playheads = new Map<string, HTMLElement>();

  constructor(over: HTMLElement, lines: readonly Line[]) {
    for (const line of lines) {
      this.hovers.set(line.id, over.appendChild(h("div", { class: "mark mark-hover", hidden: true })));
      this.playheads.set(line.id, over.appendChild(h("div", { class: "mark mark-playhead", hidden: true })));
    }
    const colour = () => {
      for (const line of lines) {
        const stroke = strokeOf(line.style, currentTheme());
        this.hovers.get(line.id)?.style.setProperty("--mark", stroke);
        this.playheads.get(line.id)?.style.setProperty("--mark", stroke);
      }
    };
    colour();
    onTheme(colour);
  }

  hover(id: string, x: number | null, y: number | null): void {
    place(this.hovers.get(id), x, y);
  }

  playhead(id: string, x: number | null, y: number | null): void {
    place(this.playheads.get(id), x, y);
  }

  clearHover(): void {
    for (const dot of this.hovers.values()) dot.hidden = true;
  }
}

function place(dot: HTMLElement | undefined, x: number | null, y: number | null): void {
  if (!dot) return;
  dot.hidden = x === null || y === null;
  if (!dot.hidden) dot.style.transform = `translate(${x}px, ${y}px)`;
}
