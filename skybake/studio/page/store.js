// What is set: options and values of the world, as typed on the command line; with undo.

const ONE_GESTURE = 900; // ms
const MOST_STEPS = 300;

/** Event: `change`. A state is `{options: {name: text}, set: {key: text}}`, of changes only. */
export class Store extends EventTarget {
  #state = { options: {}, set: {} };
  #past = [];
  #future = [];
  #gesture = { name: null, time: 0 };

  get state() {
    return this.#state;
  }

  get canUndo() {
    return this.#past.length > 0;
  }

  get canRedo() {
    return this.#future.length > 0;
  }

  option(name) {
    return this.#state.options[name];
  }

  /**
   * Change options and values; undefined takes one back. Changes by one gesture are undone together.
   */
  change({ options = {}, set = {} }, gesture = null) {
    const next = { options: merged(this.#state.options, options), set: merged(this.#state.set, set) };
    this.replace(next, gesture);
  }

  /** Set all at once. */
  replace(state, gesture = null) {
    if (same(state, this.#state)) return;
    const now = performance.now();
    const continued = gesture && gesture === this.#gesture.name && now - this.#gesture.time < ONE_GESTURE;
    this.#gesture = { name: gesture, time: now };
    if (!continued) this.#past = [...this.#past.slice(-MOST_STEPS), this.#state];
    this.#future = [];
    this.#become(state);
  }

  /** Begin with a state that cannot be undone. */
  begin(state) {
    this.#past = [];
    this.#future = [];
    this.#become(state);
  }

  undo() {
    if (!this.canUndo) return;
    this.#future.push(this.#state);
    this.#leave(this.#past.pop());
  }

  redo() {
    if (!this.canRedo) return;
    this.#past.push(this.#state);
    this.#leave(this.#future.pop());
  }

  #leave(state) {
    this.#gesture = { name: null, time: 0 };
    this.#become(state);
  }

  #become(state) {
    this.#state = state;
    this.dispatchEvent(new Event("change"));
  }
}

function merged(old, changes) {
  const result = { ...old, ...changes };
  for (const [name, value] of Object.entries(result)) {
    if (value === undefined || value === "" || (Array.isArray(value) && !value.length)) delete result[name];
  }
  return result;
}

function same(one, other) {
  return JSON.stringify(one) === JSON.stringify(other);
}
