// What a screen reader and a keyboard find in pages: node access.mjs NODE_MODULES BROWSER PAGE...
// What it prints, for each page: the controls with role and name, their words, their sizes on a phone, what Tab reaches and how
// that is seen, and how often live regions speak while something is dragged.
import { pathToFileURL } from "node:url";
import { eachPage, heard, settled } from "./driver.mjs";

const ROLES = new Set(["button", "slider", "link", "textbox", "checkbox", "combobox", "spinbutton", "radio", "tab"]);
// words are told when they rest
const REST = 700;
const MOST_TABS = 80;
await eachPage(looked);

async function looked(opened, file) {
  const page = await opened.newPage();
  const { errors } = heard(page);
  await page.setViewport({ width: 390, height: 844 });
  await page.goto(pathToFileURL(file).href);
  await page.waitForSelector("main .panel button, main .panel .knot, main .panel input");
  await settled(page);
  const tree = await nodes(page);
  const small = await page.evaluate(sizes);
  const texts = await page.evaluate(() => [...document.querySelectorAll('[role="slider"], input[type="range"]')].map((one) => one.getAttribute("aria-valuetext")));
  await page.evaluate(listen);
  const stops = await tabbed(page);
  const typed = await typedOn(page);
  await page.close();
  return { errors, controls: tree.filter(({ role }) => ROLES.has(role)), unnamed: tree.filter(unnamed), texts, small, stops, typed };
}

function unnamed({ role, name, focusable }) {
  return !name && (ROLES.has(role) || ["region", "figure", "image", "dialog"].includes(role) || (focusable && role !== "RootWebArea"));
}

async function nodes(page) {
  const session = await page.createCDPSession();
  const { nodes: found } = await session.send("Accessibility.getFullAXTree");
  await session.detach();
  return found
    .filter((node) => !node.ignored)
    .map((node) => ({
      role: node.role?.value ?? "",
      name: (node.name?.value ?? "").trim(),
      focusable: node.properties?.some(({ name, value }) => name === "focusable" && value.value) ?? false,
    }));
}

/** What is smaller than a finger needs, of 24 px. */
function sizes() {
  return [...document.querySelectorAll("button, input, .knot:not([hidden])")]
    .map((one) => ({ what: one.getAttribute("aria-label") ?? one.textContent ?? one.id, box: one.getBoundingClientRect() }))
    .filter(({ box }) => box.width > 0 && Math.min(box.width, box.height) < 24)
    .map(({ what, box }) => `${what}: ${box.width} x ${box.height}`);
}

/** Count how often a region that is told aloud changes. */
function listen() {
  window.told = 0;
  const live = '[role="status"], [role="alert"], [role="log"], [aria-live="polite"], [aria-live="assertive"], output:not([aria-live="off"])';
  const count = new MutationObserver((changes) => {
    const spoken = changes.some(({ target }) => (target.nodeType === 1 ? target : target.parentElement)?.closest(live));
    if (spoken) window.told++;
  });
  count.observe(document.body, { childList: true, characterData: true, subtree: true });
}

/** What Tab reaches, in order, and whether it can be seen there. */
async function tabbed(page) {
  const stops = [];
  for (let i = 0; i < MOST_TABS; i++) {
    await page.keyboard.press("Tab");
    const stop = await page.evaluate(() => {
      const now = document.activeElement;
      if (!now || now === document.body) return null;
      const ring = getComputedStyle(now).outlineStyle !== "none" || getComputedStyle(now, "::after").boxShadow !== "none";
      return { what: now.getAttribute("aria-label") ?? now.textContent ?? "", tag: now.tagName, role: now.getAttribute("role"), ring };
    });
    if (!stop) break;
    stops.push(stop);
  }
  return stops;
}

/** The first slider under eight keys, one after another without a rest: its value before and after, and what was told. */
async function typedOn(page) {
  await page.evaluate(() => document.querySelector('[role="slider"]:not([hidden]), input[type="range"]').focus());
  const state = () => page.evaluate(() => [document.activeElement.getAttribute("aria-valuetext"), window.told]);
  const [before] = await state();
  await page.evaluate(() => (window.told = 0));
  for (let i = 0; i < 8; i++) {
    await page.keyboard.press("ArrowUp");
    await new Promise((resolve) => setTimeout(resolve, 20));
  }
  const [, during] = await state();
  await settled(page, REST);
  const [after, told] = await state();
  return { before, after, during, told };
}
