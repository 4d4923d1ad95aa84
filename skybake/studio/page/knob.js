// One knob: a label, what is typed, a slider where there is a range, help, and what is wrong.

import { make } from "./dom.js";
import { SliderScale, readQuantity, writeQuantity } from "./scale.js";

const RANGED = new Set(["angle", "length", "number", "integer", "duration"]);
const LONG = new Set(["text", "list", "size", "direction", "time", "date", "moon", "zone"]);
const BIG_STEP = 10;
let made = 0;

/**
 * Knob of an option or of a value of the world.
 *
 * `spec` is what the server tells of it; `value` has `get()` and `set(text, gesture)`, where
 * undefined stands for the default; `check(text)` resolves to `{value}` or `{error}`.
 */
export class Knob {
  constructor(spec, value, check) {
    made += 1;
    Object.assign(this, { spec, value, check, id: `knob-${made}` });
    this.fault = make("p", { class: "fault", id: `${this.id}-fault`, role: "alert", hidden: true });
    this.note = make("p", { class: "note quiet", id: `${this.id}-note`, hidden: true }, "Shown in what is baked, not in this view.");
    this.help = make("div", { class: "help", id: `${this.id}-help`, hidden: true }, ...helpOf(spec));
    this.field = this.#field();
    this.slider = this.#slider();
    this.element = make(
      "div",
      { class: "knob", "data-knob": spec.name },
      make("label", { for: this.id, title: spec.help ?? null }, spec.title ?? titleOf(spec.name)),
      this.field,
      make("button", { type: "button", class: "icon undo", title: "Back to the default", "aria-label": `Default of ${spec.name}`, onclick: () => this.#set(undefined) }, "↺"),
      this.#helpButton(),
      this.slider?.element,
      this.fault,
      this.note,
      this.help,
    );
    if (this.#isLong()) this.element.classList.add("long");
    this.show();
  }

  /** Show what is set. */
  show() {
    const given = this.value.get();
    this.element.classList.toggle("changed", given !== undefined);
    this.note.hidden = given === undefined || !this.spec.unseen;
    if (!this.isPending && !(this.hasFault && document.activeElement === this.field)) this.#fill(given);
    this.slider?.show(this.#number(given));
  }

  /** Say what is wrong with it, or nothing. */
  complain(text) {
    this.hasFault = Boolean(text);
    this.fault.textContent = text ?? "";
    this.fault.hidden = !text;
    this.field.setAttribute("aria-invalid", String(this.hasFault));
  }

  /** Whether its name or help has a word. */
  matches(word) {
    const { name, title, help, key } = this.spec;
    return [name, title, help, key].join(" ").toLowerCase().includes(word);
  }

  #isLong() {
    const { kind, multiple, choices } = this.spec;
    if (multiple) return true;
    return kind === "choice" ? choices.some((choice) => choice.length > 14) : LONG.has(kind);
  }

  #field() {
    const { kind, choices } = this.spec;
    const common = { id: this.id, class: "value", "aria-describedby": `${this.id}-help ${this.id}-fault ${this.id}-note` };
    if (kind === "flag") return this.#flag(common);
    if (kind === "choice" && choices) {
      const shown = choices.map((choice) => make("option", { value: choice }, choice));
      const chosen = (event) => this.#set(event.target.value || undefined);
      return make("select", { ...common, onchange: chosen }, make("option", { value: "" }, defaultText(this.spec)), ...shown);
    }
    return make("input", {
      ...common,
      type: "text",
      spellcheck: "false",
      inputmode: kind === "integer" || kind === "number" ? "text" : null,
      placeholder: defaultText(this.spec),
      onchange: () => this.#typed(),
      onkeydown: (event) => this.#key(event),
    });
  }

  #flag(common) {
    if ((this.spec.flags ?? []).length < 2) {
      return make("input", { ...common, class: "", type: "checkbox", onchange: (event) => this.#set(event.target.checked || undefined) });
    }
    const choices = [["", defaultText(this.spec)], ["true", "on"], ["false", "off"]];
    const chosen = (event) => this.#set(event.target.value === "" ? undefined : event.target.value === "true");
    return make("select", { ...common, onchange: chosen }, ...choices.map(([value, text]) => make("option", { value }, text)));
  }

  #fill(given) {
    if (this.field.type === "checkbox") this.field.checked = Boolean(given);
    else this.field.value = textOf(given);
  }

  #slider() {
    const { min, max, kind, unit } = this.spec;
    const ranged = RANGED.has(kind);
    if (!ranged || !Number.isFinite(min) || !Number.isFinite(max) || max <= min) return null;
    const scale = new SliderScale(this.spec);
    const input = make("input", {
      type: "range",
      min: 0,
      max: 1,
      step: "any",
      "aria-label": `${this.spec.title ?? titleOf(this.spec.name)}, slider`,
      oninput: () => this.#set(writeQuantity(scale.value(input.valueAsNumber), unit), true),
      onkeydown: (event) => this.#slideByKey(event, scale, input),
    });
    const element = make(
      "div",
      { class: "slider" },
      make("span", { "aria-hidden": "true" }, writeQuantity(min, unit)),
      input,
      make("span", { "aria-hidden": "true" }, writeQuantity(max, unit)),
    );
    return {
      element,
      show: (number) => {
        const shown = number ?? this.spec.default ?? min;
        element.classList.toggle("unset", number === null && !Number.isFinite(this.spec.default));
        if (document.activeElement !== input || Math.abs(scale.value(input.valueAsNumber) - shown) > 1e-9) {
          input.value = scale.place(shown);
        }
        input.setAttribute("aria-valuetext", writeQuantity(shown, unit));
      },
    };
  }

  #slideByKey(event, scale, input) {
    const sign = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1, PageUp: BIG_STEP, PageDown: -BIG_STEP }[event.key];
    if (!sign) return;
    event.preventDefault();
    const now = this.#number(this.value.get()) ?? this.spec.default ?? scale.min;
    const next = scale.isLog ? scale.value(scale.place(now) + 0.01 * sign) : now + sign * scale.step * (event.shiftKey ? 1 : 5);
    const held = Math.min(scale.max, Math.max(scale.min, next));
    input.value = scale.place(held);
    this.#set(writeQuantity(Number(held.toPrecision(6)), this.spec.unit), true);
  }

  #number(given) {
    if (given === undefined) return null;
    return readQuantity(String(given), this.spec.unit) ?? this.parsed ?? null;
  }

  #key(event) {
    if (event.key === "Enter") {
      event.preventDefault();
      this.#typed();
    } else if (event.key === "Escape") {
      event.stopPropagation();
      this.isPending = false;
      this.complain(null);
      this.#fill(this.value.get());
    }
  }

  async #typed() {
    const text = this.field.value.trim();
    // A field that is left says once more what Enter has said.
    if (text === textOf(this.value.get()) && !this.hasFault) return;
    const values = this.spec.multiple ? text.split(";").map((one) => one.trim()).filter(Boolean) : [text];
    if (text === "") {
      this.isPending = false;
      this.#set(undefined);
      return;
    }
    this.isPending = true;
    const answers = await Promise.all(values.map((one) => this.check(one)));
    if (this.field.value.trim() !== text) return;
    this.isPending = false;
    const fault = answers.find((answer) => answer.error);
    if (fault) {
      this.complain(fault.error);
      return;
    }
    this.parsed = answers.length === 1 && typeof answers[0].value === "number" ? answers[0].value : null;
    this.#set(this.spec.multiple ? values : text);
  }

  #set(text, isGesture = false) {
    this.complain(null);
    this.value.set(text, isGesture ? this.spec.name : null);
    this.show();
  }

  #helpButton() {
    const toggle = (event) => {
      this.help.hidden = !this.help.hidden;
      event.currentTarget.setAttribute("aria-expanded", String(!this.help.hidden));
    };
    return make("button", { type: "button", class: "icon", "aria-expanded": "false", "aria-controls": this.help.id, "aria-label": `About ${this.spec.name}`, onclick: toggle }, "?");
  }
}

