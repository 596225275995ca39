// The script of the page: it finds its data and its core in the page itself.
import { unpacked } from "./bytes";
import type { App } from "./app";
import type { PageData } from "./data";
import { element } from "./dom";
import { mount } from "./mount";
import { watchTheme } from "./theme";

declare global {
  interface Window {
    clutchworkPage?: App;
  }
}

async function start(): Promise<void> {
  const root = document.getElementById("page")!;
  // in a frame of another page: shift.html#compact
  root.classList.toggle("compact", location.hash === "#compact");
  const text = (id: string): string => document.getElementById(id)!.textContent;
  try {
    const [data, wasm] = await Promise.all([unpacked(text("data")), unpacked(text("core"))]);
    const app = await mount(root, JSON.parse(new TextDecoder().decode(data)) as PageData, wasm);
    watchTheme(() => app.recolour());
    window.clutchworkPage = app;
  } catch (error) {
    root.append(element("p", { role: "alert", class: "verdict bad" }, `This page cannot run here: ${String(error)}`));
    throw error;
  }
}

void start();
