// How requests are sent, and sent again.

import { answerError, ConnectionFailedError, type MeshmendError } from "./errors.js";
import { pauseBefore, type Retries } from "./retries.js";
import type { Body } from "./upload.js";

export interface Request {
  method: "GET" | "HEAD" | "POST" | "PATCH" | "DELETE";
  path: string;
  query?: [string, string][];
  headers?: Record<string, string>;
  body?: Body;
  signal?: AbortSignal | undefined;
}

export class Connection {
  readonly #url: string;
  readonly #headers: Record<string, string>;
  readonly #retries: Retries;
  readonly #fetch: typeof fetch;

  constructor(url: string, headers: Record<string, string>, retries: Retries, how: typeof fetch) {
    this.#url = url.replace(/\/+$/, "");
    this.#headers = headers;
    this.#retries = retries;
    this.#fetch = how;
  }

  /** Sends a request until its answer is a good one, whose body is still to be read. */
  async send(request: Request): Promise<Response> {
    for (let attempt = 1; ; attempt += 1) {
      let error: MeshmendError;
      try {
        const response = await this.#once(request);
        // What was deleted by a request whose answer was lost is gone, as asked.
        if (response.ok || (request.method === "DELETE" && attempt > 1 && response.status === 404)) return response;
        error = await answerError(response);
      } catch (cause) {
        error = failed(cause, request.signal);
      }
      await this.pause(attempt + 1, error, request.body?.isReplayable ?? true, request.signal);
    }
  }

  /** Sends a request and reads its answer with `read`; both are done again when the connection fails. */
  async receive<T>(request: Request, read: (response: Response) => Promise<T>): Promise<T> {
    for (let attempt = 1; ; attempt += 1) {
      const response = await this.send(request);
      try {
        return await read(response);
      } catch (cause) {
        // A body that ends early is a TypeError of `fetch`; anything else is for the caller.
        if (!(cause instanceof TypeError) && !isAbort(cause)) throw cause;
        await this.pause(attempt + 1, failed(cause, request.signal), request.body?.isReplayable ?? true, request.signal);
      }
    }
  }

  /** Waits before an attempt, or throws the error when it is not to be made. */
  async pause(attempt: number, error: MeshmendError, isReplayable: boolean, signal?: AbortSignal): Promise<void> {
    const pauseS = isReplayable ? pauseBefore(this.#retries, attempt, error) : undefined;
    if (pauseS === undefined) throw error;
    await new Promise<void>((resolve, reject) => {
      const stop = () => {
        clearTimeout(timer);
        reject(signal?.reason as Error);
      };
      const timer = setTimeout(() => {
        signal?.removeEventListener("abort", stop);
        resolve();
      }, pauseS * 1000);
      if (signal?.aborted) stop();
      else signal?.addEventListener("abort", stop, { once: true });
    });
  }

  async #once({ method, path, query = [], headers, body, signal }: Request): Promise<Response> {
    const search = new URLSearchParams(query).toString();
    const content = body && { "Content-Type": body.contentType };
    const init: RequestInit & { duplex?: "half" } = { method, headers: { ...this.#headers, ...headers, ...content }, cache: "no-store" };
    if (signal) init.signal = signal;
    if (body) init.body = body.content;
    // A stream is sent before the answer is read.
    if (body?.content instanceof ReadableStream) init.duplex = "half";
    const how = this.#fetch;
    return how(`${this.#url}${path}${search && `?${search}`}`, init);
  }
}

/** The error for a connection that failed; the caller's own end is thrown as it is. */
export function failed(cause: unknown, signal?: AbortSignal): MeshmendError {
  if (signal?.aborted) throw signal.reason;
  const inner = cause instanceof Error && cause.cause instanceof Error ? `: ${cause.cause.message}` : "";
  return new ConnectionFailedError(cause instanceof Error ? `${cause.message}${inner}` : "the connection ended early", { cause });
}

function isAbort(cause: unknown): boolean {
  return cause instanceof Error && cause.name === "AbortError";
}
