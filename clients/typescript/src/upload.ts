// Bodies of requests: a form of options and meshes.

/** A mesh to send: a file of a browser or any other blob, its bytes, or a stream of pieces. For a path, see `meshmend/node`. */
export type Mesh = Blob | ArrayBuffer | ArrayBufferView<ArrayBuffer> | Stream;

type Stream = ReadableStream<Uint8Array> | AsyncIterable<Uint8Array>;

/** A mesh that the service has: the upload of an earlier job, or one that was made beforehand at `/v1/uploads`. */
export class UploadOf {
  /** Its name in `input`. */
  readonly reference: { job: string } | { upload: string };

  constructor(jobId: string) {
    this.reference = { job: jobId };
  }

  /** The one that was made beforehand, by its id. */
  static upload(id: string): UploadOf {
    return Object.assign(new UploadOf(id), { reference: { upload: id } });
  }
}

/** A mesh that can be sent again from any place on. */
export type KeptMesh = Exclude<Mesh, Stream>;

/** The protocol of uploads that come before their job: https://tus.io/protocols/resumable-upload. */
export const TUS = { "Tus-Resumable": "1.0.0" };

/** What is said of a mesh before it comes: its length and the name of its file. */
export function announced(mesh: KeptMesh, size: number): Record<string, string> {
  const name = nameOf(mesh);
  const encoded = name === undefined ? "" : btoa(String.fromCharCode(...new TextEncoder().encode(name)));
  return { ...TUS, "Upload-Length": String(size), ...(encoded && { "Upload-Metadata": `filename ${encoded}` }) };
}

/** What follows after so many bytes of a mesh. It is sent once: how far it came is asked before more is sent. */
export function restOf(mesh: Blob, offset: number): Body {
  return { contentType: "application/offset+octet-stream", content: mesh.slice(offset), isReplayable: false };
}

/** The body of a POST or PATCH. */
export interface Body {
  contentType: string;
  content: Blob | ReadableStream<Uint8Array>;
  /** Whether it can be sent a second time: not when a part is a stream. */
  isReplayable: boolean;
}

type Piece = string | Mesh;

/** A form: the options as JSON in `field`, then the meshes, each a part `mesh`, then the material of an OBJ. */
export function bodyOf(field: string, options: object, meshes: readonly Mesh[], material: Mesh | undefined): Body {
  const boundary = `meshmend-${randomText()}`;
  const parts: [string, Piece][] = [[head(boundary, field, undefined, "application/json"), JSON.stringify(options)]];
  for (const mesh of meshes) parts.push([head(boundary, "mesh", nameOf(mesh) ?? "mesh"), mesh]);
  if (material !== undefined) parts.push([head(boundary, "material", nameOf(material) ?? "material"), material]);
  const pieces = [...parts.flatMap(([text, source]) => [text, source, "\r\n"]), `--${boundary}--\r\n`];
  const contentType = `multipart/form-data; boundary=${boundary}`;
  const whole = pieces.filter((piece): piece is Exclude<Piece, Stream> => !isStream(piece));
  return whole.length === pieces.length
    ? { contentType, content: new Blob(whole), isReplayable: true }
    : { contentType, content: streamOf(pieces), isReplayable: false };
}

/** Options as JSON that name a mesh which the service has. */
export function jsonBodyOf(options: object, upload: UploadOf): Body {
  const text = JSON.stringify({ ...options, input: upload.reference });
  return { contentType: "application/json", content: new Blob([text]), isReplayable: true };
}

/** A UUID of version 4, also where `crypto.randomUUID` is not: on pages that are not secure. */
export function randomText(): string {
  const bytes = crypto.getRandomValues(new Uint8Array(16));
  const hex = [...bytes].map((byte) => byte.toString(16).padStart(2, "0")).join("");
  return `${hex.slice(0, 8)}-${hex.slice(8, 12)}-4${hex.slice(13, 16)}-a${hex.slice(17, 20)}-${hex.slice(20)}`;
}

function head(boundary: string, field: string, fileName: string | undefined, contentType = "application/octet-stream"): string {
  // As browsers write it: what would end the text early is percent-encoded.
  const escaped = fileName?.replace(/[%"\r\n]/g, (c) => `%${c.charCodeAt(0).toString(16).toUpperCase().padStart(2, "0")}`);
  const name = `name="${field}"${escaped === undefined ? "" : `; filename="${escaped}"`}`;
  return `--${boundary}\r\nContent-Disposition: form-data; ${name}\r\nContent-Type: ${contentType}\r\n\r\n`;
}

function nameOf(mesh: Mesh): string | undefined {
  return mesh instanceof Blob && "name" in mesh && typeof mesh.name === "string" && mesh.name !== "" ? mesh.name : undefined;
}

function isStream(piece: Piece): piece is Stream {
  return typeof piece === "object" && (piece instanceof ReadableStream || Symbol.asyncIterator in piece);
}

function streamOf(pieces: readonly Piece[]): ReadableStream<Uint8Array> {
  const bytes = bytesOf(pieces);
  return new ReadableStream({
    async pull(controller) {
      const next = await bytes.next();
      if (next.done) controller.close();
      else controller.enqueue(next.value);
    },
    async cancel() {
      await bytes.return();
    },
  });
}

async function* bytesOf(pieces: readonly Piece[]): AsyncGenerator<Uint8Array, void, void> {
  for (const piece of pieces) {
    if (!isStream(piece)) yield* chunksOf(new Blob([piece]).stream());
    else if (piece instanceof ReadableStream) yield* chunksOf(piece);
    else yield* piece;
  }
}

/** What a stream brings; not every browser can iterate over one by itself. */
export async function* chunksOf(stream: ReadableStream<Uint8Array>): AsyncGenerator<Uint8Array, void, void> {
  const reader = stream.getReader();
  try {
    for (let next = await reader.read(); !next.done; next = await reader.read()) yield next.value;
  } finally {
    // Whoever stops early wants no more of it.
    await reader.cancel().catch(() => undefined);
  }
}
