// The client: one method for each call of the service.

import { Connection, failed, type Request } from "./connection.js";
import { ConnectionFailedError, MeshmendError, NotFinishedError, ProblemError, problemError, UnexpectedAnswerError } from "./errors.js";
import { EventReader, isFinal, type JobEvent } from "./events.js";
import { Result } from "./result.js";
import { RETRIES, type Retries } from "./retries.js";
import type * as types from "./types.js";
import { announced, bodyOf, chunksOf, jsonBodyOf, type KeptMesh, type Mesh, randomText, restOf, TUS, UploadOf } from "./upload.js";

/** Longest wait of one request, in seconds: well below what proxies allow. */
const WAIT_S = 45;

export interface ClientOptions {
  /** Sent as `Authorization: Bearer`. */
  key?: string;
  retries?: Partial<Retries>;
  /** Used instead of `fetch` itself. */
  fetch?: typeof fetch;
}

/** How a call is made, beside what it asks for. */
export interface CallOptions {
  /** The same key gives the same job, however often it is sent. Default: a new one for each call. */
  idempotencyKey?: string;
  /** The material file of an OBJ. */
  material?: Mesh;
  /** Seconds to wait for the job's end; then `NotFinishedError`. Default: any time. */
  timeoutS?: number;
  /** Ends the call, not the job. */
  signal?: AbortSignal;
}

/**
 * A Meshmend service.
 *
 * A call is sent again as `retries` says; one that makes a job carries an `Idempotency-Key`, so that it makes one job
 * however often it is sent.
 */
export class Meshmend {
  readonly #connection: Connection;

  constructor(url: string, options: ClientOptions = {}) {
    const headers: Record<string, string> = options.key ? { Authorization: `Bearer ${options.key}` } : {};
    const how = options.fetch ?? ((input, init) => fetch(input, init));
    this.#connection = new Connection(url, headers, { ...RETRIES, ...options.retries }, how);
  }

  // --- operations with a report as their answer

