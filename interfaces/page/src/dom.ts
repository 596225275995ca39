// Elements in one line.

type Child = Node | string;
type Attributes = Record<string, string | boolean>;

export function element<K extends keyof HTMLElementTagNameMap>(tag: K, attributes: Attributes = {}, ...children: Child[]): HTMLElementTagNameMap[K] {
  const made = document.createElement(tag);
  set(made, attributes);
  made.append(...children);
  return made;
}

export function svg(tag: string, attributes: Attributes = {}, ...children: Child[]): SVGElement {
  const made = document.createElementNS("http://www.w3.org/2000/svg", tag);
  set(made, attributes);
  made.append(...children);
  return made;
}

function set(made: Element, attributes: Attributes): void {
  for (const [name, value] of Object.entries(attributes)) {
    if (value === true) made.setAttribute(name, "");
    else if (value !== false) made.setAttribute(name, value);
  }
}

export function button(label: string, action: () => void): HTMLButtonElement {
  const made = element("button", { type: "button" }, label);
  made.addEventListener("click", action);
  return made;
}

/** Text of an element, where it is another one: what stays costs no layout. */
export function write(place: Element, text: string): void {
  if (place.textContent !== text) place.textContent = text;
}

export function put(place: Element, name: string, value: string): void {
  if (place.getAttribute(name) !== value) place.setAttribute(name, value);
}

const REST = 300;

/** Words for everybody: shown at once, told aloud when they rest. */
export class Spoken {
  readonly root: HTMLElement;
  private readonly shown = element("p", { "aria-hidden": "true" });
  private readonly told = element("p", { role: "status", class: "unseen" });
  private resting: ReturnType<typeof setTimeout> | undefined;

  constructor(look: string) {
    this.root = element("div", { class: look }, this.shown, this.told);
  }

  say(words: string): void {
    write(this.shown, words);
    clearTimeout(this.resting);
    this.resting = setTimeout(() => write(this.told, words), REST);
  }
}

/** What draws a place, only while it can be seen; what it missed it draws when it comes into view. */
export function whileSeen(place: Element, draw: () => void): () => void {
  let seen = true;
  let stale = false;
  const drawn = (): void => {
    stale = !seen;
    if (seen) draw();
  };
  const look: IntersectionObserverCallback = (entries) => {
    seen = entries.at(-1)!.isIntersecting;
    if (stale) drawn();
  };
  new IntersectionObserver(look, { rootMargin: "60px" }).observe(place);
  return drawn;
}
