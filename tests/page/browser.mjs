// Opens pages in a headless browser and drags a knot of each: node browser.mjs NODE_MODULES BROWSER PAGE...
// What it prints: for each page errors, requests, the time until it is ready, and what dragging did.
import { createRequire } from "node:module";
import { pathToFileURL } from "node:url";

const [modules, browser, ...pages] = process.argv.slice(2);
const puppeteer = createRequire(`${modules}/package.json`)("puppeteer-core");
const opened = await puppeteer.launch({ executablePath: browser, args: ["--no-sandbox"], headless: true });
const made = [];
for (const file of pages) made.push(await looked(file));
await opened.close();
process.stdout.write(JSON.stringify(made));

async function looked(file) {
  const page = await opened.newPage();
  const errors = [];
  const requests = [];
  page.on("console", (message) => errors.push(message.text()));
  page.on("pageerror", (error) => errors.push(error.message));
  page.on("request", (request) => requests.push(request.url()));
  await page.setViewport({ width: 1280, height: 900 });
  await page.goto(pathToFileURL(file).href);
  await page.waitForFunction("window.clutchworkPage", { timeout: 20000 });
  const ready = await page.evaluate(() => performance.now());
  const before = await state(page);
  const knots = await page.$$(".knot:not([hidden])");
  const dragged = knots.length > 0 && (await drag(page, knots[Math.floor(knots.length / 2)]));
  const after = await state(page);
  if (dragged) await keys(page);
  const typed = await state(page);
  await page.evaluate(() => window.scrollTo(0, document.body.scrollHeight));
  await page.evaluate(() => window.clutchworkPage.look(0.3 * window.clutchworkPage.data.tEnd));
  await settled(page);
  const words = await page.evaluate(() => document.body.innerText);
  await page.close();
  return { errors, requests: requests.filter((url) => !url.startsWith("file:") && !url.startsWith("data:")), ready, dragged, before, after, typed, words };
}

/** Numbers that follow from the present run, and the picture of the first curves. */
function state(page) {
  return page.evaluate(() => {
    const { run, session, work } = window.clutchworkPage;
    const sum = run.rows.reduce((total, value, i) => total + (Number.isFinite(value) ? value * (1 + (i % 7)) : 0), 0);
    const canvas = document.querySelector(".curves canvas");
    return { sum, status: run.status, knots: session.knots, runs: work.length, picture: canvas ? canvas.toDataURL().length : 0 };
  });
}

async function drag(page, knot) {
  const box = await knot.boundingBox();
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  await page.mouse.move(x, y);
  await page.mouse.down();
  for (let i = 1; i <= 8; i++) {
    await page.mouse.move(x + 2 * i, y - 5 * i);
    await new Promise((resolve) => setTimeout(resolve, 20));
  }
  await page.mouse.up();
  await settled(page);
  return true;
}

async function keys(page) {
  await page.keyboard.press("ArrowUp");
  await page.keyboard.press("ArrowRight");
  await settled(page);
}

function settled(page) {
  return new Promise((resolve) => setTimeout(resolve, 260)).then(() => page.evaluate(() => new Promise(requestAnimationFrame)));
}
