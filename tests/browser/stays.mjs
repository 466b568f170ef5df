// What stays when something else changes: the choices of a job, its result, the name of a file, and what has to be in sight.

import assert from "node:assert/strict";
import { createHash } from "node:crypto";
import { execFileSync } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { SAMPLES } from "../../web/src/samples.js";
import { opened, picture, repaired, url, withPage } from "./browser.mjs";
import { heap } from "./ways.mjs";

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

// Where somebody sees it: not scrolled away, and with nothing over it.
const inSight = (page, selector) => page.locator(selector).evaluate((element) => {
  const { x, y, width, height } = element.getBoundingClientRect();
  return element.contains(document.elementFromPoint(x + width / 2, y + height / 2));
});

const SCREENS = [{ viewport: { width: 1180, height: 720 } }, { viewport: { width: 375, height: 667 }, hasTouch: true, isMobile: true }];

// Nothing was drawn for a while, so that what is drawn is not a rougher picture of a view that moves.
const atRest = async (page) => {
  await page.waitForTimeout(500); // so that what a key began is drawn at all
  await page.evaluate(() => delete document.querySelector("#view").dataset.seen);
  await page.waitForFunction(() => {
    const { dataset } = document.querySelector("#view");
    const isAtRest = dataset.frames === dataset.seen;
    dataset.seen = dataset.frames;
    return isAtRest;
  }, null, { polling: 500 });
};

// After a flight to a place, the whole part is seen again when its result comes. A view that was chosen by hand stays.
export async function viewAfterARepair(browser) {
  await withPage(browser, {}, async (page) => {
    const seen = async () => {
      await page.evaluate(() => document.activeElement.blur()); // without the outline of the focus
      await atRest(page);
      return createHash("sha256").update(await page.locator("#canvas").screenshot()).digest("hex");
    };
    // The same side for every picture, with nothing over it.
    const plain = async () => {
      await page.evaluate(() => { for (const part of document.querySelectorAll("#view > :not(canvas)")) part.style.visibility = "hidden"; });
      await page.evaluate(() => document.querySelector("#arrangement [data-arrangement=before]").click());
      await page.evaluate(() => { const list = document.querySelector("#colors"); list.value = "plain"; list.dispatchEvent(new Event("change")); });
      return seen();
    };
    const repair = async () => {
      const before = await page.evaluate(() => location.hash);
      await page.click("#repair");
      await page.waitForFunction((hash) => location.hash !== hash && document.querySelector("#progress").hidden && document.activeElement.id === "verdict", before);
      return plain();
    };
    const press = (keys) => page.focus("#canvas").then(async () => { for (const key of keys) await page.keyboard.press(key); });
    await open(page, "scan.off", SAMPLES.scan());
    await opened(page);
    await page.click(".finding-title[data-code=boundary-loop]");
    await page.waitForSelector("#ring:not([hidden])");
    const near = await plain();
    const whole = await repair();
    assert.notEqual(whole, near);
    await press(["f"]);
    assert.equal(await seen(), whole, "all of it is seen, from the side of the place");

    // Turned and drawn near by hand.
    await press(["ArrowLeft", "ArrowUp", "+", "+", "+", "+", "+"]);
    const own = await seen();
    assert.equal(await repair(), own, "what a hand chose stays");
    // A flight, and then a hand that leads out again.
    await page.click(".finding-title[data-code=boundary-loop]");
    await press(["-", "-", "-", "-", "-", "-", "-", "-", "-", "-", "-", "-", "-", "-", "-", "-", "ArrowLeft"]);
    await page.click(".finding-title[data-code=boundary-loop]"); // closes the list, so that nothing is lit
    const far = await plain();
    assert.equal(await repair(), far, "the whole part was seen");
  });
}

// While a repair runs, its progress and the way to end it are in sight.
export async function progressInSight(browser) {
  for (const screen of SCREENS) {
    await withPage(browser, screen, async (page) => {
      await open(page, "heap.off", heap(2000));
      await opened(page);
      await page.click(".finding-title >> nth=1");
      await page.click("#repair");
      await page.waitForSelector("#cancel:not([hidden])");
      for (const id of ["#stage", "#cancel"]) assert.ok(await inSight(page, id), `${id} at ${screen.viewport.width} pixels`);
      await page.click("#cancel");
      await page.waitForSelector('.notice[data-code="cancelled"]');
      assert.ok(await inSight(page, ".notice > p"), "and so is what became of it");
    });
  }
}

