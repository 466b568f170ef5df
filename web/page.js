// Sends a mesh as a job, follows it, and shows its report.

const WAIT_S = 20; // one long poll; the server allows up to 300

const at = (id) => document.getElementById(id);
let current = null; // the job that is being followed

async function call(path, options = {}) {
  const key = at("key").value;
  const headers = { ...options.headers, ...(key ? { Authorization: `Bearer ${key}` } : {}) };
  const response = await fetch(path, { ...options, headers });
  if (response.status === 401) at("key-label").hidden = false;
  if (!response.ok) throw new Error(await problemText(response));
  return response;
}

async function problemText(response) {
  const problem = await response.json().catch(() => null);
  return problem ? `${problem.title}: ${problem.detail}` : `HTTP ${response.status}`;
}

function query() {
  const names = ["operation", "units", "policy", ...(at("output_format").disabled ? [] : ["output_format"])];
  const given = names.map((name) => [name, at(name).value]).filter(([, value]) => value);
  return new URLSearchParams(given);
}

async function send() {
  const form = new FormData();
  form.append("mesh", at("mesh").files[0]);
  const response = await call(`/v1/jobs?${query()}`, { method: "POST", body: form });
  return response.json();
}

const isOver = (job) => !["queued", "running"].includes(job.state);

async function follow(job) {
  while (!isOver(job)) {
    at("status").textContent = job.progress.stage ? `${job.state}: ${job.progress.stage}` : job.state;
    at("progress").value = job.progress.fraction;
    // Short waits first, so that progress is seen; long ones for long jobs.
    const wait = job.state === "running" ? 1 : WAIT_S;
    job = await (await call(`${job.links.self}?wait=${wait}`)).json();
  }
  return job;
}

function fill(table, rows) {
  const body = at(table).tBodies[0];
  body.replaceChildren(...rows.map((cells) => {
    const row = document.createElement("tr");
    row.append(...cells.map((cell) => Object.assign(document.createElement("td"), { textContent: cell })));
    return row;
  }));
}

const changesOf = (action) => action.changes.filter((c) => c.count > 0).map((c) => `${c.name} ${c.count}`).join(", ");

// The same words as the first line of the command line.
function headline(verdict, printing) {
  const parts = [[verdict.outcome, verdict.printable ? "a valid solid" : "not a valid solid"].filter(Boolean).join(": ")];
  const changes = verdict.changes.map((change) => change.message).join(", ");
  if (verdict.fidelity) parts.push(changes ? `${verdict.fidelity}: ${changes}` : verdict.fidelity);
  if (printing) parts.push(policyText(verdict, printing.policy));
  return parts.join("; ");
}

function policyText(verdict, policy) {
  if (verdict.p3_holds) return `${policy} holds`;
  const broken = verdict.p3_breaches.join(", ");
  return broken ? `${policy} is broken: ${broken}` : `${policy} cannot be told`;
}

async function show(job) {
  at("status").textContent = job.problem ? `${job.problem.title}: ${job.problem.detail}` : job.state;
  if (!job.links.report) return;
  const report = await (await call(job.links.report)).json();
  const verdict = report.verdict;
  at("verdict").textContent = headline(verdict, report.printing);
  at("question").textContent = report.before?.unit_hypothesis?.question ?? "";
  fill("defects", (report.before?.defects ?? []).map((d) => [d.code, d.severity, d.count]));
  fill("actions", (report.actions ?? []).map((a) => [a.step, changesOf(a), a.reason]));
  const printing = report.printing;
  at("printing").hidden = !printing;
  fill("checks", (printing?.checks ?? []).map((c) => [c.code, c.status ?? "not known", c.message]));
  const proposals = report.plan?.findings ?? [];
  at("plan").hidden = proposals.length === 0;
  fill("remedies", proposals.map((p) => [p.code, p.count, p.remedy, p.choices.join(", "), p.confidence, p.reason]));
  at("report").textContent = JSON.stringify(report, null, 2);
  at("download").hidden = !job.links.result;
  at("result").hidden = false;
}

async function download() {
  const response = await call(current.links.result);
  const name = /filename="([^"]*)"/.exec(response.headers.get("Content-Disposition") ?? "");
  const url = URL.createObjectURL(await response.blob());
  Object.assign(document.createElement("a"), { href: url, download: name ? name[1] : "mesh" }).click();
  URL.revokeObjectURL(url);
}

async function run(event) {
  event.preventDefault();
  at("result").hidden = true;
  at("go").disabled = true;
  at("progress").hidden = false;
  at("status").textContent = "sending";
  try {
    current = await send();
    at("stop").hidden = false;
    current = await follow(current);
    await show(current);
  } catch (error) {
    at("status").textContent = error.message;
  } finally {
    at("go").disabled = false;
    at("stop").hidden = at("progress").hidden = true;
  }
}

const tell = (action) => () => action().catch((error) => { at("status").textContent = error.message; });

// Operations whose product is their report take no format for a mesh.
const choose = () => { at("output_format").disabled = !["repair", "convert"].includes(at("operation").value); };

at("operation").addEventListener("change", choose);
choose(); // browsers keep the choice when the page is loaded again
at("form").addEventListener("submit", run);
at("download").addEventListener("click", tell(download));
at("stop").addEventListener("click", tell(() => call(`${current.links.self}/cancel`, { method: "POST" })));
for (const [name, over] of [["dragover", true], ["dragleave", false], ["drop", false]]) {
  at("drop").addEventListener(name, (event) => {
    event.preventDefault();
    at("drop").classList.toggle("over", over);
    if (name === "drop" && event.dataTransfer.files.length) at("mesh").files = event.dataTransfer.files;
  });
}
