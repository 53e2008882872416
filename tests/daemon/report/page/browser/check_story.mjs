// node check_story.mjs PAGE.html [PICTURES]: whether a page of chapters draws all that it holds.
import assert from "node:assert/strict";
import { browser, empty, open, overflow } from "./browser.mjs";

const [file, pictures] = process.argv.slice(2);
for (const width of [1280, 400]) {
  const page = await open(file, width, "light");
  const told = await page.evaluate(() => JSON.parse(document.getElementById("data").textContent).chapters);
  const figures = told.flatMap((chapter) => [...chapter.plots.filter((plot) => plot.lines), ...chapter.groups.flatMap((group) => group.plots)]);
  if (pictures) await page.screenshot({ path: `${pictures}/story_${width}.png`, fullPage: true });
  await page.evaluate(() => document.querySelectorAll("details").forEach((each) => { each.open = true; }));
  await page.waitForTimeout(150);
  assert.deepEqual((await page.locator("section > h2").allTextContents()).slice(0, told.length), told.map((chapter) => chapter.title));
  assert.equal(await page.locator("canvas").count(), figures.length, `${width} px: figures`);
  assert.equal(await empty(page), 0, `${width} px: empty figures`);
  assert.ok(await overflow(page) <= 0, `${width} px: wider than the window`);
  assert.deepEqual(page.troubles, []);
  await page.context().close();
}
await browser.close();