// A size in two units is not cut off.
export async function sizeInSight(browser) {
  const answer = await fetch(`${url}/v1/convert?output_format=glb`, { method: "POST", headers: { "Content-Type": "application/octet-stream" }, body: SAMPLES.scan() });
  const glb = Buffer.from(await answer.arrayBuffer());
  for (const [width, height] of [[1366, 768], [375, 667]]) {
    await withPage(browser, { viewport: { width, height } }, async (page) => {
      await open(page, "scan.glb", glb);
      await opened(page);
      for (const id of ["#size", "#triangles"]) {
        const { x, width: wide } = await page.locator(id).boundingBox();
        assert.ok(x >= 0 && x + wide <= width, `${id} ends at ${x + wide} of ${width} pixels`);
      }
      assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), width);
    });
  }
}

// The menu of jobs is on the screen, and closes by Escape and by a click elsewhere.
export async function menu(browser) {
  for (const width of [320, 390, 1180]) {
    await withPage(browser, { viewport: { width, height: 780 } }, async (page) => {
      assert.ok(await page.isVisible("header > a"), "the way to the reference is there");
      await page.click("#sample-sound");
      await opened(page);
      await page.click("#jobs summary");
      const box = await page.locator("#jobs > div").boundingBox();
      assert.ok(box.x >= 0 && box.x + box.width <= width, `from ${box.x} to ${box.x + box.width} of ${width} pixels`);
      assert.ok(await inSight(page, "#jobs-forget"));
      await page.keyboard.press("Escape");
      assert.equal(await page.isVisible("#jobs-forget"), false, "Escape closes it");
      assert.ok(await page.evaluate(() => document.activeElement.matches("#jobs summary")));
      await page.click("#jobs summary");
      await page.click("header h1");
      assert.equal(await page.isVisible("#jobs-forget"), false, "so does a click elsewhere");
    });
  }
}

// A name in any letters stays what it is, in a download and in the command for a terminal.
export async function namesOfFiles(browser) {
  const name = "Grüße & 'x', \"y\"; z.off";
  await withPage(browser, { permissions: ["clipboard-read", "clipboard-write"] }, async (page) => {
    await open(page, name, SAMPLES.scan());
    await opened(page);
    await page.click("#repair");
    await repaired(page);
    // Marks stay, but for those that no name has on some systems.
    const told = "Grüße & 'x', _y_; z";
    assert.equal((await saved(page, "#download")).name, `${told}-repaired.off`);
    assert.equal((await saved(page, "text=Report for programs")).name, `${told}.report.json`);
    assert.equal((await saved(page, "#certificate")).name, `${told}.certificate.json`);
    await page.click("text=Copy as curl");
    const command = await page.evaluate(() => navigator.clipboard.readText());
    const folder = mkdtempSync(join(tmpdir(), "meshmend-"));
    writeFileSync(join(folder, name), SAMPLES.scan());
    execFileSync("sh", ["-c", `${command} -s`], { cwd: folder });
    assert.ok(existsSync(join(folder, name.replace(".off", "-repaired.off"))), command);
  });
}

// A process or a unit that is chosen after a repair waits for the next one; the result is still there.
export async function resultAfterAChoice(browser) {
  await withPage(browser, {}, async (page) => {
    await page.click("#sample-scan");
    await opened(page);
    await page.click("#repair");
    await repaired(page);
    const hash = await page.textContent("#hash");
    await page.selectOption("#policy", "fdm");
    assert.match(await page.textContent("#earlier"), /made with another choice/);
    assert.ok(await page.isVisible("#arrangement"), "before and after are still drawn");
    const bytes = (await saved(page, "#download")).bytes;
    assert.equal(createHash("sha256").update(bytes).digest("hex"), hash);
    await page.selectOption("#policy", "");
    assert.equal(await page.textContent("#earlier"), "");
    await page.selectOption("#policy", "fdm");
    await page.selectOption("#units", "cm");
    await page.click("#repair");
    await page.waitForSelector("#verdict .policy");
    assert.match(await page.textContent("#size"), /^758\.8 .* cm\)$/);
    assert.equal(await page.textContent("#earlier"), "");
  });
}

