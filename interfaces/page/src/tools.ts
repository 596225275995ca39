// Buttons: back to the start, and what a reader takes along.
import type { App } from "./app";
import { asCsv, asPython, asToml } from "./copies";
import { button, element } from "./dom";

export function tools(app: App): HTMLElement {
  const { session } = app;
  const reset = button("Reset", () => {
    session.reset();
    app.compute(true);
  });
  const made = element("div", { class: "tools", role: "group", "aria-label": "tools" }, reset);
  if (app.data.model) made.append(copying(app, "Copy as TOML", () => asToml(session) ?? ""));
  made.append(copying(app, "Copy as Python", () => asPython(session)));
  made.append(button("Download CSV", () => download(`${plain(app.data.name)}.csv`, asCsv(app.data, app.run))));
  return made;
}

function copying(app: App, label: string, text: () => string): HTMLElement {
  const made = button(label, () => {
    const words = text();
    const done = (): void => {
      made.textContent = "Copied";
      setTimeout(() => (made.textContent = label), 1200);
    };
    const copied = navigator.clipboard?.writeText(words) ?? Promise.reject(new Error("no clipboard"));
    copied.then(done, () => show(app.root, label, words));
  });
  return made;
}

/** Where the browser gives no clipboard: the text, to be copied by hand. */
function show(root: HTMLElement, label: string, words: string): void {
  const area = element("textarea", { readonly: true, rows: "16", "aria-label": label });
  area.value = words;
  const box = element("dialog", { "aria-label": label }, area);
  box.append(button("Close", () => box.close()));
  box.addEventListener("close", () => box.remove());
  root.append(box);
  box.showModal();
  area.select();
}

function download(name: string, content: string): void {
  const address = URL.createObjectURL(new Blob([content], { type: "text/csv" }));
  const link = element("a", { href: address, download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(address), 1000);
}

function plain(name: string): string {
  return name.replace(/[^\p{L}\p{N}_-]+/gu, "_").slice(0, 60) || "run";
}