function textOf(given) {
  if (given === undefined) return "";
  return Array.isArray(given) ? given.join("; ") : String(given);
}

/** Name of an option as a label. */
export function titleOf(name) {
  const words = name.replaceAll(/[-_]/g, " ");
  return words.charAt(0).toUpperCase() + words.slice(1);
}

function defaultText({ default_text: text, default: value, unit }) {
  const shown = text ?? (typeof value === "number" ? writeQuantity(value, unit) : value);
  return shown === null || shown === undefined || shown === "" ? "default" : `${shown}`.replace(/^\((.*)\)$/, "$1");
}

function helpOf(spec) {
  const { help, flags, metavar, min, max, unit, source, key } = spec;
  const facts = [];
  if (Number.isFinite(min) && Number.isFinite(max)) facts.push(`${writeQuantity(min, unit)} to ${writeQuantity(max, unit)}`);
  const usual = defaultText(spec);
  if (usual !== "default") facts.push(`default ${usual}`);
  return [
    help ? make("div", {}, help) : null,
    make("div", {}, make("code", {}, key ? `--set ${key}=…` : `${(flags ?? []).join(" / ")} ${metavar ?? ""}`), facts.length ? ` · ${facts.join(" · ")}` : ""),
    source ? make("div", {}, `Source: ${source}`) : null,
  ].filter(Boolean);
}
