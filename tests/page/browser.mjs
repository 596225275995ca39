// Opens pages in a headless browser and drags a knot of each: node browser.mjs NODE_MODULES BROWSER PAGE...
// What it prints: for each page errors, requests, the time until it is ready, and what dragging did.
import { pathToFileURL } from "node:url";
import { drag, eachPage, heard, settled } from "./driver.mjs";

await eachPage(looked);

async function looked(opened, file) {
  const page = await opened.newPage();
  const { errors, requests } = heard(page);
  await page.setViewport({ width: 1280, height: 900 });
  await page.goto(pathToFileURL(file).href);
  await page.waitForFunction("window.clutchworkPage", { timeout: 20000 });
  const ready = await page.evaluate(() => performance.now());
  const before = await state(page);
  const knots = await page.$$(".knot:not([hidden])");
  const dragged = knots.length > 0;
  if (dragged) await drag(page, knots[Math.floor(knots.length / 2)], [16, -40]);
  const after = await state(page);
  if (dragged) await keys(page);
  const typed = await state(page);
  const taken = await closest(page);
  const turned = await turn(page);
  const made = dragged ? await knotted(page) : null;
  const reset = await takenBack(page);
  await page.evaluate(() => window.scrollTo(0, document.body.scrollHeight));
  await page.evaluate(() => window.clutchworkPage.look(0.3 * window.clutchworkPage.data.tEnd));
  await settled(page);
  const words = await page.evaluate(() => document.body.innerText);
  await page.close();
  return { errors, requests: requests.filter((url) => !url.startsWith("file:") && !url.startsWith("data:")), ready, dragged, before, after, typed, taken, turned, made, reset, words };
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

/** Which of two knots of one table, so close that their handles overlap, a hand takes that is on the first one: names. */
async function closest(page) {
  const asked = await page.evaluate(() => {
    const middle = (one) => {
      const { x, y, width, height } = one.getBoundingClientRect();
      return [x + width / 2, y + height / 2];
    };
    const knots = [...document.querySelectorAll(".knot:not([hidden])")];
    for (const [i, one] of knots.entries()) {
      const others = knots.filter((other) => other !== one).map((other) => Math.hypot(...middle(other).map((place, k) => place - middle(one)[k])));
      const after = knots[i + 1];
      const away = after && Math.hypot(...middle(after).map((place, k) => place - middle(one)[k]));
      if (away > 4 && away < 15 && Math.min(...others) > 4) return { at: middle(one), name: one.getAttribute("aria-label") };
    }
    return null;
  });
  if (!asked) return null;
  await page.mouse.move(...asked.at);
  await page.mouse.down();
  await page.mouse.up();
  return [asked.name, await page.evaluate(() => document.activeElement.getAttribute("aria-label"))];
}

/** The first slider by keys; what follows then, null where there is none. */
async function turn(page) {
  const slider = await page.$(".turn input");
  if (!slider) return null;
  await slider.focus();
  for (let i = 0; i < 3; i++) await page.keyboard.press("ArrowLeft");
  await settled(page);
  return state(page);
}

/** How many knots there are, then after Insert and after Delete, each on the first one. */
async function knotted(page) {
  const counts = [];
  for (const key of ["", "Insert", "Delete"]) {
    await page.focus(".knot:not([hidden])");
    if (key) await page.keyboard.press(key);
    await settled(page);
    counts.push(await page.evaluate(() => window.clutchworkPage.session.knots.flat().length));
  }
  return counts;
}

/** Whether all is as at the start after Reset. */
async function takenBack(page) {
  await page.evaluate(() => [...document.querySelectorAll("button")].find((one) => one.textContent === "Reset").click());
  await settled(page);
  return page.evaluate(() => {
    const { data, knots, values } = window.clutchworkPage.session;
    return JSON.stringify([knots, values]) === JSON.stringify([data.tables.map(({ points }) => points), data.sliders.map(({ start }) => start)]);
  });
}

async function keys(page) {
  await page.keyboard.press("ArrowUp");
  await page.keyboard.press("ArrowRight");
  await settled(page);
}
