// The scenario in a browser: its page is one of the neighbour's, which takes what is printed.

import { run } from "./scenario.js";

const name = location.hash.slice(1);
const kept = new Map<string, Uint8Array>();
const lines: string[] = [];
const read = async (path: string) => {
  const answer = await fetch(path === "slow.stl" ? `/files/${path}` : `/files/fixtures/${path}`);
  return new Uint8Array(await answer.arrayBuffer());
};
try {
  await run(location.origin, name, {
    read,
    // As an input of the page gives it.
    meshAt: async (path) => new File([await read(path)], path.split("/").at(-1) ?? ""),
    save: async (result, file) => {
      const mesh = await result.bytes();
      kept.set(file, mesh);
      return mesh;
    },
    leftOf: async (file) => (kept.has(file) ? 1 : 0),
    // Browsers send streams over HTTP/2 only.
    canStream: false,
    print: (line) => lines.push(line),
  });
} catch (error) {
  lines.push(`failed: ${error instanceof Error ? error.stack : String(error)}`);
}
await fetch(`/${name}/printed`, { method: "POST", body: `${lines.join("\n")}\n` });
