// Two skies side by side: one that was kept, and that of now.

import { byId, say } from "./dom.js";

const STEP = 0.02;

/** Keeps a sky as A, and wipes between it and the sky of now. */
export class Compare {
  constructor({ live, store, views, look }) {
    Object.assign(this, { live, store, views, look, kept: null });
    byId("keep-a").addEventListener("click", () => this.keep());
    byId("wipe").addEventListener("click", () => this.toggle());
    byId("swap").addEventListener("click", () => this.swap());
    this.handle = byId("wipe-handle");
    this.handle.addEventListener("pointerdown", (event) => this.handle.setPointerCapture(event.pointerId));
    this.handle.addEventListener("pointermove", (event) => event.buttons && this.#drag(event));
    this.handle.addEventListener("keydown", (event) => this.#key(event));
  }

  /** Keep what is shown as A. */
  keep() {
    const frame = this.live.frames.now;
    if (!frame) return;
    this.kept = { state: this.store.state, look: this.look(false), planetLook: this.look(true) };
    this.views.renderer.setSky("a", frame);
    const planet = this.live.frames["planet-now"];
    if (planet) this.views.renderer.setSky("planet-a", planet);
    byId("wipe").disabled = byId("swap").disabled = false;
    say("This sky is kept as A");
    this.views.redraw();
  }

  toggle() {
    if (!this.kept) return;
    this.#wipe(this.views.wipe === null ? 0.5 : null);
  }

  /** Exchange A and now. */
  swap() {
    if (!this.kept) return;
    const { state } = this.kept;
    this.keep();
    this.store.replace(state);
  }

  #drag(event) {
    const box = this.views.canvas.getBoundingClientRect();
    this.#wipe(Math.min(1, Math.max(0, (event.clientX - box.left) / box.width)));
  }

  #key(event) {
    const step = { ArrowLeft: -STEP, ArrowRight: STEP }[event.key];
    if (!step) return;
    event.preventDefault();
    this.#wipe(Math.min(1, Math.max(0, this.views.wipe + step)));
  }

  #wipe(share) {
    const isShown = share !== null;
    this.views.wipe = share;
    byId("wipe").setAttribute("aria-pressed", String(isShown));
    for (const id of ["wipe-handle", "label-a", "label-b"]) byId(id).hidden = !isShown;
    if (isShown) {
      this.handle.style.left = `${share * 100}%`;
      this.handle.setAttribute("aria-valuenow", Math.round(share * 100));
    }
    this.views.redraw();
  }
}
