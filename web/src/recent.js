// Jobs of this browser, the latest first, and the job that the address names.

const KEPT = 20;
const ASKED_LETTERS = 500_000; // of the choices of all jobs; a browser keeps 5 million for all that its pages keep
let unkept = null; // the list of a visit that the browser does not keep

export function recent() {
  if (unkept) return unkept;
  try {
    const jobs = JSON.parse(localStorage.getItem("jobs"));
    return Array.isArray(jobs) ? jobs : [];
  } catch { return []; }
}

// `asked`: the choices that the job was made with.
export function remember(job, name, asked) {
  const jobs = [{ id: job.id, operation: job.operation, name, at: Date.now(), asked }, ...recent().filter(({ id }) => id !== job.id)];
  keep(jobs.slice(0, KEPT));
}

export const forgetAll = () => keep([]);
export const known = (id) => recent().find((job) => job.id === id);

// Where there is little room, fewer jobs keep their choices, the latest longest.
function keep(jobs) {
  for (let letters = ASKED_LETTERS; letters > 1; letters = Math.floor(letters / 8)) {
    try {
      localStorage.setItem("jobs", JSON.stringify(within(letters, jobs)));
      unkept = null;
      return;
    } catch { /* less, then */ }
  }
  unkept = jobs;
}

function within(letters, jobs) {
  let left = letters;
  return jobs.map(({ asked, ...job }) => {
    left -= JSON.stringify(asked ?? null).length;
    return left < 0 ? job : { ...job, asked };
  });
}

export const named = () => /^#job=([\w-]+)$/.exec(location.hash)?.[1] ?? null;
export const name = (id) => history.replaceState(null, "", id ? `#job=${id}` : location.pathname);
