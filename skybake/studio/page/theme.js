// Dark or light: as the system says, until one is chosen.

import { byId } from "./dom.js";

const KEY = "skybake-studio-theme";
let chosen = null;

export function startTheme() {
  const system = matchMedia("(prefers-color-scheme: light)");
  const show = () => {
    const theme = stored() ?? (system.matches ? "light" : "dark");
    document.documentElement.dataset.theme = theme;
    byId("theme").textContent = theme === "dark" ? "Light" : "Dark";
    document.dispatchEvent(new Event("theme"));
  };
  byId("theme").addEventListener("click", () => {
    const other = document.documentElement.dataset.theme === "dark" ? "light" : "dark";
    try {
      localStorage.setItem(KEY, other);
    } catch {
      // Without storage, such as in a frame of a notebook, the choice holds for this page.
    }
    chosen = other;
    show();
  });
  system.addEventListener("change", show);
  show();
}

function stored() {
  try {
    return chosen ?? localStorage.getItem(KEY);
  } catch {
    return chosen;
  }
}