  /** Describes a mesh: counts, measures, defects with witnesses, and the certificate of the file as it is. */
  async analyze(mesh: Mesh | UploadOf, options: types.AnalyzeOptions = {}, call: CallOptions = {}): Promise<types.Report> {
    return (await this.#run("analyze", [mesh], options, call)).report;
  }

  /** Certifies a file as it is. */
  async verify(mesh: Mesh | UploadOf, options: types.VerifyOptions = {}, call: CallOptions = {}): Promise<types.Report> {
    return (await this.#run("verify", [mesh], options, call)).report;
  }

  /** What may be done about each defect: to be edited and given to `repair` as `plan`. */
  async plan(mesh: Mesh | UploadOf, options: types.PlanOptions = {}, call: CallOptions = {}): Promise<types.Plan> {
    return (await this.#run("plan", [mesh], options, call)).report.plan as types.Plan;
  }

  /** A picture of a mesh, as PNG: from one side or several, defects coloured and marked, or turning; or as GLB. */
  async render(mesh: Mesh | UploadOf, options: types.RenderOptions = {}, call: CallOptions = {}): Promise<Uint8Array<ArrayBuffer>> {
    return this.thumbnail((await this.#run("render", [mesh], options, call)).jobId, options.picture_format);
  }

  // --- operations with a mesh as their answer

  /** Makes a certified valid solid of a mesh. Throws `NotRepairableError` where there is none as asked. */
  repair(mesh: Mesh | UploadOf, options: types.RepairOptions = {}, call: CallOptions = {}): Promise<Result> {
    return this.#run("repair", [mesh], options, call);
  }

  /** Writes a mesh in another format or unit. */
  convert(mesh: Mesh | UploadOf, options: types.ConvertOptions = {}, call: CallOptions = {}): Promise<Result> {
    return this.#run("convert", [mesh], options, call);
  }

  /** Fewer triangles, the same shape. */
  simplify(mesh: Mesh | UploadOf, options: types.SimplifyOptions = {}, call: CallOptions = {}): Promise<Result> {
    return this.#run("simplify", [mesh], options, call);
  }

  /** Closes holes. */
  fillHoles(mesh: Mesh | UploadOf, options: types.FillHolesOptions = {}, call: CallOptions = {}): Promise<Result> {
    return this.#run("fill-holes", [mesh], options, call);
  }

  /** Cuts singular edges and vertices, and stitches. */
  cutStitch(mesh: Mesh | UploadOf, options: types.CutStitchOptions = {}, call: CallOptions = {}): Promise<Result> {
    return this.#run("cut-stitch", [mesh], options, call);
  }

  /** Edits a polyhedron by its planes. */
  modeller(mesh: Mesh | UploadOf, options: types.ModellerOptions = {}, call: CallOptions = {}): Promise<Result> {
    return this.#run("modeller", [mesh], options, call);
  }

  /** Combines solids; a difference is the first without all others. */
  boolean(meshes: readonly Mesh[] | UploadOf, options: types.BooleanOptions = {}, call: CallOptions = {}): Promise<Result> {
    return this.#run("boolean", meshes instanceof UploadOf ? [meshes] : meshes, options, call);
  }

  // --- meshes before their job

  /**
   * Brings a mesh to the service before its job, and goes on where a connection broke: give what it returns to an operation
   * instead of the mesh. Only requests in a row that bring nothing are counted by `retries`.
   */
  async upload(mesh: KeptMesh, how: { signal?: AbortSignal } = {}): Promise<UploadOf> {
    const whole = mesh instanceof Blob ? mesh : new Blob([mesh]);
    const { signal } = how;
    const creating = { method: "POST" as const, path: "/v1/uploads", headers: announced(mesh, whole.size), signal };
    const location = await this.#connection.receive(creating, async (response) => {
      await response.text();
      return response.headers.get("location") ?? "";
    });
    const id = location.slice(location.lastIndexOf("/") + 1);
    const path = `/v1/uploads/${id}`;
    const stands = async (request: Pick<Request, "method" | "headers" | "body">) =>
      this.#connection.receive({ ...request, path, signal }, async (response) => {
        await response.text();
        const offset = response.headers.get("upload-offset");
        if (offset === null) throw new UnexpectedAnswerError(response.status, "the answer does not say where the upload stands");
        return Number(offset);
      });
    for (let [offset, attempt] = [0, 1]; offset < whole.size; ) {
      const before = offset;
      try {
        const headers = { ...TUS, "Upload-Offset": String(offset) };
        offset = await stands({ method: "PATCH", headers, body: restOf(whole, offset) });
      } catch (error) {
        if (!(error instanceof MeshmendError)) throw error;
        attempt += 1;
        // What an earlier request brought was stored after the service was asked how far it came.
        const isBehind = error instanceof ProblemError && error.code === "upload-conflict";
        await this.#connection.pause(attempt, isBehind ? new ConnectionFailedError(error.message) : error, true, signal);
        offset = await stands({ method: "HEAD", headers: TUS });
      }
      if (offset > before) attempt = 1;
    }
    return UploadOf.upload(id);
  }

  // --- jobs

  /**
   * Makes a job and does not wait for it. `request.operation` says what to do; several meshes are for `boolean`.
   * `cancelAfterS`: the job is ended when it takes longer.
   */
  async submit(
    mesh: Mesh | readonly Mesh[] | UploadOf,
    request: types.JobRequest,
    call: Omit<CallOptions, "timeoutS"> & { cancelAfterS?: number } = {},
  ): Promise<types.Job> {
    const headers: Record<string, string> = call.cancelAfterS === undefined ? {} : { "Cancel-After": String(call.cancelAfterS) };
    const meshes = Array.isArray(mesh) ? (mesh as readonly Mesh[]) : [mesh as Mesh | UploadOf];
    return this.#connection.receive(post("/v1/jobs", "job", meshes, request, call, headers), json<types.Job>);
  }

  /** A job as it stands, after at most `waitS` seconds if it has not ended before. */
  job(jobId: string, waitS = 0, signal?: AbortSignal): Promise<types.Job> {
    return this.#get(`/v1/jobs/${jobId}`, waitS > 0 ? [["wait", String(waitS)]] : [], signal);
  }

  /** A page of the caller's jobs, the latest first; `next` of the page is the `cursor` of the next one. */
  jobs(
    which: { cursor?: string; limit?: number; state?: types.JobState; labels?: Record<string, string> } = {},
  ): Promise<types.JobList> {
    const { labels = {}, ...plain } = which;
    const query = Object.entries(plain).map(([name, value]): [string, string] => [name, String(value)]);
    const wanted = Object.entries(labels).map(([name, value]): [string, string] => ["label", `${name}:${value}`]);
    return this.#get("/v1/jobs", [...query, ...wanted]);
  }

  /** What happens to a job, from its begin or after `lastEventId`, to its end. A cut connection is made again. */
  async *events(jobId: string, how: { lastEventId?: string; signal?: AbortSignal } = {}): AsyncGenerator<JobEvent, void, void> {
    let { lastEventId } = how;
    for (let attempt = 1; ; ) {
      const headers: Record<string, string> = { Accept: "text/event-stream", ...(lastEventId && { "Last-Event-ID": lastEventId }) };
      const response = await this.#connection.send({ method: "GET", path: `/v1/jobs/${jobId}/events`, headers, signal: how.signal });
      if (response.status === 204 || !response.body) return;
      const [reader, pieces] = [new EventReader(), chunksOf(response.body)];
      let cut: unknown;
      try {
        for (let piece = await next(pieces); !piece.done; piece = await next(pieces)) {
          if ("cut" in piece) {
            ({ cut } = piece);
            break;
          }
          // Also a comment, which a long pass has for hours: proxies that cut what is long do not end this.
          attempt = 1;
          for (const event of reader.feed(piece.value)) {
            lastEventId = event.id;
            yield event;
            if (event.name === "state" && isFinal(event.state)) return;
          }
        }
      } finally {
        await pieces.return();
      }
      attempt += 1;
      await this.#connection.pause(attempt, failed(cut, how.signal), true, how.signal);
    }
  }

  /**
   * Waits for a job's end, whatever it is. With `onEvent`, that is called with each event on the way. Throws
   * `NotFinishedError` when `timeoutS` is over before; with `onEvent` that is looked at with each event.
   */
  async wait(
    jobId: string,
    how: { onEvent?: (event: JobEvent) => void; timeoutS?: number; signal?: AbortSignal } = {},
  ): Promise<types.Job> {
    const end = endAfter(how.timeoutS);
    if (how.onEvent) {
      for await (const event of this.events(jobId, how.signal ? { signal: how.signal } : {})) {
        how.onEvent(event);
        if (isOver(end)) break;
      }
    }
    for (;;) {
      const job = await this.job(jobId, waitUntil(end), how.signal);
      if (isFinal(job.state)) return job;
      if (isOver(end)) throw new NotFinishedError(job);
    }
  }

  /** Waits for a job's end. Throws its problem when it did not succeed. */
  async result(jobId: string, how: { timeoutS?: number; signal?: AbortSignal } = {}): Promise<Result> {
    const job = await this.wait(jobId, how);
    const { problem } = job;
    if (!problem) return new Result(this.#connection, jobId, await this.report(jobId));
    // A job tells its problem without the report, which may be long.
    throw problemError(problem.code === "not-repairable" ? { ...problem, report: await this.report(jobId) } : problem);
  }

  /** The report of a job, also of one that was refused. */
  report(jobId: string): Promise<types.Report> {
    return this.#get(`/v1/jobs/${jobId}/report`);
  }

  /** The picture of a job that was made with `thumbnail` or that draws, in the format that it was made in. */
  async thumbnail(jobId: string, format: types.RenderOptions["picture_format"] = "png"): Promise<Uint8Array<ArrayBuffer>> {
    const path = `/v1/jobs/${jobId}/thumbnail.${format}`;
    return new Uint8Array(await this.#connection.receive({ method: "GET", path }, (response) => response.arrayBuffer()));
  }

  /** Cancels a job; one that has ended stays as it is. */
  cancel(jobId: string): Promise<types.Job> {
    return this.#connection.receive({ method: "POST", path: `/v1/jobs/${jobId}/cancel` }, json<types.Job>);
  }

  /** Removes a job with all its files. One that is not there throws `not-found`. */
  async delete(jobId: string): Promise<void> {
    await this.#connection.receive({ method: "DELETE", path: `/v1/jobs/${jobId}` }, (response) => response.text());
  }

  /** The webhooks of a job, with every try. */
  deliveries(jobId: string): Promise<types.Deliveries> {
    return this.#get(`/v1/jobs/${jobId}/deliveries`);
  }

  /** Sends a webhook again, with the same `webhook-id`. */
  redeliver(jobId: string, deliveryId: string): Promise<types.Delivery> {
    const path = `/v1/jobs/${jobId}/deliveries/${deliveryId}/redeliver`;
    return this.#connection.receive({ method: "POST", path }, json<types.Delivery>);
  }

  // --- the service about itself

  version(): Promise<types.Version> {
    return this.#get("/v1/version");
  }

  limits(): Promise<types.Limits> {
    return this.#get("/v1/limits");
  }

  formats(): Promise<types.FormatInfo[]> {
    return this.#get("/v1/formats");
  }

  policies(): Promise<types.PolicyInfo[]> {
    return this.#get("/v1/policies");
  }

  errors(): Promise<types.ErrorInfo[]> {
    return this.#get("/v1/errors");
  }

  // --- how it is done

  async #run(operation: string, meshes: readonly (Mesh | UploadOf)[], options: object, call: CallOptions): Promise<Result> {
    const end = endAfter(call.timeoutS);
    const headers = { Accept: "application/json", Prefer: `wait=${waitUntil(end)}` };
    const request = post(`/v1/${operation}`, "params", meshes, options, call, headers);
    const answer = await this.#connection.receive(request, async (response) => {
      const content = await json<unknown>(response);
      if (response.status === 202) return { job: content as types.Job };
      const id = response.headers.get("link")?.match(/<[^>]*\/v1\/jobs\/([^/>]+)\/report>/)?.[1];
      return { id: id ?? "", report: content as types.Report };
    });
    if (answer.report) return new Result(this.#connection, answer.id, answer.report);
    const left = end === undefined ? {} : { timeoutS: Math.max(end - performance.now() / 1000, 0) };
    return this.result(answer.job.id, { ...left, ...(call.signal && { signal: call.signal }) });
  }

  #get<T>(path: string, query: [string, string][] = [], signal?: AbortSignal): Promise<T> {
    return this.#connection.receive({ method: "GET", path, query, headers: { Accept: "application/json" }, signal }, json<T>);
  }
}

