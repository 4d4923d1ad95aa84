// Looking around, zooming, and putting the sun somewhere: by mouse, finger and keys.

import { FIRST_LOOK } from "./views.js";

const SUN_NAMES = { azimuth: "sun-azimuth", elevation: "sun" };
const TURN = 5;
const ZOOM = 1.12;
const ALL_AROUND = 360;

/** Listens to the canvas of `views`; `probe(direction)` is told what is under the cursor. */
export function startPointer(views, store, probe) {
  const { canvas } = views;
  const fingers = new Map();
  let spread = null;

  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    fingers.set(event.pointerId, event);
    spread = spreadOf(fingers);
    canvas.classList.add(event.shiftKey ? "picking" : "turning");
    if (event.shiftKey) putSun(views, store, event);
  });
  canvas.addEventListener("pointermove", (event) => {
    const last = fingers.get(event.pointerId);
    if (!last) {
      probe(views.directionUnder(event.clientX, event.clientY));
      return;
    }
    fingers.set(event.pointerId, event);
    if (fingers.size === 2) spread = pinch(views, spread, spreadOf(fingers));
    else if (event.shiftKey) putSun(views, store, event);
    else drag(views, event.clientX - last.clientX, event.clientY - last.clientY);
    probe(views.directionUnder(event.clientX, event.clientY));
  });
  for (const end of ["pointerup", "pointercancel"]) {
    canvas.addEventListener(end, (event) => {
      fingers.delete(event.pointerId);
      spread = spreadOf(fingers);
      canvas.classList.remove("turning", "picking");
    });
  }
  canvas.addEventListener("pointerleave", () => probe(null));
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    views.zoom(ZOOM ** Math.sign(event.deltaY));
  }, { passive: false });
  canvas.addEventListener("keydown", (event) => key(views, event));
  canvas.addEventListener("dblclick", () => views.lookAt(FIRST_LOOK));
}

function drag(views, right, down) {
  if (views.kind === "look") views.turn(-right * views.degreesPerPixel, down * views.degreesPerPixel);
  else if (views.kind === "set") views.turn((-right * ALL_AROUND) / views.canvas.clientWidth, 0);
}

function pinch(views, before, now) {
  if (before && now) views.zoom(before / now);
  return now;
}

/** How far apart two fingers are, or null if there are not two. */
function spreadOf(fingers) {
  if (fingers.size !== 2) return null;
  const [one, other] = fingers.values();
  return Math.hypot(one.clientX - other.clientX, one.clientY - other.clientY);
}

function putSun(views, store, event) {
  const found = views.directionUnder(event.clientX, event.clientY);
  if (!found || store.option("time") !== undefined) return;
  const options = {
    [SUN_NAMES.elevation]: `${found.elevation.toFixed(1)}deg`,
    [SUN_NAMES.azimuth]: `${found.azimuth.toFixed(1)}deg`,
  };
  store.change({ options }, "put the sun");
}

function key(views, event) {
  const step = event.shiftKey ? TURN / 5 : TURN;
  const turns = { ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, step], ArrowDown: [0, -step] }[event.key];
  const zoom = { "+": 1 / ZOOM, "=": 1 / ZOOM, "-": ZOOM }[event.key];
  if (turns) views.turn(...turns);
  else if (zoom) views.zoom(zoom);
  else return;
  event.preventDefault();
}
