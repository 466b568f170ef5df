// The reference at /docs, and the page of a report: read, tried, printed, and for everybody (axe).

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { into, need, shot, url, withPage } from "./browser.mjs";
import { heap } from "./ways.mjs";

const axe = readFileSync(need.resolve("axe-core/axe.min.js"), "utf8");

// A box without its lid, through which a bar passes that is inside out.
function broken() {
  const box = (low, high) => [0, 1, 2, 3, 4, 5, 6, 7].map((i) => [0, 1, 2].map((axis) => (i >> axis & 1 ? high : low)[axis]));
  const faces = [[0, 2, 3], [0, 3, 1], [0, 1, 5], [0, 5, 4], [1, 3, 7], [1, 7, 5], [3, 2, 6], [3, 6, 7], [2, 0, 4], [2, 4, 6], [4, 5, 7], [4, 7, 6]];
  const vertices = [...box([0, 0, 0], [40, 30, 20]), ...box([-10, 10, 5], [50, 14, 9])];
  const open = faces.slice(0, 10);
  const inverted = faces.map(([a, b, c]) => [a + 8, c + 8, b + 8]);
  const all = [...open, ...inverted].map((corners) => `3 ${corners.join(" ")}`);
  return `OFF\n${vertices.length} ${all.length} 0\n${vertices.map((at) => at.join(" ")).join("\n")}\n${all.join("\n")}\n`;
}

async function sound(page) {
  await page.evaluate(axe);
  const found = await page.evaluate(() => window.axe.run());
  const serious = found.violations.filter(({ impact }) => ["serious", "critical"].includes(impact));
  assert.deepEqual(serious.map(({ id, nodes }) => `${id}: ${nodes[0].html}`), []);
}

// Nothing is wider than a phone, also with a font that is wider by a fifth. `body` may hide what it has too much of.
async function fits(page) {
  for (const isWide of [false, true]) {
    if (isWide) {
      await page.evaluate(() => {
        const sizes = [...document.querySelectorAll("body *")].map((element) => [element, parseFloat(getComputedStyle(element).fontSize)]);
        for (const [element, size] of sizes) element.style.setProperty("font-size", `${size * 1.2}px`, "important");
      });
    }
    for (const width of [320, 360, 390]) {
      await page.setViewportSize({ width, height: 780 });
      const found = await page.evaluate(() => Math.max(document.documentElement.scrollWidth, document.body.scrollWidth));
      assert.equal(found, width, `nothing is wider than a phone of ${width} pixels${isWide ? " with a wide font" : ""}`);
    }
  }
}

export async function reference(browser) {
  for (const colorScheme of ["light", "dark"]) {
    await withPage(browser, { path: "/docs", colorScheme }, async (page) => {
      await sound(page);
      await shot(page, `docs-${colorScheme}`);
    });
  }
  await withPage(browser, { path: "/docs" }, async (page) => {
    const seen = () => page.isVisible("#repair .python");
    assert.equal(await seen(), false);
    await page.check("#in-python");
    assert.equal(await seen(), true);
    await page.reload();
    await page.waitForSelector("body[data-ready]");
    assert.equal(await seen(), true, "the choice is kept");

    await page.click("#render .try > summary");
    await page.setInputFiles("#render input[type=file]", { name: "part.off", mimeType: "", buffer: Buffer.from(broken()) });
    await page.click("#render .try button");
    const picture = await page.waitForSelector("#render .answer img");
    assert.equal(await picture.evaluate((image) => image.decode().then(() => image.naturalWidth)), 640);
    assert.match(await page.textContent("#render .answer"), /200.*image\/png/);
    await page.locator("#render").scrollIntoViewIfNeeded();
    await shot(page, "docs-try");

    await page.click("#repair .try > summary");
    await page.setInputFiles("#repair input[type=file]", { name: "part.off", mimeType: "", buffer: Buffer.from(broken()) });
    await page.click("#repair .try details summary");
    await page.selectOption('#repair [data-name="output_format"]', "stl");
    await page.click("#repair .try button");
    const [download] = await Promise.all([page.waitForEvent("download"), page.click("#repair .answer a[download]")]);
    assert.match(download.suggestedFilename(), /\.stl$/);

    await page.click("#get_limits .try > summary");
    await page.click("#get_limits .try button");
    await page.waitForSelector("#get_limits .answer pre");
    await page.click("#get_job .try > summary");
    await page.fill('#get_job [data-name="id"]', "none");
    await page.click("#get_job .try button");
    await page.waitForFunction(() => /"code": "not-found"/.test(document.querySelector("#get_job .answer").textContent));
  });
  for (const path of ["/", "/docs"]) {
    await withPage(browser, { path, viewport: { width: 390, height: 780 } }, async (page) => {
      if (path === "/docs") await shot(page, "docs-phone");
      await fits(page);
    });
  }
}

export async function report(browser) {
  const headers = { "Content-Type": "application/octet-stream" };
  const made = await fetch(`${url}/v1/jobs?operation=repair&thumbnail=true&policy=fdm`, { method: "POST", headers, body: broken() });
  const { links } = await made.json();
  await fetch(`${url}${links.self}?wait=60`);
  const answer = await fetch(`${url}${links.self}/report`, { headers: { Accept: "text/html" } });
  assert.match(answer.headers.get("content-security-policy"), /default-src 'none'; img-src data:/);
  const html = await answer.text();
  const context = await browser.newContext({ viewport: { width: 900, height: 1200 } });
  const page = await context.newPage();
  const loaded = [];
  page.on("request", (request) => loaded.push(request.url()));
  await page.setContent(html);
  const wide = await page.locator("img").evaluate((image) => image.decode().then(() => image.naturalWidth));
  assert.equal(wide, 960, "before and after");
  assert.deepEqual(loaded.filter((address) => !address.startsWith("data:")), [], "one file that loads nothing");
  await sound(page);
  await page.screenshot({ path: join(into, "report.png"), fullPage: true });
  const pdf = await page.pdf({ path: join(into, "report.pdf"), preferCSSPageSize: true, printBackground: true });
  // A4 in points, and no more pages than what there is to tell.
  const text = pdf.toString("latin1");
  assert.match(text.match(/\/MediaBox \[[^\]]*\]/)?.[0] ?? "no page", /\[0 0 59[45][\d.]* 84[12][\d.]*\]/);
  const pages = text.match(/\/Type\s*\/Page\b/g)?.length ?? 0;
  assert.ok(pages >= 1 && pages <= 5, `${pages} pages`);
  await fits(page);
  await sound(page);
  await page.screenshot({ path: join(into, "report-phone.png"), fullPage: true });
  await context.close();

  // A job without a picture has a page as well.
  const plain = await (await fetch(`${url}/v1/jobs?operation=analyze`, { method: "POST", headers, body: heap(3) })).json();
  await fetch(`${url}${plain.links.self}?wait=60`);
  const page2 = await (await fetch(`${url}${plain.links.self}/report`, { headers: { Accept: "text/html" } })).text();
  assert.ok(!page2.includes("<img"));
}
