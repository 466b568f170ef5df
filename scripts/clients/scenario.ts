// What a client must be able to do, against the real server with a difficult neighbour in between.
//
// The other scenarios do the same, step by step, and must print the same lines. Where it runs is said by a `Place`.

import {
  ConnectionFailedError,
  IntegrityError,
  type Job,
  type JobEvent,
  type KeptMesh,
  type Mesh,
  Meshmend,
  MeshmendError,
  NotFinishedError,
  NotRepairableError,
  ProblemError,
  type Result,
  UnexpectedAnswerError,
  UploadOf,
  verifyWebhook,
  WebhookError,
} from "meshmend";

const SECRET = "whsec_MfKQ9r8GKYqrTwjUPD8ILPZIo2LaLaSw";
const OTHER_SECRET = "whsec_AAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAA";

/** What differs between Node and a browser. */
export interface Place {
  /** A file of the fixtures, or the slow mesh. */
  read(path: string): Promise<Uint8Array<ArrayBuffer>>;
  /** The same as a mesh by its path. */
  meshAt(path: string): Promise<Mesh>;
  /** Saves a result under a name; gives what stands there then. */
  save(result: Result, name: string): Promise<Uint8Array>;
  /** Whether anything stands under a name. */
  leftOf(name: string): Promise<number>;
  /** Whether bodies can be streams here. */
  canStream: boolean;
  print(line: string): void;
}

interface Asked {
  method: string;
  path: string;
  manner: string;
  status: number | null;
  "idempotency-key"?: string;
  "last-event-id"?: string;
  "content-length"?: string;
}

function check(holds: boolean, ...what: unknown[]): asserts holds {
  if (!holds) throw new Error(`expected otherwise: ${JSON.stringify(what)}`);
}

/** The error that a call ends with. */
async function errorOf<E extends MeshmendError>(kind: abstract new (...a: never[]) => E, call: () => Promise<unknown>): Promise<E> {
  try {
    await call();
  } catch (error) {
    if (error instanceof kind) return error;
    throw error;
  }
  throw new Error("the call was to fail");
}

async function* streamOf(content: Uint8Array): AsyncGenerator<Uint8Array> {
  for (let begin = 0; begin < content.length; begin += 50) yield content.slice(begin, begin + 50);
}

const pause = (ms: number) => new Promise((resolve) => setTimeout(resolve, ms));

class Scenario {
  readonly client: Meshmend;

  constructor(
    readonly url: string,
    readonly name: string,
    readonly place: Place,
  ) {
    this.client = this.through("plain");
  }

  through(manner: string): Meshmend {
    return new Meshmend(`${this.url}/${this.name}/${manner}/`, { retries: { pauseS: 0.05 } });
  }

  async known<T>(what: string): Promise<T[]> {
    return (await (await fetch(`${this.url}/${this.name}/${what}`)).json()) as T[];
  }

  async asked(manner: string, method: string, end = ""): Promise<Asked[]> {
    const asked = await this.known<Asked>("asked");
    return asked.filter((entry) => entry.manner === manner && entry.method === method && entry.path.endsWith(end));
  }

  /** A mesh that takes the server a while, and is no other client's, so that no earlier result is given. */
  async slowMesh(): Promise<Uint8Array<ArrayBuffer>> {
    const content = await this.place.read("slow.stl");
    content.set(new TextEncoder().encode(this.name.padEnd(80).slice(0, 80)));
    return content;
  }

  untilFinal(job: Job): Promise<Job> {
    return this.client.wait(job.id, { timeoutS: 120 });
  }

  // --- the steps

  async wrong_input(): Promise<string> {
    const cube = await this.place.meshAt("valid/cube.off");
    const torn = await errorOf(ProblemError, () => this.client.repair(new TextEncoder().encode("OFF\n3 1 0\n0 0 0\nx")));
    // @ts-expect-error There is no such option.
    const unknown = await errorOf(ProblemError, () => this.client.repair(cube, { wal_mm: 1 }));
    check(unknown.problem.suggestion === "wall_mm", unknown.problem);
    const missing = await errorOf(ProblemError, () => this.client.repair(new UploadOf("00000000-0000-7000-8000-000000000000")));
    return `${torn.code} at line ${torn.problem.line}; ${unknown.status} ${unknown.code}; ${missing.code}`;
  }

