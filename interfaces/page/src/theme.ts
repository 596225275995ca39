// Light or dark: the colours of the style as a canvas needs them, and what the page around has chosen.

const CURVES = 8;
const DARK = "(prefers-color-scheme: dark)";
// attributes by which programs around a widget tell their theme: JupyterLab, VS Code, Colab
const ATTRIBUTES = ["data-jp-theme-light", "data-vscode-theme-kind", "theme"];

/** Colours by their names in the style of an element. */
export class Palette {
  private readonly known = new Map<string, string>();

  constructor(private readonly host: Element) {}

  colour(name: string): string {
    const found = this.known.get(name) ?? getComputedStyle(this.host).getPropertyValue(`--${name}`).trim();
    this.known.set(name, found);
    return found;
  }

  curve(number: number): string {
    return this.colour(`curve-${number % CURVES}`);
  }

  /** The style has other colours now. */
  forget(): void {
    this.known.clear();
  }
}

/** Whether it is dark around an element: what the program around says, otherwise what its reader prefers. */
export function isDark(place: Element): boolean {
  const jupyter = place.closest("[data-jp-theme-light]")?.getAttribute("data-jp-theme-light");
  if (jupyter) return jupyter === "false";
  const code = place.closest("[data-vscode-theme-kind]")?.getAttribute("data-vscode-theme-kind");
  if (code) return !code.endsWith("light");
  const colab = place.closest("html[theme]")?.getAttribute("theme");
  if (colab) return colab === "dark";
  const scheme = getComputedStyle(place).colorScheme;
  return scheme === "dark" || (scheme !== "light" && matchMedia(DARK).matches);
}

/** Tell whenever the theme may be another one; what is returned ends that. */
export function watchTheme(tell: () => void): () => void {
  const preferred = matchMedia(DARK);
  preferred.addEventListener("change", tell);
  const around = new MutationObserver(tell);
  around.observe(document.documentElement, { attributes: true, subtree: true, attributeFilter: ATTRIBUTES });
  return () => {
    preferred.removeEventListener("change", tell);
    around.disconnect();
  };
}

/** The switch of a style between light and dark, whatever the reader prefers: a widget follows its notebook. */
export function darkness(sheet: CSSStyleSheet): (dark: boolean) => void {
  const rules = [...sheet.cssRules].filter((rule): rule is CSSMediaRule => rule instanceof CSSMediaRule && rule.media.mediaText.includes("prefers-color-scheme"));
  return (dark) => rules.forEach((rule) => (rule.media.mediaText = dark ? "all" : "not all"));
}
