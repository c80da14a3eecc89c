import { el } from "./dom";

const kNarrow = matchMedia("(max-width: 900px)");

/// Adds a button to the heading that folds a section; initially folded on narrow screens. `opened`
/// draws content that has no size while folded.
export function foldable(section: HTMLElement | null, opened: () => void = () => undefined): HTMLElement | null {
  const heading = section?.querySelector("h2");
  if (!section || !heading) return section;
  const button = el("button", { type: "button", class: "fold" });
  const set = (folded: boolean) => {
    section.classList.toggle("folded", folded);
    button.setAttribute("aria-expanded", String(!folded));
    button.setAttribute("aria-label", `${folded ? "Open" : "Fold"} ${heading.firstChild?.textContent?.trim() ?? ""}`);
    button.textContent = folded ? "+" : "−";
  };
  button.addEventListener("click", () => {
    const folded = !section.classList.contains("folded");
    set(folded);
    if (!folded) opened();
  });
  heading.append(button);
  set(kNarrow.matches);
  return section;
}
