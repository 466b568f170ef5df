// Kinds of files and of results: projects of several parts, GLB, levels of detail, several files at once.

import assert from "node:assert/strict";
import { createHash } from "node:crypto";
import { readFileSync } from "node:fs";
import { SAMPLES } from "../../web/src/samples.js";
import { stored } from "../../web/src/stored.js";
import { drop, opened, picture, repaired, shot, url, withPage } from "./browser.mjs";
import { projectsWithPocket } from "./pocket.mjs";
import { serious } from "./ways.mjs";

const sha256 = (bytes) => createHash("sha256").update(bytes).digest("hex");

async function saved(page, selector) {
  const [download] = await Promise.all([page.waitForEvent("download"), page.click(selector)]);
  return { name: download.suggestedFilename(), bytes: readFileSync(await download.path()) };
}

export async function project(browser) {
  await withPage(browser, {}, async (page) => {
    await page.click("#sample-project");
    await opened(page);
    const told = async () => page.locator("#parts .part").evaluateAll((rows) => rows.map((row) => [row.querySelector(".name").firstChild.textContent, row.querySelector(".tag").textContent]));
    assert.deepEqual(await told(), [["Plate", "sound"], ["Cup", "defects"], ["Ball", "defects"]]);
    assert.ok(await page.isDisabled("#units"), "a 3MF states its unit");
    const whole = await picture(page);
    assert.ok(whole.orange > 0.0005 && whole.red > 0.005, "both cups are open, and the ball is inside out");

    await page.click("[data-part='2']");
    await page.waitForSelector("#view[data-place='part 2']");
    assert.ok((await picture(page)).red > whole.red * 2, "the ball is near");
    // In its own coordinates the rim is where the plate is.
    await page.click(".finding-title[data-code=boundary-loop]");
    await page.waitForSelector("#ring:not([hidden])");
    assert.ok((await picture(page)).orange > whole.orange, "the rim is lit where the build has it");
    await serious(page, "with parts");
    await shot(page, "project");

    await page.click("#repair");
    await repaired(page);
    assert.deepEqual((await told()).map(([, tag]) => tag), ["sound", "sound", "sound"]);
    assert.match(await page.textContent("#parts"), /the same bytes come back.*2 times/);
    assert.equal(await page.inputValue("#colors"), "file", "the file has colours");
    await shot(page, "project-mended");
    await page.selectOption("#colors", "kept");
    await page.waitForSelector("#legend .new");
    assert.match(await page.textContent("#legend"), /kept 1,248new 4gone 0/);

    // Each format is a file of its own, and the first one can be had again.
    for (const format of ["glb", "gltf", "stl", "3mf"]) {
      await page.selectOption("#format", format);
      const { name, bytes } = await saved(page, "#download");
      assert.equal(name, `project-repaired.${format}`);
      assert.equal(sha256(bytes), await page.textContent("#hash"), format);
      const verdict = await fetch(`${url}/v1/verify`, { method: "POST", headers: { "Content-Type": "application/octet-stream" }, body: bytes });
      assert.equal((await verdict.json()).input.format, format);
    }
    assert.equal(await page.locator("#parts .part").count(), 3);

    await page.reload();
    await repaired(page);
    assert.equal(await page.locator("#parts .part").count(), 3, "a job of a project opens again");
    assert.ok((await picture(page)).variance > 200);
  });
}

const converted = async (format, body) => Buffer.from(await (await fetch(`${url}/v1/convert?output_format=${format}`, { method: "POST", headers: { "Content-Type": "application/octet-stream" }, body })).arrayBuffer());

