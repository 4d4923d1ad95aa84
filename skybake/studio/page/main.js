// Puts the page together.

import { Bake } from "./bake.js";
import { Client } from "./client.js";
import { CloudLayers } from "./clouds.js";
import { Compare } from "./compare.js";
import { SunPlace } from "./day.js";
import { byId, say } from "./dom.js";
import { Exposure } from "./exposure.js";
import { showFigures, showProbe } from "./figures.js";
import { Gallery } from "./gallery.js";
import { countBrightness, drawHistogram } from "./histogram.js";
import { startKeys } from "./keys.js";
import { fragment, readFragment } from "./link.js";
import { Live } from "./live.js";
import { Out } from "./out.js";
import { Panel } from "./panel.js";
import { startPointer } from "./pointer.js";
import { Renderer } from "./renderer.js";
import { Store } from "./store.js";
import { startTheme } from "./theme.js";
import { FIRST_LOOK, Views } from "./views.js";

const THIRD = 1 / 3;
const LINK_DELAY = 250;

async function start() {
  startTheme();
  const client = new Client();
  const renderer = new Renderer(byId("sky"));
  const { groups, presets } = await client.get("/api/options");
  const options = new Map(groups.flatMap((group) => group.options).map((option) => [option.name, option]));
  const store = new Store();
  const views = new Views(renderer);
  const linked = readFragment(location.hash, options);
  const preset = new URLSearchParams(location.search).get("preset");
  if (preset && !linked.state.options.preset) linked.state.options.preset = preset;
  store.begin(linked.state);

  const panel = new Panel(groups, store, client);
  const clouds = new CloudLayers(panel, store, client);
  new SunPlace(panel, store, client);
  const gallery = new Gallery(presets, store, client);
  const bake = new Bake({ client, store, panel, options });
  const exposure = new Exposure(store);
  const live = new Live(client, store, views);
  const out = new Out(client, store);
  const looks = new Looks(live, exposure, views);
  const compare = new Compare({ live, store, views, look: (isPlanet) => looks.now(isPlanet) });
  views.looks = (slot, isPlanet) => (slot === "a" ? compare.kept?.[isPlanet ? "planetLook" : "look"] : looks.now(isPlanet));
  byId("to-sun").addEventListener("click", () => looks.faceSun());

  startPointer(views, store, (found) => looks.probe(found));
  startKeys(actionsOf({ store, views, exposure, compare, gallery, bake, out, live, looks }));
  startHistory(store);
  live.addEventListener("frame", ({ detail }) => looks.arrived(detail));
  live.addEventListener("command", ({ detail }) => out.show(detail));
  live.addEventListener("fault", ({ detail }) => complain(panel, clouds, detail));
  live.addEventListener("frame", () => complain(panel, clouds, {}));
  startDisplay({ client, store, options, renderer, views });
  startLink({ store, views, options, view: linked.view });
  startWorld(panel, store);
  exposure.show();
  looks.probe(null);
  client.connect();
  live.ask();
  window.studio = { store, live, views, client };
}

/** How pictures are shown: brightness and white; and what is read from them. */
class Looks {
  constructor(live, exposure, views) {
    Object.assign(this, { live, exposure, views, found: null });
    exposure.store.addEventListener("change", () => this.show());
    document.addEventListener("theme", () => this.show());
  }

  /** Of the sky, or of the planet from afar, which is metered by itself. */
  now(isPlanet = false) {
    const frame = this.live.frames[isPlanet ? "planet-now" : "now"];
    if (!frame) return null;
    return { gain: this.exposure.gain(frame), balance: frame.figures?.white_balance ?? null };
  }

  /** Turn toward the sun. */
  faceSun() {
    const { sun_azimuth_deg: azimuth, sun_elevation_deg: elevation } = this.live.frames.now?.figures ?? {};
    if (Number.isFinite(azimuth)) this.views.lookAt({ azimuth, elevation: Math.max(FIRST_LOOK.elevation, elevation) });
  }

  arrived({ name, frame }) {
    if (name !== "now") return;
    this.exposure.meter(frame.figures?.ev_auto);
    this.bins = countBrightness(frame);
    showFigures(frame.figures ?? {});
    this.show();
    this.probe(this.found);
  }

