// Frames a second of a page while a knot is dragged for 10 s, and the work from the move to the curves, beside a blank
// page that is only moved over: node benchmarks/page_frames.mjs [PAGE] [BROWSER], after `clutchwork page ... --out PAGE`.
import { createRequire } from "node:module";
import { fileURLToPath, pathToFileURL } from "node:url";

const [file = "shift.html", browser = "/usr/bin/chromium"] = process.argv.slice(2);
const modules = fileURLToPath(new URL("../interfaces/page/package.json", import.meta.url));
const puppeteer = createRequire(modules)("puppeteer-core");
const SECONDS = 10;
const opened = await puppeteer.launch({ executablePath: browser, args: ["--no-sandbox"], headless: true });

const blank = await moved(await opened.newPage(), "about:blank");
const page = await moved(await opened.newPage(), pathToFileURL(file).href);
await opened.close();
console.log(`blank page: ${blank.frames.toFixed(1)} frames a second`);
console.log(`this page:  ${page.frames.toFixed(1)} frames a second, ready after ${page.ready.toFixed(0)} ms`);
console.log(`work from move to curves: median ${page.median.toFixed(2)} ms, 95 % ${page.high.toFixed(2)} ms, ${page.runs} runs of ${page.steps} steps`);

async function moved(tab, address) {
  await tab.setViewport({ width: 1280, height: 900 });
  await tab.goto(address);
  const live = address !== "about:blank";
  if (live) await tab.waitForFunction("window.clutchworkPage");
  const ready = await tab.evaluate(() => performance.now());
  const box = live ? await place(tab) : { x: 200, y: 200 };
  await tab.bringToFront();
  await tab.mouse.move(box.x, box.y);
  await tab.mouse.down();
  await tab.evaluate(count);
  const begin = performance.now();
  while (performance.now() - begin < 1000 * SECONDS) {
    const phase = (performance.now() - begin) / 700;
    await tab.mouse.move(box.x + 18 * Math.sin(phase), box.y - 40 + 40 * Math.cos(1.3 * phase));
  }
  const frames = await tab.evaluate(() => window.counted / ((performance.now() - window.begun) / 1000));
  await tab.mouse.up();
  const work = live ? await tab.evaluate(() => window.clutchworkPage.work.slice(20)) : [0];
  const steps = live ? await tab.evaluate(() => window.clutchworkPage.run.steps) : 0;
  work.sort((a, b) => a - b);
  return { frames, ready, steps, runs: work.length, median: work[work.length >> 1], high: work[Math.floor(0.95 * work.length)] };
}

/** The middle of a knot that matters: the one behind the middle. */
async function place(tab) {
  const knots = await tab.$$(".knot:not([hidden])");
  const box = await knots[Math.floor(0.7 * knots.length)].boundingBox();
  return { x: box.x + box.width / 2, y: box.y + box.height / 2 };
}

function count() {
  window.counted = 0;
  window.begun = performance.now();
  const next = () => {
    window.counted++;
    requestAnimationFrame(next);
  };
  requestAnimationFrame(next);
}
