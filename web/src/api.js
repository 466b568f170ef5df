// The service, as the page uses it.

const FOLLOW_S = 20; // one wait for the end of a job

export class Problem extends Error {
  constructor(body) {
    super(body.detail ?? body.title ?? "");
    this.body = body;
    this.code = body.code ?? "other";
  }
}

export const isOver = (job) => !["queued", "running"].includes(job.state);

export class Api {
  constructor() {
    this.key = remembered();
  }

  useKey(key) {
    this.key = key;
    try { sessionStorage.setItem("key", key); } catch { /* asked again after a reload, then */ }
  }

  async call(path, options = {}) {
    const headers = { ...options.headers, ...(this.key ? { Authorization: `Bearer ${this.key}` } : {}) };
    const response = await fetch(path, { ...options, headers }).catch((error) => {
      throw error.name === "AbortError" ? error : new Problem({ code: "unreachable" });
    });
    if (!response.ok) throw new Problem(await response.json().catch(() => ({ code: "other", detail: `HTTP ${response.status}` })));
    return response;
  }

  async json(path, options) {
    return (await this.call(path, options)).json();
  }

  // A new job, of a file or several, or of the upload of an earlier job.
  create(request, files = null) {
    if (!files) return this.json("/v1/jobs", { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(request) });
    const form = new FormData();
    form.append("job", new Blob([JSON.stringify(request)], { type: "application/json" }));
    for (const file of [files].flat()) form.append("mesh", file, file.name);
    return this.json("/v1/jobs", { method: "POST", body: form });
  }

  job = (id) => this.json(`/v1/jobs/${id}`);
  report = (job) => this.json(job.links.report);
  cancel = (job) => this.json(`${job.links.self}/cancel`, { method: "POST" });

  // A file of a job, with the name that the service gives it.
  async file(path, accept = "*/*") {
    const response = await this.call(path, { headers: { Accept: accept } });
    return { name: nameIn(response.headers.get("Content-Disposition") ?? ""), blob: await response.blob() };
  }

  // Follows a job to its end; `told` hears its events. Where the stream breaks, it is waited for.
  async follow(job, told) {
    if (isOver(job)) return job;
    try {
      const response = await this.call(`${job.links.self}/events`, { headers: { Accept: "text/event-stream" } });
      for await (const event of events(response.body)) told(event);
    } catch (error) {
      if (error instanceof Problem && error.code !== "unreachable") throw error;
    }
    let seen = await this.job(job.id);
    while (!isOver(seen)) {
      told({ name: "progress", data: seen });
      seen = await this.json(`${job.links.self}?wait=${FOLLOW_S}`);
    }
    return seen;
  }
}

// The name of a file: whole as RFC 5987 has it, or what is left of it in ASCII.
function nameIn(disposition) {
  const whole = /filename\*=UTF-8''([^;\s]+)/i.exec(disposition)?.[1];
  return whole ? decodeURIComponent(whole) : /filename="([^"]*)"/.exec(disposition)?.[1] ?? "mesh";
}

function remembered() {
  try { return sessionStorage.getItem("key") ?? ""; } catch { return ""; }
}

// Server-sent events of a body. `EventSource` cannot send a key.
async function* events(body) {
  const reader = body.pipeThrough(new TextDecoderStream()).getReader();
  let text = "";
  for (;;) {
    const { value, done } = await reader.read();
    if (done) return;
    text += value;
    const blocks = text.split("\n\n");
    text = blocks.pop();
    for (const block of blocks) {
      const fields = Object.fromEntries(block.split("\n").map((line) => [line.slice(0, line.indexOf(":")), line.slice(line.indexOf(":") + 1).trim()]));
      if (fields.data) yield { name: fields.event, data: JSON.parse(fields.data) };
    }
  }
}
