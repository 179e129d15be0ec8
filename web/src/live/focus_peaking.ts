// SPDX-License-Identifier: Apache-2.0
// Focus peaking: colours the edges in a picture whose brightness changes steeply, because they are in focus.

const STEEPEST = 0.995; // share of the elements that are less steep than a fully coloured edge
const LIMITS: [number, number] = [10, 60]; // least and largest slope that is fully coloured, display values per element
const FAINT = 0.55; // colour begins at this share of that slope

// Returns, for each element, the slope of the displayed brightness in display values per element (Sobel's operator).
// It is 0 at the border.
export function slopes(image: ImageData): Float32Array {
  const { width, height, data } = image;
  const light = new Float32Array(width * height);
  for (let i = 0; i < light.length; ++i)
    light[i] = 0.2126 * data[4 * i] + 0.7152 * data[4 * i + 1] + 0.0722 * data[4 * i + 2];
  const slope = new Float32Array(width * height);
  for (let y = 1; y + 1 < height; ++y)
    for (let i = y * width + 1, end = i + width - 2; i < end; ++i) {
      const [a, b, c] = [i - width, i, i + width];
      const across = light[a + 1] - light[a - 1] + 2 * (light[b + 1] - light[b - 1]) + light[c + 1] - light[c - 1];
      const down = light[c - 1] - light[a - 1] + 2 * (light[c] - light[a]) + light[c + 1] - light[a + 1];
      slope[i] = Math.hypot(across, down) / 8;
    }
  return slope;
}

// Returns the slope from which an edge has the full colour. It follows the picture, because the sharpest edge that LF
// images can show depends on their resolution.
function fullSlope(slope: Float32Array): number {
  const inOrder = Float32Array.from(slope).sort();
  return Math.max(LIMITS[0], Math.min(LIMITS[1], inOrder[Math.floor(STEEPEST * inOrder.length)] ?? 0));
}

// Colours the steep edges of the picture. All else becomes darker, so that the edges stand out.
export function colourEdges(image: ImageData, [red, green, blue]: readonly [number, number, number]): void {
  const { data } = image;
  const all = slopes(image);
  const most = fullSlope(all);
  const least = FAINT * most;
  all.forEach((slope, i) => {
    const share = Math.min(1, Math.max(0, (slope - least) / (most - least)));
    const [r, g, b] = [data[4 * i], data[4 * i + 1], data[4 * i + 2]];
    const grey = 0.7 * (0.2126 * r + 0.7152 * g + 0.0722 * b);
    const rest = (part: number): number => 0.4 * part * 0.7 + 0.6 * grey;
    data[4 * i] = (1 - share) * rest(r) + share * red;
    data[4 * i + 1] = (1 - share) * rest(g) + share * green;
    data[4 * i + 2] = (1 - share) * rest(b) + share * blue;
  });
}
