// The picture in the middle: which view, where it looks, what is drawn.

import { BANDS } from "./colour.js";
import { byId, make, segments } from "./dom.js";
import { ASPECT, angles, directionAt, fitted, halfHeight } from "./geometry.js";

const KINDS = [
  ["look", "Look", "Drag to look around (1)"],
  ["equirect", "Equirect", "The whole map (2)"],
  ["cross", "Cross", "Faces of a cube (3)"],
  ["fisheye", "Fisheye", "The sky above (4)"],
  ["planet", "Planet", "From afar (5)"],
  ["set", "Set", "Grey and mirror ball (6)"],
];
const WIDEST = 130;
const NARROWEST = 4;
const INSET = [0.34, 250, 1.7];
/** Where one looks at first: the sun at the left, if it is in the south. */
export const FIRST_LOOK = { azimuth: 212, elevation: 11, fov: 80 };

/** Events: `view` when another kind is chosen or the camera was moved, `drawn` after each picture. */
export class Views extends EventTarget {
  camera = { ...FIRST_LOOK };
  kind = "look";
  isFalse = false;
  hasBalls = true;
  wipe = null;
  #pending = false;

  constructor(renderer) {
    super();
    this.renderer = renderer;
    this.canvas = renderer.canvas;
    this.markKind = segments(byId("view-kinds"), KINDS, (kind) => this.choose(kind));
    byId("stops").addEventListener("click", () => this.toggleStops());
    byId("balls").addEventListener("click", () => this.toggleBalls());
    byId("legend").replaceChildren(...BANDS.map((colour, index) => legendOf(colour, index - 8)));
    new ResizeObserver(() => this.redraw()).observe(this.canvas);
    this.choose("look");
  }

  /** Kinds of view in order. */
  static get kinds() {
    return KINDS.map(([kind]) => kind);
  }

  choose(kind) {
    if (!Views.kinds.includes(kind)) return;
    this.kind = kind;
    this.markKind(kind);
    this.changed();
  }

  /** Stops about middle grey in the place of the picture, or back. */
  toggleStops() {
    this.isFalse = !this.isFalse;
    byId("stops").setAttribute("aria-pressed", String(this.isFalse));
    byId("legend").hidden = !this.isFalse;
    this.redraw();
  }

  toggleBalls() {
    this.hasBalls = !this.hasBalls;
    byId("balls").setAttribute("aria-pressed", String(this.hasBalls));
    this.redraw();
  }

  /** Turn by degrees. */
  turn(right, up) {
    const { azimuth, elevation } = this.camera;
    this.camera.azimuth = (azimuth + right + 360) % 360;
    this.camera.elevation = Math.min(90, Math.max(-90, elevation + up));
    this.changed();
  }

  zoom(factor) {
    this.camera.fov = Math.min(WIDEST, Math.max(NARROWEST, this.camera.fov * factor));
    this.changed();
  }

  lookAt(camera) {
    Object.assign(this.camera, camera);
    this.changed();
  }

  /** Degrees by which a view turns when dragged over a pixel of the page. */
  get degreesPerPixel() {
    return this.camera.fov / Math.max(1, this.canvas.clientWidth);
  }

  changed() {
    this.redraw();
    const { azimuth, elevation, fov } = this.camera;
    const isAimed = this.kind === "look" || this.kind === "set";
    byId("looking").hidden = !isAimed;
    byId("look").textContent = `${azimuth.toFixed(0)}°, ${elevation.toFixed(0)}°, ${fov.toFixed(0)}° wide`;
    this.dispatchEvent(new Event("view"));
  }

  /** Bearing and elevation under a place of the page, or null. */
  directionUnder(clientX, clientY) {
    const box = this.canvas.getBoundingClientRect();
    const [x, y, width, height] = this.#rectangle(box.width, box.height);
    const aspect = width / height;
    const camera = { ...this.camera, half: halfHeight(this.camera, aspect) };
    const found = directionAt(this.kind, camera, (clientX - box.left - x) / width, (clientY - box.top - y) / height, aspect);
    return found && angles(found);
  }

  redraw() {
    if (this.#pending) return;
    this.#pending = true;
    requestAnimationFrame(() => {
      this.#pending = false;
      this.draw();
    });
  }

  #rectangle(width, height) {
    const aspect = this.kind === "planet" ? this.planetAspect : ASPECT[this.kind];
    return aspect ? fitted(aspect, width, height) : [0, 0, width, height];
  }

  /** Draw now what is there. */
  draw() {
    const { renderer, canvas } = this;
    renderer.fit();
    renderer.clear();
    const { width, height } = canvas;
    const rectangle = this.#rectangle(width, height);
    const split = this.wipe === null ? 0 : width * this.wipe;
    const isDrawn = this.#part("now", rectangle, [split, 0, width - split, height]);
    if (split > 0) this.#part("a", rectangle, [0, 0, split, height]);
    if (this.hasBalls && this.kind !== "set") this.#inset(width, height);
    if (isDrawn) this.dispatchEvent(new Event("drawn"));
  }

  #part(slot, rectangle, clip) {
    const isPlanet = this.kind === "planet";
    const name = isPlanet ? `planet-${slot}` : slot;
    const look = this.looks?.(slot, isPlanet);
    if (!look) return false;
    const { kind, camera, isFalse } = this;
    return this.renderer.draw(name, { ...look, kind, camera, isFalse, rectangle, clip });
  }

  #inset(width, height) {
    const look = this.looks?.("now");
    if (!look) return;
    const scale = width / this.canvas.clientWidth;
    const [share, most, aspect] = INSET;
    const w = Math.min(share * width, most * scale);
    const h = w / aspect;
    const gap = 10 * scale;
    const inner = [width - w - gap, height - h - gap, w, h];
    this.renderer.fill([inner[0] - scale, inner[1] - scale, w + 2 * scale, h + 2 * scale], [0.75, 0.75, 0.75]);
    this.renderer.draw("now", { ...look, kind: "set", camera: this.camera, isFalse: this.isFalse, rectangle: inner });
  }
}

function legendOf(colour, stops) {
  const text = stops === 0 ? "grey" : stops > 0 ? `+${stops}` : String(stops);
  const entry = make("span", {}, text);
  entry.style.background = colour;
  if (stops < -3 || stops === 7) entry.style.color = "#fff";
  return entry;
}
