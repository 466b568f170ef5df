// The whole walk: drop, see, choose, repair, compare, download, verify.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { createHash } from "node:crypto";
import { mkdtempSync, readFileSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { SAMPLES } from "../../web/src/samples.js";
import { drop, opened, picture, repaired, shot, url, withPage } from "./browser.mjs";

const sha256 = (bytes) => createHash("sha256").update(bytes).digest("hex");
const scan = SAMPLES.scan();

export async function fromDropToProof(browser) {
  await withPage(browser, { permissions: ["clipboard-read", "clipboard-write"] }, async (page) => {
    await shot(page, "start");
    await drop(page, "body", "scan.off", scan);
    await opened(page);
    await looks(page);
    await chooses(page);
    await compares(page);
    await downloads(page);
    await verifies(page);
    await repeatsWithCurl(page);
  });
}

async function looks(page) {
  const report = JSON.parse(execFileSync("curl", ["-sf", "--data-binary", "@-", `${url}/v1/analyze`], { input: scan }));
  for (const { code, count } of report.before.defects) {
    assert.equal(await page.textContent(`.finding-title[data-code="${code}"] .count`), String(count), code);
  }
  const whole = await picture(page);
  assert.ok(whole.variance > 200, `a part is seen: ${whole.variance}`);
  assert.ok(whole.orange > 0.0005, `rims are lit: ${whole.orange}`);
  assert.ok(whole.red > 0.0005, `through holes one sees back faces: ${whole.red}`);
  await shot(page, "findings");

  await page.uncheck("#findings input >> nth=1");
  await page.uncheck("#findings input >> nth=0");
  assert.ok((await picture(page)).orange < whole.orange / 3, "an overlay can be switched off");
  await page.check("#findings input >> nth=1");

  await page.click(".finding-title[data-code=boundary-loop]");
  await page.waitForSelector("#view[data-place='boundary-loop 0'] #ring:not([hidden])");
  assert.ok((await picture(page)).orange > whole.orange, "the place is near and lit");
  const [ring, view] = [await page.locator("#ring").boundingBox(), await page.locator("#view").boundingBox()];
  const off = Math.hypot(ring.x + ring.width / 2 - view.x - view.width / 2, ring.y + ring.height / 2 - view.y - view.height / 2);
  assert.ok(off < 40, `the place is in the middle of the picture: ${off}`);
  await shot(page, "place");
  await page.keyboard.press("n");
  await page.waitForSelector("#view[data-place='boundary-loop 1']");
  await page.keyboard.press("p");
  await page.waitForSelector("#view[data-place='boundary-loop 0']");

  await page.click("#fit");
  const before = await picture(page);
  await page.click("#section");
  await page.selectOption("#section-axis", "0");
  const cut = await picture(page);
  assert.ok(Math.abs(cut.variance - before.variance) > 20, "a section takes a part away");
  await shot(page, "section");
  await page.click("#section");
  await page.click("#edges");
  assert.ok(Math.abs((await picture(page)).variance - before.variance) > 2, "edges are drawn");
  await page.click("#edges");
}

async function chooses(page) {
  await page.click(".finding-title[data-code=isolated-face]");
  await page.selectOption("[data-role=remedy]", "remove");
  await page.click(".finding-title[data-code=boundary-loop]");
  await page.selectOption("[data-role=method]", "smooth");
  const sent = page.waitForRequest((request) => request.method() === "POST" && (request.postData() ?? "").includes('"repair"'));
  await page.click("#repair");
  const asked = JSON.parse((await sent).postData());
  assert.deepEqual(asked.plan.findings.map(({ code }) => code).sort(), ["boundary-loop", "isolated-face"]);
  assert.ok(asked.input.job, "the file is not sent again");
  await repaired(page);
  assert.match(await page.textContent("#verdict h2"), /Certified/);
}

async function compares(page) {
  await page.waitForSelector("#legend .new");
  await page.click("#fit");
  const both = await picture(page);
  assert.ok(both.teal > 0.0005 || both.orange > 0.0005, "kept and new have two colours");
  await shot(page, "slider");
  await page.focus("#divider");
  for (let i = 0; i < 24; i += 1) await page.keyboard.press("ArrowLeft");
  assert.ok((await picture(page)).orange < both.orange, "the border moves by keyboard, and with it the share of before");
  await page.click("#arrangement [data-arrangement=beside]");
  await picture(page);
  await shot(page, "beside");
  await page.click("#arrangement [data-arrangement=after]");
  for (const colors of ["deviation", "thickness"]) {
    await page.selectOption("#colors", colors);
    await page.waitForSelector("#legend .ramp");
    assert.ok((await picture(page)).blue > 0.01, colors);
    await shot(page, colors);
  }
}

async function saved(page, click) {
  const [download] = await Promise.all([page.waitForEvent("download"), click()]);
  return readFileSync(await download.path());
}

async function downloads(page) {
  const bytes = await saved(page, () => page.click("#download"));
  assert.equal(sha256(bytes), await page.textContent("#hash"), "what is downloaded is what is certified");
  await page.selectOption("#format", "stl");
  const stl = await saved(page, () => page.click("#download"));
  assert.equal(stl.length, 84 + 50 * stl.readUInt32LE(80));
  assert.equal(sha256(stl), await page.textContent("#hash"), "another format has a certificate of its own");
  const certificate = JSON.parse(await saved(page, () => page.click("#certificate")));
  assert.equal(certificate.sha256, sha256(stl));
  page.stl = stl;
}

async function verifies(page) {
  await drop(page, ".verify .drop", "part.stl", page.stl);
  await page.waitForSelector("#verified.good");
  assert.match(await page.textContent("#verified"), /byte for byte.*valid solid/);
  await page.setInputFiles("#verify-file", { name: "scan.off", mimeType: "", buffer: Buffer.from(scan) });
  await page.waitForSelector("#verified.bad");
  assert.match(await page.textContent("#verified"), /not the certified file.*not a valid solid/);
  await page.locator("#verified").scrollIntoViewIfNeeded();
  await shot(page, "verified");
}

async function repeatsWithCurl(page) {
  await page.click("text=Copy as curl");
  const command = await page.evaluate(() => navigator.clipboard.readText());
  const folder = mkdtempSync(join(tmpdir(), "meshmend-"));
  writeFileSync(join(folder, "scan.off"), scan);
  execFileSync("sh", ["-c", `${command} -s`], { cwd: folder });
  assert.equal(sha256(readFileSync(join(folder, "scan-repaired.stl"))), await page.textContent("#hash"), command);
}

// A part of several bodies, against the limits of a process, with fewer triangles.
export async function processAndSimplify(browser) {
  await withPage(browser, { colorScheme: "dark" }, async (page) => {
    await page.click("#sample-bodies");
    await opened(page);
    assert.ok((await picture(page)).pink > 0.0002, "lines show where bodies pass through each other");
    await page.selectOption("#policy", "sls");
    await page.waitForSelector("#checks .check");
    await page.locator("#share").fill("50");
    await page.click("#repair");
    await repaired(page);
    assert.match(await page.textContent("#verdict .policy"), /SLS/);
    const [, before, after] = (await page.textContent(".result .figures dd")).replace(/[,.]/g, "").match(/(\d+) → (\d+)/);
    assert.ok(after < before * 2, `${before} ${after}`);
    await page.click("#checks button >> nth=0");
    await page.waitForSelector("#ring:not([hidden])");
    await shot(page, "bodies");
  });
}
