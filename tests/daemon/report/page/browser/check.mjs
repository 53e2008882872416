// node check.mjs DIAGNOSIS.html IDENTIFICATION.html [PICTURES]: what an engineer sees of the two pages.
import assert from "node:assert/strict";
import YAML from "yaml";
import { browser, empty, kScreen, open, overflow } from "./browser.mjs";

const [diagnosis, identification, pictures] = process.argv.slice(2);

// Texts that stick out of what holds them, and tags that are broken.
const stickingOut = (page) => page.evaluate(() => {
  const right = (node) => {
    const range = document.createRange();
    range.selectNodeContents(node);
    return range.getBoundingClientRect().right;
  };
  const matrix = document.querySelector("#matrix"), found = [];
  if (matrix.parentElement.scrollHeight > matrix.parentElement.clientHeight) found.push("the matrix, up and down");
  if (matrix.parentElement.scrollWidth > matrix.parentElement.clientWidth) found.push("the matrix");
  for (const cell of matrix.querySelectorAll("td, th"))
    if (!cell.querySelector(".heard") && right(cell) > cell.getBoundingClientRect().right) found.push(cell.textContent);
  for (const tag of document.querySelectorAll("#numbers .tag"))
    if (tag.offsetParent && tag.offsetHeight > 1.5 * parseFloat(getComputedStyle(tag).lineHeight)) found.push(tag.textContent);
  return found;
});

// Ticks of all axes that say that a number is not known.
const unknownTicks = (page) => page.evaluate(() => [...document.querySelectorAll("figure")]
  .flatMap((each) => each.plot ? each.plot.axes.flatMap((axis) => axis._values || []) : [])
  .filter((text) => text === "–").length);

// How far apart ticks of dates are, in seconds, where that is no whole part of a minute, an hour or a day.
const oddTimes = (page) => page.evaluate(() => [...document.querySelectorAll("figure")]
  .filter((each) => each.plot && each.plot.scales.x.time)
  .map((each) => each.plot.axes[0]._splits[1] - each.plot.axes[0]._splits[0])
  .filter((step) => [[1, 60], [60, 3600], [3600, 86400]].some(([unit, whole]) =>
    step >= unit && step < whole && (step % unit !== 0 || whole % step !== 0))));

// Plots that are wider than their figures, and grids with plots that are not in line.
const tooWide = (page) => page.evaluate(() => [...document.querySelectorAll("figure")]
  .filter((each) => each.plot && each.plot.width > each.getBoundingClientRect().width + 1).length);
const outOfLine = (page) => page.evaluate(() => [...document.querySelectorAll(".grid")].filter((grid) => {
  const [first, second] = [...grid.children].map((each) => each.getBoundingClientRect());
  return second && first.width && Math.abs(first.top - second.top) > 0.5;
}).length);

async function copied(page, name) {
  await page.evaluate(() => {
    navigator.clipboard.writeText = async (text) => { window.copied = text; };
  });
  await page.click(`button[data-copy=${name}]`);
  return page.evaluate(() => window.copied);
}

for (const [name, file] of [["diagnosis", diagnosis], ["identification", identification]])
  for (const width of [1280, 400])
    for (const scheme of ["light", "dark"]) {
      const what = `${name}, ${width} px, ${scheme}`;
      const page = await open(file, width, scheme);
      assert.ok(await overflow(page) <= 0, `${what}: wider than the window`);
      assert.equal(await page.locator("#matrix td").count() > 9, true, `${what}: no matrix`);
      assert.equal(await page.locator("#numbers table").count() > 0, true, `${what}: no table`);
      const first = await page.locator("#views canvas").first().boundingBox();
      if (width === 1280)
        assert.ok(first.y + first.height < 1.5 * kScreen, `${what}: first plot ends at ${first.y + first.height} px`);
      console.log(`${what}: first plot from ${Math.round(first.y)} to ${Math.round(first.y + first.height)} px`);
      await page.evaluate(() => document.querySelectorAll("details").forEach((each) => { each.open = true; }));
      await page.waitForTimeout(150);
      assert.equal(await empty(page), 0, `${what}: empty plots`);
      assert.deepEqual(await oddTimes(page), [], `${what}: times that are not round`);
      assert.deepEqual(await stickingOut(page), [], what);
      if (width === 1280) assert.equal(await outOfLine(page), 0, `${what}: plots out of line`);
      assert.ok(await overflow(page) <= 0, `${what}: all open, wider than the window`);
      assert.deepEqual(page.troubles, [], what);
      if (pictures) {
        await page.reload();
        await page.waitForSelector("canvas", { state: "attached" });
        await page.screenshot({ path: `${pictures}/${name}_${width}_${scheme}.png`, fullPage: width < 1280 });
      }
      await page.context().close();
    }

