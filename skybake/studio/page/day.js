// The sun by angles, or by a place and the time of a day.

import { make, makeSvg, segments } from "./dom.js";

const BY_ANGLES = ["sun", "sun-azimuth"];
const BY_TIME = ["time", "date", "lat", "lon", "tz", "site", "ls", "refraction"];
const EARTH = { lat: "48.8566", lon: "2.3522", tz: "Europe/Paris", time: "sunset-1h" };
const MARS = { site: "gale", ls: "180", time: "16:30" };
const STEEPEST = 90;
const WIDTH = 144;
const HEIGHT = 92;
const OFFERED = ["sunrise", "noon", "sunset", "civil-dusk", "nautical-dusk"];
const DATE = /^\d{4}-\d\d-\d\d/;
const EVENT = /^([a-z]+(?:-[a-z]+)*)([+-].*)?$/;
const STEP_BY_KEY = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1, PageUp: 6, PageDown: -6 };

/** How the sun is placed: a choice of two, and for times a curve of the day. */
export class SunPlace {
  constructor(panel, store, client) {
    Object.assign(this, { panel, store, client, kept: {}, asked: "" });
    const choice = make("div", { class: "segments", role: "radiogroup", "aria-label": "Sun by" });
    this.markChoice = segments(choice, [["angles", "Sun by angles"], ["time", "By place and time"]], (how) => this.#choose(how));
    this.day = make("div", { class: "day", hidden: true });
    const group = panel.groupOf("sun") ?? panel.groups[0];
    group.body.prepend(make("div", { class: "how" }, choice), this.day);
    store.addEventListener("change", () => this.show());
    this.show();
  }

  get isTimed() {
    return this.store.option("time") !== undefined;
  }

  show() {
    const { isTimed } = this;
    this.markChoice(isTimed ? "time" : "angles");
    this.panel.setIdle(BY_ANGLES, isTimed);
    this.panel.setIdle(BY_TIME, !isTimed);
    const group = this.panel.groupOf("time");
    if (isTimed && group && !this.wasTimed) group.element.open = true;
    this.wasTimed = isTimed;
    this.day.hidden = !isTimed;
    if (isTimed) this.#ask();
  }

  #choose(how) {
    if ((how === "time") === this.isTimed) return;
    const leaving = how === "time" ? BY_ANGLES : BY_TIME;
    const options = {};
    for (const name of leaving) {
      this.kept[name] = this.store.option(name);
      options[name] = undefined;
    }
    for (const name of how === "time" ? BY_TIME : BY_ANGLES) options[name] = this.kept[name];
    if (how === "time" && options.time === undefined) Object.assign(options, this.#somewhere());
    this.store.change({ options });
  }

  #somewhere() {
    const preset = this.store.option("preset") ?? "earth";
    if (preset.startsWith("mars")) return MARS;
    return { ...EARTH, date: new Date().toISOString().slice(0, 10) };
  }

