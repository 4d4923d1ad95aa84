// Talks to the server: requests over HTTP, pictures and progress over one WebSocket.

import { readFrame } from "./frame.js";

const FIRST_WAIT = 400;
const LONGEST_WAIT = 4000;

/**
 * Events: `frame`, `progress`, `fault`, `bake` with what the server said in `detail`;
 * `connection` with "open", "lost" or "refused".
 */
export class Client extends EventTarget {
  #token = new URLSearchParams(location.search).get("token") ?? "";
  #socket = null;
  #id = 0;
  #wait = FIRST_WAIT;
  #latest = new Map();
  #tags = new Map();

  /** Address of something on the server, with the token. */
  address(path, query = {}) {
    const parameters = new URLSearchParams({ ...query, token: this.#token });
    return `${path}?${parameters}`;
  }

  /** JSON of a GET request; throws what the server says is wrong. */
  async get(path, query) {
    return answer(await fetch(this.address(path, query)));
  }

  /** JSON of a POST request; throws what the server says is wrong. */
  async post(path, body) {
    const headers = { "Content-Type": "application/json" };
    return answer(await fetch(this.address(path), { method: "POST", headers, body: JSON.stringify(body) }));
  }

  /** Table of a display transform. */
  async display(view) {
    const response = await fetch(this.address("/api/display", { view }));
    if (!response.ok) throw new Error(`display: ${response.status} ${response.statusText}`);
    return readFrame(await response.arrayBuffer());
  }

  /** Open the socket, and again whenever it is lost. */
  connect() {
    const scheme = location.protocol === "https:" ? "wss" : "ws";
    const socket = new WebSocket(`${scheme}://${location.host}${this.address("/api/live")}`);
    socket.binaryType = "arraybuffer";
    socket.addEventListener("open", () => this.#opened());
    socket.addEventListener("message", (event) => this.#received(event.data));
    socket.addEventListener("close", () => this.#closed());
    this.#socket = socket;
  }

  /** Ask for a picture; an older request with the same tag is dropped. Returns its number. */
  request(tag, state, view) {
    this.#id += 1;
    const message = { id: this.#id, state, view, tag };
    this.#latest.set(tag, message);
    this.#tags.set(this.#id, tag);
    this.#send(message);
    return this.#id;
  }

  /** No longer want the picture of a tag. */
  stop(tag) {
    this.#latest.delete(tag);
    this.#send({ stop: tag });
  }

  /** Cancel a bake. */
  cancelBake(id) {
    this.#send({ cancel: id });
  }

  #send(message) {
    if (this.#socket?.readyState === WebSocket.OPEN) this.#socket.send(JSON.stringify(message));
  }

  #opened() {
    this.#wait = FIRST_WAIT;
    this.#tell("connection", "open");
    for (const message of this.#latest.values()) this.#send(message);
  }

  async #closed() {
    let refused = false;
    try {
      refused = (await fetch(this.address("/"), { method: "HEAD" })).status === 403;
    } catch {
      // The server is not there; it is asked again below.
    }
    this.#tell("connection", refused ? "refused" : "lost");
    setTimeout(() => this.connect(), this.#wait);
    this.#wait = Math.min(LONGEST_WAIT, this.#wait * 1.6);
  }

  #received(data) {
    if (typeof data !== "string") {
      this.#ifLatest("frame", readFrame(data));
      return;
    }
    const message = JSON.parse(data);
    if ("bake" in message) this.#tell("bake", message);
    else if (message.error) this.#ifLatest("fault", message);
    else if (message.stage) this.#ifLatest("progress", message);
  }

  #ifLatest(type, message) {
    const tag = this.#tags.get(message.id);
    if (this.#latest.get(tag)?.id !== message.id) return;
    this.#tell(type, { ...message, tag });
  }

  #tell(type, detail) {
    this.dispatchEvent(new CustomEvent(type, { detail }));
  }
}

async function answer(response) {
  const text = await response.text();
  let body = {};
  try {
    body = JSON.parse(text);
  } catch {
    body = { error: text };
  }
  if (!response.ok) throw new Error(body.error || `${response.status} ${response.statusText}`);
  return body;
}