  async repaired(): Promise<string> {
    const path = "intersection/self_intersection.off";
    const first = await this.client.repair(await this.place.read(path), { output_format: "stl" });
    const second = await this.client.repair(await this.place.meshAt(path), { output_format: "stl" });
    const third = await this.client.repair(new UploadOf(first.jobId), { output_format: "stl" });
    const mesh = await first.bytes();
    for (const result of [first, second, third]) {
      check(result.sha256() === first.sha256(), result.report);
      check(String(await this.place.save(result, `${this.name}.stl`)) === String(mesh));
    }
    const { verdict } = first.report;
    return `${verdict.outcome}, ${verdict.fidelity}, ${mesh.length} bytes, ${first.sha256()}`;
  }

  async brought(): Promise<string> {
    const [client, path] = [this.through("torn"), "intersection/self_intersection.off"];
    const content = await this.place.read(path);
    const upload = await client.upload((await this.place.meshAt(path)) as KeptMesh);
    const asked = await this.asked("torn", "PATCH");
    // The second request brings what the first one did not.
    check(Number(asked.at(-1)?.["content-length"]) === content.length - Math.floor(content.length / 2), asked);
    const first = await client.repair(upload, { output_format: "stl" });
    const second = await client.repair(await client.upload(content), { output_format: "stl" });
    const missing = UploadOf.upload("00000000-0000-7000-8000-000000000000");
    const gone = await errorOf(ProblemError, () => client.repair(missing));
    return `${first.sha256()}, ${second.sha256()}; ${gone.code}`;
  }

  async refused(): Promise<string> {
    const sheet = await this.place.meshAt("boundary/open_sheet.off");
    const error = await errorOf(NotRepairableError, () => this.client.repair(sheet, { require: "faithful" }));
    const job = await this.client.submit(sheet, { operation: "repair", require: "faithful" });
    const later = await errorOf(NotRepairableError, () => this.client.result(job.id));
    check(JSON.stringify(later.report?.verdict) === JSON.stringify(error.report?.verdict), later.report);
    return `${error.status} ${error.code}, ${error.report?.verdict.outcome}`;
  }

  async described(): Promise<string> {
    const crossing = await this.place.meshAt("intersection/self_intersection.off");
    const report = await this.client.analyze(crossing);
    const verified = await this.client.verify(await this.place.meshAt("valid/cube.off"));
    const plan = await this.client.plan(crossing);
    const again = await this.client.repair(crossing, { plan });
    const defects = report.before?.defects.map((defect) => defect.code).sort();
    const { printable } = verified.certificate ?? verified.input_certificate;
    return `${defects}; printable ${printable}; by its plan ${again.report.verdict.outcome}`;
  }

  async made(): Promise<string> {
    const { client, place } = this;
    const steps = JSON.parse(new TextDecoder().decode(await place.read("modeller/hip_roof.off.options.json"))) as object;
    const [cube, obj] = [await place.meshAt("valid/cube.off"), await place.meshAt("valid/cube.obj")];
    const material = new TextEncoder().encode("newmtl a\nKd 1 0 0\n");
    const simplified = await client.simplify(cube, { targets: [{ faces: 12 }, { faces: 8 }] });
    const results = {
      convert: await client.convert(obj, { output_format: "ply" }, { material }),
      simplify: simplified,
      fill: await client.fillHoles(await place.meshAt("boundary/boundary_loop.off"), { method: "auto" }),
      cut: await client.cutStitch(await place.meshAt("non_manifold/non_manifold_edge.off")),
      model: await client.modeller(await place.meshAt("modeller/hip_roof.off"), steps),
      combine: await client.boolean([cube, await place.read("valid/cube.obj")], { set_operation: "intersection" }),
    };
    const sizes: string[] = [];
    for (const [name, result] of Object.entries(results)) sizes.push(`${name} ${(await result.bytes()).length}`);
    return [...sizes, `level 2 ${(await simplified.bytes(2)).length}`].join(", ");
  }

