// What can go wrong, one class for each way to react to it.

import type { Job, Problem, ProblemCode, Report } from "./types.js";

/** Any error of this package. */
export class MeshmendError extends Error {
  constructor(message: string, options?: ErrorOptions) {
    super(message, options);
    this.name = new.target.name;
  }
}

/** The service said no, or a job ended without what was asked: `problem` is its problem document (RFC 9457). */
export class ProblemError extends MeshmendError {
  readonly problem: Problem;
  readonly retryAfterS: number | undefined;

  constructor(problem: Problem, retryAfterS?: number) {
    super(`${problem.code}: ${problem.detail}`);
    this.problem = problem;
    this.retryAfterS = retryAfterS;
  }

  /** The stable code; `GET /v1/errors` explains each. */
  get code(): ProblemCode {
    return this.problem.code;
  }

  get status(): number {
    return this.problem.status;
  }
}

/** The repair was refused: no result keeps what the request asks for. `report` says why. */
export class NotRepairableError extends ProblemError {
  get report(): Report | undefined {
    return this.problem.report ?? undefined;
  }
}

/** An error that is no problem document, for example of a proxy in between. */
export class UnexpectedAnswerError extends MeshmendError {
  readonly status: number;
  readonly body: string;
  readonly retryAfterS: number | undefined;

  constructor(status: number, body: string, retryAfterS?: number) {
    super(`status ${status}: ${body.slice(0, 200)}`);
    this.status = status;
    this.body = body;
    this.retryAfterS = retryAfterS;
  }
}

/** No answer, after all retries; `cause` says why. */
export class ConnectionFailedError extends MeshmendError {}

/** The time that the caller gives is over. The job goes on: `job` says which. */
export class NotFinishedError extends MeshmendError {
  readonly job: Job;

  constructor(job: Job) {
    super(`job ${job.id} is still ${job.state}`);
    this.job = job;
  }
}

/** The bytes that came are not those that the certificate is about. */
export class IntegrityError extends MeshmendError {}

/** A call that must not be believed. */
export class WebhookError extends MeshmendError {}

/** The error for a problem document. */
export function problemError(problem: Problem, retryAfterS?: number): ProblemError {
  const kind = problem.code === "not-repairable" ? NotRepairableError : ProblemError;
  return new kind(problem, retryAfterS);
}

/** The error for an answer that is none of the expected ones. */
export async function answerError(response: Response): Promise<ProblemError | UnexpectedAnswerError> {
  const text = await response.text();
  const retryAfter = response.headers.get("retry-after");
  const retryAfterS = retryAfter !== null && /^\d+$/.test(retryAfter) ? Number(retryAfter) : undefined;
  if (response.headers.get("content-type")?.split(";")[0]?.trim() === "application/problem+json") {
    const problem = parsed(text);
    if (isProblem(problem)) return problemError(problem, retryAfterS);
  }
  return new UnexpectedAnswerError(response.status, text, retryAfterS);
}

function parsed(text: string): unknown {
  try {
    return JSON.parse(text);
  } catch {
    return undefined;
  }
}

function isProblem(value: unknown): value is Problem {
  return typeof value === "object" && value !== null && "code" in value && "status" in value && "detail" in value;
}
