// Numbers beside the sky: its light, and what is under the cursor.

import { byId, make } from "./dom.js";
import { chromaticity, luminance, swatch, temperature } from "./colour.js";
import { lightAt } from "./light.js";

const MIDDLE_GREY = 0.18;
const REFLECTED = 8; // ISO 100 over the constant 12.5 of a meter for reflected light

const KNOWN = [
  ["sun_illuminance_lx", "Sun, facing it", lux],
  ["sun_horizontal_illuminance_lx", "Sun, level", lux],
  ["sky_illuminance_lx", "Sky, level", lux],
  ["moonlight", "Moon, facing it", ({ illuminance_lx: level }) => lux(level)],
  ["moonlight", "Moon, lit", ({ illuminated_fraction: share }) => `${Math.round(share * 100)} %`],
  ["sun_temperature_k", "Sun's colour", (kelvin, figures) => coloured(figures.sun_colour, kelvin ? `${round(kelvin, 3)}\u00a0K` : "")],
  ["sun_elevation_deg", "Sun's elevation", degrees],
  ["sun_azimuth_deg", "Sun's bearing", degrees],
  ["optical_depth_550", "Optical depth", (depth) => round(depth, 3)],
  ["visibility_km", "Visibility", (km) => `${round(km, 3)} km`],
  ["ev_auto", "Metered", (ev) => `EV ${ev.toFixed(1)}`],
];

/** Show the figures of a frame. */
export function showFigures(figures) {
  const rows = KNOWN.filter(([key]) => figures[key] !== undefined && figures[key] !== null);
  byId("figures").replaceChildren(...rows.flatMap(([key, title, text]) => row(title, text(figures[key], figures))));
}

/** Show what is in a direction of a map, or that nothing is. */
export function showProbe(frame, found, gain) {
  if (!frame || !found) {
    byId("probe").replaceChildren(make("dt", {}, "Point at the sky"), make("dd", {}, ""));
    return;
  }
  const light = lightAt(frame, found.azimuth, found.elevation);
  const y = luminance(light);
  const level = y * frame.scale;
  const xy = chromaticity(light);
  const kelvin = temperature(xy);
  const stops = Math.log2((y * gain) / MIDDLE_GREY);
  const rows = [
    ["Luminance", `${round(level, 3)} cd/m²`],
    ["Stops", Number.isFinite(stops) ? signed(stops, 1) : "–"],
    ["Spot meter", level > 0 ? `EV ${Math.log2(level * REFLECTED).toFixed(1)}` : "–"],
    ["Temperature", y > 0 ? coloured(light, kelvin ? `${round(kelvin, 3)} K` : "off white") : "–"],
    ["x, y", xy ? xy.map((value) => value.toFixed(3)).join(", ") : "–"],
    ["Direction", `${found.azimuth.toFixed(1)}°, ${found.elevation.toFixed(1)}°`],
  ];
  byId("probe").replaceChildren(...rows.flatMap(([title, text]) => row(title, text)));
}

/** Number with so many digits that count, in groups of three. */
export function round(value, digits) {
  if (!Number.isFinite(value)) return "–";
  if (value !== 0 && (Math.abs(value) < 1e-3 || Math.abs(value) >= 1e9)) return value.toExponential(digits - 1);
  return Number(value.toPrecision(digits)).toLocaleString("en", { maximumFractionDigits: 9 }).replaceAll(",", " ");
}

/** Number with its sign, which zero has none of. */
export function signed(value, decimals) {
  const text = value.toFixed(decimals);
  const number = Number(text);
  return number === 0 ? text.replace("-", "") : number > 0 ? `+${text}` : text;
}

function row(title, text) {
  return [make("dt", {}, title), make("dd", {}, text)];
}

function lux(value) {
  return value >= 1e4 ? `${round(value / 1e3, 3)} klx` : `${round(value, 3)} lx`;
}

function degrees(value) {
  return `${value.toFixed(1)}°`;
}

function coloured(rgb, text) {
  const patch = make("span", { class: "swatch" });
  if (rgb) patch.style.background = swatch(rgb);
  return make("span", {}, patch, text);
}
