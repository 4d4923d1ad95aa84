// The knobs on the left: a group for each that the server tells of, and the values of the world.

import { byId, make } from "./dom.js";
import { Knob } from "./knob.js";

const ORDER = ["Sun", "Time and place", "Observer", "Clouds", "World", "Moon", "Night", "Picture", "Sun's disc", "Map", "File"];
const OPEN = ["Sun", "Observer", "Clouds"];
const ELSEWHERE = ["preset", "set", "preview-ev"];

/** All knobs; `special` are elements by the name of the option whose knob they stand for. */
export class Panel {
  constructor(groups, store, client) {
    Object.assign(this, { store, client, knobs: new Map(), groups: [] });
    this.container = byId("groups");
    const ordered = [...groups].sort((one, other) => rank(one.title) - rank(other.title));
    for (const { title, options } of ordered) this.#group(title, options);
    byId("search").addEventListener("input", (event) => this.find(event.target.value));
    store.addEventListener("change", () => this.show());
  }

  /** Knob of an option that may also stand elsewhere, such as in the dialog of a bake. */
  knob(spec) {
    const { store, client } = this;
    const value = {
      get: () => store.option(spec.name),
      set: (text, gesture) => store.change({ options: { [spec.name]: text } }, gesture),
    };
    const knob = new Knob(spec, value, (text) => client.get("/api/parse", { option: spec.name, text }));
    const all = this.knobs.get(spec.name) ?? [];
    this.knobs.set(spec.name, [...all, knob]);
    return knob;
  }

  /** Group that holds an option, to which special widgets are added. */
  groupOf(name) {
    return this.groups.find((group) => group.names.has(name));
  }

  /** Put an element in the place of the knobs of some options. */
  replace(names, element) {
    const group = this.groupOf(names[0]);
    if (!group) return;
    group.body.prepend(element);
    for (const name of names) {
      for (const knob of this.knobs.get(name) ?? []) knob.element.remove();
    }
  }

  /** Hide knobs that have no effect for now. */
  setIdle(names, isIdle) {
    for (const name of names) {
      for (const knob of this.knobs.get(name) ?? []) knob.element.classList.toggle("idle", isIdle);
    }
    this.find(byId("search").value);
  }

  /** Values of a world as knobs in a group of their own. */
  async showWorld(preset) {
    let world;
    try {
      world = await this.client.get("/api/world", { preset });
    } catch {
      return; // What is wrong with the preset is said where its picture would be.
    }
    if ((this.store.option("preset") ?? "earth") !== preset) return;
    this.worldGroup?.element.remove();
    this.groups = this.groups.filter((group) => group !== this.worldGroup);
    const group = this.#frame("Air and ground", new Set());
    if (world.source) group.body.append(make("p", { class: "source" }, world.source));
    for (const value of world.values) group.add(this.#worldKnob(value));
    this.worldGroup = group;
    const before = this.groups.find((one) => one.title === "World") ?? this.groups.at(-1);
    this.groups = [...this.groups, group];
    before?.element.after(group.element);
    this.show();
  }

  /** Show what is set, and forget faults that no longer are. */
  show() {
    for (const group of this.groups) {
      for (const knob of group.knobs) knob.show();
      const count = group.knobs.filter((knob) => knob.value.get() !== undefined).length;
      group.changes.textContent = count ? `${count} changed` : "";
    }
  }

  /** Say a fault under the knob of an option; whether there is one. */
  complain(name, text) {
    for (const knobs of this.knobs.values()) for (const knob of knobs) if (knob.fromServer) knob.complain(null);
    const [knob] = this.knobs.get(name) ?? [];
    if (!knob || !text) return false;
    knob.complain(text);
    knob.fromServer = true;
    const group = this.groupOf(name);
    if (group) group.element.open = true;
    return true;
  }

  /** Show only knobs with a word in their name or help. */
  find(word) {
    const wanted = word.trim().toLowerCase();
    let found = 0;
    for (const group of this.groups) {
      let shown = 0;
      for (const knob of group.knobs) {
        const isIdle = knob.element.classList.contains("idle") && !wanted;
        const isShown = !isIdle && knob.matches(wanted);
        knob.element.hidden = !isShown;
        shown += isShown;
      }
      group.element.hidden = shown === 0 && (wanted !== "" || group.knobs.length > 0);
      if (wanted && shown) group.element.open = true;
      found += shown;
    }
    byId("nothing-found").hidden = found > 0;
  }

  #group(title, options) {
    const shown = options.filter((option) => option.live && !ELSEWHERE.includes(option.name));
    if (!shown.length) return;
    const group = this.#frame(title, new Set(options.map((option) => option.name)));
    for (const option of shown) group.add(this.knob(option));
    this.groups.push(group);
    this.container.append(group.element);
  }

  #frame(title, names) {
    const changes = make("span", { class: "changes" });
    const body = make("div", { class: "body" });
    const isOpen = OPEN.includes(title);
    const element = make("details", { class: "knob-group", open: isOpen }, make("summary", {}, title, changes), body);
    const group = { title, names, body, changes, element, knobs: [] };
    group.add = (knob) => {
      group.knobs.push(knob);
      body.append(knob.element);
    };
    return group;
  }

  #worldKnob(spec) {
    const { store } = this;
    const value = {
      get: () => store.state.set[spec.key],
      set: (text, gesture) => store.change({ set: { [spec.key]: text } }, gesture),
    };
    const check = (text) => this.client.get("/api/parse", { option: "set", text: `${spec.key}=${text}` });
    return new Knob({ kind: "number", name: spec.key, ...spec, unit: null, title: withUnit(spec) }, value, check);
  }
}

function rank(title) {
  const place = ORDER.indexOf(title);
  return place < 0 ? ORDER.length : place;
}

function withUnit({ title, unit }) {
  return unit ? `${title} [${unit}]` : title;
}
