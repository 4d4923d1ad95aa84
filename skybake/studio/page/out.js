// What one takes along: command, preset, Python, link.

import { byId, make, say } from "./dom.js";

const TEXTS = [
  ["command", "Command line", null],
  ["toml", "Preset as TOML", "world.toml"],
  ["python", "Python", "sky.py"],
];

/** Footer and dialog of what the state is written as. */
export class Out {
  constructor(client, store) {
    Object.assign(this, { client, store });
    byId("copy-command").addEventListener("click", () => this.copyCommand());
    byId("copy-link").addEventListener("click", () => copy(location.href, "Link"));
    byId("more-out").addEventListener("click", () => this.open());
  }

  /** Show the command of a picture. */
  show(command) {
    if (command) byId("command").textContent = command;
  }

  /** Copy the command of what is set now, which may be newer than the picture. */
  async copyCommand() {
    try {
      const { command } = await this.client.post("/api/command", { state: this.store.state });
      this.show(command);
      await copy(command, "Command");
    } catch (fault) {
      say(fault.message);
    }
  }

  async open() {
    byId("out-texts").replaceChildren(make("p", { class: "quiet" }, "Writing…"));
    byId("out").showModal();
    try {
      const texts = await this.client.post("/api/command", { state: this.store.state });
      const shown = TEXTS.filter(([key]) => texts[key]);
      byId("out-texts").replaceChildren(...shown.map(([key, title, file]) => section(title, texts[key], file)));
    } catch (fault) {
      byId("out-texts").replaceChildren(make("p", { class: "fault" }, fault.message));
    }
  }
}

function section(title, text, file) {
  const buttons = [make("button", { type: "button", onclick: () => copy(text, title) }, "Copy")];
  if (file) buttons.push(make("button", { type: "button", onclick: () => download(text, file) }, `Save ${file}`));
  return make("section", {}, make("header", {}, make("h3", {}, title), ...buttons), make("pre", { tabindex: 0, role: "group", "aria-label": title }, text));
}

async function copy(text, what) {
  try {
    await navigator.clipboard.writeText(text);
  } catch {
    copyBySelection(text);
  }
  say(`${what} copied`);
  flash(`${what} copied`);
}

// In a frame of a notebook the clipboard may be denied, and only a selection can be copied.
function copyBySelection(text) {
  const field = make("textarea", { class: "unseen" });
  field.value = text;
  document.body.append(field);
  field.select();
  document.execCommand("copy");
  field.remove();
}

let restore = null;

function flash(text) {
  const button = byId("copy-command");
  clearTimeout(restore);
  button.textContent = text;
  restore = setTimeout(() => {
    button.textContent = "Copy";
  }, 1400);
}

function download(text, name) {
  const address = URL.createObjectURL(new Blob([text], { type: "text/plain" }));
  make("a", { href: address, download: name }).click();
  URL.revokeObjectURL(address);
}
