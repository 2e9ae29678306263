// pen.ts — what charts are drawn with: a canvas, or what writes the same strokes as SVG (svg_pen.ts).

/** The part of a canvas' context that charts use. */
export type Pen = Pick<
  CanvasRenderingContext2D,
  | "save"
  | "restore"
  | "beginPath"
  | "moveTo"
  | "lineTo"
  | "rect"
  | "arc"
  | "clip"
  | "stroke"
  | "fill"
  | "fillText"
  | "measureText"
  | "setLineDash"
  | "strokeStyle"
  | "fillStyle"
  | "globalAlpha"
  | "lineWidth"
  | "lineJoin"
  | "lineCap"
  | "font"
  | "textBaseline"
  | "textAlign"
>;
