// mark_texture.ts — the signs of marked vertices: a square for held ones, a disc for those a tool drives.
import * as THREE from "three";

const SIZE = 32;

/** White sign with a dark rim, to be tinted by the material. */
export function markTexture(shape: "square" | "disc"): THREE.Texture {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = SIZE;
  const context = canvas.getContext("2d");
  if (context) {
    context.fillStyle = "#fff";
    context.strokeStyle = "#000";
    context.lineWidth = 6;
    context.beginPath();
    if (shape === "disc") context.arc(SIZE / 2, SIZE / 2, SIZE / 2 - 4, 0, 2 * Math.PI);
    else context.rect(4, 4, SIZE - 8, SIZE - 8);
    context.fill();
    context.stroke();
  }
  const texture = new THREE.CanvasTexture(canvas);
  texture.colorSpace = THREE.SRGBColorSpace;
  return texture;
}
