// The state in the address, readable: #preset=mars&sun=5deg&set.mie.scale=2&view.kind=fisheye

const SET = "set.";
const VIEW = "view.";

/** Fragment of an address that holds a state and how it is looked at. */
export function fragment(state, view) {
  const parameters = new URLSearchParams();
  for (const [name, value] of Object.entries(state.options)) {
    for (const one of Array.isArray(value) ? value : [value]) parameters.append(name, String(one));
  }
  for (const [key, value] of Object.entries(state.set)) parameters.append(SET + key, value);
  for (const [key, value] of Object.entries(view)) parameters.append(VIEW + key, String(value));
  return parameters.toString();
}

/** State and view of such a fragment; names that no option has are left out. */
export function readFragment(text, options) {
  const state = { options: {}, set: {} };
  const view = {};
  for (const [name, value] of new URLSearchParams(text.replace(/^#/, ""))) {
    if (name.startsWith(VIEW)) view[name.slice(VIEW.length)] = value;
    else if (name.startsWith(SET)) state.set[name.slice(SET.length)] = value;
    else if (!options.has(name)) continue;
    else if (options.get(name).multiple) (state.options[name] ??= []).push(value);
    else if (options.get(name).kind === "flag") state.options[name] = value === "true";
    else state.options[name] = value;
  }
  return { state, view };
}