function post(
  path: string,
  field: string,
  meshes: readonly (Mesh | UploadOf)[],
  options: object,
  call: Pick<CallOptions, "idempotencyKey" | "material" | "signal">,
  headers: Record<string, string>,
) {
  const given = meshes.filter((mesh): mesh is Mesh => !(mesh instanceof UploadOf));
  const upload = meshes.find((mesh) => mesh instanceof UploadOf);
  if (upload && (meshes.length > 1 || call.material)) {
    throw new TypeError("the upload of an earlier job is used again as it is, alone");
  }
  const body = upload ? jsonBodyOf(options, upload) : bodyOf(field, options, given, call.material);
  const key = { "Idempotency-Key": call.idempotencyKey ?? randomText() };
  return { method: "POST" as const, path, headers: { ...headers, ...key }, body, signal: call.signal };
}

async function json<T>(response: Response): Promise<T> {
  return JSON.parse(await response.text()) as T;
}

/** The next piece of a stream, or why there is none. */
async function next(pieces: AsyncGenerator<Uint8Array, void, void>) {
  try {
    return await pieces.next();
  } catch (cut) {
    return { done: false as const, cut };
  }
}

function endAfter(timeoutS: number | undefined): number | undefined {
  return timeoutS === undefined ? undefined : performance.now() / 1000 + timeoutS;
}

function isOver(end: number | undefined): boolean {
  return end !== undefined && performance.now() / 1000 >= end;
}

/** Whole seconds that one request may wait; a bit more than is left rather than less. */
function waitUntil(end: number | undefined): number {
  return end === undefined ? WAIT_S : Math.min(Math.max(Math.ceil(end - performance.now() / 1000), 0), WAIT_S);
}
