type Theme = "light" | "dark";

const kKey = "prowl-theme";
const system = matchMedia("(prefers-color-scheme: dark)");

/// Light or dark: the system setting, until the reader chooses.
export class ThemeSwitch {
  readonly button = document.createElement("button");
  private chosen: Theme | null = null;

  constructor(private readonly changed: () => void) {
    this.button.type = "button";
    this.button.className = "theme";
    try {
      const stored = localStorage.getItem(kKey);
      if (stored === "light" || stored === "dark") this.chosen = stored;
    } catch {
      // Pages opened from a file may have no storage: then the choice is lost with the page.
    }
    this.button.addEventListener("click", () => this.choose(this.theme === "dark" ? "light" : "dark"));
    system.addEventListener("change", () => this.apply());
    this.apply();
  }

  private get theme(): Theme {
    return this.chosen ?? (system.matches ? "dark" : "light");
  }
  private choose(theme: Theme): void {
    this.chosen = theme;
    try {
      localStorage.setItem(kKey, theme);
    } catch {
      // as above
    }
    this.apply();
  }
  private apply(): void {
    document.documentElement.dataset.theme = this.theme;
    const other = this.theme === "dark" ? "light" : "dark";
    this.button.textContent = other === "dark" ? "Dark" : "Light";
    this.button.setAttribute("aria-label", `Switch to ${other} colours`);
    this.changed();
  }
}
