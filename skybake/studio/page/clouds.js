// Layers of clouds: kind, cover, and whatever else the command line takes.

import { make } from "./dom.js";
import { titleOf } from "./knob.js";

const KINDS = ["cumulus", "stratocumulus", "stratus", "altocumulus", "cirrus"];
const USUAL = { cumulus: 0.4, stratocumulus: 0.7, stratus: 1, altocumulus: 0.5, cirrus: 0.4 };
const NONE = "none";
const LAYER = /^([a-z]+)(?::([^,]*))?(?:,(.*))?$/;

/** Widget of the option `clouds`. */
export class CloudLayers {
  constructor(panel, store, client) {
    Object.assign(this, { store, client });
    this.list = make("div", {});
    this.fault = make("p", { class: "fault", role: "alert", hidden: true });
    const kinds = make("select", { "aria-label": "Kind of clouds to add" }, ...KINDS.map((kind) => make("option", { value: kind }, kind)));
    const add = () => this.#write([...this.layers, `${kinds.value}:${USUAL[kinds.value]}`]);
    this.clear = make("button", { type: "button", title: "Without the world's own clouds", onclick: () => this.#toggleNone() }, "No clouds of the world");
    const buttons = make("div", { class: "row" }, kinds, make("button", { type: "button", onclick: add }, "Add layer"), this.clear);
    this.element = make("div", { class: "clouds" }, this.list, this.fault, buttons);
    panel.replace(["clouds"], this.element);
    store.addEventListener("change", () => this.show());
    this.show();
  }

  get layers() {
    return this.#given().filter((layer) => layer !== NONE);
  }

  /** Say what is wrong with the layers. */
  complain(text) {
    this.fault.textContent = text ?? "";
    this.fault.hidden = !text;
  }

  show() {
    this.clear.setAttribute("aria-pressed", String(this.#given().includes(NONE)));
    const key = JSON.stringify(this.layers.map((layer) => LAYER.exec(layer)?.[1] ?? layer));
    if (key !== this.shown || !this.list.contains(document.activeElement)) {
      this.list.replaceChildren(...this.layers.map((layer, index) => this.#layer(layer, index)));
      this.shown = key;
    }
  }

  #given() {
    return this.store.option("clouds") ?? [];
  }

  #layer(layer, index) {
    const [, kind, cover, rest] = LAYER.exec(layer) ?? [];
    const remove = make("button", { type: "button", "aria-label": `Remove ${kind ?? layer}`, onclick: () => this.#write(this.layers.filter((_, other) => other !== index)) }, "×");
    const text = make("input", { type: "text", class: "wide", spellcheck: "false", "aria-label": "Layer as on the command line", value: layer, onchange: (event) => this.#typed(event.target, index) });
    if (!kind) return make("div", { class: "layer" }, make("strong", {}, layer), remove, text);
    const share = shareOf(cover, USUAL[kind] ?? 0.5);
    const output = make("output", {}, `${Math.round(share * 100)} %`);
    const slide = (event) => {
      output.textContent = `${Math.round(event.target.valueAsNumber * 100)} %`;
      text.value = [`${kind}:${event.target.value}`, rest].filter(Boolean).join(",");
      this.#write(this.layers.map((old, other) => (other === index ? text.value : old)), `clouds-${index}`);
    };
    const slider = make("input", { type: "range", min: 0, max: 1, step: 0.05, value: share, "aria-label": `Cover of ${kind}`, oninput: slide });
    return make("div", { class: "layer" }, make("strong", {}, titleOf(kind)), remove, slider, output, text);
  }

  async #typed(field, index) {
    const text = field.value.trim();
    const answer = text ? await this.client.get("/api/parse", { option: "clouds", text }) : {};
    field.setAttribute("aria-invalid", String(Boolean(answer.error)));
    this.complain(answer.error);
    if (answer.error) return;
    this.#write(this.layers.map((old, other) => (other === index ? text : old)).filter(Boolean));
  }

  #toggleNone() {
    const given = this.#given();
    this.store.change({ options: { clouds: given.includes(NONE) ? this.layers : [NONE, ...given] } });
  }

  #write(layers, gesture = null) {
    this.complain(null);
    const none = this.#given().filter((layer) => layer === NONE);
    this.store.change({ options: { clouds: [...none, ...layers] } }, gesture);
  }
}

function shareOf(cover, usual) {
  if (!cover) return usual;
  const okta = /^([\d.]+)\s*okta$/.exec(cover);
  const share = okta ? Number(okta[1]) / 8 : Number(cover);
  return Number.isFinite(share) ? share : usual;
}
