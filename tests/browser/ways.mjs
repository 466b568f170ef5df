// Other ways through the page: errors, keyboard, phone, reload, languages; and for everybody (axe).

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { drop, need, opened, picture, repaired, shot, url, withPage } from "./browser.mjs";

const axe = readFileSync(need.resolve("axe-core/axe.min.js"), "utf8");

export async function errors(browser) {
  await withPage(browser, {}, async (page) => {
    const told = async (code, text) => {
      const notice = await page.waitForSelector(`.notice[data-code="${code}"]`);
      assert.match(await notice.textContent(), text);
      assert.ok(await page.isVisible("#start .drop"), "the next file can be dropped at once");
    };
    await drop(page, "body", "letter.obj", "Dear customer,\n");
    await told("mesh-unparseable", /cannot be read/);
    await drop(page, "body", "part.off", "OFF\n8 12 0\n0 0 0\n1 0 0\n");
    await told("mesh-truncated", /ends too early.*line 5/);
    await shot(page, "error");
    await page.route("**/v1/jobs", (route) => route.abort());
    await page.click("#sample-sound");
    await page.waitForSelector('.notice[data-code="unreachable"]');
    await page.unroute("**/v1/jobs");
    await page.click("#dismiss");
    assert.equal(await page.locator(".notice").count(), 0);
    await drop(page, "body", "rim.off", "OFF\n3 1 0\n0 0 0\n10 0 0\n0 10 0\n3 0 1 2\n");
    await opened(page);
    assert.match(await page.textContent("#verdict h2"), /Not printable/);
  });
}

// From the first key to the download, without a pointer.
export async function keyboard(browser) {
  await withPage(browser, {}, async (page) => {
    const reach = async (selector) => {
      for (let i = 0; i < 120; i += 1) {
        if (await page.evaluate((wanted) => document.activeElement.matches(wanted), selector)) return;
        await page.keyboard.press("Tab");
      }
      assert.fail(`${selector} cannot be reached by Tab`);
    };
    await reach("#sample-scan");
    await page.keyboard.press("Enter");
    await opened(page);
    await reach("#canvas");
    const frames = Number(await page.getAttribute("#view", "data-frames"));
    for (const key of ["ArrowLeft", "ArrowUp", "+", "-", "f"]) await page.keyboard.press(key);
    await page.waitForFunction((seen) => Number(document.querySelector("#view").dataset.frames) > seen, frames);
    await page.keyboard.press("n");
    await page.waitForSelector("#ring:not([hidden])");
    await reach("[data-role=next]");
    await page.keyboard.press("Enter");
    await reach("[data-role=next]");
    await reach("#repair");
    await page.keyboard.press("Enter");
    await repaired(page);
    await reach("#divider");
    await reach("#download");
    const [download] = await Promise.all([page.waitForEvent("download"), page.keyboard.press("Enter")]);
    assert.match(download.suggestedFilename(), /\.off$/);
  });
}

export async function phone(browser) {
  const settings = { viewport: { width: 390, height: 780 }, deviceScaleFactor: 1, hasTouch: true, isMobile: true };
  await withPage(browser, settings, async (page) => {
    await page.tap("#sample-scan");
    await opened(page);
    await page.tap(".finding-title[data-code=boundary-loop]");
    await page.waitForSelector("#ring:not([hidden])");
    await shot(page, "phone");
    assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), 390, "nothing is wider than the phone");
    await page.tap("#repair");
    await repaired(page);
    assert.ok((await picture(page)).variance > 200);
    await shot(page, "phone-result");
    await page.setInputFiles("#file", { name: "letter.obj", mimeType: "", buffer: Buffer.from("Dear customer,\n") });
    await page.waitForSelector(".notice");
    const [notice, zone] = await Promise.all([".notice", "#start .drop"].map((selector) => page.locator(selector).boundingBox()));
    assert.ok(notice.y > 0 && notice.y + notice.height < zone.y && zone.y < 780, "below what is wrong the next file can be chosen");
    await shot(page, "phone-error");
  });
}

// At the width of a narrow phone the head has two rows at most, in every language.
export async function narrowPhone(browser) {
  const settings = { viewport: { width: 360, height: 780 }, deviceScaleFactor: 1, hasTouch: true, isMobile: true };
  for (const locale of ["de", "fr", "en"]) {
    await withPage(browser, { ...settings, locale }, async (page) => {
      await page.tap("#sample-sound");
      await opened(page);
      const rows = await page.locator("header > :not(.unseen)").evaluateAll((parts) => {
        const boxes = parts.map((part) => part.getBoundingClientRect()).filter(({ width, height }) => width && height).sort((a, b) => a.top - b.top);
        return boxes.reduce(({ count, end }, { top, bottom }) => (top >= end ? { count: count + 1, end: bottom } : { count, end: Math.max(end, bottom) }), { count: 0, end: -Infinity }).count;
      });
      assert.ok(rows <= 2, `${locale}: ${rows} rows`);
      assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), 360, "nothing is wider than the phone");
      await shot(page, `phone-360-${locale}`);
    });
  }
}