// What of several parts is one solid: united after each was mended, or one together, which has one plan and no parts.
export async function solids(browser) {
  await withPage(browser, {}, async (page) => {
    const asked = () => page.waitForRequest((request) => request.method() === "POST" && (request.postData() ?? "").includes('"operation"'));
    const parts = async (request) => JSON.parse(/\{"operation".*\}/.exec((await request).postData())[0]).parts;
    const open = (name, content) => page.setInputFiles("#file", { name, mimeType: "", buffer: Buffer.from(content) });
    await open("scan.off", SAMPLES.scan());
    await opened(page);
    assert.equal(await page.isVisible("#solid"), false, "one part has nothing to choose");
    await open("project.3mf", SAMPLES.project());
    await page.waitForSelector("#parts .part");
    assert.equal(await page.inputValue("#solid"), "separate");
    await page.selectOption("#solid", "union");
    let request = asked();
    await page.click("#repair");
    assert.equal(await parts(request), "union");
    await repaired(page);
    assert.match(await page.textContent("#verdict h2"), /Certified/);

    await open("project.3mf", SAMPLES.project());
    await page.waitForSelector("#panel[data-operation=plan] #parts .part");
    request = asked();
    await page.selectOption("#solid", "together");
    assert.equal(await parts(request), "together", "it is looked at anew");
    await page.waitForSelector("#parts .part", { state: "detached" });
    await page.click(".finding-title[data-code=boundary-loop]");
    await page.waitForSelector("#ring:not([hidden])");
    assert.ok(await page.isVisible("[data-role=method]"), "and has a plan, hole by hole");
    await page.selectOption("[data-role=method]", "flat");
    await serious(page, "with the parts together");
    request = asked();
    await page.click("#repair");
    assert.equal(await parts(request), "together");
    await repaired(page);
    assert.equal(await page.isVisible("#solid"), true, "the choice stays");
    assert.match(await page.textContent("#verdict h2"), /Certified/);
  });
}

// A negative part stands out of a box. It is not drawn, also not of a result, and a click on it in the list shows where it is.
export async function negativePart(browser) {
  for (const [at, content] of projectsWithPocket(["NegativeVolume", "negative_part"], 23, [[2, 2, 5], [8, 8, 40]]).entries()) {
    await withPage(browser, {}, async (page) => {
      await page.setInputFiles("#file", { name: "pocket.3mf", mimeType: "", buffer: Buffer.from(content) });
      await opened(page);
      assert.match(await page.textContent("#size"), /^30 × 10 × 10 mm/, "of what is printed");
      assert.equal(await page.locator("#parts .part").count(), 3);
      await page.evaluate(() => { document.querySelector("#corner").style.visibility = "hidden"; }); // its notes come and go
      await page.click("[data-look=front]");
      const whole = await picture(page);
      await shot(page, `negative-${at}`);
      await page.click("[data-part='1']");
      await page.waitForSelector("#ring:not([hidden])");
      assert.ok(Math.abs((await picture(page)).variance - whole.variance) > 1, "it is shown");
      await shot(page, `negative-${at}-shown`);
      await page.click("[data-part='0']");
      await page.waitForSelector("#ring", { state: "hidden" });
      await page.click("[data-look=front]");
      assert.ok(Math.abs((await picture(page)).variance - whole.variance) < 1, "it is away again");

      await page.selectOption("#solid", "together");
      await page.waitForSelector("#parts .part", { state: "detached" });
      await page.click("#repair");
      await repaired(page);
      await page.waitForSelector("#legend .new");
      assert.match(await page.textContent("#legend"), /kept 24new 0gone 0/, "nothing of the drawn part went");
      await shot(page, `negative-${at}-together`);
    });
  }
}

// An open box that is blue, as each format says it; before and after the repair.
export async function colors(browser) {
  await withPage(browser, {}, async (page) => {
    const boxes = colored();
    for (const [name, content] of [...boxes, ["faces.glb", await converted("glb", boxes[0][1])]]) {
      await page.setInputFiles("#file", { name, mimeType: "", buffer: Buffer.from(content) });
      await page.waitForSelector("#view[data-drawn=before]");
      await opened(page);
      assert.equal(await page.inputValue("#colors"), "file", name);
      await page.click("#backs");
      assert.ok((await picture(page)).blue > 0.02, name);
      await page.selectOption("#colors", "plain");
      assert.ok((await picture(page)).blue < 0.002, `${name} without its colours`);
      await page.selectOption("#colors", "file");
      await page.click("#backs");
      await page.click("#repair");
      await repaired(page);
      await page.click("[data-arrangement=after]");
      assert.ok((await picture(page)).blue > 0.02, `${name}: the result`);
    }
    await page.setInputFiles("#file", { name: "sound.off", mimeType: "", buffer: Buffer.from(SAMPLES.sound()) });
    await opened(page);
    assert.equal(await page.inputValue("#colors"), "plain");
    assert.ok(await page.locator("#colors option[value=file]").evaluate((option) => option.disabled), "a file without colours");
  });
}

