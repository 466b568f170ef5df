// A browser for one test, and what every test holds the page to: no error, and nothing loaded from elsewhere.

import assert from "node:assert/strict";
import { mkdirSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";

// The packages are where scripts/test.sh installs them.
export const need = createRequire(new URL("../../target/browser/package.json", import.meta.url));
const { chromium } = need("playwright-core");

const PATIENCE_MS = 60_000; // only what hangs meets it
const SOFTWARE = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--no-sandbox", "--ignore-gpu-blocklist"];

export const url = process.argv[2];
export const into = process.argv[3];
mkdirSync(into, { recursive: true });

export const launch = () => chromium.launch({ executablePath: "/usr/bin/chromium", args: SOFTWARE });

// Runs `test` with a page that stands open.
export async function withPage(browser, options, test) {
  const { path = "/", ...settings } = options;
  const context = await browser.newContext({ viewport: { width: 1180, height: 720 }, locale: "en-US", reducedMotion: "reduce", ...settings });
  context.setDefaultTimeout(PATIENCE_MS);
  const page = await context.newPage();
  const wrong = [];
  page.on("pageerror", (error) => wrong.push(error.stack));
  page.on("console", (message) => {
    // A request that is refused is written there by the browser itself.
    if (message.type() === "error" && !message.text().startsWith("Failed to load resource")) wrong.push(message.text());
  });
  context.on("request", (request) => {
    if (!request.url().startsWith(`${url}/`) && !/^(blob|data):/.test(request.url())) wrong.push(`loaded ${request.url()}`);
  });
  await page.goto(url + path);
  await page.waitForSelector("body[data-ready]");
  try {
    await test(page);
  } catch (error) {
    await page.screenshot({ path: join(into, "failed.png") }).catch(() => {});
    throw error;
  }
  await context.close();
  assert.deepEqual(wrong, []);
}

export const shot = (page, name) => page.screenshot({ path: join(into, `${name}.png`) });

// Lets files be dropped on an element, as from a file manager.
export async function drop(page, selector, name, content) {
  const bytes = Buffer.from(content).toString("base64");
  const transfer = await page.evaluateHandle(([fileName, text]) => {
    const data = new DataTransfer();
    data.items.add(new File([Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0))], fileName));
    return data;
  }, [name, bytes]);
  await page.dispatchEvent(selector, "dragover", { dataTransfer: transfer });
  await page.dispatchEvent(selector, "drop", { dataTransfer: transfer });
}

export const opened = (page) => page.waitForSelector("#view[data-drawn] ~ #panel #verdict h2");
export const repaired = (page) => page.waitForSelector("#arrangement:not([hidden])");

// The picture stands when two frames in a row are the same.
export async function picture(page) {
  const canvas = page.locator("#canvas");
  let before = await canvas.screenshot();
  for (let i = 0; i < 20; i += 1) {
    const now = await canvas.screenshot();
    if (now.equals(before)) break;
    before = now;
  }
  return measured(page, before);
}

// Of a picture: how much its brightness varies, and the shares of some hues in it.
async function measured(page, png) {
  const blank = await page.context().newPage();
  const result = await blank.evaluate(async (text) => {
    const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
    const image = await createImageBitmap(new Blob([bytes], { type: "image/png" }));
    const canvas = new OffscreenCanvas(image.width, image.height).getContext("2d");
    canvas.drawImage(image, 0, 0);
    const { data } = canvas.getImageData(0, 0, image.width, image.height);
    const hues = { red: [350, 12], orange: [15, 40], teal: [155, 180], pink: [325, 348], blue: [200, 225] };
    const count = Object.fromEntries(Object.keys(hues).map((name) => [name, 0]));
    let [sum, squares] = [0, 0];
    for (let i = 0; i < data.length; i += 4) {
      const [r, g, b] = [data[i], data[i + 1], data[i + 2]];
      const [high, low] = [Math.max(r, g, b), Math.min(r, g, b)];
      const light = (r + g + b) / 3;
      sum += light;
      squares += light * light;
      if (high - low < 60) continue;
      const sector = high === r ? (g - b) / (high - low) : high === g ? 2 + (b - r) / (high - low) : 4 + (r - g) / (high - low);
      const hue = (sector * 60 + 360) % 360;
      for (const [name, [from, to]] of Object.entries(hues)) if (from < to ? hue >= from && hue <= to : hue >= from || hue <= to) count[name] += 1;
    }
    const pixels = data.length / 4;
    const mean = sum / pixels;
    return { variance: squares / pixels - mean * mean, ...Object.fromEntries(Object.entries(count).map(([name, n]) => [name, n / pixels])) };
  }, png.toString("base64"));
  await blank.close();
  return result;
}
