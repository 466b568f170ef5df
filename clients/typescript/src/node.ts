// What only Node can do: files by their path.

import { createHash, randomUUID } from "node:crypto";
import { openAsBlob } from "node:fs";
import { open, rename, rm } from "node:fs/promises";
import { basename, dirname, join } from "node:path";

import type { Result } from "./result.js";
import { chunksOf } from "./upload.js";

/** The mesh in a file; it is read while it is sent. */
export async function meshAt(path: string): Promise<Blob> {
  return Object.assign(await openAsBlob(path), { name: basename(path) });
}

/** Writes the mesh of a result to a file, which is there only when its SHA-256 is the certificate's. */
export async function save(result: Result, path: string, level = 1): Promise<void> {
  const part = join(dirname(path), `.${basename(path)}.${randomUUID()}.part`);
  try {
    const sha256 = await result.receive(level, (response) => written(response, part));
    result.check(sha256, level);
    await rename(part, path);
  } finally {
    await rm(part, { force: true });
  }
}

async function written(response: Response, path: string): Promise<string> {
  const digest = createHash("sha256");
  const file = await open(path, "w");
  try {
    for await (const chunk of response.body ? chunksOf(response.body) : []) {
      digest.update(chunk);
      await file.writeFile(chunk);
    }
  } finally {
    await file.close();
  }
  return digest.digest("hex");
}
