// What is going on: the bar with its stage, and problems with what to do about them.

import { at, el } from "../dom.js";
import { knows, t } from "../text/text.js";
import { SAME_PROBLEM } from "../text/words.js";

export function working(text, fraction = null) {
  at("progress").hidden = false;
  at("stage").textContent = text;
  if (fraction === null) at("bar").removeAttribute("value");
  else at("bar").value = fraction;
}

export function rest() {
  at("progress").hidden = true;
  at("cancel").hidden = true;
}

// What an event of a job says.
export function told({ name, data }) {
  if (name === "state") working(t(data.state === "queued" ? "status.queued" : data.state === "running" ? "stage.read" : "status.done"), data.state === "running" ? 0 : null);
  if (name === "stage") working(t(`stage.${data.stage}`), data.fraction);
  if (name === "progress") working(data.progress.stage ? t(`stage.${data.progress.stage}`) : t("status.queued"), data.progress.fraction);
}

// A problem in people's words.
export function wordsOf(error) {
  const key = `problem.${SAME_PROBLEM[error.code] ?? error.code ?? "other"}`;
  return t(knows(key) ? key : "problem.other");
}

// `retry`: what may do better another time.
export function complain(error, retry) {
  const notice = el("div", { className: "notice", role: "alert", "data-code": error.code ?? "other" },
    el("p", {}, wordsOf(error)),
    error.message && el("details", {}, el("summary", {}, t("detail")), el("p", { lang: "en" }, error.message)),
    el("div", { className: "row links" },
      retry && el("button", { type: "button", className: "quiet", id: "look-again", onclick: retry }, t("look.again")),
      el("button", { type: "button", className: "quiet", id: "dismiss", onclick: () => notice.remove() }, t("dismiss"))));
  at("notices").replaceChildren(notice);
  notice.scrollIntoView({ block: "nearest" });
}

export const calm = () => at("notices").replaceChildren();
