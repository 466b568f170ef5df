// Server-sent events of a job.

import type { JobState, StageEvent, StateEvent } from "./types.js";

/** The job has come into another state, or a pass of its run begins or ends. */
export type JobEvent = ({ name: "state"; id: string } & StateEvent) | ({ name: "stage"; id: string } & StageEvent);

const FINAL: readonly JobState[] = ["succeeded", "failed", "cancelled", "expired"];

/** Whether nothing further will happen to a job. */
export function isFinal(state: JobState): boolean {
  return FINAL.includes(state);
}

/** Takes a stream of events as it comes, piece by piece. */
export class EventReader {
  readonly #decoder = new TextDecoder();
  #rest = "";
  #name = "";
  #id = "";
  #data: string[] = [];

  /** The events that are complete with this piece. Names that this version does not know are passed over. */
  feed(piece: Uint8Array): JobEvent[] {
    const lines = (this.#rest + this.#decoder.decode(piece, { stream: true })).split("\n");
    this.#rest = lines.pop() ?? "";
    return lines.flatMap((line) => this.#line(line.replace(/\r$/, "")) ?? []);
  }

  #line(line: string): JobEvent | undefined {
    if (line === "") return this.#complete();
    // A line that begins with a colon is a comment that tells that the connection lives.
    const [field, ...rest] = line.split(":");
    const value = rest.join(":").replace(/^ /, "");
    if (field === "event") this.#name = value;
    else if (field === "id") this.#id = value;
    else if (field === "data") this.#data.push(value);
    return undefined;
  }

  #complete(): JobEvent | undefined {
    const [name, data] = [this.#name, this.#data.join("\n")];
    this.#name = "";
    this.#data = [];
    if (name === "state") return { name, id: this.#id, ...(JSON.parse(data) as StateEvent) };
    if (name === "stage") return { name, id: this.#id, ...(JSON.parse(data) as StageEvent) };
    return undefined;
  }
}
