// Frames of a knot that is dragged: node frames.mjs NODE_MODULES BROWSER FOLDER PAGE KNOT WAY, WAY as [[x, y], ...] in px.
// FOLDER/NN.png, one at each place of the way. What it prints: what the page said in its console.
import { pathToFileURL } from "node:url";
import { heard, launched, settled } from "./driver.mjs";

const [modules, browser, folder, file, label, way] = process.argv.slice(2);
// the controls of the time are out of the way, and the pointer is seen
const LOOKS = `.clock { display: none } body { background: var(--ground) } #pointer { position: fixed; z-index: 9; pointer-events: none }`;
const POINTER = `<svg id="pointer" width="22" height="26" viewBox="0 0 22 26"><path d="M2 2v19l5-4.5 3.2 7 3.4-1.6-3.2-6.9H17z" stroke="#fff" stroke-width="1.5"/></svg>`;

const opened = await launched(modules, browser);
const page = await opened.newPage();
const { errors } = heard(page);
// the page lets in no styles but its own
await page.setBypassCSP(true);
await page.setViewport({ width: 660, height: 680, deviceScaleFactor: 1.25 });
await page.goto(`${pathToFileURL(file).href}#compact`);
await page.waitForSelector("main .panel");
await page.addStyleTag({ content: LOOKS });
await page.evaluate((pointer) => document.body.insertAdjacentHTML("beforeend", pointer), POINTER);
const box = await (await page.$(`.knot[aria-label="${label}"]`)).boundingBox();
const from = [box.x + box.width / 2, box.y + box.height / 2];
// below the panels that are not asked for
const bottom = await page.evaluate(() => Math.max(...[...document.querySelectorAll(".curves > .panel")].slice(0, 2).map((one) => one.getBoundingClientRect().bottom)));
const clip = { x: 0, y: 0, width: 660, height: Math.ceil(bottom) + 6 };

let number = 0;
await page.mouse.move(...from);
for (const [x, y] of JSON.parse(way)) {
  // the hand takes the knot before it moves
  if (number === 1) await page.mouse.down();
  await page.mouse.move(from[0] + x, from[1] + y);
  await page.evaluate((at) => Object.assign(document.querySelector("#pointer").style, { left: `${at[0] - 2}px`, top: `${at[1] - 2}px` }), [from[0] + x, from[1] + y]);
  await settled(page);
  await page.screenshot({ path: `${folder}/${String(number).padStart(2, "0")}.png`, clip });
  number += 1;
}
await opened.close();
process.stdout.write(errors.join("\n"));
