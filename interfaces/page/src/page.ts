// The script of the page: it finds its data and its core in the page itself.
import { unpacked } from "./bytes";
import type { App } from "./app";
import type { PageData } from "./data";
import { element } from "./dom";
import { mount } from "./mount";

declare global {
  interface Window {
    clutchworkPage?: App;
  }
}

async function start(): Promise<void> {
  const root = document.getElementById("page")!;
  const text = (id: string): string => document.getElementById(id)!.textContent;
  try {
    const [data, wasm] = await Promise.all([unpacked(text("data")), unpacked(text("core"))]);
    window.clutchworkPage = await mount(root, JSON.parse(new TextDecoder().decode(data)) as PageData, wasm);
  } catch (error) {
    root.append(element("p", { role: "alert", class: "verdict bad" }, `This page cannot run here: ${String(error)}`));
    throw error;
  }
}

void start();