// What a glTF puts at its place by a matrix is kept where it stays, although the result is rounded in metres.
export async function keptOfAGlb(browser) {
  const document = JSON.parse((await converted("gltf", SAMPLES.scan())).toString());
  document.nodes[0].matrix = [0.013, 0, 0, 0, 0, 0.013, 0, 0, 0, 0, 0.013, 0, 0, 0, 0, 1];
  await withPage(browser, {}, async (page) => {
    await drop(page, "body", "scan.gltf", JSON.stringify(document));
    await page.waitForSelector("#view[data-drawn=before]");
    await opened(page);
    await page.click("#repair");
    await repaired(page);
    await page.waitForSelector("#legend .new");
    const [kept, fresh] = (await page.textContent("#legend")).replaceAll(",", "").match(/\d+/g).map(Number);
    assert.ok(kept > 10_000 && fresh < 500, `${kept} kept, ${fresh} new`);
  });
}

// The service draws what is not read here.
export async function glb(browser) {
  for (const format of ["glb", "gltf"]) {
    await withPage(browser, {}, async (page) => {
      await drop(page, "body", `scan.${format}`, await converted(format, SAMPLES.scan()));
      await page.waitForSelector("#view[data-drawn=before]");
      await opened(page);
      assert.match(await page.textContent("#size"), /^75\.\d+ × 58\.\d+ × 68\.\d+ mm \(0\.0\d+ × .* m\)$/, "metres are millimetres here");
      assert.equal(await page.locator("#units option").first().textContent(), "m");
      assert.ok((await picture(page)).orange > 0.0005, "rims are lit");
      await page.click("#repair");
      await repaired(page);
      assert.equal((await saved(page, "#download")).name, `scan-repaired.${format}`);
    });
  }
}

export async function levels(browser) {
  await withPage(browser, { acceptDownloads: true }, async (page) => {
    await page.click("#sample-scan");
    await opened(page);
    await page.locator("#share").fill("50");
    await page.selectOption("#levels", "3");
    const sent = page.waitForRequest((request) => request.method() === "POST" && (request.postData() ?? "").includes('"repair"'));
    await page.click("#repair");
    assert.deepEqual(JSON.parse((await sent).postData()).targets, [{ ratio: 0.5 }, { ratio: 0.25 }, { ratio: 0.125 }]);
    await repaired(page);
    const counts = (await page.locator(".levels .name").evaluateAll((names) => names.map((name) => Number(name.firstChild.textContent.replace(/\D/g, "")))));
    assert.equal(counts.length, 3);
    assert.ok(counts[0] > counts[1] * 1.8 && counts[1] > counts[2] * 1.8, counts.join());
    await page.waitForSelector("#legend .new");
    const first = await page.textContent("#legend");
    await page.click("[data-level='2']");
    await page.waitForSelector("[data-level='2'][aria-pressed=true]");
    await page.waitForFunction((before) => document.querySelector("#legend .new") && document.querySelector("#legend").textContent !== before, first);
    const [shown, fresh] = (await page.textContent("#legend")).replaceAll(",", "").match(/\d+/g).map(Number);
    assert.equal(shown + fresh, counts[2], "the third level is drawn");
    await serious(page, "with levels");
    await shot(page, "levels");
    const { name, bytes } = await saved(page, "[data-level-file='1']");
    assert.equal(name, "scan-repaired-2.off");
    assert.equal(Number(bytes.toString().split(/\s+/)[2]), counts[1]);
    await drop(page, ".verify .drop", name, bytes);
    await page.waitForSelector("#verified.good");
  });
}

