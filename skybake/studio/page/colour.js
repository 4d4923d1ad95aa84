// Luminance, chromaticity and colour temperature of linear Rec. 709, and false colour.

const XYZ = [
  [0.4123907992659593, 0.357584339383878, 0.1804807884018343],
  [0.2126390058715102, 0.715168678767756, 0.0721923153607337],
  [0.0193308187155918, 0.119194779794626, 0.9505321522496607],
];

/** Luminance of linear Rec. 709, in its own scale. */
export function luminance([r, g, b]) {
  return XYZ[1][0] * r + XYZ[1][1] * g + XYZ[1][2] * b;
}

/** CIE xy, or null of darkness. */
export function chromaticity(rgb) {
  const [x, y, z] = XYZ.map((row) => row[0] * rgb[0] + row[1] * rgb[1] + row[2] * rgb[2]);
  const sum = x + y + z;
  return sum > 0 ? [x / sum, y / sum] : null;
}

/**
 * Correlated colour temperature [K], or null where a light is too far from white to have one.
 *
 * C. S. McCamy, 1992, below 3000 K; J. Hernandez-Andres, R. L. Lee and J. Romero, "Calculating
 * correlated color temperatures across the entire gamut of daylight and skylight", 1999, above.
 */
export function temperature(xy) {
  if (!xy) return null;
  const [x, y] = xy;
  const n = (x - 0.3366) / (y - 0.1735);
  const t = -949.86315 + 6253.80338 * Math.exp(-n / 0.92159) + 28.70599 * Math.exp(-n / 0.20039) + 0.00004 * Math.exp(-n / 0.07125);
  const m = (x - 0.332) / (0.1858 - y);
  const kelvin = t >= 3000 ? t : 449 * m ** 3 + 3525 * m ** 2 + 6823.3 * m + 5520.33;
  return kelvin > 1000 && kelvin < 100000 && distance(x, y) < 0.05 ? kelvin : null;
}

// Distance in CIE 1960 uv from black bodies, by M. Krystek's formula of 1985 at the nearest of some.
function distance(x, y) {
  const u = (4 * x) / (-2 * x + 12 * y + 3);
  const v = (6 * y) / (-2 * x + 12 * y + 3);
  let least = Infinity;
  for (let reciprocal = 20; reciprocal <= 1000; reciprocal += 10) {
    const t = 1e6 / reciprocal;
    const bu = (0.860117757 + 1.54118254e-4 * t + 1.28641212e-7 * t * t) / (1 + 8.42420235e-4 * t + 7.08145163e-7 * t * t);
    const bv = (0.317398726 + 4.22806245e-5 * t + 4.20481691e-8 * t * t) / (1 - 2.89741816e-5 * t + 1.61456053e-7 * t * t);
    least = Math.min(least, Math.hypot(u - bu, v - bv));
  }
  return least;
}

/** Colours of stops -8 to 8 about middle grey: blue below, grey at it, red above, white beyond. */
export const BANDS = [
  "#0a0a12", "#1b1340", "#2a1c78", "#2b3bb0", "#2563cf", "#1f8ad6", "#1fb0c4", "#3fc29a",
  "#8b8f94",
  "#7fce57", "#bfd944", "#f2d93b", "#f8b133", "#f3812d", "#e54b2a", "#c11f3a", "#ffffff",
];

/** The same as numbers within 0 to 1. */
export const BAND_VALUES = BANDS.flatMap((text) => [1, 3, 5].map((at) => parseInt(text.slice(at, at + 2), 16) / 255));

/** sRGB text of linear Rec. 709, as bright as it can be. */
export function swatch(rgb) {
  const most = Math.max(...rgb, 1e-30);
  const codes = rgb.map((value) => {
    const c = Math.min(1, Math.max(0, value / most));
    return Math.round(255 * (c <= 0.0031308 ? 12.92 * c : 1.055 * c ** (1 / 2.4) - 0.055));
  });
  return `rgb(${codes.join(" ")})`;
}
