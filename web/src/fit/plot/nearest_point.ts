// nearest_point.ts — the point of a small chart that cursor or arrow keys mean.
import type { PointsMark } from "./marks.ts";
import { type Scale, place } from "./scale.ts";

export interface FoundPoint {
  mark: PointsMark;
  index: number;
}

/** The point nearest on the screen; null farther than `reach` pixels. */
export function nearestPoint(
  marks: readonly PointsMark[],
  xScale: Scale,
  yScale: Scale,
  left: number,
  top: number,
  box: { width: number; height: number },
  reach = 60,
): FoundPoint | null {
  let best: FoundPoint | null = null;
  let least = reach * reach;
  for (const mark of marks) {
    for (let index = 0; index < Math.min(mark.x.length, mark.y.length); index++) {
      const dx = place(xScale, mark.x[index]!) * box.width - left;
      const dy = (1 - place(yScale, mark.y[index]!)) * box.height - top;
      const distance = dx * dx + dy * dy;
      if (distance < least) {
        least = distance;
        best = { mark, index };
      }
    }
  }
  return best;
}

/** All points of all marks, by x: the way of the arrow keys. */
export function orderAlongX(marks: readonly PointsMark[]): FoundPoint[] {
  const all = marks.flatMap((mark) =>
    Array.from({ length: Math.min(mark.x.length, mark.y.length) }, (_, index) => ({ mark, index })),
  );
  return all
    .filter(({ mark, index }) => Number.isFinite(mark.x[index]!) && Number.isFinite(mark.y[index]!))
    .sort((a, b) => a.mark.x[a.index]! - b.mark.x[b.index]!);
}
