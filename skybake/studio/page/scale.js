// Between what is typed, numbers, and where a slider stands.

const TO_UNIT = {
  deg: { deg: 1, "": 1, rad: 180 / Math.PI, arcmin: 1 / 60, arcsec: 1 / 3600 },
  km: { km: 1, m: 1e-3, ft: 0.3048e-3, mi: 1.609344 },
  m: { m: 1, km: 1e3, ft: 0.3048, mi: 1609.344 },
  DU: { DU: 1 },
  s: { s: 1, min: 60, h: 3600 },
  min: { min: 1, s: 1 / 60, h: 60 },
};
const TYPED = new Set(["deg", "km", "m", "DU", "s", "min", "h"]);
const QUANTITY = /^\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:e[+-]?\d+)?)\s*([a-z]*)\s*$/i;
const LEAST_SHARE = 2e-7;
const STEPS = 1000;

/** Number of a text in a unit, or null if only the server can tell. */
export function readQuantity(text, unit) {
  const match = QUANTITY.exec(text ?? "");
  if (!match) return null;
  const factor = TO_UNIT[unit]?.[match[2]] ?? (TYPED.has(unit) || match[2] !== "" ? null : 1);
  return factor === null ? null : Number(match[1]) * factor;
}

/** Text of a number as one would type it. */
export function writeQuantity(value, unit, digits = 6) {
  if (unit === "km" && Math.abs(value) < 1) return `${plain(value * 1000, digits)}m`;
  return `${plain(value, digits)}${TYPED.has(unit) ? unit : ""}`;
}

function plain(value, digits) {
  const rounded = Number(value.toPrecision(digits));
  const text = String(rounded);
  return text.includes("e") ? rounded.toFixed(20).replace(/\.?0+$/, "") : text;
}

/** Where a slider stands for a value, and back; of a range with a linear or logarithmic scale. */
export class SliderScale {
  constructor({ min, max, scale, kind }) {
    this.min = min;
    this.max = max;
    this.isLog = scale === "log" && max > 0 && min >= 0;
    // From zero, a logarithm begins where a step would not be seen: 1 m of an orbit's height.
    this.offset = this.isLog && min === 0 ? max * LEAST_SHARE : 0;
    this.isWhole = kind === "integer";
    this.step = this.isWhole ? 1 : 10 ** Math.floor(Math.log10((max - min) / STEPS));
  }

  /** Place within 0 to 1. */
  place(value) {
    const clamped = Math.min(this.max, Math.max(this.min, value));
    if (!this.isLog) return (clamped - this.min) / (this.max - this.min);
    const from = Math.log(this.min + this.offset);
    return (Math.log(clamped + this.offset) - from) / (Math.log(this.max + this.offset) - from);
  }

  /** Value at a place, rounded as a hand would. */
  value(place) {
    if (!this.isLog) return this.#rounded(this.min + place * (this.max - this.min));
    const from = Math.log(this.min + this.offset);
    const value = Math.exp(from + place * (Math.log(this.max + this.offset) - from)) - this.offset;
    if (value <= this.min) return this.min;
    const held = Math.min(this.max, value);
    return this.isWhole ? Math.round(held) : Number(held.toPrecision(held < this.offset * 20 ? 1 : 3));
  }

  #rounded(value) {
    const decimals = Math.max(0, -Math.floor(Math.log10(this.step)));
    return Math.min(this.max, Math.max(this.min, Number((Math.round(value / this.step) * this.step).toFixed(decimals))));
  }
}
