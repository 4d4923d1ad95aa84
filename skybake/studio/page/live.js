// Asks for pictures as knobs move, and says how far they are.

import { byId, say } from "./dom.js";
import { lighting } from "./light.js";

const SKY = "sky";
const PLANET = "planet";
const UNNOTICED = 250; // ms within which a picture needs no word
const PLANET_MOST = 1024;
const DETAILS = [512, 1024, 2048, 4096];

/**
 * Events: `frame` with a picture in `detail`, `command` with its command line.
 *
 * `data-state` of the frame is "busy", "fault", "cancelled", or "settled" once the full picture of
 * what is set has been drawn.
 */
export class Live extends EventTarget {
  frames = {};
  expected = {};
  detail = 1024;

  constructor(client, store, views) {
    super();
    Object.assign(this, { client, store, views });
    client.addEventListener("frame", ({ detail }) => this.#arrived(detail));
    client.addEventListener("progress", ({ detail }) => this.#progress(detail));
    client.addEventListener("fault", ({ detail }) => this.#failed(detail));
    client.addEventListener("connection", ({ detail }) => this.#connection(detail));
    store.addEventListener("change", () => this.ask());
    views.addEventListener("view", () => this.#viewed());
    views.addEventListener("drawn", () => this.#drawn());
    byId("cancel").addEventListener("click", () => this.cancel());
    const select = byId("detail");
    for (const width of DETAILS) select.add(new Option(`${width} × ${width / 2}`, width));
    select.value = String(this.detail);
    select.addEventListener("change", () => {
      this.detail = Number(select.value);
      this.ask();
    });
  }

  /** Ask for the sky that is set, and for the planet if it is looked at. */
  ask() {
    this.asked = null;
    this.expected[SKY] = this.client.request(SKY, this.store.state, { kind: "equirect", size: [this.detail, this.detail / 2] });
    this.#begin();
    if (this.views.kind === PLANET) this.#askPlanet();
  }

  /** Keep the picture that is there. */
  cancel() {
    for (const tag of Object.keys(this.expected)) this.client.stop(tag);
    this.expected = {};
    this.#end("cancelled");
    say("Cancelled; the last picture stays");
  }

  get isBusy() {
    return Object.keys(this.expected).length > 0;
  }

  #viewed() {
    if (this.views.kind === PLANET && this.asked !== this.store.state) this.#askPlanet();
  }

  #askPlanet() {
    this.asked = this.store.state;
    const { clientWidth: width, clientHeight: height } = this.views.canvas;
    const share = Math.min(1, PLANET_MOST / Math.max(width, height, 1));
    const size = [width, height].map((length) => Math.max(64, Math.round(length * share)));
    this.expected[PLANET] = this.client.request(PLANET, this.store.state, { kind: PLANET, size });
    this.#begin();
  }

  #begin() {
    byId("frame").dataset.state = "busy";
    this.isFull = false;
    clearTimeout(this.timer);
    this.timer = setTimeout(() => {
      if (this.isBusy) byId("progress").hidden = false;
    }, UNNOTICED);
    this.#say("waiting", null);
  }

  #arrived(frame) {
    if (frame.kind === PLANET || frame.tag === PLANET) {
      this.views.planetAspect = frame.width / frame.height;
      this.#keep("planet-now", { ...frame, kind: PLANET });
    } else {
      const light = lighting(frame);
      this.#keep("now", { ...frame, lighting: light, drawn: light.texels });
      this.dispatchEvent(new CustomEvent("command", { detail: frame.command }));
    }
    if (!frame.final) return;
    delete this.expected[frame.tag];
    this.isFull = !this.isBusy;
  }

  #keep(name, frame) {
    this.frames[name] = frame;
    this.views.renderer.setSky(name, frame);
    this.dispatchEvent(new CustomEvent("frame", { detail: { name, frame } }));
    this.views.redraw();
  }

  #progress({ stage, progress }) {
    this.#say(stage, progress);
  }

  #say(stage, progress) {
    const words = stage.charAt(0).toUpperCase() + stage.slice(1);
    const element = byId("progress-stage");
    if (element.textContent !== words) element.textContent = words;
    const bar = byId("progress-share");
    if (progress === null || progress === undefined) bar.removeAttribute("value");
    else bar.value = progress;
  }

  #failed({ tag, error, option }) {
    delete this.expected[tag];
    if (!this.isBusy) this.#end("fault");
    this.dispatchEvent(new CustomEvent("fault", { detail: { error, option } }));
  }

  #drawn() {
    if (this.isFull) this.#end("settled");
  }

  #end(state) {
    clearTimeout(this.timer);
    this.isFull = false;
    byId("progress").hidden = true;
    byId("frame").dataset.state = state;
  }

  #connection(state) {
    const words = {
      open: "",
      lost: "The server does not answer. What you see stays; trying again…",
      refused: "Another server runs here now: open the address that it printed.",
    };
    const element = byId("connection");
    if (element.textContent !== words[state]) element.textContent = words[state];
    element.classList.toggle("lost", state !== "open");
    if (state !== "open") byId("progress").hidden = true;
  }
}
