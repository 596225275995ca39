// The page in a notebook: knots and sliders are traits, which Python reads and sets.
import type { PageData } from "./data";
import { element } from "./dom";
import { mount } from "./mount";
import { stateOf, take, type State } from "./state";
import { darkness, isDark, watchTheme } from "./theme";

interface Model {
  get(name: "page" | "css"): string;
  get(name: "core"): DataView;
  get(name: "knots"): State["knots"];
  get(name: "values"): State["values"];
  set(name: string, value: unknown): void;
  save_changes(): void;
  on(name: string, action: () => void): void;
  off(name: string, action: () => void): void;
}

const TRAITS = ["change:knots", "change:values"];

/** Each view has a root, a style and a theme of its own; what is returned takes it away. */
async function render({ model, el }: { model: Model; el: HTMLElement }): Promise<() => void> {
  // keys on knots and sliders are theirs, not shortcuts of JupyterLab
  const place = element("div", { "data-lm-suppress-shortcuts": true });
  const root = element("main");
  const sheet = new CSSStyleSheet();
  sheet.replaceSync(model.get("css").replaceAll(":root", ":host"));
  const inside = place.attachShadow({ mode: "open" });
  inside.adoptedStyleSheets = [sheet];
  inside.append(root);
  el.append(place);
  await shown(place);
  const darken = darkness(sheet);
  const core = model.get("core");
  const bytes = new Uint8Array(core.buffer, core.byteOffset, core.byteLength).slice();
  darken(isDark(el));
  const app = await mount(root, JSON.parse(model.get("page")) as PageData, bytes);
  const unwatch = watchTheme(() => {
    darken(isDark(el));
    app.recolour();
  });
  const hear = (): void => {
    if (take(app.session, { knots: model.get("knots"), values: model.get("values") })) app.compute(true);
  };
  app.add({
    update: (_, settled) => {
      if (!settled) return;
      const now = stateOf(app.session);
      model.set("knots", now.knots);
      model.set("values", now.values);
      model.save_changes();
    },
  });
  hear();
  TRAITS.forEach((name) => model.on(name, hear));
  return () => {
    TRAITS.forEach((name) => model.off(name, hear));
    unwatch();
    app.end();
    place.remove();
  };
}

/** Notebooks give an element that they show later: until then nothing in it has a colour or a width. */
function shown(place: Element): Promise<void> {
  return new Promise((resolve) => {
    new ResizeObserver((_, self) => {
      self.disconnect();
      resolve();
    }).observe(place);
  });
}

export default { render };
