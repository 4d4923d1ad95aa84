// How much of the sky and of the ground is how bright, in stops about middle grey.

import { byId } from "./dom.js";
import { luminance } from "./colour.js";
import { signed } from "./figures.js";
import { texel } from "./light.js";

const FROM = -12;
const TO = 12;
const PER_STOP = 4;
const ROWS = 90;
const MIDDLE_GREY = 0.18;

/** Share of solid angle by brightness above and below the horizontal: log2 of texels, in bins. */
export function countBrightness(frame) {
  const bins = { above: new Map(), below: new Map() };
  for (let row = 0; row < ROWS; row += 1) {
    const weight = Math.sin(((row + 0.5) / ROWS) * Math.PI);
    const half = row < ROWS / 2 ? bins.above : bins.below;
    for (let column = 0; column < 2 * ROWS; column += 1) {
      const y = luminance(texel(frame, Math.floor((column + 0.5) * (frame.width / (2 * ROWS))), Math.floor((row + 0.5) * (frame.height / ROWS))));
      if (!(y > 0)) continue;
      const bin = Math.round(Math.log2(y) * PER_STOP);
      half.set(bin, (half.get(bin) ?? 0) + weight);
    }
  }
  return bins;
}

/** Draw it at an exposure. */
export function drawHistogram(bins, gain) {
  const canvas = byId("histogram");
  const scale = devicePixelRatio;
  const width = (canvas.width = Math.round(canvas.clientWidth * scale));
  const height = (canvas.height = Math.round(canvas.clientHeight * scale));
  const context = canvas.getContext("2d");
  const style = getComputedStyle(document.documentElement);
  const colours = { above: style.getPropertyValue("--day"), below: style.getPropertyValue("--quiet") };
  const shift = Math.log2(gain / MIDDLE_GREY);
  const most = Math.max(...bins.above.values(), ...bins.below.values(), 1e-9);
  const place = (stops) => ((stops - FROM) / (TO - FROM)) * width;
  context.strokeStyle = style.getPropertyValue("--accent");
  for (const half of ["below", "above"]) {
    context.fillStyle = colours[half];
    context.globalAlpha = 0.8;
    for (const [bin, weight] of bins[half]) {
      const bar = Math.sqrt(weight / most) * (height - 14 * scale);
      context.fillRect(place(bin / PER_STOP + shift), height - 12 * scale - bar, width / ((TO - FROM) * PER_STOP) + 0.5, bar);
    }
  }
  context.globalAlpha = 1;
  context.fillStyle = style.getPropertyValue("--quiet");
  context.font = `${10 * scale}px system-ui, sans-serif`;
  context.textAlign = "center";
  for (let stops = FROM + 4; stops < TO; stops += 4) context.fillText(stops > 0 ? `+${stops}` : stops, place(stops), height - 2 * scale);
  context.beginPath();
  context.moveTo(place(0), 0);
  context.lineTo(place(0), height - 12 * scale);
  context.stroke();
  byId("histogram-text").textContent = summary(bins, shift);
}

function summary(bins, shift) {
  const parts = [["above", "sky"], ["below", "ground"]].map(([half, title]) => {
    const levels = [...bins[half].keys()].map((bin) => bin / PER_STOP + shift);
    return levels.length ? `${title} ${signed(Math.min(...levels), 0)} to ${signed(Math.max(...levels), 0)}` : `${title} dark`;
  });
  return `Stops about middle grey: ${parts.join(", ")}`;
}