const page = await open(diagnosis, 1280, "dark");
const model = YAML.parse(await copied(page, "YAML")).model;
assert.equal(model.channels.length, 9);
assert.ok(model.channels.every((each) => Number.isFinite(each.gain)));
const rows = (await copied(page, "CSV")).trimEnd().split("\n").map((line) => line.split(","));
assert.deepEqual(rows[0], ["cv", "input", "number", "unit", "old", "new", "low", "high"]);
assert.equal(rows.length, 28); // 9 channels of three numbers
const gain = rows.find((row) => row[0] === "y3" && row[1] === "u3" && row[2] === "gain");
assert.equal(gain[4], "7.2");
const typed = model.channels.find((each) => each.cv === "y3" && each.mv === "u3");
assert.ok(Math.abs(gain[5] / typed.gain - 1) < 1e-5, "the table and the YAML differ");

// The cursor tells time and values; a drag zooms both plots of a finding.
const over = page.locator("#views .u-over").first();
await over.hover({ position: { x: 120, y: 60 } });
assert.match(await page.locator("#views .readout").first().textContent(), /measured .*simulated .*extended/);
const box = await over.boundingBox();
await page.mouse.move(box.x + 100, box.y + 50);
await page.mouse.down();
await page.mouse.move(box.x + 200, box.y + 50);
await page.mouse.up();
const ranges = await page.evaluate(() => [...document.querySelectorAll("#views .view:first-child figure")]
  .map((each) => [each.plot.scales.x.min, each.plot.scales.x.max, each.plot.data[0].at(-1) - each.plot.data[0][0]]));
assert.ok(ranges[0][1] - ranges[0][0] < 0.5 * ranges[0][2], "a drag does not zoom");
for (const range of ranges) assert.deepEqual(range.slice(0, 2), ranges[0].slice(0, 2), "one plot is zoomed alone");

// Printed from any window: laid out for the paper before the browser takes its picture.
const pages = [];
for (const width of [1280, 400]) {
  const printed = await open(diagnosis, width, "dark");
  await printed.evaluate(() => window.dispatchEvent(new Event("beforeprint")));
  await printed.waitForTimeout(150);
  assert.equal(await tooWide(printed), 0, `printed from ${width} px: plots wider than their places`);
  assert.equal(await outOfLine(printed), 0, `printed from ${width} px: plots below each other`);
  assert.equal(await unknownTicks(printed), 0, `printed from ${width} px: ticks without a number`);
  const paper = (await printed.pdf({ format: "A4" })).toString("latin1");
  pages.push(paper.match(/\/Type *\/Page\b/g).length);
  await printed.context().close();
}
assert.equal(pages[0], pages[1], "another window gives another paper");
console.log(`on ${pages[0]} pages of paper`);

// Paper is white, everything is open, nothing is cut off.
await page.emulateMedia({ media: "print", colorScheme: "dark" });
await page.setViewportSize({ width: 718, height: 1000 });
await page.waitForTimeout(200);
assert.equal(await page.evaluate(() => getComputedStyle(document.body).backgroundColor), "rgb(255, 255, 255)");
assert.equal(await page.locator("details:not([open])").count(), 0);
assert.ok(await overflow(page) <= 0, "wider than the paper");
assert.equal(await tooWide(page), 0, "plots wider than their places on paper");
assert.ok((await page.pdf({ format: "A4" })).length > 50_000);
assert.deepEqual(page.troubles, []);
await browser.close();
console.log("all as it should be");