  async drawn(): Promise<string> {
    const crossing = await this.place.meshAt("intersection/self_intersection.off");
    const sides = await this.client.render(crossing, { views: "four", width: 320, height: 240 });
    const job = await this.client.submit(crossing, { operation: "repair", thumbnail: true });
    await this.untilFinal(job);
    const thumbnail = await this.client.thumbnail(job.id);
    for (const picture of [sides, thumbnail]) check(String(picture.slice(0, 4)) === "137,80,78,71");
    const turned = await this.client.render(crossing, { picture_format: "glb" });
    check(new TextDecoder().decode(turned.slice(0, 4)) === "glTF");
    const digest = new Uint8Array(await crypto.subtle.digest("SHA-256", sides));
    return `${[...digest].map((byte) => byte.toString(16).padStart(2, "0")).join("")}, ${thumbnail.length} bytes`;
  }

  async followed(): Promise<string> {
    const client = this.through("cut");
    const job = await client.submit(await this.slowMesh(), { operation: "repair" });
    const heard: JobEvent[] = [];
    for await (const event of client.events(job.id)) {
      heard.push(event);
      // It would go on for long; after three passes enough is heard.
      if (heard.filter((each) => each.name === "stage").length === 3) await this.client.cancel(job.id);
    }
    const fractions = heard.flatMap((event) => (event.name === "stage" ? event.fraction : []));
    check(fractions.length >= 3 && String([...fractions].sort((a, b) => a - b)) === String(fractions), fractions);
    const ids = (await this.asked("cut", "GET", "/events")).map((entry) => entry["last-event-id"]);
    // Each connection brings one event, and the next one begins after it.
    check(String(ids) === String([undefined, ...heard.slice(0, -1).map((event) => event.id)]), ids, heard);
    const again: JobEvent[] = [];
    const ended = await this.client.wait(job.id, { onEvent: (event) => again.push(event) });
    const [states, repeated] = [heard, again].map((events) => events.flatMap((event) => (event.name === "state" ? event.state : [])));
    check(String(states) === String(repeated), states, repeated);
    let left = 0;
    for await (const _ of client.events(job.id, { lastEventId: heard.at(-1)?.id ?? "" })) left += 1;
    return `${states}; passes heard; ${ended.state}; ${left} left`;
  }

  async cancelled(): Promise<string> {
    const job = await this.client.submit(await this.slowMesh(), { operation: "repair" }, { cancelAfterS: 600 });
    const unfinished = await errorOf(NotFinishedError, () => this.client.result(job.id, { timeoutS: 0 }));
    check(unfinished.job.id === job.id);
    const stop = new AbortController();
    const waiting = this.client.wait(job.id, { signal: stop.signal });
    stop.abort(new RangeError("enough"));
    check((await waiting.catch((error: unknown) => error)) instanceof RangeError);
    await this.client.cancel(job.id);
    const ended = await this.untilFinal(job);
    const error = await errorOf(ProblemError, () => this.client.result(job.id));
    return `${ended.state}; ${error.code}`;
  }

  async sent_again(): Promise<string> {
    const words: string[] = [];
    const cube = await this.place.meshAt("valid/cube.off");
    for (const manner of ["busy", "lost"]) {
      const [client, labels, key] = [this.through(manner), { try: `${this.name}-${manner}` }, `${this.name}-${manner}-1`];
      const begun = performance.now();
      await client.submit(cube, { operation: "verify", labels }, { idempotencyKey: key });
      // The first answer says that it is to be a second.
      check(manner !== "busy" || performance.now() - begun >= 1000);
      const asked = await this.asked(manner, "POST", "/v1/jobs");
      check(asked.every((entry) => entry["idempotency-key"] === key), asked);
      const made = await client.jobs({ labels });
      words.push(`${manner} [${asked.map((entry) => entry.status).join(", ")}] makes ${made.jobs.length}`);
    }
    const away = this.through("away");
    check((await away.version()).version !== "" && (await this.asked("away", "GET")).length === 2);
    const nobody = new Meshmend("http://127.0.0.1:9", { retries: { attemptsMax: 2, pauseS: 0.01 } });
    await errorOf(ConnectionFailedError, () => nobody.version());
    return words.join("; ");
  }

  async guarded(): Promise<string> {
    const crossing = await this.place.meshAt("intersection/self_intersection.off");
    const short = await this.through("short").repair(crossing, { output_format: "stl" });
    const size = (await this.place.save(short, `${this.name}-short.stl`)).length;
    check((await this.asked("short", "GET", "/result")).length === 2);
    const bent = await this.through("bent").repair(crossing, { output_format: "stl" });
    await errorOf(IntegrityError, () => this.place.save(bent, `${this.name}-bent.stl`));
    await errorOf(IntegrityError, () => bent.bytes());
    return `${size} bytes at the second try; ${await this.place.leftOf(`${this.name}-bent.stl`)} files of bent bytes`;
  }

