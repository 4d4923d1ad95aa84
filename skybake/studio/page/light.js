// What a map sheds on surfaces: harmonics of its irradiance, and the sun apart.

import { HALF } from "./half.js";
import { direction } from "./geometry.js";
import { sunOf } from "./sun.js";

const MOST_ROWS = 128;

/** Light of a texel: linear Rec. 709, in the frame's own scale. */
export function texel({ texels, width, height, channels }, column, row) {
  const x = ((column % width) + width) % width;
  const y = Math.min(height - 1, Math.max(0, row));
  const at = (y * width + x) * channels;
  return [HALF[texels[at]], HALF[texels[at + 1]], HALF[texels[at + 2]]];
}

/** Light of a map in a direction given by bearing and elevation, in degrees. */
export function lightAt(frame, azimuth, elevation) {
  return texel(frame, Math.floor((azimuth / 360) * frame.width), Math.floor(((90 - elevation) / 180) * frame.height));
}

/**
 * Irradiance of an equirect map as nine coefficients of a polynomial in the normal, without the sun;
 * and the sun, see `sunOf`.
 *
 * R. Ramamoorthi and P. Hanrahan, "An Efficient Representation for Irradiance Environment Maps", 2001.
 */
export function lighting(frame) {
  const sun = sunOf(frame);
  const shaded = { ...frame, texels: sun.texels };
  const sums = Array.from({ length: 9 }, () => [0, 0, 0]);
  const rows = Math.min(MOST_ROWS, frame.height);
  const columns = 2 * rows;
  for (let row = 0; row < rows; row += 1) {
    const elevation = 90 - ((row + 0.5) / rows) * 180;
    const weight = Math.cos((elevation * Math.PI) / 180) * (Math.PI / rows) * ((2 * Math.PI) / columns);
    const sourceRow = Math.floor(((row + 0.5) / rows) * frame.height);
    for (let column = 0; column < columns; column += 1) {
      const share = (column + 0.5) / columns;
      add(sums, direction(share * 360, elevation), texel(shaded, Math.floor(share * frame.width), sourceRow), weight);
    }
  }
  return { harmonics: convolved(sums), ...sun };
}

function add(sums, [x, y, z], light, weight) {
  const shapes = [0.282095, 0.488603 * y, 0.488603 * z, 0.488603 * x, 1.092548 * x * y, 1.092548 * y * z, 0.315392 * (3 * z * z - 1), 1.092548 * x * z, 0.546274 * (x * x - y * y)];
  for (let index = 0; index < 9; index += 1) {
    const share = shapes[index] * weight;
    for (let channel = 0; channel < 3; channel += 1) sums[index][channel] += light[channel] * share;
  }
}

function convolved(sums) {
  const shapes = [0.282095, 0.488603, 0.488603, 0.488603, 1.092548, 1.092548, 0.315392, 1.092548, 0.546274];
  const clamped = [Math.PI, ...Array(3).fill((2 * Math.PI) / 3), ...Array(5).fill(Math.PI / 4)];
  return sums.map((sum, index) => sum.map((value) => value * shapes[index] * clamped[index]));
}