// What the parts become, chosen after a repair, waits for the next one as well. Choices of single findings are for what is chosen.
export async function resultAfterAnotherSolid(browser) {
  await withPage(browser, {}, async (page) => {
    await page.click("#sample-project");
    await page.waitForSelector("#parts .part");
    await page.click("#repair");
    await repaired(page);
    const hash = await page.textContent("#hash");
    for (const [solid, text] of [["together", /made with another choice/], ["separate", /^$/], ["union", /made with another choice/], ["together", /made with another choice/]]) {
      await page.selectOption("#solid", solid);
      assert.match(await page.textContent("#earlier"), text, solid);
    }
    assert.ok(await page.isVisible("#arrangement"), "before and after are still drawn");
    assert.equal(await page.getAttribute("#view", "data-drawn"), "before after");
    const { bytes } = await saved(page, "#download");
    assert.equal(createHash("sha256").update(bytes).digest("hex"), hash);
    let request = nextRequest(page);
    await page.click("#repair");
    assert.equal((await asked(request)).parts, "together");
    await page.waitForSelector("#parts .part", { state: "detached" });
    await page.waitForSelector("#progress", { state: "hidden" });
    assert.equal(await page.textContent("#earlier"), "");
    assert.notEqual(await page.textContent("#hash"), hash);

    // The plan of the whole has nothing for parts one by one.
    await page.click(".finding-title[data-code=boundary-loop]");
    await page.selectOption("[data-role=method]", "flat");
    await page.selectOption("#solid", "separate");
    assert.equal(await page.locator("[data-role=method]").count(), 0);
    request = nextRequest(page);
    await page.click("#repair");
    const { parts, plan } = await asked(request);
    assert.deepEqual([parts, plan], [undefined, undefined]);
    await page.waitForSelector("#parts .part");
  });
}

// The list of jobs has room in the browser, however much was chosen for them, and also where the browser has none.
export async function listOfJobs(browser) {
  await withPage(browser, {}, async (page) => {
    await page.evaluate(() => {
      const job = (id) => ({ id: `00000000-0000-0000-0000-0000000000${id}`, operation: "repair", name: `${id}.off`, at: 1, asked: { ratio: 0.5, more: "x".repeat(200_000) } });
      localStorage.setItem("jobs", JSON.stringify(Array.from({ length: 20 }, (_, at) => job(at + 10))));
    });
    await page.click("#sample-sound");
    await opened(page);
    const kept = () => page.evaluate(() => localStorage.getItem("jobs"));
    const jobs = JSON.parse(await kept());
    assert.ok((await kept()).length < 1_000_000, `${(await kept()).length} letters`);
    assert.deepEqual([jobs.length, jobs[0].name, Boolean(jobs[1].asked), jobs[19].name, jobs[19].asked], [20, "sound.off", true, "28.off", undefined]);

    const names = async () => {
      await page.click("#jobs summary");
      await page.locator("#jobs-list a").first().waitFor();
      const all = await page.locator("#jobs-list strong").allTextContents();
      await page.keyboard.press("Escape");
      return all;
    };
    await page.evaluate(() => {
      for (let count = 4_000_000; count >= 1; count = Math.floor(count / 2)) {
        try { for (let at = 0; ; at += 1) localStorage.setItem(`full-${count}-${at}`, "x".repeat(count)); } catch { /* nearly full */ }
      }
    });
    // With half of its room taken by others, the list forgets choices first.
    await page.click("#repair");
    await repaired(page);
    assert.equal(JSON.parse(await kept())[0].operation, "repair");
    await page.evaluate(() => {
      localStorage.removeItem("jobs");
      for (let count = 4_000_000; count >= 1; count = Math.floor(count / 2)) {
        try { for (let at = 0; ; at += 1) localStorage.setItem(`fuller-${count}-${at}`, "x".repeat(count)); } catch { /* full */ }
      }
    });
    await open(page, "scan.off", SAMPLES.scan());
    await page.waitForFunction(() => document.querySelector("#triangles").textContent === "10,309");
    await opened(page);
    assert.equal(await kept(), null);
    assert.equal((await names())[0], "scan.off", "the list of this visit");
  });
}

const SIDES = "0 2 3|0 3 1|4 5 7|4 7 6|0 1 5|0 5 4|1 3 7|1 7 5|3 2 6|3 6 7|2 0 4|2 4 6".split("|");

function cube(side, faces = SIDES, places = []) {
  const corners = Array.from({ length: 8 }, (_, at) => [at & 1, (at >> 1) & 1, at >> 2].map((far) => far * side).join(" "));
  return `OFF\n${8 + places.length} ${faces.length} 0\n${[...corners, ...places].join("\n")}\n${faces.map((face) => `3 ${face}`).join("\n")}\n`;
}

// One of 20 mm, and a triangle at `places`.
const cubeAnd = (...places) => cube(20, [...SIDES, "8 9 10"], places);

