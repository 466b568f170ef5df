// A client typed by openapi-typescript repairs a mesh, reads a report, waits for a job and reads its events.
//
//     node with_openapi_typescript.js URL MESH.off

import { readFileSync } from "node:fs";
import createClient from "openapi-fetch";
import type { components, paths } from "./schema.js";

function check(holds: boolean, what: unknown): asserts holds {
  if (!holds) throw new Error(`expected otherwise: ${JSON.stringify(what)}`);
}

const [url, path] = process.argv.slice(2);
const client = createClient<paths>({ baseUrl: url });
const mesh = readFileSync(path);
// Bytes go out as they are; in the contract they are a string of format `binary`.
const raw = {
  body: mesh as unknown as string,
  bodySerializer: () => new Uint8Array(mesh),
  headers: { "Content-Type": "application/octet-stream" },
} as const;

const repaired = await client.POST("/v1/repair", {
  ...raw, params: { query: { output_format: "stl" } }, parseAs: "arrayBuffer",
});
check(repaired.response.status === 200 && (repaired.data as unknown as ArrayBuffer).byteLength > 84, repaired.error);
const fidelity: components["schemas"]["Fidelity"][] = ["exact", "faithful", "changed"];
check(fidelity.some((word) => word === repaired.response.headers.get("meshmend-fidelity")), "a word of fidelity");

const analyzed = await client.POST("/v1/analyze", raw);
check(analyzed.data !== undefined && "input" in analyzed.data && analyzed.data.input.format === "off", analyzed.error);

const made = await client.POST("/v1/jobs", { ...raw, params: { query: { operation: "repair" } } });
check(made.data !== undefined, made.error);
const params = { path: { id: made.data.id } };
const ended = await client.GET("/v1/jobs/{id}", { params: { ...params, query: { wait: 60 } } });
check(ended.data?.state === "succeeded", ended.data ?? ended.error);
const events = await client.GET("/v1/jobs/{id}/events", { params, parseAs: "text" });
check(String(events.data).includes("event: state") && String(events.data).includes("succeeded"), events.data);
const result = await client.GET("/v1/jobs/{id}/result", { params, parseAs: "text" });
check(String(result.data).startsWith("OFF"), result.error);
console.log("openapi-typescript: repaired, read a report, waited for a job, read its events");
