// The scenario in Node.
//
//     node scenario_node.js NEIGHBOUR_URL NAME FIXTURES FOLDER

import { readdir, readFile } from "node:fs/promises";
import { join } from "node:path";
import { meshAt, save } from "meshmend/node";
import { run } from "./scenario.js";

const [url = "", name = "", fixtures = "", folder = ""] = process.argv.slice(2);
const at = (path: string) => join(path === "slow.stl" ? folder : fixtures, path);

await run(url, name, {
  read: async (path) => new Uint8Array(await readFile(at(path))),
  meshAt: (path) => meshAt(at(path)),
  save: async (result, file) => {
    await save(result, join(folder, file));
    return new Uint8Array(await readFile(join(folder, file)));
  },
  leftOf: async (file) => (await readdir(folder)).filter((other) => other.includes(file)).length,
  canStream: true,
  print: (line) => console.log(line),
});
