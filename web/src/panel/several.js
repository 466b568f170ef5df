// Several files at once: what becomes of them together.

import { at, el, field, select } from "../dom.js";
import { t } from "../text/text.js";

export const SEVERAL_MAX = 32;
const OPERATIONS = ["union", "intersection", "difference"];

// Asks in the panel; `combine(operation)` and `openFirst()` happen on a click.
export function askAboutSeveral(files, { combine, openFirst }) {
  let operation = OPERATIONS[0];
  const close = (then) => () => { card.remove(); then(); };
  const card = el("div", { className: "card several", role: "group", "aria-labelledby": "several-title" },
    el("h2", { id: "several-title" }, t("several", { n: files.length })),
    el("ol", {}, files.map((file) => el("li", {}, file.name))),
    field(t("several.how"), select(OPERATIONS.map((word) => [word, t(`several.${word}`)]), operation, (word) => { operation = word; }, { id: "several-how" })),
    el("div", { className: "row" },
      el("button", { type: "button", className: "primary", id: "several-combine", onclick: close(() => combine(operation)) }, t("several.combine")),
      el("button", { type: "button", className: "quiet", onclick: close(openFirst) }, t("several.first"))));
  at("notices").replaceChildren(card);
  at("several-how").focus();
}