  probe(found) {
    this.found = found;
    const frame = this.live.frames.now;
    showProbe(frame, this.views.kind === "planet" || this.views.kind === "set" ? null : found, frame ? this.exposure.gain(frame) : 1);
  }

  show() {
    this.exposure.show();
    const frame = this.live.frames.now;
    if (frame && this.bins) drawHistogram(this.bins, this.exposure.gain(frame));
    this.views.redraw();
  }
}

function actionsOf({ store, views, exposure, compare, gallery, bake, out, live, looks }) {
  const titles = { look: "Look around", equirect: "Equirect map", cross: "Cross of a cube", fisheye: "Fisheye", planet: "Planet from afar", set: "Grey and mirror ball" };
  return {
    undo: () => store.undo(),
    redo: () => store.redo(),
    bake: () => bake.open(),
    views: Views.kinds.map((kind) => [titles[kind], () => views.choose(kind)]),
    sun: () => looks.faceSun(),
    stops: () => views.toggleStops(),
    balls: () => views.toggleBalls(),
    exposure: () => exposure.toggle(),
    darker: () => exposure.move(-THIRD),
    brighter: () => exposure.move(THIRD),
    keep: () => compare.keep(),
    wipe: () => compare.toggle(),
    swap: () => compare.swap(),
    gallery: () => gallery.open(),
    find: () => byId("search").focus(),
    copy: () => out.copyCommand(),
    cancel: () => live.cancel(),
    help: () => byId("keys").showModal(),
  };
}

function startHistory(store) {
  byId("undo").addEventListener("click", () => store.undo());
  byId("redo").addEventListener("click", () => store.redo());
  byId("help").addEventListener("click", () => byId("keys").showModal());
  byId("reset").addEventListener("click", () => {
    const { preset } = store.state.options;
    store.replace({ options: preset ? { preset } : {}, set: {} });
  });
  byId("knobs").addEventListener("submit", (event) => event.preventDefault());
  const show = () => {
    byId("undo").disabled = !store.canUndo;
    byId("redo").disabled = !store.canRedo;
  };
  store.addEventListener("change", show);
  show();
}

function complain(panel, clouds, { error, option }) {
  clouds.complain(option === "clouds" ? error : null);
  const isShown = panel.complain(option, error) || (option === "clouds" && error);
  byId("notice").textContent = error ?? "";
  byId("notice").hidden = !error || isShown;
}

function startDisplay({ client, store, options, renderer, views }) {
  const usual = options.get("view")?.default ?? options.get("view")?.choices?.[0] ?? "aces1";
  let shown = null;
  const show = async () => {
    const wanted = store.option("view") ?? usual;
    if (wanted === shown) return;
    shown = wanted;
    try {
      const table = await client.display(wanted);
      if (shown === wanted) renderer.setDisplay(table);
      views.redraw();
    } catch (fault) {
      shown = null;
      say(fault.message);
    }
  };
  store.addEventListener("change", show);
  client.addEventListener("connection", ({ detail }) => detail === "open" && show());
  show();
}

function startLink({ store, views, options, view }) {
  const numbers = ["azimuth", "elevation", "fov"].filter((name) => Number.isFinite(Number.parseFloat(view[name])));
  views.lookAt(Object.fromEntries(numbers.map((name) => [name, Number(view[name])])));
  if (view.kind) views.choose(view.kind);
  let timer = null;
  const write = () => {
    clearTimeout(timer);
    timer = setTimeout(() => {
      const { azimuth, elevation, fov } = views.camera;
      const looked = { kind: views.kind, azimuth: azimuth.toFixed(1), elevation: elevation.toFixed(1), fov: fov.toFixed(1) };
      history.replaceState(null, "", `${location.pathname}${location.search}#${fragment(store.state, looked)}`);
    }, LINK_DELAY);
  };
  store.addEventListener("change", write);
  views.addEventListener("view", write);
  addEventListener("hashchange", () => {
    const now = readFragment(location.hash, options);
    store.replace(now.state);
    if (now.view.kind) views.choose(now.view.kind);
  });
}

function startWorld(panel, store) {
  let shown = null;
  const show = () => {
    const preset = store.option("preset") ?? "earth";
    if (preset === shown) return;
    shown = preset;
    panel.showWorld(preset);
  };
  store.addEventListener("change", show);
  show();
}

start().catch((fault) => {
  byId("notice").textContent = fault.message;
  byId("notice").hidden = false;
});
