// When a request is sent again, and after which pause.

import { ConnectionFailedError, type MeshmendError, ProblemError, UnexpectedAnswerError } from "./errors.js";

/** How often and how patiently a request is sent again. */
export interface Retries {
  /** Most requests for one call, the first one included. Default: 6. */
  attemptsMax: number;
  /** Pause after the first failure, in seconds; it doubles with each further one. Default: 0.5. */
  pauseS: number;
  /** Longest pause of ours, in seconds. Default: 30. */
  pauseMaxS: number;
  /** A `Retry-After` beyond this is not waited for: the error is thrown. Default: 300. */
  retryAfterMaxS: number;
}

export const RETRIES: Retries = { attemptsMax: 6, pauseS: 0.5, pauseMaxS: 30, retryAfterMaxS: 300 };

// Too slow an upload, too many requests, and whatever a service or proxy in between says when it is away for a moment.
const PASSING = [408, 429, 502, 503];

/** Seconds to wait before the given attempt, from 2; none when it is not to be made. */
export function pauseBefore(retries: Retries, attempt: number, error: MeshmendError): number | undefined {
  if (attempt > retries.attemptsMax || !isPassing(error)) return undefined;
  const asked = error instanceof ProblemError || error instanceof UnexpectedAnswerError ? error.retryAfterS : undefined;
  const own = Math.min(retries.pauseS * 2 ** (attempt - 2), retries.pauseMaxS);
  // Anything from half to all, so that clients that failed together do not come back together.
  if (asked === undefined) return own * (0.5 + Math.random() / 2);
  // Never before the server's time, and not all at it.
  return asked <= retries.retryAfterMaxS ? asked + (own * Math.random()) / 2 : undefined;
}

function isPassing(error: MeshmendError): boolean {
  // A lost worker: the job itself ended so, and the same key gives the same job again.
  if (error instanceof ProblemError) return PASSING.includes(error.status) && error.code !== "worker-lost";
  if (error instanceof UnexpectedAnswerError) return PASSING.includes(error.status) || error.status === 504;
  return error instanceof ConnectionFailedError;
}
