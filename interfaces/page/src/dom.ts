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

const known = new Map<string, string>();
let host: Element | undefined;

/** The element whose style has the colours, where that is not the whole page. */
export function setHost(given: Element): void {
  host = given;
}

/** Colours of the style, as the canvas needs them. */
export function colour(name: string): string {
  const found = known.get(name) ?? getComputedStyle(host ?? document.documentElement).getPropertyValue(`--${name}`).trim();
  known.set(name, found);
  return found;
}

/** The style has other colours now. */
export function forgetColours(): void {
  known.clear();
}

export const CURVES = 8;

export function curveColour(number: number): string {
  return colour(`curve-${number % CURVES}`);
}

/** Text of an element, where it is another one: what stays costs no layout. */
export function write(place: Element, text: string): void {
  if (place.textContent !== text) place.textContent = text;
}

export function put(place: Element, name: string, value: string): void {
  if (place.getAttribute(name) !== value) place.setAttribute(name, value);
}

/** Tell whether an element can be seen, now and whenever that changes. */
export function watched(place: Element, tell: (seen: boolean) => void): void {
  new IntersectionObserver((entries) => tell(entries.at(-1)!.isIntersecting), { rootMargin: "60px" }).observe(place);
}
