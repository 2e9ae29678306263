// webgl.ts — a WebGL context, or none: browsers without one get a message instead of an error.

/** A WebGL 2 context of the canvas, null where the browser or its settings give none. */
export function webglContext(canvas: HTMLCanvasElement): WebGL2RenderingContext | null {
  try {
    return canvas.getContext("webgl2", { antialias: true, alpha: true, stencil: true, preserveDrawingBuffer: true });
  } catch {
    return null;
  }
}
