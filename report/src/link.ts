import type { Clock } from "./clock";
import { el } from "./dom";
import type { Plots } from "./plots";
import type { View } from "./view";

const kPatience = 300; // delay between the last change and the update of the address [ms]
const kDigits = 3; // of times and lengths

/// Time, tab and view of the page in the fragment of its address: t=1.25&tab=Base&view=...
export class MomentLink {
  readonly button = el("button", { type: "button", class: "link" }, "Copy link");
  private waiting = 0;
  private written = "";

  constructor(
    private readonly clock: Clock,
    private readonly plots: Plots,
    private readonly view: View | null,
  ) {
    this.button.title = "Copy a link to this moment, tab and view";
    this.button.addEventListener("click", () => void this.copy());
  }

  /// Applies the address; afterwards the address follows while the motion is paused.
  start(): void {
    this.read();
    this.clock.onChange(() => this.follow());
    this.plots.onChoose = () => this.follow();
    addEventListener("hashchange", () => location.hash !== this.written && this.read());
  }

  private read(): void {
    const values = new URLSearchParams(location.hash.slice(1));
    const tab = values.get("tab");
    if (tab) this.plots.chooseNamed(tab);
    const six = values.get("view")?.split(",").map(Number) ?? [];
    if (this.view && six.length === 6 && six.every(Number.isFinite)) this.view.cameraPose = six;
    const time = Number(values.get("t") ?? NaN);
    if (Number.isFinite(time)) {
      this.clock.pause();
      this.clock.seek(time);
    }
  }
  private follow(): void {
    clearTimeout(this.waiting);
    if (!this.clock.playing) this.waiting = setTimeout(() => this.write(), kPatience) as unknown as number;
  }
  private write(): void {
    const values = [`t=${Number(this.clock.time.toFixed(kDigits))}`, `tab=${encodeURIComponent(this.plots.tab)}`];
    if (this.view?.hasOwnCamera)
      values.push(`view=${this.view.cameraPose.map((x) => Number(x.toFixed(kDigits))).join()}`);
    this.written = `#${values.join("&")}`;
    try {
      history.replaceState(null, "", this.written);
    } catch {
      // Some browsers refuse this for pages opened from a file.
    }
  }
  private async copy(): Promise<void> {
    this.write();
    const address = location.href.split("#")[0] + this.written;
    try {
      await navigator.clipboard.writeText(address);
      this.button.textContent = "Copied";
      setTimeout(() => (this.button.textContent = "Copy link"), 1500);
    } catch {
      prompt("Link to this moment", address);
    }
  }
}
