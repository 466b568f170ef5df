// Jobs of this browser, the latest first, and the job that the address names.

const KEPT = 20;

export function recent() {
  try { return JSON.parse(localStorage.getItem("jobs") ?? "[]"); } catch { return []; }
}

// `asked`: the choices that the job was made with.
export function remember(job, name, asked) {
  const jobs = [{ id: job.id, operation: job.operation, name, at: Date.now(), asked }, ...recent().filter(({ id }) => id !== job.id)];
  keep(jobs.slice(0, KEPT));
}

export const forgetAll = () => keep([]);
export const known = (id) => recent().find((job) => job.id === id);

function keep(jobs) {
  try { localStorage.setItem("jobs", JSON.stringify(jobs)); } catch { /* a list for this visit only, then */ }
}

export const named = () => /^#job=([\w-]+)$/.exec(location.hash)?.[1] ?? null;
export const name = (id) => history.replaceState(null, "", id ? `#job=${id}` : location.pathname);
