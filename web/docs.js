// The forms of the reference: each is made from the contract when it is opened, and sends what it says.

let contract;
const load = () => (contract ??= fetch("/openapi.json").then((answer) => answer.json()));
const key = document.getElementById("key");

function make(name, properties = {}, ...children) {
  const element = document.createElement(name);
  for (const [property, value] of Object.entries(properties)) {
    if (property.includes("-")) element.setAttribute(property, value);
    else element[property] = value;
  }
  element.append(...children);
  return element;
}

function resolved(document, part) {
  if (!part?.$ref) return part;
  return part.$ref.slice(2).split("/").reduce((at, name) => at?.[name.replaceAll("~1", "/")], document);
}

// A control for a value: a list where its words are known, a line otherwise.
function control(document, parameter) {
  const schema = resolved(document, parameter.schema) ?? {};
  const words = schema.type === "boolean" ? ["true", "false"] : schema.enum;
  if (!words) {
    const isNumber = schema.type === "integer" || schema.type === "number";
    return make("input", { type: "text", inputMode: isNumber ? "decimal" : "text", placeholder: [schema.type].flat().join(" or ") || "text", autocomplete: "off" });
  }
  return make("select", {}, make("option", { value: "", textContent: "as usual" }), ...words.map((word) => make("option", { value: word, textContent: word })));
}

function field(document, parameter) {
  const input = control(document, parameter);
  input.required = parameter.required === true;
  input.dataset.name = parameter.name;
  input.dataset.in = parameter.in;
  const name = parameter.in === "query" ? parameter.name : `${parameter.name} (${parameter.in})`;
  return make("label", {}, make("span", { textContent: name }), input);
}

async function build(details) {
  const { path, method } = details.dataset;
  const document = await load();
  const operation = document.paths[path][method];
  const parameters = (operation.parameters ?? []).map((parameter) => resolved(document, parameter));
  const form = make("form", { action: "" });
  if (operation.requestBody) {
    // An operation on several meshes takes them as a form only.
    const several = !operation.requestBody.content?.["application/octet-stream"];
    const file = make("input", { type: "file", required: true, multiple: several });
    file.dataset.in = "body";
    const told = several ? "meshes (parts of a form)" : "mesh (body)";
    form.append(make("div", { className: "fields" }, make("label", {}, make("span", { textContent: told }), file)));
  }
  const fields = parameters.map((parameter) => field(document, parameter));
  const types = Object.keys(operation.responses["200"]?.content ?? {});
  if (types.length > 1) {
    const accept = make("select", {}, ...types.map((type) => make("option", { value: type, textContent: type })));
    accept.dataset.in = "header";
    accept.dataset.name = "Accept";
    fields.unshift(make("label", {}, make("span", { textContent: "Accept (header)" }), accept));
  }
  const box = make("div", { className: "fields" }, ...fields);
  if (fields.length > 8) form.append(make("details", {}, make("summary", { textContent: `Options (${fields.length})` }), box));
  else if (fields.length) form.append(box);
  const button = make("button", { type: "submit", textContent: "Send" });
  const answer = make("div", { className: "answer", role: "status" });
  form.append(button, answer);
  form.addEventListener("submit", async (event) => {
    event.preventDefault();
    button.disabled = true;
    answer.replaceChildren(make("p", { textContent: "Waiting for the answer…" }));
    try {
      await send(path, method, form, answer);
    } catch (error) {
      answer.replaceChildren(make("p", { textContent: `The service did not answer: ${error.message}` }));
    }
    button.disabled = false;
  });
  details.querySelector("p").replaceWith(form);
}

async function send(path, method, form, place) {
  const query = new URLSearchParams();
  const headers = {};
  let body;
  for (const input of form.querySelectorAll("[data-in]")) {
    const { name } = input.dataset;
    if (input.dataset.in === "body") {
      body = input.files[0];
      if (input.multiple) {
        body = new FormData();
        for (const file of input.files) body.append("mesh", file);
      }
    } else if (input.value === "") continue;
    else if (input.dataset.in === "query") query.append(name, input.value);
    else if (input.dataset.in === "header") headers[name] = input.value;
    else path = path.replace(`{${name}}`, encodeURIComponent(input.value));
  }
  // The browser names the type of a form itself.
  if (body && !(body instanceof FormData)) headers["Content-Type"] = "application/octet-stream";
  if (key.value) headers.Authorization = `Bearer ${key.value}`;
  const began = performance.now();
  const answer = await fetch(path + (query.size ? `?${query}` : ""), { method: method.toUpperCase(), headers, body });
  const content = await answer.arrayBuffer();
  const took = Math.round(performance.now() - began);
  await show(answer, content, took, path, place);
}

const SHOWN = 100_000; // characters; more would make the page slow

async function show(answer, content, took, path, place) {
  const type = (answer.headers.get("Content-Type") ?? "").split(";")[0];
  const line = make("p", {}, make("strong", { textContent: `${answer.status} ${answer.statusText}` }), ` ${type}, ${content.byteLength} bytes, ${took} ms`);
  const told = ["Location", "Meshmend-Outcome", "Meshmend-Fidelity", "Link", "Retry-After", "ETag"];
  const headers = told.filter((name) => answer.headers.has(name)).map((name) => `${name}: ${answer.headers.get(name)}`);
  const parts = [line];
  if (headers.length) parts.push(make("p", { className: "quiet", textContent: headers.join("; ") }));
  if (type.endsWith("json")) {
    const text = JSON.stringify(JSON.parse(new TextDecoder().decode(content)), null, 2);
    parts.push(shown(text));
  } else if (type === "image/png") {
    parts.push(make("img", { alt: "The picture of the answer", src: await dataUrl(new Blob([content], { type })) }));
  } else if (type.startsWith("text/") && !type.includes("off")) {
    parts.push(shown(new TextDecoder().decode(content)));
  } else if (content.byteLength) {
    const named = /filename="([^"]*)"/.exec(answer.headers.get("Content-Disposition") ?? "")?.[1];
    const link = make("a", { href: URL.createObjectURL(new Blob([content], { type })), download: named ?? path.split("/").pop(), textContent: `Save ${named ?? "the answer"}` });
    parts.push(make("p", {}, link));
  }
  place.replaceChildren(...parts);
}

function shown(text) {
  const cut = text.length > SHOWN ? `${text.slice(0, SHOWN)}\n… ${text.length - SHOWN} more characters` : text;
  return make("pre", { tabIndex: 0, "aria-label": "Body of the answer" }, make("code", { textContent: cut }));
}

function dataUrl(blob) {
  return new Promise((resolve) => {
    const reader = new FileReader();
    reader.onload = () => resolve(reader.result);
    reader.readAsDataURL(blob);
  });
}

for (const details of document.querySelectorAll("details.try")) {
  details.addEventListener("toggle", () => build(details), { once: true });
}

// The language of the examples is remembered.
const stored = localStorage.getItem("language-of-examples");
const chosen = stored && document.querySelector(`#languages input[value="${CSS.escape(stored)}"]`);
if (chosen) chosen.checked = true;
document.getElementById("languages").addEventListener("change", (event) => localStorage.setItem("language-of-examples", event.target.value));

document.body.dataset.ready = "";
