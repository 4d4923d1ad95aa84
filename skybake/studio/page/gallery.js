// Worlds as pictures.

import { byId, make, say } from "./dom.js";

const OF_A_WORLD = ["clouds", "visibility", "turbidity", "ozone", "ground-albedo", "airglow"];
const OF_A_PLACE = ["time", "date", "lat", "lon", "tz", "site", "ls", "refraction", "moon", "eclipse", "lst"];

/** Button with the world of now, and the dialog from which another is chosen. */
export class Gallery {
  constructor(presets, store, client) {
    Object.assign(this, { presets, store, client });
    this.dialog = byId("gallery");
    this.items = presets.map((preset) => this.#item(preset));
    byId("gallery-list").replaceChildren(...this.items.map((item) => item.element));
    byId("world").addEventListener("click", () => this.open());
    byId("gallery-search").addEventListener("input", (event) => this.#find(event.target.value.trim().toLowerCase()));
    store.addEventListener("change", () => this.show());
    this.show();
  }

  open() {
    this.dialog.showModal();
    byId("gallery-search").focus();
  }

  show() {
    const name = this.store.option("preset") ?? "earth";
    for (const { preset, button } of this.items) button.setAttribute("aria-current", String(preset.name === name));
    if (name === this.shown) return;
    this.shown = name;
    const preset = this.presets.find((one) => one.name === name);
    byId("world-title").textContent = preset?.title ?? name;
    byId("world-summary").textContent = preset?.summary || "a world of your own";
    byId("world-picture").hidden = !preset;
    if (preset) byId("world-picture").src = this.client.address(preset.picture);
  }

  #item(preset) {
    const picture = make("img", { alt: "", fetchpriority: "low", src: this.client.address(preset.picture), width: 240, height: 120 });
    const lines = [make("span", {}, sentence(preset.summary) || preset.title), make("small", {}, preset.summary ? `${preset.title} · ${preset.name}` : preset.name)];
    const button = make("button", { type: "button", "data-preset": preset.name, onclick: () => this.#choose(preset) }, picture, ...lines);
    return { preset, button, element: make("li", {}, button) };
  }

  #choose(preset) {
    this.dialog.close();
    const now = this.store.state;
    const options = { ...now.options, preset: preset.name };
    const isElsewhere = isMars(now.options.preset) !== isMars(preset.name);
    for (const name of [...OF_A_WORLD, ...(isElsewhere ? OF_A_PLACE : [])]) delete options[name];
    this.store.replace({ options, set: {} });
    say(`${preset.title} chosen`);
  }

  #find(word) {
    for (const { preset, element } of this.items) {
      element.hidden = ![preset.name, preset.title, preset.summary].join(" ").toLowerCase().includes(word);
    }
  }
}

function sentence(words) {
  return words ? words.charAt(0).toUpperCase() + words.slice(1) : "";
}

function isMars(name) {
  return (name ?? "earth").startsWith("mars");
}
