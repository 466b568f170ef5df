// "Verify this file": are its bytes those of the certificate, and are they a valid solid?

import { el } from "../dom.js";
import { t } from "../text/text.js";

// `digests`: of the files of the result; `of`: texts about them.
export function verifier(digests, of, host) {
  const answer = el("p", { className: "answer", role: "status", id: "verified" });
  const check = async (file) => {
    answer.className = "answer";
    answer.textContent = t("view.working");
    try {
      const { digest, isValid } = await host.verify(file);
      const isSame = digests.includes(digest);
      answer.classList.add(isSame && isValid ? "good" : "bad");
      answer.textContent = `${of(isSame ? "verify.same" : "verify.other")} ${t(isValid ? "verify.valid" : "verify.invalid")}`;
    } catch (error) {
      answer.classList.add("bad");
      answer.textContent = host.words(error);
    }
  };
  const input = el("input", { type: "file", id: "verify-file", className: "unseen", onchange: () => { if (input.files[0]) check(input.files[0]); input.value = ""; } });
  const zone = el("label", { className: "drop small", for: "verify-file" }, el("strong", {}, t("verify")), el("span", {}, of("verify.more")));
  droppable(zone, ([file]) => check(file));
  return el("div", { className: "verify" }, input, zone, answer);
}

// Lets files be dropped on an element.
export function droppable(element, taken) {
  const stop = (event, isOver) => {
    event.preventDefault();
    event.stopPropagation();
    element.classList.toggle("over", isOver);
  };
  element.addEventListener("dragover", (event) => stop(event, true));
  element.addEventListener("dragleave", (event) => stop(event, false));
  element.addEventListener("drop", (event) => {
    stop(event, false);
    const files = [...event.dataTransfer.files];
    if (files.length) taken(files);
  });
}
