// pixels.mjs — what a picture of an element shows: colours counted in the page itself, from a real screenshot.

/** Share of pixels that differ from the commonest colour, number of distinct colours, and a hash, of an element. */
export async function pixelsOf(page, locator) {
  const shot = await locator.screenshot({ animations: "disabled" });
  return page.evaluate(async (base64) => {
    const bytes = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
    const picture = await createImageBitmap(new Blob([bytes], { type: "image/png" }));
    const canvas = new OffscreenCanvas(picture.width, picture.height);
    const context = canvas.getContext("2d");
    context.drawImage(picture, 0, 0);
    const data = new Uint32Array(context.getImageData(0, 0, picture.width, picture.height).data.buffer);
    const counts = new Map();
    let hash = 2166136261;
    for (const value of data) {
      counts.set(value, (counts.get(value) ?? 0) + 1);
      hash = Math.imul(hash ^ value, 16777619);
    }
    const commonest = Math.max(...counts.values());
    return { colours: counts.size, drawn: 1 - commonest / data.length, hash };
  }, shot.toString("base64"));
}

/** Coloured (not grey) pixels of a chart's own canvas by "r,g,b", and a hash of all of it; nothing over it counts. */
export function canvasOf(canvas) {
  return canvas.evaluate((element) => {
    const copy = new OffscreenCanvas(element.width, element.height);
    const context = copy.getContext("2d", { willReadFrequently: true });
    context.drawImage(element, 0, 0);
    const data = context.getImageData(0, 0, copy.width, copy.height).data;
    const colours = {};
    let hash = 2166136261;
    for (let i = 0; i < data.length; i += 4) {
      const [r, g, b, a] = [data[i], data[i + 1], data[i + 2], data[i + 3]];
      hash = Math.imul(hash ^ ((r << 24) | (g << 16) | (b << 8) | a), 16777619);
      if (a < 250 || Math.max(r, g, b) - Math.min(r, g, b) < 60) continue;
      const key = `${r},${g},${b}`;
      colours[key] = (colours[key] ?? 0) + 1;
    }
    return { colours, hash };
  });
}

export async function lineColours(canvas) {
  return (await canvasOf(canvas)).colours;
}

/** RGBA of a square of 30 × 30 pixels about a place in shares of an element's size, from a real screenshot. */
async function squareAt(page, locator, x, y) {
  const shot = await locator.screenshot({ animations: "disabled" });
  return page.evaluate(
    async ([base64, x, y]) => {
      const bytes = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
      const picture = await createImageBitmap(new Blob([bytes], { type: "image/png" }));
      const context = new OffscreenCanvas(picture.width, picture.height).getContext("2d");
      context.drawImage(picture, 0, 0);
      const left = Math.round(x * picture.width) - 15;
      return [...context.getImageData(left, Math.round(y * picture.height) - 15, 30, 30).data];
    },
    [shot.toString("base64"), x, y],
  );
}

/** Shares of that square that are of each tone. @param tones  names to tests of ([low, middle, high], [r, g, b]) of a pixel */
export async function tonesAt(page, locator, x, y, tones) {
  const data = await squareAt(page, locator, x, y);
  const colours = Array.from({ length: data.length / 4 }, (_, i) => data.slice(4 * i, 4 * i + 3));
  const share = (is) =>
    colours.filter((c) =>
      is(
        [...c].sort((a, b) => a - b),
        c,
      ),
    ).length / colours.length;
  return Object.fromEntries(Object.entries(tones).map(([name, is]) => [name, share(is)]));
}

/** Mean difference between neighbours in that square, in levels of red. */
export async function grainAt(page, locator, x, y) {
  const data = await squareAt(page, locator, x, y);
  let sum = 0;
  for (let i = 0; i + 4 < data.length; i += 4) if ((i / 4) % 30 !== 29) sum += Math.abs(data[i] - data[i + 4]);
  return sum / (29 * 30);
}
