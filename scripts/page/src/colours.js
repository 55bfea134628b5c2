// Colour scales: those of scripts/scene.py, and one of two sides for values of either sign.
export const HEAT = ["#f4f4ee", "#ffeda0", "#fed976", "#feb24c", "#fd8d3c", "#fc4e2a", "#e31a1c", "#b10026", "#4d0012"];
export const TWO_SIDES = ["#053061", "#2166ac", "#4393c3", "#92c5de", "#f4f4ee", "#fdae61", "#f46d43", "#d7301f", "#67001f"];
export const ABOVE = "#2166ac";

const channels = (colour) => [1, 3, 5].map((i) => parseInt(colour.slice(i, i + 2), 16));

/** RGBA bytes of n colours along a scale. */
export function ramp(scale, n) {
  const stops = scale.map(channels), bytes = new Uint8Array(4 * n);
  for (let i = 0; i < n; i++) {
    const x = (i / (n - 1)) * (stops.length - 1), a = Math.min(Math.floor(x), stops.length - 2);
    for (let k = 0; k < 3; k++) bytes[4 * i + k] = Math.round(stops[a][k] + (x - a) * (stops[a + 1][k] - stops[a][k]));
    bytes[4 * i + 3] = 255;
  }
  return bytes;
}