// The part is in sight beside a triangle that lies far away, before and after the repair.
export async function partInSight(browser) {
  await withPage(browser, {}, async (page) => {
    await open(page, "far.off", cubeAnd("5000 5000 5000", "5001 5000 5000", "5000 5001 5000"));
    await opened(page);
    await page.click("#grid");
    assert.ok((await picture(page)).variance > 500, "the cube is seen");
    assert.match(await page.textContent("#far"), /^A triangle lies far away/);
    await page.click(".finding-title[data-code=isolated-face]");
    await page.waitForSelector("#ring:not([hidden])");
    assert.ok((await picture(page)).orange > 0.005, "and so is the triangle");
    await page.click("#repair");
    await repaired(page);
    await page.click("#fit");
    await page.click("#arrangement [data-arrangement=after]");
    assert.ok((await picture(page)).variance > 500, "the cube again");
    await open(page, "sound.off", SAMPLES.sound());
    await page.waitForFunction(() => document.querySelector("#triangles").textContent === "384");
    assert.equal(await page.isVisible("#far"), false);
  });
}

// A part of less than a millionth of a millimetre is seen as a large one is: its rim, the place of a hole, and the bed.
export async function tinyPart(browser) {
  await withPage(browser, {}, async (page) => {
    await open(page, "tiny.off", cube(2e-7, SIDES.slice(0, -1)));
    await opened(page);
    const before = await picture(page);
    await page.click(".finding-title[data-code=boundary-loop]");
    await page.waitForSelector("#ring:not([hidden])");
    const { orange, red } = await picture(page);
    assert.ok(orange > before.orange && orange > 0.002, `the rim is lit: ${orange}`);
    assert.ok(red > 0.01, `and the hole faces the viewer: ${red}`);
    await page.click("#fit");
    const withBed = await picture(page);
    await page.click("#grid");
    assert.ok(Math.abs((await picture(page)).variance - withBed.variance) > 1, "the bed is there");
  });
}

// What is no mesh is not drawn, and the next file can be dropped. Faces of more corners are counted as triangles.
export async function trianglesOfAFile(browser) {
  await withPage(browser, {}, async (page) => {
    const photo = Buffer.from([0xff, 0xd8, 0xff, 0xe0, ...Array.from({ length: 10_240 }, (_, at) => at % 256)]);
    await page.setInputFiles("#file", { name: "photo.stl", mimeType: "", buffer: photo });
    await page.waitForSelector(".notice[data-code=mesh-unparseable]");
    assert.ok(await page.isVisible("#start .drop"));
    assert.equal(await page.isVisible("#facts"), false);
    await open(page, "box.off", "OFF\n8 5 0\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 0 1\n1 0 1\n0 1 1\n1 1 1\n4 0 2 3 1\n4 0 1 5 4\n4 1 3 7 5\n4 3 2 6 7\n4 2 0 4 6\n");
    await opened(page);
    assert.equal(await page.textContent("#triangles"), "10");
  });
}

// A triangle that hangs over a wall is no wall of nearly nothing.
export async function strayPieces(browser) {
  await withPage(browser, {}, async (page) => {
    await open(page, "cube.off", cubeAnd("9 9 20.05", "11 9 20.05", "9 11 20.05"));
    await opened(page);
    for (const shown of await page.locator("#findings input").all()) await shown.uncheck();
    await page.click("[data-look=top]");
    await page.selectOption("#colors", "thickness");
    await page.waitForSelector("#legend .ramp");
    await page.evaluate(() => new Promise((done) => { requestAnimationFrame(() => requestAnimationFrame(done)); }));
    const { red, blue } = await picture(page);
    assert.ok(blue > 0.01, "the cube is measured"); // red is in the legend, too
    assert.ok(red < 0.0005, `the stray triangle is not: ${red}`);
    assert.match(await page.textContent("#legend"), /not measured: stray pieces/);
  });
}

// A look that was cancelled can be had again, also by choosing a process.
export async function lookAgain(browser) {
  await withPage(browser, {}, async (page) => {
    for (const again of [() => page.click("#look-again"), () => page.selectOption("#policy", "fdm")]) {
      // Not a file that the service has seen before.
      await open(page, "heap.off", heap(6000 + Math.floor(Math.random() * 900)));
      await page.waitForSelector("#cancel:not([hidden])");
      await page.waitForSelector("#view[data-drawn]");
      await page.click("#cancel");
      await page.waitForSelector('.notice[data-code="cancelled"]');
      assert.equal(await page.isVisible("#start"), false, "nothing lies over the mesh");
      await again();
      await opened(page);
      assert.equal(await page.locator(".notice").count(), 0);
    }
    await open(page, "empty.stl", "");
    assert.match(await (await page.waitForSelector('.notice[data-code="file-empty"]')).textContent(), /file is empty/);
  });
}

