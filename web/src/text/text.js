// Texts in the reader's language, from one table.

import { words as interfaceWords } from "./interface.js";
import { words as contractWords } from "./words.js";

export const LANGUAGES = ["en", "de", "fr"];
export const table = { ...interfaceWords, ...contractWords };

let language = chosen();

function chosen() {
  const wanted = [stored(), ...(navigator.languages ?? [])].filter(Boolean);
  return wanted.map((tag) => tag.slice(0, 2)).find((tag) => LANGUAGES.includes(tag)) ?? "en";
}

function stored() {
  try { return localStorage.getItem("language"); } catch { return null; }
}

export const current = () => language;

export function speak(tag) {
  language = tag;
  try { localStorage.setItem("language", tag); } catch { /* not kept, then */ }
  document.documentElement.lang = tag;
}

export const knows = (key) => key in table;

// The text of `key`, with `{name}` replaced. A code that is newer than this page is shown as it is.
export function t(key, values = {}) {
  const text = table[key]?.[LANGUAGES.indexOf(language)] ?? key.replace(/^\w+\./, "").replaceAll("-", " ");
  return bound(text.replace(/\{(\w+)\}/g, (_, name) => values[name] ?? ""));
}

// French has a space before some marks, at which no line ends.
const bound = (text) => (language === "fr" ? text.replace(/ (?=[:;?!%])/g, "\u00a0") : text);

// The text of `key` for so many things; one may have a text of its own.
export const counted = (key, count, values = {}) => t(count === 1 && knows(`${key}.one`) ? `${key}.one` : key, { n: number(count), ...values });

export const number = (value, options = {}) => new Intl.NumberFormat(language, { maximumFractionDigits: 0, ...options }).format(value);
export const percent = (share) => number(share, { style: "percent", maximumSignificantDigits: 3 });
// Four digits, as many as a part is measured with.
export const digits = (value, count = 4) => number(value, { maximumFractionDigits: 20, maximumSignificantDigits: count, notation: isLong(Math.abs(value)) ? "scientific" : "standard" });
const isLong = (size) => size >= 1e9 || (size > 0 && size < 1e-6);
export const length = (millimetres) => (millimetres > 0 && millimetres < 1e-3 ? `< ${digits(1e-3)} mm` : `${digits(millimetres)} mm`);

// Puts texts where the markup asks for them: `data-t` in the element, `data-t-label` as its label.
export function translate(root) {
  for (const element of root.querySelectorAll("[data-t]")) element.textContent = t(element.dataset.t);
  for (const element of root.querySelectorAll("[data-t-label]")) {
    element.setAttribute("aria-label", t(element.dataset.tLabel));
    element.title = t(element.dataset.tLabel);
  }
}
