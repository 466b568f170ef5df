// Elements, made in one expression.

import { t } from "./text/text.js";

export const at = (id) => document.getElementById(id);

// `values`: properties; those with a dash, and `for`, are attributes, `on...` are listeners.
export function el(tag, values = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(values)) {
    if (value === undefined || value === null) continue;
    if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
    else if (name.includes("-") || name === "for" || name === "role" || name === "lang") element.setAttribute(name, value);
    else element[name] = value;
  }
  element.append(...children.flat().filter((child) => child !== null && child !== undefined && child !== false));
  return element;
}

let isHeld = false;

// Whoever has the focus somewhere now shall have it afterwards.
export const holdFocus = () => { isHeld = document.activeElement !== document.body; };

// Gives the focus to an element where it was lost with one that is gone.
export function keepFocus(element) {
  if (!isHeld) return;
  const { activeElement: focused } = document;
  if (focused === document.body || focused.disabled || !focused.checkVisibility()) element?.focus({ preventScroll: true });
}

// A choice: rows of value and text.
export function select(rows, value, onchange, values = {}) {
  const options = rows.map(([word, text]) => el("option", { value: word, selected: word === value }, text));
  return el("select", { ...values, onchange: (event) => onchange(event.target.value) }, options);
}

export const field = (label, control) => el("label", { className: "field" }, el("span", {}, label), control);

export function save(blob, name) {
  const url = URL.createObjectURL(blob);
  el("a", { href: url, download: name }).click();
  // The click only begins the download.
  setTimeout(() => URL.revokeObjectURL(url), 60_000);
}

// A button that copies a text and says so.
export function copyButton(label, text) {
  const button = el("button", { type: "button", className: "quiet", onclick: async () => {
    await copy(text());
    button.textContent = t("copied");
    setTimeout(() => { button.textContent = label; }, 1600);
  } }, label);
  return button;
}

// The clipboard of the browser is missing on plain HTTP; an old way is left there.
async function copy(text) {
  if (navigator.clipboard) return navigator.clipboard.writeText(text);
  const area = el("textarea", { value: text });
  document.body.append(area);
  area.select();
  document.execCommand("copy");
  area.remove();
  return undefined;
}
