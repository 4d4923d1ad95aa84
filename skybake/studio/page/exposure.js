// How bright a picture is shown, by the option preview-ev or as a camera meters.

import { byId } from "./dom.js";

const NAME = "preview-ev";
const SATURATION = 1.2; // cd m-2 that an exposure value of 0 brings to 1; ISO 2720, ISO 12232

/** Slider of the exposure, and the factor on a picture that it stands for. */
export class Exposure {
  constructor(store) {
    this.store = store;
    this.slider = byId("exposure");
    this.slider.addEventListener("input", () => this.#set(this.slider.valueAsNumber.toFixed(1)));
    byId("exposure-auto").addEventListener("click", () => this.toggle());
    this.metered = 14;
  }

  /** Exposure value at ISO 100. */
  get ev() {
    const typed = Number(this.store.option(NAME));
    return this.isAuto || !Number.isFinite(typed) ? this.metered : typed;
  }

  get isAuto() {
    const typed = this.store.option(NAME);
    return typed === undefined || typed === "auto";
  }

  /** Factor from texels of a frame to scene-linear values. */
  gain(frame) {
    return gainOf(frame, this.isAuto ? (frame.figures?.ev_auto ?? this.metered) : this.ev);
  }

  /** Take what a camera would meter. */
  meter(ev) {
    if (Number.isFinite(ev)) this.metered = ev;
    this.show();
  }

  toggle() {
    this.#set(this.isAuto ? this.metered.toFixed(1) : undefined);
  }

  /** Brighter or darker by stops. */
  move(stops) {
    this.#set((this.ev - stops).toFixed(1));
  }

  show() {
    const text = `EV ${this.ev.toFixed(1)}`;
    this.slider.value = this.ev;
    this.slider.setAttribute("aria-valuetext", text);
    byId("exposure-text").textContent = text;
    byId("exposure-auto").setAttribute("aria-pressed", String(this.isAuto));
  }

  #set(text) {
    this.store.change({ options: { [NAME]: text } }, "exposure");
  }
}

/** Factor from texels of a frame to scene-linear values at an exposure value. */
export function gainOf(frame, ev) {
  return frame.scale / (SATURATION * 2 ** ev);
}
