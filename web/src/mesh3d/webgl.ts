// webgl.ts — a WebGL context, or none: browsers without one get a message instead of an error.

/** A WebGL 2 context of the canvas, null where the browser or its settings give none. @param smooth  edges of surfaces */
export function webglContext(canvas: HTMLCanvasElement, smooth = true): WebGL2RenderingContext | null {
  try {
    return canvas.getContext("webgl2", {
      antialias: smooth,
      alpha: true,
      stencil: true,
      preserveDrawingBuffer: true,
    });
  } catch {
    return null;
  }
}

/** Whether the browser says that it draws without a graphics card, where each sample of a pixel takes its time. */
export function drawsInSoftware(): boolean {
  try {
    const probe = document.createElement("canvas").getContext("webgl2");
    const info = probe?.getExtension("WEBGL_debug_renderer_info");
    const name = probe && info ? String(probe.getParameter(info.UNMASKED_RENDERER_WEBGL)) : "";
    probe?.getExtension("WEBGL_lose_context")?.loseContext();
    return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(name);
  } catch {
    return false;
  }
}
