// Keyboard shortcuts, and the sheet that lists them.

import { byId, make } from "./dom.js";

const FIELDS = "input, select, textarea, [contenteditable]";

/** Listen for keys; `actions` are functions by name. */
export function startKeys(actions) {
  const keys = [
    ["Ctrl+Z", "Undo", actions.undo],
    ["Ctrl+Shift+Z", "Redo", actions.redo],
    ["Ctrl+Y", null, actions.redo],
    ["Ctrl+Enter", "Bake at full size", actions.bake],
    ...actions.views.map(([title, choose], index) => [String(index + 1), title, choose]),
    ["L", "Look toward the sun", actions.sun],
    ["F", "False colour in stops", actions.stops],
    ["B", "Balls in the corner", actions.balls],
    ["E", "Exposure as a camera meters, or held", actions.exposure],
    ["[", "Darker by a third of a stop", actions.darker],
    ["]", "Brighter by a third of a stop", actions.brighter],
    ["A", "Keep this sky as A", actions.keep],
    ["W", "Wipe between A and now", actions.wipe],
    ["S", "Exchange A and now", actions.swap],
    ["G", "Gallery of worlds", actions.gallery],
    ["/", "Find a knob", actions.find],
    ["C", "Copy the command", actions.copy],
    ["Escape", "Cancel what is being computed", actions.cancel],
    ["?", "This sheet", actions.help],
  ];
  const others = [
    ["Drag, arrows", "Look around"],
    ["Wheel, + −", "Zoom"],
    ["Shift+drag", "Put the sun there"],
    ["Double click", "Look as at first"],
  ];
  const listed = [...keys.filter(([, title]) => title), ...others];
  byId("keys-list").replaceChildren(...listed.flatMap(([name, title]) => [make("dt", {}, make("kbd", {}, name)), make("dd", {}, title)]));
  const byName = new Map(keys.map(([name, , action]) => [name.toLowerCase(), action]));
  document.addEventListener("keydown", (event) => {
    const isTyping = event.target.matches?.(FIELDS) && event.target.type !== "range";
    const isModified = event.ctrlKey || event.metaKey;
    if (event.altKey || (isTyping && !(isModified && event.key === "Enter")) || document.querySelector("dialog[open]")) return;
    const action = byName.get(nameOf(event, isModified));
    if (!action) return;
    event.preventDefault();
    action();
  });
}

function nameOf(event, isModified) {
  const shift = isModified && event.shiftKey ? "shift+" : "";
  return `${isModified ? "ctrl+" : ""}${shift}${event.key.toLowerCase()}`;
}