  async #ask() {
    const names = ["preset", ...BY_TIME.filter((name) => name !== "time"), "altitude"];
    const query = {};
    for (const name of names) {
      const value = this.store.option(name);
      if (value !== undefined) query[name] = value;
    }
    const [dated] = DATE.exec(this.store.option("time")) ?? [];
    if (dated) query.date = dated;
    const key = JSON.stringify(query);
    if (key === this.asked) {
      this.#markNow();
      return;
    }
    this.asked = key;
    try {
      const day = await this.client.get("/api/day", query);
      if (this.asked === key) this.#draw(day);
    } catch (fault) {
      if (this.asked === key) this.day.replaceChildren(make("p", { class: "quiet" }, fault.message));
    }
  }

  #draw(day) {
    const { curve, events } = day;
    const x = (index) => (index / (curve.length - 1)) * WIDTH;
    const y = (elevation) => HEIGHT / 2 - (elevation / STEEPEST) * (HEIGHT / 2 - 3);
    const points = curve.map((point, index) => `${x(index).toFixed(2)},${y(point.elevation_deg).toFixed(2)}`);
    this.places = curve.map((point) => point.time);
    this.labels = curve.map((point) => point.label ?? point.time);
    this.now = makeSvg("line", { class: "now", y1: 0, y2: HEIGHT });
    const picture = makeSvg(
      "svg",
      { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, preserveAspectRatio: "none", role: "slider", tabindex: 0, "aria-label": "Time of the day", "aria-valuemin": 0, "aria-valuemax": curve.length - 1 },
      makeSvg("rect", { class: "above", width: WIDTH, height: HEIGHT / 2 }),
      makeSvg("rect", { class: "below", y: HEIGHT / 2, width: WIDTH, height: HEIGHT / 2 }),
      makeSvg("line", { class: "horizon", x2: WIDTH, y1: HEIGHT / 2, y2: HEIGHT / 2 }),
      ...events.map((event) => this.#mark(event, curve, x)),
      makeSvg("polyline", { class: "curve", points: points.join(" ") }),
      this.now,
    );
    picture.addEventListener("pointerdown", (event) => this.#drag(event, picture));
    picture.addEventListener("pointermove", (event) => event.buttons && this.#drag(event, picture));
    picture.addEventListener("keydown", (event) => this.#key(event));
    this.picture = picture;
    this.text = make("output", {});
    const buttons = events.filter((event) => OFFERED.includes(event.name)).map((event) =>
      make("button", { type: "button", onclick: () => this.#set(event.time) }, `${event.name.replaceAll("-", " ")} ${event.label ?? event.time}`));
    this.day.replaceChildren(picture, this.text, make("div", { class: "events" }, ...buttons));
    this.events = events;
    this.#markNow();
  }

  #mark(event, curve, x) {
    const index = indexOf(event.label ?? event.time, curve.map((point) => point.label ?? point.time));
    return makeSvg("line", { class: "mark", x1: x(index), x2: x(index), y1: 0, y2: HEIGHT });
  }

  #drag(event, picture) {
    picture.setPointerCapture(event.pointerId);
    const box = picture.getBoundingClientRect();
    const share = Math.min(1, Math.max(0, (event.clientX - box.left) / box.width));
    this.#set(this.places[Math.round(share * (this.places.length - 1))], "day");
  }

  #key(event) {
    const step = STEP_BY_KEY[event.key];
    if (!step) return;
    event.preventDefault();
    const next = Math.round(this.index ?? 0) + step;
    this.#set(this.places[Math.min(this.places.length - 1, Math.max(0, next))], "day");
  }

  #set(time, gesture = null) {
    this.store.change({ options: { time } }, gesture);
  }

  #markNow() {
    if (!this.places) return;
    const time = this.store.option("time");
    const exact = this.places.indexOf(time);
    this.index = exact >= 0 ? exact : indexOf(time, this.labels, this.events);
    const isKnown = Number.isFinite(this.index);
    this.now.style.display = isKnown ? "" : "none";
    if (isKnown) {
      const x = (this.index / (this.places.length - 1)) * WIDTH;
      this.now.setAttribute("x1", x);
      this.now.setAttribute("x2", x);
      this.picture.setAttribute("aria-valuenow", Math.round(this.index));
    }
    this.text.textContent = exact >= 0 ? this.labels[exact] : time;
    this.picture.setAttribute("aria-valuetext", this.text.textContent);
  }
}

/** Place of HH:MM, or of an event such as sunset-20min, among labels, or between two of them. */
function indexOf(text, labels, events = []) {
  const [, name, offset] = EVENT.exec(text) ?? [];
  const event = events.find((one) => one.name === name);
  const minutes = event ? minutesOf(event.label) + minutesIn(offset) : minutesOf(text);
  const first = minutesOf(labels[0]);
  const step = minutesOf(labels[1]) - first;
  return (minutes - first) / step;
}

function minutesIn(offset) {
  let sum = 0;
  for (const [, value, unit] of (offset ?? "").matchAll(/([\d.]+)(h|min|s)/g)) sum += Number(value) * { h: 60, min: 1, s: 1 / 60 }[unit];
  return offset?.startsWith("-") ? -sum : sum;
}

function minutesOf(label) {
  const match = /(\d{1,2}):(\d{2})/.exec(label ?? "");
  return match ? Number(match[1]) * 60 + Number(match[2]) : NaN;
}
