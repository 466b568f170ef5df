// Runs every test of the page against a server, one after the other.
//
//   node tests/browser/run.mjs URL FOLDER [NAME...]
//
// FOLDER takes the screenshots. Needs Chromium, and the packages as scripts/test.sh installs them.

import { launch } from "./browser.mjs";
import * as documents from "./documents.mjs";
import * as files from "./files.mjs";
import * as modules from "./modules.mjs";
import * as stays from "./stays.mjs";
import * as walk from "./walk.mjs";
import * as ways from "./ways.mjs";

const wanted = process.argv.slice(4);
const tests = Object.entries({ ...modules, ...walk, ...ways, ...stays, ...files, ...documents }).filter(([name]) => !["heap", "serious"].includes(name) && (wanted.length === 0 || wanted.includes(name)));
const browser = await launch();
let failures = 0;
for (const [name, test] of tests) {
  const begin = performance.now();
  try {
    await test(browser);
    console.log(`ok      ${name} (${((performance.now() - begin) / 1000).toFixed(1)} s)`);
  } catch (error) {
    failures += 1;
    console.log(`FAILED  ${name}\n${error.stack}`);
  }
}
await browser.close();
console.log(failures ? `${failures} of ${tests.length} tests failed` : `all ${tests.length} tests passed`);
process.exitCode = failures ? 1 : 0;
