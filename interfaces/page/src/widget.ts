// The page in a notebook: knots and sliders are traits, which Python reads and sets.
import { setHost } from "./dom";
import { mount } from "./mount";
import { stateOf, take, type State } from "./state";
import type { PageData } from "./data";

interface Model {
  get(name: "page" | "style"): string;
  get(name: "core"): DataView;
  get(name: "knots"): State["knots"];
  get(name: "values"): State["values"];
  set(name: string, value: unknown): void;
  save_changes(): void;
  on(name: string, action: () => void): void;
  off(name: string, action: () => void): void;
}

async function render({ model, el }: { model: Model; el: HTMLElement }): Promise<() => void> {
  const shadow = el.attachShadow({ mode: "open" });
  const style = document.createElement("style");
  style.textContent = model.get("style").replaceAll(":root", ":host");
  const root = document.createElement("main");
  shadow.append(style, root);
  setHost(root);
  const core = model.get("core");
  const app = await mount(root, JSON.parse(model.get("page")) as PageData, new Uint8Array(core.buffer, core.byteOffset, core.byteLength).slice());
  const given = (): Partial<State> => ({ knots: model.get("knots"), values: model.get("values") });
  const hear = (): void => {
    if (take(app.session, given())) app.compute(true);
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
  model.on("change:knots", hear);
  model.on("change:values", hear);
  return () => {
    model.off("change:knots", hear);
    model.off("change:values", hear);
  };
}

export default { render };
