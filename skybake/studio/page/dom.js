// Elements made and found in few words.

/** Element with an id of the page. */
export const byId = (id) => document.getElementById(id);

/**
 * Make an element. Names of `attributes` that begin with "on" are listeners, a boolean is a
 * property, `class` and all others attributes.
 */
export function make(tag, attributes = {}, ...children) {
  return furnished(document.createElement(tag), attributes, children);
}

/** The same for SVG. */
export function makeSvg(tag, attributes = {}, ...children) {
  return furnished(document.createElementNS("http://www.w3.org/2000/svg", tag), attributes, children);
}

function furnished(element, attributes, children) {
  for (const [name, value] of Object.entries(attributes)) {
    if (value === null || value === undefined) continue;
    if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
    else if (typeof value === "boolean") element[name] = value;
    else element.setAttribute(name, value);
  }
  element.append(...children.filter((child) => child !== null && child !== undefined));
  return element;
}

/** Say something to those who listen instead of looking. */
export function say(text) {
  byId("said").textContent = text;
}

/** Radio buttons side by side; arrow keys choose, as in any group of them. */
export function segments(container, choices, choose) {
  const buttons = choices.map(([value, title, hint]) =>
    make("button", {
      type: "button",
      role: "radio",
      "data-value": value,
      title: hint ?? null,
      onclick: () => choose(value),
      onkeydown: (event) => {
        const step = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 }[event.key];
        if (!step) return;
        event.preventDefault();
        const next = buttons.at((buttons.indexOf(event.currentTarget) + step) % buttons.length);
        next.focus();
        next.click();
      },
    }, title));
  container.replaceChildren(...buttons);
  return (value) => {
    for (const button of buttons) {
      const chosen = button.dataset.value === value;
      button.setAttribute("aria-checked", String(chosen));
      button.tabIndex = chosen ? 0 : -1;
    }
  };
}