// A job that takes long: hundreds of triangles thrown together.
export function heap(count) {
  let seed = 12345;
  const random = () => { seed = (Math.imul(seed, 1103515245) + 12345) & 0x7fffffff; return seed / 0x7fffffff; };
  const vertices = [];
  for (let i = 0; i < count; i += 1) {
    const middle = [random() * 60, random() * 60, random() * 60];
    for (let corner = 0; corner < 3; corner += 1) vertices.push(middle.map((value) => (value + random() * 8 - 4).toFixed(4)).join(" "));
  }
  const faces = Array.from({ length: count }, (_, i) => `3 ${i * 3} ${i * 3 + 1} ${i * 3 + 2}`);
  return `OFF\n${vertices.length} ${count} 0\n${vertices.join("\n")}\n${faces.join("\n")}\n`;
}

export async function reloadAndCancel(browser) {
  await withPage(browser, {}, async (page) => {
    await drop(page, "body", "heap.off", heap(2000));
    await opened(page);
    const looked = await page.evaluate(() => location.hash);
    await page.click("#repair");
    await page.waitForFunction((hash) => location.hash !== hash, looked);
    await page.waitForFunction(() => Number(document.querySelector("#bar").getAttribute("value")) > 0);
    await page.reload();
    await page.waitForSelector("#cancel:not([hidden])");
    // The run goes on meanwhile, so that it may be in any pass by now.
    await page.waitForFunction(() => document.querySelector("#stage").textContent !== "");
    assert.equal(await page.textContent("#file-name"), "heap.off");
    await page.click("#cancel");
    await page.waitForSelector('.notice[data-code="cancelled"]');

    // Jobs of this browser are listed, and open again by their link.
    await page.click("#sample-sound");
    await opened(page);
    await page.click("#repair");
    await repaired(page);
    const link = await page.evaluate(() => location.hash);
    await page.reload();
    await repaired(page);
    assert.match(await page.textContent("#verdict"), /same bytes come back/);
    await page.click("#jobs summary");
    // The list is made when it is opened.
    await page.locator("#jobs-list a").nth(3).waitFor();
    assert.equal(await page.locator("#jobs-list a").count(), 4);
    await page.click(`#jobs-list a:not([href="${link}"]) >> nth=0`);
    await page.waitForFunction((hash) => location.hash !== hash, link);
    await opened(page);
    assert.equal(await page.textContent("#file-name"), "sound.off");
  });
}

export async function languages(browser) {
  const { components } = await (await fetch(`${url}/openapi.json`)).json();
  await withPage(browser, { locale: "de-AT" }, async (page) => {
    assert.equal(await page.textContent("#start .drop strong"), "Netz hier ablegen");
    await page.selectOption("#language", "fr");
    assert.equal(await page.textContent("#start .drop strong"), "Déposez un maillage ici");
    assert.equal(await page.getAttribute("html", "lang"), "fr");
    await page.reload();
    await page.waitForSelector("body[data-ready]");
    assert.equal(await page.inputValue("#language"), "fr", "the choice is kept");
  });
  const { words: own } = await import("../../web/src/text/interface.js");
  const { words: contract, SAME_PROBLEM } = await import("../../web/src/text/words.js");
  for (const [key, texts] of Object.entries({ ...own, ...contract })) {
    assert.equal(texts.filter((text) => text.trim()).length, 3, key);
    const names = texts.map((text) => (text.match(/\{\w+\}/g) ?? []).sort().join());
    assert.equal(new Set(names).size, 1, `${key} has the same places in all languages`);
  }
  const schemas = { defect: "DefectCode", remedy: "Remedy", method: "FillMethod", hole: "HoleClass", severity: "Severity", stage: "Stage", fidelity: "Fidelity", change: "ChangeKind", check: "CheckCode", state: "JobState" };
  for (const code of components.schemas.ProblemCode.enum) assert.ok(contract[`problem.${SAME_PROBLEM[code] ?? code}`], `problem.${code}`);
  for (const [prefix, name] of Object.entries(schemas)) {
    for (const word of components.schemas[name].enum) assert.ok(contract[`${prefix}.${word}`], `${prefix}.${word}`);
  }
}

export async function forEverybody(browser) {
  for (const colorScheme of ["light", "dark"]) {
    await withPage(browser, { colorScheme }, async (page) => {
      await serious(page, `${colorScheme}, at the start`);
      await page.click("#sample-scan");
      await opened(page);
      await page.click(".finding-title[data-code=boundary-loop]");
      await page.click("#section");
      await serious(page, `${colorScheme}, with findings`);
      await page.selectOption("#policy", "fdm");
      await page.waitForSelector("#checks .check");
      await page.click("#repair");
      await repaired(page);
      await page.click("#jobs summary");
      await serious(page, `${colorScheme}, with a result`);
    });
  }
}

// The rules are run without their script element, which the page's policy forbids.
export async function serious(page, where) {
  await page.evaluate(axe);
  const { violations } = await page.evaluate(() => window.axe.run());
  const found = violations.filter(({ impact }) => ["serious", "critical"].includes(impact));
  assert.deepEqual(found.map(({ id, nodes }) => `${id}: ${nodes.map(({ html }) => html.slice(0, 90)).join(" | ")}`), [], where);
}
