// Pictures of pages to look at, after a knot was dragged: node pictures.mjs NODE_MODULES BROWSER FOLDER PAGE...
// One for desktop and one for phone, in light and dark: FOLDER/PAGE-BROWSER-WIDTH-SCHEME.png. What it prints: errors by page.
import { basename } from "node:path";
import { pathToFileURL } from "node:url";
import { drag, heard, launched, settled } from "./driver.mjs";

const [modules, browser, folder, ...pages] = process.argv.slice(2);
const kind = /firefox/i.test(browser) ? "firefox" : "chromium";
const WIDTHS = { desktop: 1280, phone: 390 };
const found = {};
for (const scheme of ["light", "dark"]) {
  // Firefox takes its scheme when it starts
  const opened = await launched(modules, browser, { extraPrefsFirefox: { "ui.systemUsesDarkTheme": scheme === "dark" ? 1 : 0 } });
  for (const file of pages) for (const [name, width] of Object.entries(WIDTHS)) await picture(opened, file, scheme, name, width);
  await opened.close();
}
process.stdout.write(JSON.stringify(found));

async function picture(opened, file, scheme, name, width) {
  const page = await opened.newPage();
  const { errors } = heard(page);
  if (kind === "chromium") await page.emulateMediaFeatures([{ name: "prefers-color-scheme", value: scheme }]);
  await page.setViewport({ width, height: 844 });
  await page.goto(pathToFileURL(file).href);
  await page.waitForSelector("main .panel");
  await settled(page);
  const [knot] = (await page.$$(".knot:not([hidden])")).slice(2);
  if (knot) await drag(page, knot, [12, -24]);
  // parts that nobody sees are not drawn: all of the page in one window
  for (let i = 0; i < 2; i++) {
    await page.setViewport({ width, height: await page.evaluate(() => document.documentElement.scrollHeight) });
    await settled(page);
  }
  const stem = basename(file).replace(/\.html$/, "");
  await page.screenshot({ path: `${folder}/${stem}-${kind}-${name}-${scheme}.png` });
  if (errors.length) found[`${stem}-${kind}`] = errors;
  await page.close();
}