  async called(): Promise<string> {
    const webhook = { url: `${this.url}/${this.name}/hook`, secret: SECRET };
    const cube = await this.place.meshAt("valid/cube.off");
    const job = await this.client.submit(cube, { operation: "repair", labels: { order: "17" }, webhook });
    const ids = new Set<string>();
    for (const { body, headers } of await this.callsOf(2)) {
      const { id, message } = await verifyWebhook(body, headers, [OTHER_SECRET, SECRET]);
      ids.add(id);
      check(message.type === "job.succeeded" && message.data.id === job.id, message);
      const sentAt = Number(Object.entries(headers).find(([name]) => name.toLowerCase() === "webhook-timestamp")?.[1]);
      const wrong = [
        () => verifyWebhook(`${body} `, headers, SECRET),
        () => verifyWebhook(body, headers, OTHER_SECRET),
        () => verifyWebhook(body, {}, SECRET),
        () => verifyWebhook(body, headers, SECRET, { now: sentAt + 301 }),
        () => verifyWebhook(body, headers, SECRET, { now: sentAt - 301 }),
      ];
      for (const call of wrong) await errorOf(WebhookError, call);
    }
    const told = async () => (await this.client.deliveries(job.id)).deliveries[0];
    let delivery = await told();
    for (; delivery?.state === "pending"; delivery = await told()) await pause(50);
    check(delivery !== undefined && ids.size === 1 && ids.has(delivery.id), [...ids], delivery);
    await this.client.redeliver(job.id, delivery.id);
    await this.callsOf(3);
    return `${delivery.state} after [${delivery.tries.map((each) => each.status).join(", ")}]; sent again when asked`;
  }

  async callsOf(count: number) {
    for (let look = 0; look < 600; look += 1) {
      const calls = await this.known<{ body: string; headers: Record<string, string> }>("calls");
      if (calls.length >= count) return calls;
      await pause(100);
    }
    throw new Error("no call came");
  }

  async streamed(): Promise<string> {
    const content = await this.place.read("intersection/self_intersection.off");
    const first = await this.client.repair(streamOf(content), { output_format: "stl" });
    const second = await this.client.repair(new Blob([content]).stream(), { output_format: "stl" });
    // Of neither is it known before how long it is.
    check((await this.asked("plain", "POST", "/v1/repair")).slice(-2).every((entry) => entry["content-length"] === undefined));
    const error = await errorOf(UnexpectedAnswerError, () => this.through("away").verify(streamOf(content)));
    const count = (await this.asked("away", "POST")).length;
    return `${first.sha256()}, ${second.sha256()}; sent once: ${error.status}, ${count}`;
  }

  async tidied(): Promise<string> {
    const page = await this.client.jobs({ limit: 1, state: "succeeded" });
    const after = await this.client.jobs({ limit: 1, state: "succeeded", cursor: page.next ?? "" });
    const id = page.jobs[0]?.id ?? "";
    check(id !== after.jobs[0]?.id);
    await this.client.delete(id);
    const gone = await errorOf(ProblemError, () => this.client.job(id));
    const limits = await this.client.limits();
    check(limits.upload_bytes_max > 0 && limits.webhook_attempts_max > 0);
    const formats = (await this.client.formats()).map((entry) => entry.name);
    check(formats.includes("stl") && formats.includes("off") && (await this.client.policies()).length > 0);
    const codes = (await this.client.errors()).map((entry) => entry.code);
    return `${gone.code}; it is explained: ${codes.includes(gone.code)}`;
  }
}

const STEPS = [
  "wrong_input", "repaired", "brought", "refused", "described", "made", "drawn", "followed", "cancelled", "sent_again",
  "guarded", "called", "streamed", "tidied",
] as const;

export async function run(url: string, name: string, place: Place): Promise<void> {
  const scenario = new Scenario(url, name, place);
  for (const step of STEPS) {
    if (step !== "streamed" || place.canStream) place.print(`${step}: ${await scenario[step]()}`);
  }
}
