// The sun's disc in a map: its light, and the map without it.

import { HALF } from "./half.js";
import { direction } from "./geometry.js";

const DEG = Math.PI / 180;
const USUAL_RADIUS = 0.27;
const MOST_TEXELS = 8; // of a radius; larger discs are drawn as the map has them
const LEAST_EXCESS = 0.02;

/**
 * The sun of an equirect map, in the direction that its figures name.
 *
 * Returns `sunlight`, what it sheds on a plane that faces it, in texels times steradian; `sunward`,
 * where it stands; `texels` without it; and `disc` as it is drawn: `radiance`, `radius` [rad], and
 * `floor`, the sine of the elevation below which it is hidden. `disc` is null where the map
 * shows it better: a large one, or one behind a moon.
 */
export function sunOf(frame) {
  const { sun_azimuth_deg: azimuth = 180, sun_elevation_deg: elevation = -90, sun_radius_deg: radius = USUAL_RADIUS, moon } = frame.figures ?? {};
  const sunward = direction(azimuth, elevation);
  const step = 180 / frame.height;
  const reach = radius + 1.5 * step;
  const texels = frame.texels.slice();
  const sunlight = [0, 0, 0];
  let lowest = null;
  for (const { row, columns, level, up } of rowsOf(frame, azimuth, elevation, reach, step)) {
    const edges = [columns[0] - 1, columns.at(-1) + 1].map((column) => place(frame, column, row));
    const weight = level * (step * DEG) ** 2;
    let excess = 0;
    columns.forEach((column, index) => {
      const at = place(frame, column, row);
      const nearest = edges[index < columns.length / 2 ? 0 : 1];
      for (let channel = 0; channel < 3; channel += 1) {
        const around = HALF[frame.texels[nearest + channel]];
        const above = Math.max(0, HALF[frame.texels[at + channel]] - around);
        sunlight[channel] += above * weight;
        excess = Math.max(excess, above / Math.max(around, 1e-9));
        texels[at + channel] = frame.texels[nearest + channel];
      }
    });
    if (excess > LEAST_EXCESS) lowest = up - step / 2;
  }
  const isDrawn = !moon && radius < MOST_TEXELS * step && Math.max(...sunlight) > 0;
  const disc = isDrawn ? discOf(sunlight, radius * DEG, elevation * DEG, lowest * DEG) : null;
  return { sunlight, sunward, disc, texels: disc ? texels : frame.texels };
}

function* rowsOf(frame, azimuth, elevation, reach, step) {
  const first = Math.max(0, Math.floor((90 - elevation - reach) / step));
  const last = Math.min(frame.height - 1, Math.ceil((90 - elevation + reach) / step));
  const middle = (azimuth / 360) * frame.width - 0.5;
  for (let row = first; row <= last; row += 1) {
    const up = 90 - (row + 0.5) * step;
    const level = Math.cos(up * DEG);
    const half = Math.min(frame.width / 2 - 1, reach / step / Math.max(level, 1e-3));
    const columns = [];
    for (let column = Math.ceil(middle - half); column <= middle + half; column += 1) columns.push(column);
    if (columns.length) yield { row, columns, level, up };
  }
}

function place({ width, channels }, column, row) {
  return (row * width + (((column % width) + width) % width)) * channels;
}

// Of a disc that the horizon cuts, the part above it has all the light.
function discOf(sunlight, radius, elevation, lowest) {
  const isCut = lowest > elevation - radius;
  const height = isCut ? Math.min(1, Math.max(-1, (lowest - elevation) / radius)) : -1;
  const shown = (Math.acos(height) - height * Math.sqrt(1 - height * height)) / Math.PI;
  const area = Math.PI * radius * radius * Math.max(0.02, shown);
  return { radiance: sunlight.map((value) => value / area), radius, floor: isCut ? Math.sin(lowest) : -2 };
}
