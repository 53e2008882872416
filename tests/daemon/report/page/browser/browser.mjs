// What the checks of pages have in common.
import path from "node:path";
import { chromium } from "playwright-core";

export const kScreen = 900; // height of a window, pixels
const quiet = ["--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
  "--disable-background-networking", "--disable-component-update", "--disable-sync"];
export const browser = await chromium.launch({ executablePath: "/usr/bin/chromium", args: quiet });

export async function open(file, width, colorScheme) {
  const context = await browser.newContext({ viewport: { width, height: kScreen }, colorScheme });
  const page = await context.newPage();
  page.troubles = [];
  page.on("console", (message) => page.troubles.push(message.text()));
  page.on("pageerror", (error) => page.troubles.push(error.stack));
  page.on("request", (request) => {
    if (!request.url().startsWith("file:")) page.troubles.push(`asks for ${request.url()}`);
  });
  await page.goto(`file://${path.resolve(file)}`);
  await page.waitForSelector("canvas", { state: "attached" });
  return page;
}

export const overflow = (page) =>
  page.evaluate(() => document.documentElement.scrollWidth - document.documentElement.clientWidth);

// Whether each drawn plot holds more than its ground.
export const empty = (page) => page.evaluate(() => [...document.querySelectorAll("canvas")].filter((canvas) => {
  const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
  return !data.some((value) => value !== data[0]);
}).length);
