// The widget in a page that holds two of them, as anywidget gives it a model: node widget.mjs NODE_MODULES BROWSER FOLDER
// FOLDER: widget.js, and traits.json with page, css, core (base64), knots, values. What it prints: what came of each deed.
import { readFile } from "node:fs/promises";
import { drag, heard, launched, settled } from "./driver.mjs";

const [modules, browser, folder] = process.argv.slice(2);
const script = (await readFile(`${folder}/widget.js`)).toString("base64");
const traits = JSON.parse(await readFile(`${folder}/traits.json`, "utf8"));
const opened = await launched(modules, browser);
const page = await opened.newPage();
const { errors, requests } = heard(page);
await page.setViewport({ width: 1280, height: 1000 });
await page.emulateMediaFeatures([{ name: "prefers-color-scheme", value: "light" }]);
await page.evaluate(place, script, traits);
await page.waitForFunction(() => window.places.every(({ inside }) => inside()?.querySelector(".knot")));
await settled(page);

const start = await both();
const knot = await page.evaluateHandle(() => window.places[0].inside().querySelectorAll(".knot:not([hidden])")[1]);
await drag(page, knot.asElement(), [20, -30]);
const dragged = await both();
await page.keyboard.press("ArrowUp");
await settled(page);
const typed = await both();
await page.evaluate((name, knots) => window.places[1].model.receive("knots", { [name]: knots }), ...later(traits));
await settled(page);
const received = await both();
await page.evaluate(() => window.places.forEach(({ el }) => el.setAttribute("data-jp-theme-light", "false")));
await settled(page);
const dark = await both();
await page.evaluate(() => window.places.forEach(({ el }) => el.removeAttribute("data-jp-theme-light")));
await settled(page);
const unsaid = await both();
await page.emulateMediaFeatures([{ name: "prefers-color-scheme", value: "dark" }]);
await settled(page);
const preferred = await both();
const said = {};
for (const [where, name, value] of [["body", "data-vscode-theme-kind", "vscode-light"], ["body", "data-vscode-theme-kind", "vscode-dark"], ["html", "theme", "light"], ["html", "theme", "dark"]]) {
  await page.evaluate((...given) => document.querySelector(given[0]).setAttribute(given[1], given[2]), where, name, value);
  await settled(page);
  said[`${name} ${value}`] = await both();
  await page.evaluate((...given) => document.querySelector(given[0]).removeAttribute(given[1]), where, name);
}
await page.evaluate(() => window.places[0].away());
const listeners = await page.evaluate(() => window.places.map(({ model, el }) => [model.count(), el.childElementCount]));
await page.evaluate(() => window.places[0].again());
await settled(page);
const again = await page.evaluate(() => window.places[0].inside().querySelectorAll(".knot").length);
await opened.close();
const asked = requests.filter((url) => !url.startsWith("data:") && !url.startsWith("about:"));
process.stdout.write(JSON.stringify({ errors, asked, start, dragged, typed, received, dark, unsaid, preferred, said, listeners, again }));

/** The knots of the first table, lower and later, as Python sets them. */
function later({ knots }) {
  const [name, points] = Object.entries(knots)[0];
  return [name, points.map(([t, y], i) => [t, i ? 0.5 * y : y])];
}

/** What each of the two widgets shows, and what its model has. */
function both() {
  return page.evaluate(() =>
    window.places.map(({ model, inside }) => {
      const canvas = inside().querySelector(".curves canvas");
      const label = inside().querySelector(".verdict").textContent;
      const style = getComputedStyle(inside().querySelector(".panel"));
      return { knots: model.get("knots"), saves: model.saves, picture: canvas.toDataURL(), label, ground: style.backgroundColor, text: style.color };
    }),
  );
}

/** Two models and two places in the page: the first in a light notebook, the second in a dark one. */
async function place(code, given) {
  const { default: widget } = await import(`data:text/javascript;base64,${code}`);
  const core = Uint8Array.from(atob(given.core), (letter) => letter.charCodeAt(0));
  class Model {
    constructor() {
      this.traits = { ...structuredClone(given), core: new DataView(core.buffer) };
      this.heard = [];
      this.saves = 0;
    }
    get(name) {
      return this.traits[name];
    }
    // as Backbone does: what is equal changes nothing
    set(name, value) {
      if (JSON.stringify(this.traits[name]) === JSON.stringify(value)) return;
      this.traits[name] = value;
      this.heard.filter(([event]) => event === `change:${name}`).forEach(([, action]) => action());
    }
    receive(name, value) {
      this.set(name, value);
    }
    save_changes() {
      this.saves++;
    }
    on(name, action) {
      this.heard.push([name, action]);
    }
    off(name, action) {
      this.heard = this.heard.filter(([event, other]) => event !== name || other !== action);
    }
    count() {
      return this.heard.length;
    }
  }
  window.places = ["true", "false"].map((light) => {
    const model = new Model();
    const el = document.createElement("div");
    el.setAttribute("data-jp-theme-light", light);
    el.style.cssText = "display: inline-block; width: 49%; vertical-align: top";
    const made = { model, el, inside: () => el.firstElementChild?.shadowRoot };
    const given = widget.render({ model, el });
    // notebooks show it later
    setTimeout(() => document.body.append(el), 50);
    made.away = async () => (await given)();
    made.again = () => widget.render({ model, el });
    return made;
  });
}
