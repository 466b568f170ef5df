// What an operation made.

import type { Connection } from "./connection.js";
import { IntegrityError } from "./errors.js";
import type { Report } from "./types.js";

/** What an operation made: its report, and the mesh, which is fetched when it is asked for. */
export class Result {
  readonly #connection: Connection;

  constructor(
    connection: Connection,
    readonly jobId: string,
    readonly report: Report,
  ) {
    this.#connection = connection;
  }

  /** The mesh, its SHA-256 compared with the certificate's. `level`: which target of a simplification, from 1. */
  async bytes(level = 1): Promise<Uint8Array<ArrayBuffer>> {
    // Browsers give it to pages of https and of the own machine only.
    if (!globalThis.crypto?.subtle) throw new IntegrityError("a mesh cannot be checked on a page that is not secure");
    const content = await this.receive(level, (response) => response.arrayBuffer());
    const digest = new Uint8Array(await crypto.subtle.digest("SHA-256", content));
    this.check([...digest].map((byte) => byte.toString(16).padStart(2, "0")).join(""), level);
    return new Uint8Array(content);
  }

  /** SHA-256 that the certificate states for the mesh, in hexadecimal. */
  sha256(level = 1): string {
    const { levels, certificate } = this.report;
    const stated = levels.length > 0 ? levels[level - 1]?.certificate : certificate;
    if (!stated) throw new IntegrityError("the report has no certificate for a result");
    return stated.sha256;
  }

  /** Throws unless this is the certificate's SHA-256. */
  check(sha256: string, level: number): void {
    if (sha256 !== this.sha256(level)) {
      throw new IntegrityError(`the bytes have the SHA-256 ${sha256}, the certificate says ${this.sha256(level)}`);
    }
  }

  /** Reads the mesh as it comes, unchecked; again from its begin when the connection fails. */
  async receive<T>(level: number, read: (response: Response) => Promise<T>): Promise<T> {
    const query: [string, string][] = level === 1 ? [] : [["level", String(level)]];
    return this.#connection.receive({ method: "GET", path: `/v1/jobs/${this.jobId}/result`, query }, read);
  }
}
