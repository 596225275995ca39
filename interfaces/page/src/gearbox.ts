// The page of a gearbox: choose a gear, give speed and torque at the input, see what every part does.
import { unpacked } from "./bytes";
import { element, Spoken } from "./dom";
import { gearTables, sentence, type GearboxData, type GearData } from "./gears";

const SPEEDS = { max: 6000, start: 1500, unit: "1/min" };
const TORQUES = { max: 800, start: 300, unit: "N m" };
const CAPTIONS: Record<string, string> = { stick: "Power flow", lever: "Levers: distances from the teeth, positions from the speeds" };

class Page {
  private readonly now = element("div", { class: "curves" });
  private readonly words = new Spoken("panel drag");
  private readonly pictures = element("div", { class: "gearpictures" });
  private readonly buttons: HTMLButtonElement[] = [];
  private gear = 0;
  private speed = SPEEDS.start;
  private torque = TORQUES.start;

  constructor(root: HTMLElement, private readonly data: GearboxData) {
    const source = element("p", { class: "help" }, data.source);
    const hand = element("div", { class: "hand" }, this.gears(), this.inputs(), this.words.root, this.now);
    const columns = element("div", { class: "columns" }, hand, this.pictures);
    root.replaceChildren(element("header", {}, element("h1", {}, data.title)), columns, source);
    this.choose(0);
  }

  private gears(): HTMLElement {
    const group = element("div", { class: "tools gears", role: "group", "aria-label": "gear" });
    this.data.gears.forEach((gear, place) => {
      const button = element("button", { type: "button" }, gear.name);
      button.addEventListener("click", () => this.choose(place));
      this.buttons.push(button);
      group.append(button);
    });
    group.addEventListener("keydown", (event) => {
      const step = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 }[event.key];
      if (step === undefined) return;
      event.preventDefault();
      const count = this.data.gears.length;
      this.choose((this.gear + step + count) % count);
      this.buttons[this.gear]!.focus();
    });
    return element("section", { class: "panel drag" }, element("h2", {}, "Gear"), group);
  }

  private inputs(): HTMLElement {
    const speed = slider("speed of the input", SPEEDS, (value) => {
      this.speed = value;
      this.tell();
    });
    const torque = slider("torque of the input", TORQUES, (value) => {
      this.torque = value;
      this.tell();
    });
    return element("section", { class: "panel drag" }, element("h2", {}, "At the input"), speed, torque);
  }

  private choose(place: number): void {
    this.gear = place;
    this.buttons.forEach((button, number) => button.setAttribute("aria-pressed", String(number === place)));
    this.pictures.replaceChildren(...pictures(this.data.gears[place]!));
    this.tell();
  }

  private tell(): void {
    const gear = this.data.gears[this.gear]!;
    this.words.say(sentence(this.data, gear, this.speed, this.torque));
    this.now.replaceChildren(...gearTables(this.data, gear, this.speed, this.torque));
  }
}

function slider(label: string, range: typeof SPEEDS, action: (value: number) => void): HTMLElement {
  const input = element("input", { type: "range", min: "0", max: `${range.max}`, value: `${range.start}`, step: "10", "aria-label": label });
  const output = element("output", { "aria-live": "off" }, `${range.start} ${range.unit}`);
  input.setAttribute("aria-valuetext", output.textContent);
  input.addEventListener("input", () => {
    output.textContent = `${input.value} ${range.unit}`;
    input.setAttribute("aria-valuetext", output.textContent);
    action(Number(input.value));
  });
  return element("label", { class: "slider" }, element("span", {}, label), output, input);
}

function pictures(gear: GearData): HTMLElement[] {
  return Object.entries(gear.pictures).map(([kind, text]) => {
    const drawing = new DOMParser().parseFromString(text, "image/svg+xml").documentElement;
    const frame = element("div", { class: "wide paper" });
    frame.append(document.importNode(drawing, true));
    return element("section", { class: "panel" }, element("h2", {}, CAPTIONS[kind] ?? kind), frame);
  });
}

async function start(): Promise<void> {
  const root = document.getElementById("page")!;
  const data = await unpacked(document.getElementById("data")!.textContent);
  new Page(root, JSON.parse(new TextDecoder().decode(data)) as GearboxData);
}

void start();