// The best there is, is not called certified.
export async function bestThereIs(browser) {
  await withPage(browser, {}, async (page) => {
    await page.click("#sample-scan");
    await opened(page);
    await page.click(".finding-title[data-code=boundary-loop]");
    await page.selectOption("[data-role=remedy]", "keep");
    await page.check("#best");
    await page.click("#repair");
    await repaired(page);
    assert.equal((await page.textContent("#verdict h2")).replace("!", ""), "Not certified");
    assert.doesNotMatch(await page.textContent("#result"), /certif/i);
  });
}

// Another language reaches all that is told, also figures and steps; one thing is told as one.
export async function languageOfAResult(browser) {
  await withPage(browser, { locale: "de" }, async (page) => {
    await page.click("#sample-scan");
    await opened(page);
    await page.click("#repair");
    await page.waitForSelector("#legend .new");
    assert.match(await page.textContent("#legend"), /behalten [\d.]+neu/);
    await page.click("text=Was getan wurde");
    assert.match(await page.textContent(".result .steps"), /Löcher geschlossen: 4/);
    await page.selectOption("#language", "fr");
    await page.waitForFunction(() => document.querySelector("#legend").textContent.startsWith("gardé"));
    assert.match(await page.textContent(".result .steps"), /trous bouchés\u00a0: 4/);
    assert.match(await page.textContent("#triangles"), /^10\s309$/);
    assert.match(await page.textContent("#verdict"), /permis\u00a0: /);

    await open(page, "rim.off", "OFF\n4 3 0\n0 0 0\n10 0 0\n0 10 0\n0 0 10\n3 0 2 1\n3 0 1 3\n3 0 3 2\n");
    await page.waitForFunction(() => document.querySelector("#triangles").textContent === "3");
    await page.waitForSelector("#verdict h2");
    for (const [language, text] of [["fr", /Un type de défauts à/], ["de", /Eine Art von Fehlern muss/], ["en", /One kind of defect must/]]) {
      await page.selectOption("#language", language);
      assert.match(await page.textContent("#verdict"), text);
    }
    // What is chosen first can be read whole.
    await page.selectOption("#language", "de");
    const cut = await page.locator("#units").evaluate((list) => {
      const text = document.createElement("span");
      text.style.cssText = "position: absolute; white-space: nowrap";
      text.textContent = list.selectedOptions[0].textContent;
      list.after(text);
      const { paddingLeft } = getComputedStyle(list);
      const missing = text.offsetWidth + 2 * parseFloat(paddingLeft) + 16 - list.offsetWidth;
      text.remove();
      return missing;
    });
    assert.ok(cut <= 0, `${cut} pixels are missing`);
  });
}

// Without a pointer: the file is chosen first of all, the focus is never lost, the border goes to its ends, the theme stays.
export async function focus(browser) {
  await withPage(browser, { colorScheme: "light" }, async (page) => {
    const focused = () => page.evaluate(() => document.activeElement.id);
    await page.keyboard.press("Tab");
    assert.equal(await focused(), "file");
    assert.equal(await page.locator("#start .drop").evaluate((zone) => getComputedStyle(zone).outlineStyle), "solid");
    await page.focus("#sample-scan");
    await page.keyboard.press("Enter");
    await opened(page);
    assert.equal(await focused(), "canvas");
    await page.focus("#file");
    await page.focus("#repair");
    await page.keyboard.press("Enter");
    await repaired(page);
    await page.waitForFunction(() => document.activeElement.id === "verdict");
    assert.equal(await page.getAttribute("#verdict", "aria-live"), "polite");
    await page.focus("#divider");
    for (const [key, value] of [["Home", "2"], ["PageUp", "12"], ["End", "98"], ["PageDown", "88"]]) {
      await page.keyboard.press(key);
      assert.equal(await page.getAttribute("#divider", "aria-valuenow"), value, key);
    }
    for (const look of ["back", "left", "bottom"]) await page.click(`[data-look=${look}]`);
    await page.click("#theme");
    await page.reload();
    await repaired(page);
    assert.equal(await page.getAttribute("html", "data-theme"), "dark", "the choice is kept");
  });
}
