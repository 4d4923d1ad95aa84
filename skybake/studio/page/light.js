// What a map sheds on surfaces: harmonics of its irradiance, and the sun apart.

import { HALF } from "./half.js";
import { direction } from "./geometry.js";

const MOST_ROWS = 128;
const DEG = Math.PI / 180;
const LEAST_RADIUS = 0.27;

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
 * Irradiance of an equirect map as nine coefficients of a polynomial in the normal, without the sun,
 * and the sun's own on a plane that faces it.
 *
 * R. Ramamoorthi and P. Hanrahan, "An Efficient Representation for Irradiance Environment Maps", 2001.
 */
export function lighting(frame) {
  const { sun_azimuth_deg: azimuth = 180, sun_elevation_deg: elevation = -90 } = frame.figures ?? {};
  const sun = direction(azimuth, elevation);
  const step = 180 / frame.height;
  const radius = 1.5 * step + LEAST_RADIUS;
  const { light: sunlight, around } = sunOf(frame, azimuth, elevation, radius, step);
  const closeCosine = Math.cos(radius * DEG);
  const sums = Array.from({ length: 9 }, () => [0, 0, 0]);
  const rows = Math.min(MOST_ROWS, frame.height);
  const columns = 2 * rows;
  for (let row = 0; row < rows; row += 1) {
    const polar = ((row + 0.5) / rows) * Math.PI;
    const weight = Math.sin(polar) * (Math.PI / rows) * ((2 * Math.PI) / columns);
    const sourceRow = Math.floor(((row + 0.5) / rows) * frame.height);
    for (let column = 0; column < columns; column += 1) {
      const share = (column + 0.5) / columns;
      const bearing = share * 2 * Math.PI;
      const level = Math.sin(polar);
      const n = [Math.sin(bearing) * level, Math.cos(polar), -Math.cos(bearing) * level];
      const isSun = n[0] * sun[0] + n[1] * sun[1] + n[2] * sun[2] > closeCosine;
      const light = isSun ? around : texel(frame, Math.floor(share * frame.width), sourceRow);
      add(sums, n, light, weight);
    }
  }
  return { harmonics: convolved(sums), sunlight, sunward: sun };
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

function sunOf(frame, azimuth, elevation, radius, step) {
  const ring = [0, 60, 120, 180, 240, 300].map((turn) => {
    const up = elevation + 2 * radius * Math.sin(turn * DEG);
    const aside = (2 * radius * Math.cos(turn * DEG)) / Math.max(0.05, Math.cos(elevation * DEG));
    return lightAt(frame, azimuth + aside, up);
  });
  const around = [0, 1, 2].map((channel) => ring.reduce((sum, light) => sum + light[channel], 0) / ring.length);
  const light = [0, 0, 0];
  const sun = direction(azimuth, elevation);
  const first = Math.floor((90 - elevation - radius) / step);
  const last = Math.ceil((90 - elevation + radius) / step);
  const middle = Math.floor((azimuth / 360) * frame.width);
  for (let row = Math.max(0, first); row <= Math.min(frame.height - 1, last); row += 1) {
    const up = 90 - (row + 0.5) * step;
    const level = Math.cos(up * DEG);
    const reach = Math.min(frame.width / 2, Math.ceil(radius / step / Math.max(level, 1e-3)));
    for (let column = middle - reach; column <= middle + reach; column += 1) {
      const d = direction(((column + 0.5) / frame.width) * 360, up);
      if (d[0] * sun[0] + d[1] * sun[1] + d[2] * sun[2] < Math.cos(radius * DEG)) continue;
      const weight = level * (step * DEG) ** 2;
      texel(frame, column, row).forEach((value, channel) => {
        light[channel] += Math.max(0, value - around[channel]) * weight;
      });
    }
  }
  return { light, around };
}
