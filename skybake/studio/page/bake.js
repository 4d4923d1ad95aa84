// The dialog that bakes maps at full size.

import { byId, make, say } from "./dom.js";

const NAMES = ["target", "projection", "cube-layout", "size", "colorspace", "sun-disc"];

/** Bakes with the knobs of the file, and lists what is being baked. */
export class Bake {
  constructor({ client, store, panel, options }) {
    Object.assign(this, { client, store, jobs: new Map() });
    const knobs = NAMES.filter((name) => options.has(name)).map((name) => panel.knob(options.get(name)));
    this.name = make("input", { type: "text", class: "value", id: "bake-name", value: "sky.exr", spellcheck: "false" });
    this.fault = make("p", { class: "fault", role: "alert", hidden: true });
    const name = make("div", { class: "knob" }, make("label", { for: "bake-name" }, "File in the working folder"), this.name);
    const actions = make("div", { class: "actions" }, make("button", { type: "submit", class: "primary" }, "Bake"));
    byId("bake-form").replaceChildren(...knobs.map((knob) => knob.element), name, this.fault, actions);
    byId("bake-form").addEventListener("submit", (event) => {
      event.preventDefault();
      this.bake();
    });
    byId("bake").addEventListener("click", () => this.open());
    client.addEventListener("bake", ({ detail }) => this.#told(detail));
    store.addEventListener("change", () => knobs.forEach((knob) => knob.show()));
  }

  open() {
    const preset = this.store.option("preset") ?? "earth";
    if (this.name.value === this.proposed || this.name.value === "sky.exr") this.name.value = `${preset}.exr`;
    this.proposed = this.name.value;
    byId("bake-dialog").showModal();
  }

  async bake() {
    this.fault.hidden = true;
    try {
      const { bake } = await this.client.post("/api/bake", { state: this.store.state, output: this.name.value.trim() });
      this.#job(bake, this.name.value.trim());
    } catch (fault) {
      this.fault.textContent = fault.message;
      this.fault.hidden = false;
    }
  }

  #job(id, name) {
    if (this.jobs.has(id)) return this.jobs.get(id);
    const text = make("span", {}, name ?? `Map ${id}`);
    const bar = make("progress", { max: 1, "aria-label": `Baking ${name ?? id}` });
    const cancel = make("button", { type: "button", onclick: () => this.client.cancelBake(id) }, "Cancel");
    const job = { name: name ?? `Map ${id}`, text, bar, cancel, element: make("li", {}, text, cancel, bar) };
    this.jobs.set(id, job);
    byId("bake-jobs").prepend(job.element);
    return job;
  }

  #told({ bake, stage, progress, done, files, folder, error, cancelled }) {
    const job = this.#job(bake);
    if (stage) job.text.textContent = `${job.name}: ${stage}`;
    if (typeof progress === "number") job.bar.value = progress;
    if (!done && !error && !cancelled) return;
    job.bar.remove();
    job.cancel.remove();
    job.text.className = error ? "fault" : "";
    job.text.textContent = error ?? (cancelled ? `${job.name}: cancelled` : `${files.join(", ")} in ${folder}`);
    say(job.text.textContent);
  }
}
