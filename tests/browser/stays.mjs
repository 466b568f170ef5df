// What stays when something else changes: the choices of a job, its result, the name of a file, and what has to be in sight.

import assert from "node:assert/strict";
import { createHash } from "node:crypto";
import { execFileSync } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { SAMPLES } from "../../web/src/samples.js";
import { opened, repaired, withPage } from "./browser.mjs";

const open = (page, name, content) => page.setInputFiles("#file", { name, mimeType: "", buffer: Buffer.from(content) });
const triangles = async (page) => (await page.textContent(".result .figures dd")).replace(/[,.]/g, "").match(/→ (\d+)/)[1];
const nextRequest = (page) => page.waitForRequest((request) => request.method() === "POST" && (request.postData() ?? "").includes('"operation"'));
const asked = async (request) => JSON.parse(/\{"operation".*\}/.exec((await request).postData())[0]);

async function saved(page, selector) {
  const [download] = await Promise.all([page.waitForEvent("download"), page.click(selector)]);
  return { name: download.suggestedFilename(), bytes: readFileSync(await download.path()) };
}

// A job that is opened again shows and asks for what it was made with, also in another format.
export async function choicesOfAJob(browser) {
  await withPage(browser, { permissions: ["clipboard-read", "clipboard-write"] }, async (page) => {
    await open(page, "scan.off", SAMPLES.scan());
    await opened(page);
    await page.selectOption("#policy", "sls");
    await page.waitForSelector("#checks .check");
    await page.selectOption("#units", "cm");
    await page.waitForFunction(() => document.querySelector("#size").textContent.includes("cm"));
    await page.waitForSelector("#progress", { state: "hidden" });
    await page.locator("#share").fill("30");
    await page.click(".finding-title[data-code=isolated-face]");
    await page.selectOption("[data-role=remedy]", "remove");
    const first = nextRequest(page);
    await page.click("#repair");
    const { operation, input, thumbnail, ...choices } = await asked(first);
    await repaired(page);
    const [count, hash] = [await triangles(page), await page.textContent("#hash")];

    await page.reload();
    await repaired(page);
    assert.deepEqual(await page.evaluate(() => ["units", "policy", "share"].map((id) => document.getElementById(id).value)), ["cm", "sls", "30"]);
    assert.match(await page.textContent("#share-text"), /^30%/);
    assert.equal(await page.textContent("#hash"), hash);
    await page.click(".finding-title[data-code=isolated-face]");
    assert.equal(await page.inputValue("[data-role=remedy]"), "remove");
    await page.click("text=Copy as curl");
    assert.match(await page.evaluate(() => navigator.clipboard.readText()), /"ratio":0\.3/);
    await page.selectOption("#format", "obj");
    const again = nextRequest(page);
    const { name, bytes } = await saved(page, "#download");
    const { output_format: format, operation: same, input: of, ...repeated } = await asked(again);
    assert.deepEqual([name, format, repeated], ["scan-repaired.obj", "obj", choices]);
    assert.equal(bytes.toString().match(/^f /gm).length, Number(count), "the same mesh in another format");
    assert.equal(await triangles(page), count);

    // Of a job of another browser it is not known what was done about each finding.
    await page.evaluate(() => localStorage.removeItem("jobs"));
    await page.reload();
    await repaired(page);
    assert.deepEqual(await page.evaluate(() => ["units", "policy", "share"].map((id) => document.getElementById(id).value)), ["cm", "sls", "30"]);
    assert.deepEqual(await page.locator("#format option").allTextContents(), ["OBJ"]);
    assert.equal((await saved(page, "#download")).name, "scan-repaired.obj");
  });
}
