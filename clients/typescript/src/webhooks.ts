// Calls of the service, verified as Standard Webhooks says.

import { WebhookError } from "./errors.js";
import type { WebhookMessage } from "./types.js";

/** An older call may be a recorded one, as the specification advises. */
const TOLERANCE_S = 300;

export interface WebhookCheck {
  /** Most seconds between the call's time and now. Default: 300. */
  toleranceS?: number;
  /** Now, in seconds since 1970. Default: the clock's. */
  now?: number;
}

/**
 * The id and the message of a call whose signature is right for one of the secrets (`whsec_...`).
 *
 * `body` is the body as it came, byte for byte. A message may come more than once, always with the same id. Throws
 * `WebhookError` for a call that is not signed so, or longer ago (or ahead) than `toleranceS`.
 */
export async function verifyWebhook(
  body: Uint8Array<ArrayBuffer> | string,
  headers: Headers | Record<string, string | string[] | undefined>,
  secrets: string | readonly string[],
  check: WebhookCheck = {},
): Promise<{ id: string; message: WebhookMessage }> {
  const [id, timestamp, signatures] = ["webhook-id", "webhook-timestamp", "webhook-signature"].map((name) => header(headers, name));
  if (!id || !timestamp || !signatures) throw new WebhookError("a header of the signature is missing");
  if (!/^\d+$/.test(timestamp)) throw new WebhookError("the time is no number of seconds");
  const now = check.now ?? Date.now() / 1000;
  if (Math.abs(now - Number(timestamp)) > (check.toleranceS ?? TOLERANCE_S)) {
    throw new WebhookError("the call is too old, or a clock is wrong");
  }
  const content = typeof body === "string" ? new TextEncoder().encode(body) : body;
  const signed = new Uint8Array(await new Blob([`${id}.${timestamp}.`, content]).arrayBuffer());
  const given = signatures.split(" ").filter((text) => text.startsWith("v1,")).flatMap((text) => bytesOf(text.slice(3)) ?? []);
  let matches = false;
  for (const secret of typeof secrets === "string" ? [secrets] : secrets) {
    const raw = bytesOf(secret.replace(/^whsec_/, ""));
    if (raw === undefined) throw new TypeError("a secret is `whsec_` and base64");
    const key = await crypto.subtle.importKey("raw", raw, { name: "HMAC", hash: "SHA-256" }, false, ["verify"]);
    // All pairs are compared, each in constant time.
    for (const signature of given) matches = (await crypto.subtle.verify("HMAC", key, signature, signed)) || matches;
  }
  if (!matches) throw new WebhookError("the signature is not right");
  return { id, message: JSON.parse(new TextDecoder().decode(content)) as WebhookMessage };
}

function header(headers: Headers | Record<string, string | string[] | undefined>, name: string): string | undefined {
  if (headers instanceof Headers) return headers.get(name) ?? undefined;
  const value = Object.entries(headers).find(([key]) => key.toLowerCase() === name)?.[1];
  return Array.isArray(value) ? value[0] : value;
}

function bytesOf(base64: string): Uint8Array<ArrayBuffer> | undefined {
  try {
    return Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
  } catch {
    return undefined;
  }
}