// Two washers that share a half, and a file that is no solid.
export async function several(browser) {
  const other = SAMPLES.sound().split("\n").map((line, at) => {
    const [x, ...more] = line.split(" ");
    return at > 1 && more.length === 2 ? [Number(x) + 6, ...more].join(" ") : line;
  }).join("\n");
  const file = (name, text) => ({ name, mimeType: "", buffer: Buffer.from(text) });
  await withPage(browser, {}, async (page) => {
    await page.setInputFiles("#file", [file("a.off", SAMPLES.sound()), file("b.off", other)]);
    await page.waitForSelector(".several");
    assert.deepEqual(await page.locator(".several li").allTextContents(), ["a.off", "b.off"]);
    await serious(page, "with several files");
    await shot(page, "several");
    await page.selectOption("#several-how", "intersection");
    await page.click("#several-combine");
    await opened(page);
    assert.equal(await page.textContent("#file-name"), "intersection.off");
    assert.match(await page.textContent("#size"), /^6 × /);
    assert.match(await page.textContent("#verdict h2"), /A valid solid/);

    await page.setInputFiles("#file", [file("a.off", SAMPLES.sound()), file("scan.off", SAMPLES.scan())]);
    await page.click("#several-combine");
    const notice = await page.waitForSelector('.notice[data-code="input-not-solid"]');
    assert.match(await notice.textContent(), /no closed solid/);
    await page.setInputFiles("#file", [file("a.off", SAMPLES.sound()), file("b.off", other)]);
    await page.click(".several .quiet");
    await opened(page);
    assert.equal(await page.textContent("#file-name"), "a.off");
    await page.setInputFiles("#file", Array.from({ length: 33 }, (_, at) => file(`${at}.off`, "OFF\n")));
    await page.waitForSelector('.notice[data-code="too-many-files"]');
  });
}

// A blue box without its lid in each format that has colours.
function colored() {
  const at = [0, 1, 2, 3, 4, 5, 6, 7].map((i) => [i & 1, (i >> 1) & 1, i >> 2].map((side) => side * 10));
  const faces = [[0, 2, 3], [0, 3, 1], [0, 1, 5], [0, 5, 4], [1, 3, 7], [1, 7, 5], [3, 2, 6], [3, 6, 7], [2, 0, 4], [2, 4, 6]];
  const rows = (list, of) => list.map(of).join("\n");
  const ply = (vertex, face) => `ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n${vertex}element face 10\nproperty list uchar int vertex_indices\n${face}end_header\n`;
  const channels = (type) => ["red", "green", "blue"].map((name) => `property ${type} ${name}\n`).join("");
  const model = (resources, object, more) => stored([["3D/3dmodel.model", `<model unit="millimeter" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02" xmlns:m="http://schemas.microsoft.com/3dmanufacturing/material/2015/02" xmlns:slic3rpe="http://schemas.slic3r.org/3mf/2017/06"><resources>${resources}<object id="9" ${object}><mesh><vertices>${at.map(([x, y, z]) => `<vertex x="${x}" y="${y}" z="${z}"/>`).join("")}</vertices><triangles>${faces.map(([a, b, c]) => `<triangle v1="${a}" v2="${b}" v3="${c}" ${more}/>`).join("")}</triangles></mesh></object></resources><build><item objectid="9"/></build></model>`],
    ["[Content_Types].xml", '<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types"><Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/><Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/><Default Extension="config" ContentType="text/plain"/></Types>'],
    ["_rels/.rels", '<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships"><Relationship Id="r" Target="/3D/3dmodel.model" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>'],
    ["Metadata/Slic3r_PE.config", "; extruder_colour = #FF0000;#105AE0\n"]]);
  return [
    ["faces.off", `OFF\n8 10 0\n${rows(at, (v) => v.join(" "))}\n${rows(faces, (f) => `3 ${f.join(" ")} 16 90 224`)}\n`],
    ["vertices.off", `COFF\n8 10 0\n${rows(at, (v) => `${v.join(" ")} 0.06 0.35 0.88 1`)}\n${rows(faces, (f) => `3 ${f.join(" ")}`)}\n`],
    ["vertices.obj", `${rows(at, (v) => `v ${v.join(" ")} 0.06 0.35 0.88`)}\n${rows(faces, (f) => `f ${f.map((id) => id + 1).join(" ")}`)}\n`],
    ["vertices.ply", `${ply(channels("uchar"), "")}${rows(at, (v) => `${v.join(" ")} 16 90 224`)}\n${rows(faces, (f) => `3 ${f.join(" ")}`)}\n`],
    ["faces.ply", `${ply("", channels("float"))}${rows(at, (v) => v.join(" "))}\n${rows(faces, (f) => `3 ${f.join(" ")} 0.06 0.35 0.88`)}\n`],
    ["material.3mf", model('<basematerials id="1"><base name="a" displaycolor="#FF0000"/><base name="b" displaycolor="#105AE0"/></basematerials>', 'pid="1" pindex="1"', "")],
    ["group.3mf", model('<m:colorgroup id="1"><m:color color="#105AE0FF"/></m:colorgroup>', "", 'pid="1" p1="0"')],
    ["painted.3mf", model("", "", 'slic3rpe:mmu_segmentation="8"')],
  ];
}
