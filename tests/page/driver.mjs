// A headless browser with real mouse and keys: Chromium over its own protocol, Firefox over WebDriver BiDi.
import { createRequire } from "node:module";

export async function launched(modules, browser, options = {}) {
  const puppeteer = createRequire(`${modules}/package.json`)("puppeteer-core");
  const firefox = /firefox/i.test(browser);
  return puppeteer.launch({ executablePath: browser, headless: true, browser: firefox ? "firefox" : "chrome", args: firefox ? [] : ["--no-sandbox"], ...options });
}

/** Open the pages that the command line names, one after another, and print what `looked` finds in each. */
export async function eachPage(looked) {
  const [modules, browser, ...pages] = process.argv.slice(2);
  const opened = await launched(modules, browser);
  const made = [];
  for (const file of pages) made.push(await looked(opened, file));
  await opened.close();
  process.stdout.write(JSON.stringify(made));
}

/** What a page says and asks for, as it comes. */
export function heard(page) {
  const errors = [];
  const requests = [];
  page.on("console", (message) => errors.push(message.text()));
  page.on("pageerror", (error) => errors.push(error.message));
  page.on("request", (request) => requests.push(request.url()));
  return { errors, requests };
}

/** Take an element by its middle and move it by [x, y] px in steps. */
export async function drag(page, handle, [x, y]) {
  const box = await handle.boundingBox();
  const from = [box.x + box.width / 2, box.y + box.height / 2];
  await page.mouse.move(...from);
  await page.mouse.down();
  for (let i = 1; i <= 8; i++) {
    await page.mouse.move(from[0] + (x * i) / 8, from[1] + (y * i) / 8);
    await new Promise((resolve) => setTimeout(resolve, 20));
  }
  await page.mouse.up();
  await settled(page);
}

/** The hand rests: what moved last is drawn, then timers of the page up to so many ms are over, however busy the machine is. */
export function settled(page, rest = 260) {
  return page.evaluate((ms) => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => setTimeout(() => requestAnimationFrame(done), ms)))), rest);
}
